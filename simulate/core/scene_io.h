// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reader of scene files (TOML, schema version 1, data_synthetic/README.md).

#ifndef FLOCKLIFT_SIMULATE_CORE_SCENE_IO_H_
#define FLOCKLIFT_SIMULATE_CORE_SCENE_IO_H_

#include <filesystem>
#include <string>
#include <string_view>

#include "simulate/core/scene.h"

namespace flocklift {

// Throws InputError with file, line and mend; an unknown key suggests the nearest known one. Names
// of models and their parameters are checked where the models are known (simulate/flock).
Scene ReadScene(const std::filesystem::path& path);
Scene ParseScene(std::string_view text, const std::string& name);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SCENE_IO_H_
