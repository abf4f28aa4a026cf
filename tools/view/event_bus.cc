// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/event_bus.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

namespace flocklift {

void EventBus::Publish(const std::string& name, const nlohmann::ordered_json& data) {
  const std::string text =
      "event: " + name +
      "\ndata: " + data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
      "\n\n";
  {
    const std::lock_guard lock(mutex_);
    latest_[name] = {++last_, text};
  }
  changed_.notify_all();
}

HttpServer::Streamer EventBus::Subscribe() {
  auto seen = std::make_shared<std::uint64_t>(0);
  return [this, seen](const HttpServer::Sink& write) {
    const std::string text = Next(seen.get());
    return write(text.empty() ? ":\n\n" : text);
  };
}

std::string EventBus::Next(std::uint64_t* seen) {
  constexpr std::chrono::milliseconds kWait(300);
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kWait, [&] { return last_ > *seen; });
  std::vector<const News*> fresh;
  for (const auto& [name, news] : latest_) {
    if (news.number > *seen) fresh.push_back(&news);
  }
  std::sort(fresh.begin(), fresh.end(),
            [](const News* a, const News* b) { return a->number < b->number; });
  std::string text;
  for (const News* news : fresh) text += news->text;
  *seen = last_;
  return text;
}

}  // namespace flocklift
