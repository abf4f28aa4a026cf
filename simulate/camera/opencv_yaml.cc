// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/opencv_yaml.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simulate/camera/yaml_tokens.h"
#include "simulate/core/check.h"
#include "simulate/core/text.h"

namespace flocklift {
namespace {

using internal::FiniteNumber;
using internal::IsDigit;
using internal::IsSpace;
using internal::Lower;
using internal::Token;
using internal::Tokens;

// The rest of a list whose opening bracket was read: numbers, or rows of numbers.
YamlMatrix ParseList(Tokens* tokens, long line, const std::string& key, const std::string& file) {
  YamlMatrix matrix;
  std::size_t row_length = 0, row_begin = 0;
  bool in_row = false;
  while (true) {
    const Token token = tokens->Next();
    if (token.kind == Token::Kind::kEnd) {
      throw InputError(file, line, "the list of " + key + " is not closed", "add the missing ']'");
    }
    if (token.kind == Token::Kind::kOpen) {
      if (in_row || (matrix.rows == 0 && !matrix.values.empty())) {
        throw InputError(file, token.line, key + " is nested too deep or unevenly",
                         "write a list of numbers or a list of rows");
      }
      in_row = true;
      row_begin = matrix.values.size();
      ++matrix.rows;
    } else if (token.kind == Token::Kind::kClose) {
      if (!in_row) return matrix;
      in_row = false;
      const std::size_t length = matrix.values.size() - row_begin;
      if (matrix.rows > 1 && length != row_length) {
        throw InputError(file, token.line, "the rows of " + key + " differ in length",
                         "give every row the same number of values");
      }
      row_length = length;
      matrix.cols = static_cast<int>(row_length);
    } else {
      if (!in_row && matrix.rows > 0) {
        throw InputError(file, token.line, key + " mixes rows and numbers",
                         "write a list of numbers or a list of rows");
      }
      matrix.values.push_back(FiniteNumber(token, key, file));
    }
  }
}

// The items of a `- 1.0` list whose first dash was read.
YamlMatrix ParseDashes(Tokens* tokens, const std::string& key, const std::string& file) {
  YamlMatrix matrix;
  Token token{Token::Kind::kWord, "-", 0};
  while (token.kind != Token::Kind::kEnd) {
    if (token.text != "-") {
      throw InputError(file, token.line, key + " holds " + Quoted(token.text),
                       "begin each item with '- ' and a number");
    }
    matrix.values.push_back(FiniteNumber(tokens->Next(), key, file));
    token = tokens->Next();
  }
  return matrix;
}

int ParseDimension(const Token& token, const std::string& key, const std::string& file) {
  const double value = FiniteNumber(token, key, file);
  if (value < 0 || value > 1e8 || value != std::floor(value)) {
    throw InputError(file, token.line, key + " has a dimension of " + Quoted(token.text),
                     "rows and cols are whole numbers");
  }
  return static_cast<int>(value);
}

// rows, cols, dt, data in any order; `token` is the first key.
YamlMatrix ParseMap(Token token, Tokens* tokens, long line, const std::string& key,
                    const std::string& file) {
  std::optional<int> rows, cols;
  std::optional<YamlMatrix> data;
  for (; token.kind != Token::Kind::kEnd; token = tokens->Next()) {
    const Token value = tokens->Next();
    if (token.text == "rows:") {
      rows = ParseDimension(value, key, file);
    } else if (token.text == "cols:") {
      cols = ParseDimension(value, key, file);
    } else if (token.text == "dt:") {
      if (value.text.size() != 1) {
        throw InputError(file, value.line, key + " has elements of type " + Quoted(value.text),
                         "write it with one channel (dt: d)");
      }
    } else if (token.text == "data:" && value.kind == Token::Kind::kOpen) {
      data = ParseList(tokens, value.line, key, file);
    } else if (token.text == "data:") {
      throw InputError(file, value.line, "the data of " + key + " is no list in [ ]",
                       "write it as text, without base64");
    } else {
      throw InputError(file, token.line, key + " holds " + Quoted(token.text),
                       "write a list, or rows, cols, dt and data as OpenCV does");
    }
  }
  if (!rows || !cols || !data) {
    throw InputError(file, line,
                     key + " has no " +
                         (!rows   ? "rows"
                          : !cols ? "cols"
                                  : "data"),
                     "write rows, cols, dt and data as OpenCV does");
  }
  const auto count = static_cast<std::size_t>(*rows) * static_cast<std::size_t>(*cols);
  if (data->values.size() != count) {
    throw InputError(file, line,
                     key + " has " + std::to_string(data->values.size()) + " values for " +
                         std::to_string(*rows) + " x " + std::to_string(*cols),
                     "mend its rows, cols or data");
  }
  return {*rows, *cols, std::move(data->values)};
}

// Does a line at the left margin go on with the entry above it?
bool Continues(std::string_view line) {
  const char c = line.front();
  if (c == '-' || c == '+' || c == '.') {
    return line.size() == 1 || IsSpace(line[1]) || IsDigit(line[1]) || line[1] == '.';
  }
  return IsDigit(c) || c == ']' || c == '}' || c == ',' || c == '[';
}

}  // namespace

OpenCvYaml::OpenCvYaml(std::string_view text, std::string name)
    : name_(std::move(name)), text_(text) {
  std::string_view rest = text_;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  const auto first = rest.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) {
    throw InputError(name_, 0, "the file is empty", "write a camera with `flocklift camera`");
  }
  if (text_.find('\0') != std::string::npos) {
    throw InputError(name_, 0, "the file is not text",
                     "give OpenCV's YAML, not a video or picture");
  }
  if (rest[first] == '<' || rest[first] == '{') {
    throw InputError(name_, 0, rest[first] == '<' ? "the file is XML" : "the file is JSON",
                     "let OpenCV write YAML, by a name that ends in .yaml");
  }

