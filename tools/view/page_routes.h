// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every view serves: the page itself, its news, and answers as JSON.

#ifndef FLOCKLIFT_TOOLS_VIEW_PAGE_ROUTES_H_
#define FLOCKLIFT_TOOLS_VIEW_PAGE_ROUTES_H_

#include <functional>
#include <nlohmann/json.hpp>

#include "tools/view/event_bus.h"
#include "tools/view/http_server.h"

namespace flocklift {

HttpReply JsonReply(const nlohmann::ordered_json& json);
HttpReply BinaryReply(std::string bytes);

// The body of a POST; throws std::invalid_argument when it is no JSON object.
nlohmann::ordered_json BodyOf(const HttpRequest& request);

// "/", the page with what it is to show first, and "/api/events" from the bus, which must outlive
// the server. Calls `listens` when a page begins to.
void ServePage(
    HttpServer* server, EventBus* bus, std::function<nlohmann::ordered_json()> data,
    std::function<void()> listens = [] {});

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_PAGE_ROUTES_H_
