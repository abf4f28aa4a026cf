// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A picture of some frames for a person who has to decide who is who: panels over the span, cut out
// around the animals in question and enlarged, with tracks and ids.

#ifndef FLOCKLIFT_TOOLS_TRACK_PICTURE_H_
#define FLOCKLIFT_TOOLS_TRACK_PICTURE_H_

#include <filesystem>
#include <string>
#include <vector>

#include "simulate/core/observations.h"
#include "tools/track_overlay.h"

namespace flocklift {

struct PictureSpan {
  int first = 1, last = 1;
  std::vector<Id> ids;  // none: the whole picture
};

// "FIRST:LAST" or "FIRST:LAST:ID,ID,...". Throws CLI::ValidationError, which names the flag.
PictureSpan ParsePictureSpan(const std::string& text, const std::string& flag);

// "picture_12_40_3_7.png".
std::string NameOfPicture(const PictureSpan& span);

// Throws InputError when the footage ends before the span begins, or no track has one of the ids.
void WriteTrackPicture(const std::filesystem::path& footage, const TracksBetween& tracks,
                       const PictureSpan& span, const std::filesystem::path& picture);

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_TRACK_PICTURE_H_
