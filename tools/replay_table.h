// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a replay parts from its reconstruction, as a table for people: at the times that the figures
// of the summary have, how far apart the two are on average (rms), beside a replay without noise,
// straight flight and what a small perturbation of the same flock grows to; and both flocks'
// statistics.

#ifndef FLOCKLIFT_TOOLS_REPLAY_TABLE_H_
#define FLOCKLIFT_TOOLS_REPLAY_TABLE_H_

#include <nlohmann/json.hpp>
#include <string>

namespace flocklift {

// `divergence` and `statistics` as in the figures of `replay`; empty without divergence.
std::string ReplayTable(const nlohmann::ordered_json& divergence,
                        const nlohmann::ordered_json& statistics);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_REPLAY_TABLE_H_
