// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The server over real sockets: what it serves, and that it refuses what a hostile page, a hostile
// name or a broken client may send.

#include "tools/view/http_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <thread>

#include "tools/view/event_bus.h"

namespace flocklift {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Sends bytes as they are, and returns all that comes back until the other side closes or is silent
// for a while. `heard` is told what has come so far, whenever more has.
std::string Talk(int port, const std::string& bytes, int silence_ms = 20'000,
                 const std::function<void(const std::string&)>& heard = {}) {
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  if (connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    close(s);
    return "no connection";
  }
  timeval timeout{silence_ms / 1000, silence_ms % 1000 * 1000};
  setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t n = send(s, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  std::string answer;
  char piece[4096];
  for (ssize_t n = 0; (n = recv(s, piece, sizeof piece, 0)) > 0;) {
    answer.append(piece, static_cast<std::size_t>(n));
    if (heard) heard(answer);
  }
  close(s);
  return answer;
}

class Server : public testing::Test {
 protected:
  Server() : server_(0), thread_([this] { server_.Run(); }) {
    // Routes may be added before anybody asks.
    server_.Get("/api/hello", [](const HttpRequest& r) {
      return HttpReply{.body = "{\"path\": \"" + r.path + "\", \"a\": \"" + r.Text("a") + "\"}"};
    });
    server_.Get("/page", [](const HttpRequest&) {
      return HttpReply{.body = "x", .may_run = "script-src 'sha256-x'; style-src 'none'"};
    });
    server_.Get("/frame/", [](const HttpRequest& r) { return HttpReply{.body = r.path}; });
    server_.Get("/number", [](const HttpRequest& r) {
      return HttpReply{.body = std::to_string(r.Number("n") + 1)};
    });
    server_.Get("/fails",
                [](const HttpRequest&) -> HttpReply { throw std::runtime_error("out of luck"); });
    server_.Post("/api/write", [this](const HttpRequest& r) {
      ++writes_;
      return HttpReply{.body = r.body};
    });
    server_.Get("/file", [this](const HttpRequest&) {
      return HttpReply{.type = "video/mp4", .file = file_};
    });
    server_.Stream("/api/events", "text/event-stream",
                   [this](const HttpRequest&) { return bus_.Subscribe(); });
  }
  ~Server() override {
    server_.Stop();
    thread_.join();
  }

  std::string Head(const std::string& method, const std::string& below) const {
    return method + " /" + server_.guard().token() + below +
           " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_.port()) +
           "\r\nConnection: close\r\n";
  }
  std::string Get(const std::string& below, const std::string& more = "") const {
    return Talk(server_.port(), Head("GET", below) + more + "\r\n");
  }
  std::string Origin() const {
    return "Origin: http://127.0.0.1:" + std::to_string(server_.port()) + "\r\n";
  }

  EventBus bus_;
  std::atomic<int> writes_ = 0;
  fs::path file_;
  HttpServer server_;
  std::thread thread_;
};

TEST_F(Server, ServesThePageItself) {
  const std::string answer = Get("/api/hello?a=b");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, EndsWith("{\"path\": \"/api/hello\", \"a\": \"b\"}"));
  EXPECT_THAT(Get("/frame/12"), EndsWith("/frame/12"));
  EXPECT_THAT(Get("/number?n=41"), EndsWith("42"));
  EXPECT_THAT(Get("/nothing"), StartsWith("HTTP/1.1 404"));
}

// Compression costs more than it saves on one computer.
TEST_F(Server, SendsWhatItHasAsItIs) {
  const std::string answer = Get("/api/hello?a=b", "Accept-Encoding: gzip, deflate, br\r\n");
  EXPECT_THAT(answer, Not(HasSubstr("Content-Encoding")));
  EXPECT_THAT(answer, EndsWith("{\"path\": \"/api/hello\", \"a\": \"b\"}"));
}

TEST_F(Server, EveryAnswerForbidsEverythingFromOutside) {
  const std::string port = std::to_string(server_.port());
  for (const std::string& answer :
       {Get("/api/hello"), Get("/nothing"), Get("/fails"),
        Talk(server_.port(),
             "GET / HTTP/1.1\r\nHost: 127.0.0.1:" + port + "\r\nConnection: close\r\n\r\n")}) {
    EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'"));
    EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'"));
    EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
    EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
    EXPECT_THAT(answer, HasSubstr("Cross-Origin-Resource-Policy: same-origin"));
    EXPECT_THAT(answer, Not(HasSubstr("Access-Control-Allow-Origin")));
  }
}

// Nothing runs in an answer but what it says itself, and that policy stands alone.
TEST_F(Server, ScriptsRunWhereTheAnswerNamesThem) {
  EXPECT_THAT(Get("/api/hello"), HasSubstr("script-src 'none'; style-src 'none';"));
  const std::string page = Get("/page");
  EXPECT_THAT(page, HasSubstr("default-src 'none'; script-src 'sha256-x'; style-src 'none'; img"));
  EXPECT_EQ(page.find("Content-Security-Policy"), page.rfind("Content-Security-Policy"));
}

TEST_F(Server, RefusesHostileHostsOriginsAndTokens) {
  const int port = server_.port();
  const std::string token = server_.guard().token();
  EXPECT_THAT(Talk(port, "GET /" + token + "/api/hello HTTP/1.1\r\nHost: evil.example:" +
                             std::to_string(port) + "\r\nConnection: close\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Talk(port, "GET /" + token + "/api/hello HTTP/1.0\r\n\r\n"), HasSubstr(" 403"));
  EXPECT_THAT(Get("/api/hello", "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Get("/api/hello", "Sec-Fetch-Site: cross-site\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(Talk(port, "GET /api/hello HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                             "\r\nConnection: close\r\n\r\n"),
              StartsWith("HTTP/1.1 404"));
}

TEST_F(Server, WritesForItsOwnPageOnly) {
  const std::string body = "{\"x\": 1}";
  const std::string length = "Content-Length: " + std::to_string(body.size()) + "\r\n";
  const std::string json = "Content-Type: application/json\r\n";
  const auto post = [&](const std::string& headers) {
    return Talk(server_.port(), Head("POST", "/api/write") + headers + length + "\r\n" + body);
  };
  EXPECT_THAT(post(Origin() + json), EndsWith(body));
  EXPECT_EQ(writes_, 1);
  EXPECT_THAT(post(json), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(post("Origin: null\r\n" + json), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(post("Origin: http://evil.example\r\n" + json), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(post(Origin() + "Content-Type: text/plain\r\n"), StartsWith("HTTP/1.1 415"));
  // What a page of another site asks before it may send JSON is refused, so that it never sends.
  EXPECT_THAT(Talk(server_.port(), Head("OPTIONS", "/api/write") +
                                       "Origin: http://evil.example\r\n"
                                       "Access-Control-Request-Method: POST\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  for (const char* method : {"PUT", "DELETE", "PATCH", "OPTIONS"}) {
    EXPECT_THAT(Talk(server_.port(), Head(method, "/api/write") + Origin() + "\r\n"),
                StartsWith("HTTP/1.1 405"))
        << method;
  }
  EXPECT_EQ(writes_, 1);
}

TEST_F(Server, BoundsWhatItReads) {
  const std::string json = Origin() + "Content-Type: application/json\r\n";
  EXPECT_THAT(Talk(server_.port(),
                   Head("POST", "/api/write") + json + "Content-Length: 4000000000\r\n\r\nx"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(Talk(server_.port(), Head("POST", "/api/write") + json +
                                       "Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"),
              StartsWith("HTTP/1.1 411"));
  EXPECT_THAT(Get("/" + std::string(20000, 'a')), HasSubstr(" 414"));
  std::string many;
  for (int k = 0; k < 40; ++k)
    many += "X-" + std::to_string(k) + ": " + std::string(1000, 'a') + "\r\n";
  EXPECT_THAT(Get("/api/hello", many), StartsWith("HTTP/1.1 431"));
  EXPECT_EQ(writes_, 0);
}

TEST_F(Server, TakesNoRefusedBodyForARequest) {
  const std::string inner = Head("POST", "/api/write") + Origin() +
                            "Content-Type: application/json\r\nContent-Length: 2\r\n\r\n{}";
  std::string outer =
      Head("POST", "/api/write") + "Origin: http://evil.example\r\n" +
      "Content-Type: text/plain\r\nContent-Length: " + std::to_string(inner.size()) + "\r\n\r\n" +
      inner;
  outer.replace(outer.find("Connection: close"), 17, "Connection: keep-alive");
  const std::string answer = Talk(server_.port(), outer);
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 403"));
  EXPECT_EQ(answer.find("HTTP/1.1", 8), std::string::npos) << answer;
  EXPECT_EQ(writes_, 0);
}

TEST_F(Server, SurvivesWhatIsNoHttp) {
  for (const std::string& bytes :
       std::vector<std::string>{"\r\n\r\n", std::string(100, '\0'), "GET\r\n\r\n", "hello\r\n\r\n",
                                "GET / HTTP/9.9\r\n\r\n", Head("GET", "/%zz%00%ff") + "\r\n",
                                Head("GET", "/files/..%2f..%2fetc%2fpasswd") + "\r\n",
                                Head("GET", "/file") + "Range: bytes=9-1\r\n\r\n"}) {
    EXPECT_THAT(Talk(server_.port(), bytes, 300), Not(HasSubstr(" 200 ")));
  }
  EXPECT_THAT(Get("/api/hello"), StartsWith("HTTP/1.1 200"));
}

TEST_F(Server, TellsMistakesInWords) {
  EXPECT_THAT(Get("/number?n=4x"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Get("/number"), EndsWith("{\"error\":\"the query needs a whole number n\"}"));
  EXPECT_THAT(Get("/fails"), StartsWith("HTTP/1.1 500"));
}

TEST_F(Server, ServesRangesOfAFile) {
  file_ = fs::path(testing::TempDir()) / "http_server_test.bin";
  std::ofstream(file_) << "0123456789";
  EXPECT_THAT(Get("/file"), EndsWith("\r\n\r\n0123456789"));
  const std::string middle = Get("/file", "Range: bytes=3-5\r\n");
  EXPECT_THAT(middle, StartsWith("HTTP/1.1 206"));
  EXPECT_THAT(middle, HasSubstr("Content-Range: bytes 3-5/10"));
  EXPECT_THAT(middle, EndsWith("\r\n\r\n345"));
  EXPECT_THAT(Get("/file", "Range: bytes=7-\r\n"), EndsWith("\r\n\r\n789"));
  EXPECT_THAT(Get("/file", "Range: bytes=0-1,4-5\r\n"), StartsWith("HTTP/1.1 416"));
  fs::remove(file_);
  EXPECT_THAT(Get("/file"), StartsWith("HTTP/1.1 404"));
}

TEST_F(Server, StreamsTheLatestNews) {
  bus_.Publish("solve", {{"done", 1}});
  bus_.Publish("solve", {{"done", 2}});
  bus_.Publish("data", {{"version", 7}});
  int told = 2;
  const std::string answer = Talk(
      server_.port(), Head("GET", "/api/events") + "\r\n", 20'000, [&](const std::string& so_far) {
        const auto has = [&](const char* news) { return so_far.find(news) != std::string::npos; };
        if (told == 2 && has("{\"version\":7}")) {
          told = 3;
          bus_.Publish("solve", {{"done", 3}});
        }
        if (has("{\"done\":3}")) server_.Stop();
      });
  EXPECT_THAT(answer, HasSubstr("text/event-stream"));
  EXPECT_THAT(answer, Not(HasSubstr("{\"done\":1}")));
  const auto second = answer.find("event: solve\ndata: {\"done\":2}\n\n");
  const auto data = answer.find("event: data\ndata: {\"version\":7}\n\n");
  const auto third = answer.find("event: solve\ndata: {\"done\":3}\n\n");
  EXPECT_LT(second, data);
  EXPECT_LT(data, third);
  EXPECT_NE(third, std::string::npos);
}

TEST(HttpServer, ListensOnTheLoopbackInterfaceOnly) {
  HttpServer server(0);
  std::thread thread([&server] { server.Run(); });
  // Linux answers the whole of 127/8 for a socket that is bound to all interfaces.
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(server.port()));
  inet_pton(AF_INET, "127.0.0.2", &address.sin_addr);
  EXPECT_NE(connect(s, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  close(s);
  server.Stop();
  thread.join();
}

TEST(HttpServer, SharesItsPortWithNobody) {
  HttpServer first(0);
  std::thread thread([&first] { first.Run(); });
  EXPECT_THROW(HttpServer(first.port()), std::runtime_error);
  first.Stop();
  thread.join();
}

}  // namespace
}  // namespace flocklift
