// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The words of the YAML that simulate/camera/opencv_yaml.h reads, with their lines.

#ifndef FLOCKLIFT_SIMULATE_CAMERA_YAML_TOKENS_H_
#define FLOCKLIFT_SIMULATE_CAMERA_YAML_TOKENS_H_

#include <cstddef>
#include <string>
#include <string_view>

namespace flocklift::internal {

inline bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\r'; }
inline bool IsDigit(char c) { return c >= '0' && c <= '9'; }
std::string Lower(std::string_view text);  // of A to Z

struct Token {
  enum class Kind { kWord, kText, kOpen, kClose, kEnd };
  Kind kind = Kind::kEnd;
  std::string_view text;
  long line = 0;
};

// Words, quoted texts and square brackets; commas, braces and line ends only separate.
class Tokens {
 public:
  // `text` begins in line `line` of its file.
  Tokens(std::string_view text, long line) : rest_(text), line_(line) {}

  Token Next();

 private:
  void Skip();
  Token Take(Token::Kind kind, std::size_t length);
  Token TakeText(char quote);

  std::string_view rest_;
  long line_;
};

// The number that a token of `key` is. Throws InputError for anything else.
double FiniteNumber(const Token& token, const std::string& key, const std::string& file);

}  // namespace flocklift::internal

#endif  // FLOCKLIFT_SIMULATE_CAMERA_YAML_TOKENS_H_
