// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/page_routes.h"

#include <memory>
#include <string>
#include <utility>

#include "simulate/core/check.h"
#include "tools/view/page_files.h"
#include "tools/view/page_text.h"

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

void ServePage(HttpServer* server, EventBus* bus, std::function<nlohmann::ordered_json()> data,
               std::function<void()> listens) {
  const auto page = std::make_shared<const PageText>(EmbeddedPage());
  server->Get("/", [page, data = std::move(data)](const HttpRequest&) {
    return HttpReply{
        .type = "text/html; charset=utf-8", .body = page->With(data()), .may_run = page->policy()};
  });
  server->Stream("/api/events", "text/event-stream",
                 [bus, listens = std::move(listens)](const HttpRequest&) {
                   listens();
                   return bus->Subscribe();
                 });
}

}  // namespace flocklift
