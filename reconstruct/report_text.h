// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a reconstruction has shown, in words.

#ifndef FLOCKLIFT_RECONSTRUCT_REPORT_TEXT_H_
#define FLOCKLIFT_RECONSTRUCT_REPORT_TEXT_H_

#include <string>
#include <vector>

#include "reconstruct/reconstruct.h"

namespace flocklift::internal {

// What relative depth and the common scale rest on in this solution, and how sure they are; whether
// speed and sizes agree, and whether forces count, as far as the report knows.
std::string DescribeSolution(const Knowledge& knowledge, const Segments& segments,
                             const BatchResult& batch, const ReconstructReport& report);

// The stated speed lies outside what the sizes say, however little it is trusted itself. `apart` is
// ReconstructReport::speed_by_sizes.
void WarnOfDisagreement(const Uncertain& apart, std::vector<std::string>* warnings);

// Few of its tracks have found their animal.
void WarnOfSecondCamera(const SecondCameraReport& second, std::vector<std::string>* warnings);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_RECONSTRUCT_REPORT_TEXT_H_
