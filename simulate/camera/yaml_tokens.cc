// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/camera/yaml_tokens.h"

#include <algorithm>

#include "simulate/core/check.h"
#include "simulate/core/text.h"

namespace flocklift::internal {
namespace {

bool IsNotFinite(std::string_view text) {
  const std::string lower = Lower(text);
  return lower.find("nan") != std::string::npos || lower.find("inf") != std::string::npos;
}

}  // namespace

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

Token Tokens::Next() {
  Skip();
  if (rest_.empty()) return {Token::Kind::kEnd, {}, line_};
  const char c = rest_.front();
  if (c == '[') return Take(Token::Kind::kOpen, 1);
  if (c == ']') return Take(Token::Kind::kClose, 1);
  if (c == '"' || c == '\'') return TakeText(c);
  const auto length = std::min(rest_.find_first_of(" \t\r\n,[]{}"), rest_.size());
  const auto colon = rest_.substr(0, length).find(':');
  return Take(Token::Kind::kWord, colon == std::string_view::npos ? length : colon + 1);
}

void Tokens::Skip() {
  char before = ' ';
  while (!rest_.empty()) {
    const char c = rest_.front();
    if (c == '#' && (IsSpace(before) || before == '\n')) {
      rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
      before = ' ';
      continue;
    }
    if (!IsSpace(c) && c != '\n' && c != ',' && c != '{' && c != '}') return;
    if (c == '\n') ++line_;
    before = c;
    rest_.remove_prefix(1);
  }
}

Token Tokens::Take(Token::Kind kind, std::size_t length) {
  const Token token{kind, rest_.substr(0, length), line_};
  rest_.remove_prefix(length);
  return token;
}

Token Tokens::TakeText(char quote) {
  const auto end = std::min(rest_.find(quote, 1), rest_.size());
  const Token token{Token::Kind::kText, rest_.substr(1, end - 1), line_};
  line_ += std::count(token.text.begin(), token.text.end(), '\n');
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  return token;
}

double FiniteNumber(const Token& token, const std::string& key, const std::string& file) {
  if (token.kind == Token::Kind::kWord) {
    if (const auto value = ParseReal(token.text)) return *value;
    if (IsNotFinite(token.text)) {
      throw InputError(file, token.line, key + " holds " + Quoted(token.text),
                       "every number must be finite; calibrate again");
    }
  }
  const bool ended = token.kind == Token::Kind::kEnd;
  throw InputError(file, token.line,
                   key + (ended ? " ends too early" : " holds " + Quoted(token.text)),
                   "a number is wanted there");
}

}  // namespace flocklift::internal
