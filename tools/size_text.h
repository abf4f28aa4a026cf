// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sizes and points as they are typed: "1920x1080", "0,-45,1.7".

#ifndef FLOCKLIFT_TOOLS_SIZE_TEXT_H_
#define FLOCKLIFT_TOOLS_SIZE_TEXT_H_

#include <string>
#include <utility>

#include "simulate/core/vec3.h"

namespace flocklift {

// Throw CLI::ValidationError, which names the flag.
std::pair<int, int> ParseSize(const std::string& text, const std::string& flag);
Vec3d ParsePoint(const std::string& text, const std::string& flag);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_SIZE_TEXT_H_
