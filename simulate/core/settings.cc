// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulate/core/check.h"
#include "simulate/core/fps.h"
#include "simulate/core/suggest.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

long LineOf(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

std::string OnOneLine(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return line;
}

}  // namespace

toml::table ParseToml(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw InputError(name, static_cast<long>(error.source().begin.line),
                     "this is not TOML: " + OnOneLine(error.description()),
                     "mend the line; strings stand in quotation marks, lists in brackets");
  }
}

void FailAt(const toml::node& node, const std::string& name, const std::string& fault,
            const std::string& mend) {
  throw InputError(name, LineOf(node), fault, mend);
}

const toml::node* Settings::Find(std::string_view key) {
  known_.emplace_back(key);
  return table_.get(key);
}

double Settings::CheckedNumber(const toml::node& node, std::string_view key,
                               const Limits& limits) const {
  if (!node.is_number()) {
    FailAt(node, name_, fmt::format("{} in {} is not a number", key, heading_), "give a number");
  }
  const double value = node.value<double>().value_or(NAN);
  const bool legal =
      value >= limits.low && value <= limits.high && (limits.low_is_legal || value != limits.low);
  if (legal) return value;
  FailAt(node, name_, fmt::format("{} in {} is {:g}", key, heading_, value),
         fmt::format("give a number {} {:g} and at most {:g}",
                     limits.low_is_legal ? "of at least" : "above", limits.low, limits.high));
}

bool Settings::Number(std::string_view key, double* value, const Limits& limits) {
  const toml::node* const node = Find(key);
  if (node != nullptr) *value = CheckedNumber(*node, key, limits);
  return node != nullptr;
}

bool Settings::Integer(std::string_view key, std::int64_t* value, std::int64_t low,
                       std::int64_t high) {
  const toml::node* const node = Find(key);
  if (node == nullptr) return false;
  const toml::value<std::int64_t>* const integer = node->as_integer();
  if (integer == nullptr) {
    Fail(key, fmt::format("{} in {} is not a whole number", key, heading_), "give a whole number");
  }
  if (integer->get() < low || integer->get() > high) {
    Fail(key, fmt::format("{} in {} is {}", key, heading_, integer->get()),
         fmt::format("give a whole number from {} to {}", low, high));
  }
  *value = integer->get();
  return true;
}

bool Settings::Text(std::string_view key, std::string* value,
                    const std::vector<std::string>& choices) {
  const toml::node* const node = Find(key);
  if (node == nullptr) return false;
  const toml::value<std::string>* const text = node->as_string();
  if (text == nullptr) {
    Fail(key, fmt::format("{} in {} is not text", key, heading_), "put it in quotation marks");
  }
  const std::string& chosen = text->get();
  if (!choices.empty() && std::find(choices.begin(), choices.end(), chosen) == choices.end()) {
    Fail(key, fmt::format("{} in {} is {}", key, heading_, Quoted(chosen)),
         SuggestName(chosen, choices));
  }
  *value = chosen;
  return true;
}

bool Settings::Fps(std::string_view key, double* value) {
  const toml::node* const node = Find(key);
  if (node == nullptr) return false;
  std::optional<double> fps;
  if (const auto* text = node->as_string()) {
    fps = ParseFps(Trim(text->get()));
  } else if (node->is_number()) {
    fps = ParseFps(fmt::format("{}", *node->value<double>()));
  }
  if (!fps) {
    Fail(key, fmt::format("{} in {} is no rate", key, heading_),
         "give a positive number, or a ratio in quotation marks such as \"30000/1001\"");
  }
  *value = *fps;
  return true;
}

Vec3d Settings::CheckedVector(const toml::array& numbers, std::string_view key,
                              bool is_flat) const {
  if (numbers.size() != 3 && !(is_flat && numbers.size() == 2)) {
    FailAt(numbers, name_, fmt::format("{} in {} has {} numbers", key, heading_, numbers.size()),
           is_flat ? "give [x, y]" : "give [x, y, z] in metres");
  }
  Vec3d vector{CheckedNumber(numbers[0], key, {}), CheckedNumber(numbers[1], key, {}), 0};
  if (numbers.size() == 3) vector.z = CheckedNumber(numbers[2], key, {});
  if (is_flat) vector.z = 0;
  return vector;
}

bool Settings::Vector(std::string_view key, Vec3d* value, bool is_flat) {
  const toml::array* const numbers = FindArray(key);
  if (numbers != nullptr) *value = CheckedVector(*numbers, key, is_flat);
  return numbers != nullptr;
}

