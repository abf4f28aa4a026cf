// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <random>
#include <utility>

namespace flocklift {
namespace {

// Takes as long wherever the two differ, so that time tells nothing of the token.
bool EqualInConstantTime(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  }
  return difference == 0;
}

// Nothing, or a whole number of bytes that may be read.
bool IsBodyLength(const std::string& text) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  return text.empty() || (error == std::errc{} && end == text.data() + text.size() &&
                          length <= Guard::kMaxBodyBytes);
}

}  // namespace

Guard::Guard(std::string token, int port) : token_(std::move(token)), port_(port) {}

std::string Guard::Address() const { return fmt::format("http://127.0.0.1:{}/{}/", port_, token_); }

std::optional<Refusal> Guard::Refuse(const RequestHead& head) const {
  const auto is_here = [this](const std::string& host) {
    return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
  };
  const auto is_own = [&](const std::string& origin) {
    constexpr std::string_view kScheme = "http://";
    return origin.starts_with(kScheme) && is_here(origin.substr(kScheme.size()));
  };
  if (head.header_bytes > kMaxHeaderBytes) return Refusal{431, "the headers are too long"};
  if (head.hosts.size() != 1 || !is_here(head.hosts.front())) {
    return Refusal{403, "the host is not this computer"};
  }
  if (head.origins.size() > 1 || !std::all_of(head.origins.begin(), head.origins.end(), is_own)) {
    return Refusal{403, "the request comes from another page"};
  }
  if (!head.fetch_site.empty() && head.fetch_site != "same-origin" && head.fetch_site != "none") {
    return Refusal{403, "the request comes from another site"};
  }
  const std::string_view path = head.path;
  if (!path.starts_with('/') || path.size() < token_.size() + 2 ||
      !EqualInConstantTime(path.substr(1, token_.size()), token_) ||
      path[token_.size() + 1] != '/') {
    return Refusal{404, "use the whole address that flocklift printed"};
  }
  if (head.method != "GET" && head.method != "POST") {
    return Refusal{405, "only GET and POST are known"};
  }
  if (!IsBodyLength(head.content_length)) return Refusal{413, "the body is too long"};
  if (head.has_transfer_encoding) return Refusal{411, "say how long the body is"};
  if (head.range.find(',') != std::string::npos) return Refusal{416, "ask for one range"};
  if (head.method == "POST") {
    if (head.origins.empty()) return Refusal{403, "a request that writes must say its origin"};
    if (head.content_type != "application/json") return Refusal{415, "send JSON"};
  }
  return std::nullopt;
}

std::string_view Guard::Below(std::string_view path) const {
  return path.substr(token_.size() + 1);
}

const std::vector<std::pair<std::string, std::string>>& Guard::AnswerHeaders() {
  static const std::vector<std::pair<std::string, std::string>> headers = {
      {kPolicy, Policy("script-src 'none'; style-src 'none'")},
      {"X-Content-Type-Options", "nosniff"},
      {"X-Frame-Options", "DENY"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cache-Control", "no-store"}};
  return headers;
}

std::string Guard::Policy(const std::string& may_run) {
  return "default-src 'none'; " + may_run +
         "; img-src 'self' blob: data:; font-src data:; connect-src 'self'; media-src 'self'; "
         "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
}

std::string NewToken() {
  std::random_device device;  // the system's, on Linux
  std::string token;
  for (int k = 0; k < 4; ++k) token += fmt::format("{:08x}", device());
  return token;
}

}  // namespace flocklift
