// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frames per second as people and files write them: a decimal, or a ratio such as 30000/1001.

#ifndef FLOCKLIFT_SIMULATE_CORE_FPS_H_
#define FLOCKLIFT_SIMULATE_CORE_FPS_H_

#include <optional>
#include <string>
#include <string_view>

namespace flocklift {

// Nothing when the text is neither, or the value is not in (0, 1e6].
std::optional<double> ParseFps(std::string_view text);

// The shortest text that ParseFps reads as the same number; NTSC rates as ratios over 1001.
std::string FormatFps(double fps);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_FPS_H_
