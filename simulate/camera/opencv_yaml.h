// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of YAML that OpenCV's FileStorage writes for a calibration, and people write by hand:
// one `key: value` per entry at the start of a line, values being numbers, texts, lists of numbers,
// lists of rows, and `!!opencv-matrix` maps of rows, cols, dt and data. Entries that nobody asks
// for may hold anything. Read here rather than by cv::FileStorage because that tells no line
// numbers and was not made for files that it did not write.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_OPENCV_YAML_H_
#define FLOCKLIFT_SIMULATE_CAMERA_OPENCV_YAML_H_

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace flocklift {

// Row-major. A flat list has rows 0 and cols 0: its shape is for the reader of it to say.
struct YamlMatrix {
  int rows = 0, cols = 0;
  std::vector<double> values;  // all finite
};

// The entries of one file. Keys are compared without regard to case, as they changed it between
// OpenCV's versions. Every fault is an InputError with the line.
class OpenCvYaml {
 public:
  OpenCvYaml(std::string_view text, std::string name);

  bool Has(const std::string& key) const { return entries_.contains(key); }
  long Line(const std::string& key) const;  // where the entry begins; 0 when there is none
  const std::string& name() const { return name_; }

  // Each throws when the entry is missing or is none of the kind. `key` in lower case.
  double Number(const std::string& key) const;
  std::string Text(const std::string& key) const;  // a word or quoted text, comments removed
  YamlMatrix Matrix(const std::string& key) const;

 private:
  struct Entry {
    long line = 0;
    std::string_view value;  // what follows the colon, to the next entry
  };
  const Entry& Find(const std::string& key) const;

  std::string name_;
  std::string text_;
  std::map<std::string, Entry> entries_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_SIMULATE_CAMERA_OPENCV_YAML_H_
