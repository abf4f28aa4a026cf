// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Who may talk to the server of `view`. Any web page that is open in the same browser can send
// requests to this computer, and a name on the web can be made to point here (DNS rebinding). So a
// request is served only when
//   its Host is 127.0.0.1:PORT or localhost:PORT        (no rebinding)
//   its Origin, if it has one, is that of this server   (no other page reads or writes)
//   it does not come from another site (Sec-Fetch-Site) (no picture or frame in another page)
//   its path begins with a token of 128 random bits     (no other user of the computer)
// and when writing (POST), it must have an Origin and be JSON, which a form cannot send.

#ifndef FLOCKLIFT_TOOLS_VIEW_GUARD_H_
#define FLOCKLIFT_TOOLS_VIEW_GUARD_H_

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flocklift {

// What is known of a request before its body is read.
struct RequestHead {
  std::string method = {};
  std::string path = {};                  // decoded, without the query
  std::vector<std::string> hosts = {};    // every Host header
  std::vector<std::string> origins = {};  // every Origin header
  std::string fetch_site = {};            // Sec-Fetch-Site; empty: none
  std::string content_type = {};          // empty: none
  std::string range = {};                 // empty: none
  std::string content_length = {};        // empty: none
  bool has_transfer_encoding = false;     // a body of unknown length
  std::size_t header_bytes = 0;           // of all headers together
};

struct Refusal {
  int status = 403;
  std::string reason;  // for the person who wonders why
};

class Guard {
 public:
  static constexpr const char* kPolicy = "Content-Security-Policy";
  static constexpr std::size_t kMaxHeaderBytes = 16 << 10;
  static constexpr std::size_t kMaxBodyBytes = 1 << 20;

  Guard(std::string token, int port);

  const std::string& token() const { return token_; }
  // "http://127.0.0.1:PORT/TOKEN/"
  std::string Address() const;

  // Nothing when the request may be served.
  std::optional<Refusal> Refuse(const RequestHead& head) const;

  // The path below the token ("/api/session"); the request must have passed.
  std::string_view Below(std::string_view path) const;

  // Sent with every answer, the refusals too: nothing from outside is loaded, nobody may frame,
  // sniff or embed what is sent, and the token leaves in no Referer.
  static const std::vector<std::pair<std::string, std::string>>& AnswerHeaders();
  // The content security policy among them, with what may run (PageText::policy()) instead of
  // nothing.
  static std::string Policy(const std::string& may_run);

 private:
  std::string token_;
  int port_;
};

// 128 bits of the system's random numbers as 32 hexadecimal digits.
std::string NewToken();

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_GUARD_H_
