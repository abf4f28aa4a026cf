// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A contact sheet and a table of simulated scenes, from what `flocklift simulate --still` left of
// each. tools/gallery makes both for all scenes of data_synthetic/.

#ifndef FLOCKLIFT_TOOLS_GALLERY_SHEET_H_
#define FLOCKLIFT_TOOLS_GALLERY_SHEET_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "simulate/core/image.h"

namespace flocklift {

struct GalleryEntry {
  std::string name;
  std::int64_t agents = 0;
  double steps_per_second = 0;  // of CPU time, the stepping alone
  double mde_share = 0;         // of the animals, a step
  std::string paper_rate;       // frames/s as the paper has them; empty: none
  std::string paper_mde;        // likewise, with its unit
  Image still;
};

// `folder` holds summary.simulate.json and still.png of one run. Throws InputError when one is
// missing or lacks a figure.
GalleryEntry ReadGalleryEntry(const std::filesystem::path& folder, const std::string& name);

// What the papers say of a scene.
struct PaperFigures {
  std::string name, rate, mde;
};
// Lines `scene,frames per second,MDE`, after a header; # starts a comment.
std::vector<PaperFigures> ReadPaperFigures(const std::filesystem::path& path);

// The stills, all of one size, in rows of `columns`, each with a line of text below it.
Image ContactSheet(std::span<const GalleryEntry> entries, int columns);

// A markdown table.
std::string GalleryTable(std::span<const GalleryEntry> entries);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_GALLERY_SHEET_H_
