// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// News for every open page, as server-sent events (HTML Living Standard, section 9.2). Only the
// latest of each name is kept: a page that is slow, or opens later, learns how things stand now.

#ifndef FLOCKLIFT_TOOLS_VIEW_EVENT_BUS_H_
#define FLOCKLIFT_TOOLS_VIEW_EVENT_BUS_H_

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/view/http_server.h"

namespace flocklift {

class EventBus {
 public:
  void Publish(const std::string& name, const nlohmann::ordered_json& data);

  // One page's stream: what it has not seen yet, oldest first, and a comment when there is nothing
  // so that a closed page is noticed.
  HttpServer::Streamer Subscribe();

 private:
  struct News {
    std::uint64_t number = 0;
    std::string text;
  };
  // What came after `seen`, which moves on; waits a little for it.
  std::string Next(std::uint64_t* seen);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t last_ = 0;
  std::map<std::string, News> latest_;
};

}  // namespace flocklift

#endif  // FLOCKLIFT_TOOLS_VIEW_EVENT_BUS_H_
