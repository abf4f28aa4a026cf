// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Any frame of the footage as a JPEG, exactly that one. Seeking in a video is by time and lands on
// a key frame, and what a container declares is often wrong; so all packets' times are read once,
// frame k is the one with the k-th smallest, and it is reached by decoding from the key frame
// before it. Going on to the next frame decodes only that.

#ifndef FLOCKLIFT_TOOLS_VIEW_FOOTAGE_H_
#define FLOCKLIFT_TOOLS_VIEW_FOOTAGE_H_

#include <filesystem>
#include <memory>
#include <string>

namespace flocklift {

class Footage {
 public:
  // A video, a folder of pictures or a pattern of them. Throws InputError when it is none.
  explicit Footage(const std::filesystem::path& path);
  ~Footage();
  Footage(const Footage&) = delete;
  Footage& operator=(const Footage&) = delete;

  int width() const;   // [px]
  int height() const;  // [px]
  int frame_count() const;
  // The video file, empty for pictures.
  const std::filesystem::path& file() const;

  // Frame `frame` (from 1), made smaller where it is wider than `widest` px; empty when there is no
  // such frame. Any thread may ask; frames asked for lately are kept.
  std::string Jpeg(int frame, int widest);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_FOOTAGE_H_
