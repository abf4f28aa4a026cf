// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools/view/http_server.h"

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "simulate/core/check.h"

namespace flocklift {
namespace {

constexpr int kThreads = 24;  // event streams keep one each
constexpr std::size_t kPiece = 256 << 10;

RequestHead HeadOf(const httplib::Request& request) {
  RequestHead head;
  head.method = request.method;
  head.path = request.path;
  const auto all = [&request](const char* name) {
    std::vector<std::string> values;
    const auto [first, end] = request.headers.equal_range(name);
    for (auto it = first; it != end; ++it) values.push_back(it->second);
    return values;
  };
  head.hosts = all("Host");
  head.origins = all("Origin");
  head.fetch_site = request.get_header_value("Sec-Fetch-Site");
  head.content_type = request.get_header_value("Content-Type");
  head.range = request.get_header_value("Range");
  head.content_length = request.get_header_value("Content-Length");
  head.has_transfer_encoding = request.has_header("Transfer-Encoding");
  for (const auto& [name, value] : request.headers) head.header_bytes += name.size() + value.size();
  return head;
}

std::string AsError(const std::string& message) {
  return nlohmann::json{{"error", message}}.dump(-1, ' ', false,
                                                 nlohmann::json::error_handler_t::replace);
}

// As it is: the library would compress a text of its own, which takes a second for the page and
// saves nothing on one computer.
void SendBytes(const std::string& body, const std::string& type, httplib::Response& response) {
  if (body.empty()) return response.set_content(body, type);
  const auto bytes = std::make_shared<const std::string>(body);
  response.set_content_provider(
      bytes->size(), type,
      [bytes](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        return sink.write(bytes->data() + offset, length);
      });
}

void SendFile(const std::filesystem::path& path, const std::string& type,
              httplib::Response& response) {
  auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (!*file || error || size == 0) {
    response.status = 404;
    response.set_content(AsError("there is no such file"), "application/json");
    return;
  }
  response.set_content_provider(
      static_cast<std::size_t>(size), type,
      [file](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::vector<char> piece(std::min(length, kPiece));
        file->clear();
        file->seekg(static_cast<std::streamoff>(offset));
        file->read(piece.data(), static_cast<std::streamsize>(piece.size()));
        return file->gcount() > 0 &&
               sink.write(piece.data(), static_cast<std::size_t>(file->gcount()));
      });
}

}  // namespace

int HttpRequest::Number(const std::string& name) const {
  const auto found = query.find(name);
  int value = 0;
  if (found != query.end()) {
    const std::string& text = found->second;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size()) return value;
  }
  throw std::invalid_argument("the query needs a whole number " + name);
}

std::string HttpRequest::Text(const std::string& name, const std::string& fallback) const {
  const auto found = query.find(name);
  return found == query.end() ? fallback : found->second;
}

struct HttpServer::Impl {
  httplib::Server server;
  std::optional<Guard> guard;
  int port = 0;
  std::atomic<bool> stops = false;
  std::map<std::string, Handler> get, post;
  std::map<std::string, std::pair<std::string, StreamHandler>> streams;

  void Answer(const httplib::Request& request, httplib::Response& response) {
    for (const auto& [name, value] : Guard::AnswerHeaders()) response.set_header(name, value);
    if (const auto refusal = guard->Refuse(HeadOf(request))) {
      response.status = refusal->status;
      response.set_content(AsError(refusal->reason), "application/json");
    }
  }

  void Route(const httplib::Request& request, httplib::Response& response) {
    HttpRequest own{.path = std::string(guard->Below(request.path)), .query = {}, .body = {}};
    for (const auto& [name, value] : request.params) own.query.emplace(name, value);
    own.body = request.body;
    if (request.method == "GET") {
      if (const auto stream = streams.find(own.path); stream != streams.end()) {
        return Open(stream->second.first, stream->second.second(own), response);
      }
    }
    const auto& handlers = request.method == "GET" ? get : post;
    // The longest path that fits, up to a slash: "/frame/" takes "/frame/12".
    auto found = handlers.find(own.path);
    if (found == handlers.end()) {
      found = handlers.find(own.path.substr(0, own.path.find_last_of('/') + 1));
      if (found != handlers.end() && found->first == "/") found = handlers.end();
    }
    if (found == handlers.end()) return Fail(404, "there is nothing at " + own.path, response);
    const HttpReply reply = found->second(own);
    if (!reply.file) response.status = reply.status;  // else 200 or 206, as it is asked for
    if (!reply.download_name.empty()) {
      response.set_header("Content-Disposition",
                          fmt::format("attachment; filename=\"{}\"", reply.download_name));
    }
    if (!reply.may_run.empty()) {
      response.headers.erase(Guard::kPolicy);
      response.set_header(Guard::kPolicy, Guard::Policy(reply.may_run));
    }
    if (reply.file) return SendFile(*reply.file, reply.type, response);
    SendBytes(reply.body, reply.type, response);
  }

