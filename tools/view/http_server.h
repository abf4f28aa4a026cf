// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A web server on the loopback interface only, behind a Guard. Handlers are looked up by the path
// below the token; each runs on a thread of the server's pool, several at a time.

#ifndef FLOCKLIFT_TOOLS_VIEW_HTTP_SERVER_H_
#define FLOCKLIFT_TOOLS_VIEW_HTTP_SERVER_H_

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tools/view/guard.h"

namespace flocklift {

struct HttpRequest {
  std::string path;  // below the token
  std::map<std::string, std::string> query;
  std::string body;

  // A whole number of the query. Throws InputError when it is missing or none.
  int Number(const std::string& name) const;
  std::string Text(const std::string& name, const std::string& fallback = "") const;
};

struct HttpReply {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  std::optional<std::filesystem::path> file = {};  // instead of the body; ranges are served
  std::string download_name = {};                  // not empty: to be saved under this name
  std::string may_run = {};                        // not empty: for Guard::Policy
};

class HttpServer {
 public:
  using Handler = std::function<HttpReply(const HttpRequest&)>;
  // Sends a piece of an endless answer; false when nobody listens any more.
  using Sink = std::function<bool(std::string_view)>;
  // Called again and again until it returns false; must come back every few tenths of a second.
  using Streamer = std::function<bool(const Sink&)>;
  using StreamHandler = std::function<Streamer(const HttpRequest&)>;

  // Binds 127.0.0.1:`port` (0: any that is free). Throws std::runtime_error when it is taken.
  explicit HttpServer(int port);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  void Get(const std::string& path, Handler handler);
  void Post(const std::string& path, Handler handler);
  void Stream(const std::string& path, const std::string& type, StreamHandler handler);

  const Guard& guard() const;
  int port() const;

  // Serves until Stop, which any thread may call. A handler's InputError and invalid_argument
  // become status 400 and {"error": "..."}.
  void Run();
  void Stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_HTTP_SERVER_H_
