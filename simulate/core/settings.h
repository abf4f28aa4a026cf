// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Checked reading of TOML tables: every key is asked for by name, with its type and range; what
// nobody asked for is an error that suggests the nearest key. Only for sources: it drags in toml++.

#ifndef FLOCKLIFT_SIMULATE_CORE_SETTINGS_H_
#define FLOCKLIFT_SIMULATE_CORE_SETTINGS_H_

#include <toml++/toml.h>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/core/scene.h"
#include "simulate/core/vec3.h"

namespace flocklift::internal {

// InputError with the line when the text is not TOML.
toml::table ParseToml(std::string_view text, const std::string& name);

// A value's own line in the file `name`.
[[noreturn]] void FailAt(const toml::node& node, const std::string& name, const std::string& fault,
                         const std::string& mend);

// Legal values of a number; `above` is itself not legal.
struct Limits {
  double low = -1e9, high = 1e9;
  bool low_is_legal = true;

  static Limits Positive(double high = 1e9) { return {0, high, false}; }
};

class Settings {
 public:
  // `heading` is how a person writes the table: "[scene]".
  Settings(const toml::table& table, std::string name, std::string heading)
      : table_(table), name_(std::move(name)), heading_(std::move(heading)) {}

  // Each leaves `value` alone when the key is absent, and returns whether it is there.
  bool Number(std::string_view key, double* value, const Limits& limits = {});
  bool Integer(std::string_view key, std::int64_t* value, std::int64_t low, std::int64_t high);
  bool Text(std::string_view key, std::string* value, const std::vector<std::string>& choices = {});
  bool Fps(std::string_view key, double* value);  // a number, or a ratio as text
  // [x, y, z]; when `is_flat`, also [x, y], and z becomes 0.
  bool Vector(std::string_view key, Vec3d* value, bool is_flat);

  // [[x, y, z], [x, y, z]]: the low corner of a box with some extent, then the high one.
  bool Corners(std::string_view key, Vec3d* low, Vec3d* high, bool is_flat);

  // [[x, y, z], ...].
  bool Points(std::string_view key, std::vector<Vec3d>* points);

  // The node of a key, null when absent; checks nothing but marks the key as known.
  const toml::node* Find(std::string_view key);
  const toml::array* FindArray(std::string_view key);
  const toml::table* FindTable(std::string_view key);
  // Calls `take` for each table of [[key]].
  void EachTable(std::string_view key, const std::function<void(const toml::table&)>& take);
  bool Flag(std::string_view key, bool* value);
  // A path, made relative to the folder of this file.
  bool File(std::string_view key, std::filesystem::path* value);
  // Every key that nobody asked for yet, a number or a word, and "FILE:LINE" of each: names that
  // only the model knows.
  void AllOthers(ModelSpec* model);

  // Fails at the first key that none of the above was asked for.
  void FailUnknown() const;
  [[noreturn]] void Fail(std::string_view key, const std::string& fault,
                         const std::string& mend) const;
  [[noreturn]] void FailMissing(std::string_view key, const std::string& mend) const;

  const toml::table& table() const { return table_; }
  const std::string& name() const { return name_; }
  std::string Where(std::string_view key) const;  // "FILE:LINE" of the key, or else of the table

 private:
  double CheckedNumber(const toml::node& node, std::string_view key, const Limits& limits) const;
  Vec3d CheckedVector(const toml::array& numbers, std::string_view key, bool is_flat) const;

  const toml::table& table_;
  std::string name_, heading_;
  std::vector<std::string> known_;
};

// The force term of a table such as [[species.force]]: `type` names it.
ModelSpec ReadForce(const toml::table& table, const std::string& name, const std::string& heading);

// A finite number as TOML, the shortest text that reads the same; and text in quotation marks.
std::string TomlNumber(double value);
std::string TomlText(std::string_view text);
std::string TomlKey(std::string_view key);  // in quotation marks where TOML needs them

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CORE_SETTINGS_H_