  void Open(const std::string& type, const Streamer& streamer, httplib::Response& response) {
    response.set_chunked_content_provider(
        type, [this, streamer](std::size_t /*offset*/, httplib::DataSink& sink) {
          bool listens = true;
          const Sink write = [&](std::string_view piece) {
            listens = sink.is_writable() && sink.write(piece.data(), piece.size());
            return listens;
          };
          if (stops || !streamer(write)) sink.done();
          return listens && sink.is_writable();
        });
  }

  static void Fail(int status, const std::string& message, httplib::Response& response) {
    response.status = status;
    response.set_content(AsError(message), "application/json");
  }
};

HttpServer::HttpServer(int port) : impl_(std::make_unique<Impl>()) {
  httplib::Server& server = impl_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_tcp_nodelay(true);
  // One request a connection: what is left of a refused one is never taken for the next.
  server.set_keep_alive_max_count(1);
  server.set_read_timeout(5);
  server.set_write_timeout(5);
  server.set_payload_max_length(Guard::kMaxBodyBytes);
  // A second server on the port fails instead of sharing it, which the library would allow.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  if (port == 0) {
    impl_->port = server.bind_to_any_port("127.0.0.1");
  } else if (server.bind_to_port("127.0.0.1", port)) {
    impl_->port = port;
  }
  if (impl_->port <= 0) {
    throw std::runtime_error(
        fmt::format("port {} of this computer is taken: choose another with "
                    "--port, or leave it out",
                    port));
  }
  impl_->guard.emplace(NewToken(), impl_->port);

  using Handled = httplib::Server::HandlerResponse;
  server.set_pre_routing_handler([this](const auto& request, auto& response) {
    impl_->Answer(request, response);
    return response.status > 0 ? Handled::Handled : Handled::Unhandled;
  });
  const auto route = [this](const httplib::Request& request, httplib::Response& response) {
    impl_->Route(request, response);
  };
  server.Get(".*", route);
  server.Post(".*", route);
  server.set_exception_handler([](const auto&, auto& response, std::exception_ptr error) {
    try {
      std::rethrow_exception(std::move(error));
    } catch (const InputError& e) {
      Impl::Fail(400, e.what(), response);
    } catch (const std::invalid_argument& e) {
      Impl::Fail(400, e.what(), response);
    } catch (const nlohmann::json::exception&) {
      Impl::Fail(400, "the request's JSON is not as expected", response);
    } catch (const std::exception& e) {
      Impl::Fail(500, e.what(), response);
    }
  });
  // Requests that never came as far as the guard: what is too long, or no HTTP.
  server.set_error_handler([](const auto&, auto& response) {
    for (const auto& [name, value] : Guard::AnswerHeaders()) {
      if (!response.has_header(name)) response.set_header(name, value);
    }
  });
}

HttpServer::~HttpServer() { Stop(); }

void HttpServer::Get(const std::string& path, Handler handler) {
  impl_->get[path] = std::move(handler);
}
void HttpServer::Post(const std::string& path, Handler handler) {
  impl_->post[path] = std::move(handler);
}
void HttpServer::Stream(const std::string& path, const std::string& type, StreamHandler handler) {
  impl_->streams[path] = {type, std::move(handler)};
}

const Guard& HttpServer::guard() const { return *impl_->guard; }
int HttpServer::port() const { return impl_->port; }

void HttpServer::Run() {
  if (!impl_->stops) impl_->server.listen_after_bind();
}

void HttpServer::Stop() {
  impl_->stops = true;
  impl_->server.stop();
}

}  // namespace flocklift