  Entry* current = nullptr;
  const char* value_begin = nullptr;
  long number = 0;
  const auto close = [&](const char* end) {
    if (current != nullptr) {
      current->value = {value_begin, static_cast<std::size_t>(end - value_begin)};
    }
  };
  while (!rest.empty()) {
    ++number;
    const auto length = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, length);
    if (line.ends_with('\r')) line.remove_suffix(1);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    if (Trim(line).empty() || line.front() == '#' || line.front() == '%' || IsSpace(line.front())) {
      if (current == nullptr && !Trim(line).empty() && IsSpace(line.front()) &&
          Trim(line).front() != '#') {
        throw InputError(name_, number, "an indented line belongs to no key",
                         "begin every key at the left margin");
      }
      continue;
    }
    if (line.starts_with("---") && current == nullptr) continue;
    if (line.starts_with("...")) break;
    if (line.starts_with("---")) {
      throw InputError(name_, number, "a second document begins", "keep one camera in a file");
    }
    if (current != nullptr && Continues(line)) continue;

    const auto colon = line.find(':');
    if (colon == std::string_view::npos) {
      throw InputError(name_, number, Quoted(Trim(line)) + " is no 'key: value'",
                       "remove the line or indent what goes on from above");
    }
    std::string key = Lower(Trim(line.substr(0, colon)));
    if (key.size() >= 2 && (key.front() == '"' || key.front() == '\'') && key.back() == key[0]) {
      key = key.substr(1, key.size() - 2);
    }
    close(line.data());
    const auto [entry, is_new] = entries_.try_emplace(key);
    if (!is_new) {
      throw InputError(name_, number,
                       "the key " + Quoted(key) + " of line " + std::to_string(entry->second.line) +
                           " comes again",
                       "keep one of them");
    }
    current = &entry->second;
    current->line = number;
    value_begin = line.data() + colon + 1;
  }
  close(rest.empty() ? text_.data() + text_.size() : rest.data());
}

long OpenCvYaml::Line(const std::string& key) const {
  const auto entry = entries_.find(key);
  return entry == entries_.end() ? 0 : entry->second.line;
}

const OpenCvYaml::Entry& OpenCvYaml::Find(const std::string& key) const {
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) {
    throw InputError(name_, 0, "the key " + key + " is missing",
                     "calibrate with `flocklift calibrate`, or add it");
  }
  return entry->second;
}

double OpenCvYaml::Number(const std::string& key) const {
  const Entry& entry = Find(key);
  Tokens tokens(entry.value, entry.line);
  const double value = FiniteNumber(tokens.Next(), key, name_);
  const Token more = tokens.Next();
  if (more.kind != Token::Kind::kEnd) {
    throw InputError(name_, more.line, key + " is followed by " + Quoted(more.text),
                     "write one number");
  }
  return value;
}

std::string OpenCvYaml::Text(const std::string& key) const {
  const Entry& entry = Find(key);
  Tokens tokens(entry.value, entry.line);
  const Token token = tokens.Next();
  if (token.kind != Token::Kind::kWord && token.kind != Token::Kind::kText) {
    throw InputError(name_, token.line, key + " is empty or a list", "write one word");
  }
  return std::string(Trim(token.text));
}

YamlMatrix OpenCvYaml::Matrix(const std::string& key) const {
  const Entry& entry = Find(key);
  Tokens tokens(entry.value, entry.line);
  Token token = tokens.Next();
  if (token.kind == Token::Kind::kWord && token.text.starts_with("!")) {
    // The tag: two exclamation marks and opencv-matrix, which has no colon and so is one word.
    token = tokens.Next();
  }
  YamlMatrix matrix;
  if (token.kind == Token::Kind::kOpen) {
    matrix = ParseList(&tokens, token.line, key, name_);
    token = tokens.Next();
    if (token.kind != Token::Kind::kEnd) {
      throw InputError(name_, token.line, key + " is followed by " + Quoted(token.text),
                       "write one list");
    }
  } else if (token.kind == Token::Kind::kWord && token.text == "-") {
    matrix = ParseDashes(&tokens, key, name_);
  } else if (token.kind == Token::Kind::kEnd) {
    throw InputError(name_, entry.line, key + " has no value", "write a list in [ ]");
  } else {
    matrix = ParseMap(token, &tokens, entry.line, key, name_);
  }
  return matrix;
}

}  // namespace flocklift
