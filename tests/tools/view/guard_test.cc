// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/guard.h"

#include <gtest/gtest.h>

#include <set>

namespace flocklift {
namespace {

const char* const kToken = "0123456789abcdef0123456789abcdef";

std::string Around(std::string before, const char* after) {
  before += kToken;
  before += after;
  return before;
}

RequestHead Good() {
  return {.method = "GET", .path = Around("/", "/api/session"), .hosts = {"127.0.0.1:8123"}};
}

int StatusOf(const RequestHead& head) {
  const Guard guard(kToken, 8123);
  const auto refusal = guard.Refuse(head);
  return refusal ? refusal->status : 200;
}

TEST(Guard, LetsTheOwnPagePass) {
  EXPECT_EQ(StatusOf(Good()), 200);
  RequestHead named = Good();
  named.hosts = {"localhost:8123"};
  named.origins = {"http://localhost:8123"};
  named.fetch_site = "same-origin";
  EXPECT_EQ(StatusOf(named), 200);
  named.fetch_site = "none";  // typed by the person
  EXPECT_EQ(StatusOf(named), 200);
  EXPECT_EQ(Guard(kToken, 8123).Address(), Around("http://127.0.0.1:8123/", "/"));
  EXPECT_EQ(Guard(kToken, 8123).Below(Good().path), "/api/session");
}

TEST(Guard, RefusesANameThatWasMadeToPointHere) {
  for (const char* host : {"evil.example:8123", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:81230",
                           "127.0.0.1.evil.example:8123", "localhost", "[::1]:8123", ""}) {
    RequestHead head = Good();
    head.hosts = {host};
    EXPECT_EQ(StatusOf(head), 403) << host;
  }
  RequestHead none = Good();
  none.hosts.clear();
  EXPECT_EQ(StatusOf(none), 403);
  RequestHead two = Good();
  two.hosts = {"127.0.0.1:8123", "127.0.0.1:8123"};
  EXPECT_EQ(StatusOf(two), 403);
}

TEST(Guard, RefusesOtherPages) {
  for (const char* origin : {"http://evil.example", "https://127.0.0.1:8123", "null", "",
                             "http://127.0.0.1:8124", "http://127.0.0.1:8123.evil.example"}) {
    RequestHead head = Good();
    head.origins = {origin};
    EXPECT_EQ(StatusOf(head), 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site", "weird"}) {
    RequestHead head = Good();
    head.fetch_site = site;
    EXPECT_EQ(StatusOf(head), 403) << site;
  }
}

TEST(Guard, RefusesWhoDoesNotKnowTheToken) {
  for (const std::string& path : std::vector<std::string>{
           "/", "", "/api/session", "/0123456789abcdef0123456789abcdee/api/session",
           "/0123456789abcdef0123456789abcdef", "/0123456789ABCDEF0123456789ABCDEF/",
           "//0123456789abcdef0123456789abcdef/", "/x/../0123456789abcdef0123456789abcdef/"}) {
    RequestHead head = Good();
    head.path = path;
    EXPECT_EQ(StatusOf(head), 404) << path;
  }
}

TEST(Guard, WritesOnlyWhatAFormCannotSend) {
  RequestHead head = Good();
  head.method = "POST";
  head.content_type = "application/json";
  EXPECT_EQ(StatusOf(head), 403);  // no Origin
  head.origins = {"http://127.0.0.1:8123"};
  EXPECT_EQ(StatusOf(head), 200);
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded",
                           "multipart/form-data; boundary=x", "application/json; charset=x"}) {
    head.content_type = type;
    EXPECT_EQ(StatusOf(head), 415) << type;
  }
}

TEST(Guard, RefusesWhatItDoesNotKnow) {
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "CONNECT", "get", ""}) {
    RequestHead head = Good();
    head.method = method;
    EXPECT_EQ(StatusOf(head), 405) << method;
  }
  RequestHead chunked = Good();
  chunked.has_transfer_encoding = true;
  EXPECT_EQ(StatusOf(chunked), 411);
  RequestHead ranges = Good();
  ranges.range = "bytes=0-1,4-5";
  EXPECT_EQ(StatusOf(ranges), 416);
  for (const char* length : {"1048577", "4000000000", "-1", "1x", "99999999999999999999999"}) {
    RequestHead head = Good();
    head.content_length = length;
    EXPECT_EQ(StatusOf(head), 413) << length;
  }
  RequestHead large = Good();
  large.header_bytes = Guard::kMaxHeaderBytes + 1;
  EXPECT_EQ(StatusOf(large), 431);
}

TEST(Guard, TokensAreLongAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    const std::string token = NewToken();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100u);
}

}  // namespace
}  // namespace flocklift
