// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// flocklift_gallery PAPERS.csv SHEET.jpg RUN...: the second half of tools/gallery. Writes the
// contact sheet, and the table on standard output.

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <vector>

#include "simulate/core/atomic_file.h"
#include "simulate/media/image_codec.h"
#include "tools/gallery_sheet.h"

int main(int argc, char** argv) {
  constexpr int kColumns = 3;
  constexpr int kQuality = 85;  // of 100
  try {
    if (argc < 4) {
      fmt::print(stderr, "usage: flocklift_gallery PAPERS.csv SHEET.jpg RUN...\n");
      return 2;
    }
    const auto papers = flocklift::ReadPaperFigures(argv[1]);
    std::vector<flocklift::GalleryEntry> entries;
    for (int k = 3; k < argc; ++k) {
      const std::filesystem::path folder = argv[k];
      auto& entry =
          entries.emplace_back(flocklift::ReadGalleryEntry(folder, folder.filename().string()));
      for (const auto& paper : papers) {
        if (paper.name != entry.name) continue;
        entry.paper_rate = paper.rate;
        entry.paper_mde = paper.mde;
      }
    }
    const auto sheet = flocklift::EncodeJpeg(flocklift::ContactSheet(entries, kColumns), kQuality);
    flocklift::WriteTextFile(argv[2], {reinterpret_cast<const char*>(sheet.data()), sheet.size()});
    fmt::print("{}", flocklift::GalleryTable(entries));
  } catch (const std::exception& error) {
    fmt::print(stderr, "flocklift_gallery: {}\n", error.what());
    return 2;
  }
  return 0;
}
