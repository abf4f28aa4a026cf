// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Reader and writer of scene files (TOML, schema version 1, data_synthetic/README.md).

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
// A relative camera file is relative to the folder of the scene.
Scene ParseScene(std::string_view text, const std::string& name);

// The file's text with every key, defaults included; numbers read back as the same double, and
// a camera file stands with its absolute name.
std::string FormatScene(const Scene& scene);
void WriteScene(const std::filesystem::path& path, const Scene& scene);

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CORE_SCENE_IO_H_
