// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/page_routes.h"

#include <string>
#include <utility>

#include "simulate/core/check.h"
#include "tools/view/page_files.h"

namespace flocklift {

HttpReply JsonReply(const nlohmann::ordered_json& json) {
  return {.body = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

HttpReply BinaryReply(std::string bytes) {
  return {.type = "application/octet-stream", .body = std::move(bytes)};
}

nlohmann::ordered_json BodyOf(const HttpRequest& request) {
  auto json = nlohmann::ordered_json::parse(request.body, nullptr, /*allow_exceptions=*/false);
  Check(json.is_object(), "the request must be a JSON object");
  return json;
}

void ServePage(HttpServer* server, EventBus* bus, const std::function<void()>& listens) {
  const PageFiles page = EmbeddedPage();
  const auto file = [server](const std::string& path, const std::string& type,
                             std::string_view text) {
    server->Get(path, [type, text](const HttpRequest&) {
      return HttpReply{.type = type, .body = std::string(text)};
    });
  };
  file("/", "text/html; charset=utf-8", page.html);
  file("/first.js", "text/javascript; charset=utf-8", page.first);
  file("/page.js", "text/javascript; charset=utf-8", page.script);
  file("/page.css", "text/css; charset=utf-8", page.style);
  server->Stream("/api/events", "text/event-stream", [bus, listens](const HttpRequest&) {
    listens();
    return bus->Subscribe();
  });
}

}  // namespace flocklift