bool Settings::Corners(std::string_view key, Vec3d* low, Vec3d* high, bool is_flat) {
  const toml::array* const corners = FindArray(key);
  if (corners == nullptr) return false;
  if (corners->size() != 2 || !corners->is_homogeneous(toml::node_type::array)) {
    Fail(key, fmt::format("{} in {} is not a pair of corners", key, heading_),
         is_flat ? "give [[x, y], [x, y]]" : "give [[x, y, z], [x, y, z]]");
  }
  *low = CheckedVector(*(*corners)[0].as_array(), key, is_flat);
  *high = CheckedVector(*(*corners)[1].as_array(), key, is_flat);
  const Vec3d extent = *high - *low;
  const bool has_height = extent.z > 0 || (is_flat && extent.z == 0);
  if (!(extent.x > 0 && extent.y > 0 && has_height)) {
    Fail(key, fmt::format("{} in {} has no extent along some axis", key, heading_),
         "give the low corner first, then the high one");
  }
  return true;
}

bool Settings::Points(std::string_view key, std::vector<Vec3d>* points) {
  const toml::array* const list = FindArray(key);
  if (list == nullptr) return false;
  for (const toml::node& point : *list) {
    if (!point.is_array()) {
      FailAt(point, name_, fmt::format("{} in {} holds something that is no point", key, heading_),
             "give [[x, y, z], [x, y, z], ...]");
    }
    points->push_back(CheckedVector(*point.as_array(), key, false));
  }
  return true;
}

const toml::array* Settings::FindArray(std::string_view key) {
  const toml::node* const node = Find(key);
  if (node != nullptr && !node->is_array()) {
    Fail(key, fmt::format("{} in {} is not a list", key, heading_),
         "give a list in brackets, such as [1, 2, 3]");
  }
  return node == nullptr ? nullptr : node->as_array();
}

const toml::table* Settings::FindTable(std::string_view key) {
  const toml::node* const node = Find(key);
  if (node != nullptr && !node->is_table()) {
    Fail(key, fmt::format("{} in {} is not a table", key, heading_),
         fmt::format("write its keys below a heading [{}]", key));
  }
  return node == nullptr ? nullptr : node->as_table();
}

void Settings::EachTable(std::string_view key,
                         const std::function<void(const toml::table&)>& take) {
  const toml::node* const node = Find(key);
  if (node == nullptr) return;
  const toml::array* const array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    Fail(key, fmt::format("{} is not a list of tables", key),
         fmt::format("write each below a heading [[{}]]", key));
  }
  for (const toml::node& element : *array) take(*element.as_table());
}

bool Settings::Flag(std::string_view key, bool* value) {
  const toml::node* const node = Find(key);
  if (node == nullptr) return false;
  const toml::value<bool>* const flag = node->as_boolean();
  if (flag == nullptr) {
    Fail(key, fmt::format("{} in {} is neither true nor false", key, heading_),
         "write true or false");
  }
  *value = flag->get();
  return true;
}

bool Settings::File(std::string_view key, std::filesystem::path* value) {
  std::string file;
  if (!Text(key, &file)) return false;
  if (file.empty()) {
    Fail(key, fmt::format("{} in {} is empty", key, heading_), "name a file");
  }
  *value = std::filesystem::path(name_).parent_path() / file;
  return true;
}

void Settings::AllOthers(ModelSpec* model) {
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    known_.emplace_back(key.str());
    const std::string name(key.str());
    if (const toml::value<std::string>* const word = node.as_string()) {
      model->choices[name] = word->get();
    } else {
      model->parameters[name] = CheckedNumber(node, Quoted(key.str()), {});
    }
    model->where_of[name] = Where(key.str());
  }
}

void Settings::FailUnknown() const {
  const toml::key* first = nullptr;
  for (const auto& [key, node] : table_) {
    if (std::find(known_.begin(), known_.end(), key.str()) != known_.end()) continue;
    if (first == nullptr || key.source().begin.line < first->source().begin.line) first = &key;
  }
  if (first == nullptr) return;
  throw InputError(name_, static_cast<long>(first->source().begin.line),
                   fmt::format("unknown key {} in {}", Quoted(first->str()), heading_),
                   SuggestName(first->str(), known_));
}

void Settings::Fail(std::string_view key, const std::string& fault, const std::string& mend) const {
  const toml::node* const node = table_.get(key);
  FailAt(node != nullptr ? *node : table_, name_, fault, mend);
}

void Settings::FailMissing(std::string_view key, const std::string& mend) const {
  FailAt(table_, name_, fmt::format("{} is missing in {}", key, heading_), mend);
}

std::string Settings::Where(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  return fmt::format("{}:{}", name_, LineOf(node != nullptr ? *node : table_));
}

ModelSpec ReadForce(const toml::table& table, const std::string& name, const std::string& heading) {
  Settings settings(table, name, heading);
  ModelSpec force;
  if (!settings.Text("type", &force.name)) settings.FailMissing("type", "name the force term");
  force.where = settings.Where("type");
  settings.AllOthers(&force);
  return force;
}

std::string TomlNumber(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  const std::string text = fmt::format("{}", value);
  const bool is_float = text.find_first_of(".en") != std::string::npos;
  return is_float ? text : text + ".0";
}

std::string TomlText(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string TomlKey(std::string_view key) {
  const bool is_bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return is_bare ? std::string(key) : TomlText(key);
}

}  // namespace flocklift::internal
