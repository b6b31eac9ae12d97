// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "web/web_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <functional>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"
#include "web/connection.h"
#include "web/gate.h"
#include "web/handshake.h"
#include "web/listener.h"

namespace vicinity::viewer {
namespace {

constexpr double longest_wait_s = 0.25;
constexpr int snapshots_per_s = 60;
// A client that is still sending when its answer is complete would lose the answer if its socket
// were closed at once.
constexpr double longest_linger_s = 2;
// Read from one client at a time, so that all others come to their turn.
constexpr std::size_t turn_bytes = 65'536;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool contains_word(std::string_view list, std::string_view lower_case_word) {
  std::string lower(list);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower.find(lower_case_word) != std::string::npos;
}

bool wants_websocket(const HttpRequest& request) {
  return contains_word(request["upgrade"], "websocket") &&
         contains_word(request["connection"], "upgrade");
}

std::string query_value(const HttpRequest& request, const std::string& key) {
  const auto found = request.query.find(key);
  return found == request.query.end() ? std::string() : found->second;
}

}  // namespace

/// All of it but posting belongs to the thread that runs it.
class WebServer::Loop {
 public:
  Loop(const WebOptions& options, Site& site)
      : options_(options),
        site_(site),
        on_loopback_(is_loopback(options.address)),
        listener_(listen_at(options.address, options.port)),
        poll_(epoll_create1(EPOLL_CLOEXEC)),
        wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    watch(listener_.socket.get(), listener_id, EPOLLIN, EPOLL_CTL_ADD);
    watch(wake_.get(), wake_id, EPOLLIN, EPOLL_CTL_ADD);
  }

  const Listener& listener() const noexcept { return listener_; }
  std::size_t open_count() const noexcept { return open_.load(std::memory_order_relaxed); }

  void stop() noexcept {
    stop_.store(true);
    wake();
  }

  /// Has something done by the loop's thread.
  void post(std::function<void()> work) {
    {
      const std::lock_guard lock(posted_mutex_);
      posted_.push_back(std::move(work));
    }
    wake();
  }

  void run() {
    while (!stop_.load()) {
      std::array<epoll_event, 64> events;
      const int count = epoll_wait(poll_.get(), events.data(), static_cast<int>(events.size()),
                                   static_cast<int>(1000 * wait_s()) + 1);
      now_ = now_s();
      for (int n = 0; n < count; ++n) {
        handle(events[static_cast<std::size_t>(n)].data.u64,
               events[static_cast<std::size_t>(n)].events);
      }
      do_posted();
      send_snapshots();
      look_after_clients();
      reap();
    }
    for (const auto& [id, client] : clients_) {
      if (client->state == Connection::State::open) site_.closed(id);
    }
    clients_.clear();
  }

  // What is posted.

  void send(ClientId id, const SharedBytes& payload) {
    Connection* const client = find(id);
    if (client == nullptr || client->state != Connection::State::open) return;
    client->outbox.add_message(payload);
    write(*client);
  }

  void broadcast(const SharedBytes& payload) {
    for (const auto& [id, client] : clients_) send(id, payload);
  }

  void respond(ClientId id, const HttpResponse& response) {
    Connection* const client = find(id);
    if (client == nullptr || client->state != Connection::State::awaiting_response) return;
    answer(*client, response);
  }

  void set_rate(ClientId id, int per_s) {
    Connection* const client = find(id);
    if (client == nullptr) return;
    client->snapshots_per_s = std::clamp(per_s, 0, snapshots_per_s);
    if (client->snapshots_per_s == 0) client->outbox.drop_snapshot();
  }

 private:
  static constexpr ClientId listener_id = 0, wake_id = 1;

  void watch(int descriptor, ClientId id, std::uint32_t events, int operation) const {
    epoll_event event{.events = events, .data = {.u64 = id}};
    epoll_ctl(poll_.get(), operation, descriptor, &event);
  }

  void wake() noexcept {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
  }

  Connection* find(ClientId id) {
    const auto found = clients_.find(id);
    return found == clients_.end() || gone(*found->second) ? nullptr : found->second.get();
  }

  bool gone(const Connection& client) const {
    return std::ranges::find(leaving_, client.id) != leaving_.end();
  }

  double wait_s() const {
    if (open_count() == 0) return longest_wait_s;
    return std::clamp(next_snapshot_s_ - now_s(), 0.0, longest_wait_s);
  }

  void handle(ClientId id, std::uint32_t events) {
    if (id == listener_id) return accept_all();
    if (id == wake_id) {
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t got = ::read(wake_.get(), &count, sizeof count);
      return;
    }
    if (Connection* const client = find(id)) {
      if ((events & EPOLLIN) != 0) read(*client);
      if (!gone(*client) && (events & EPOLLOUT) != 0) write(*client);
      if ((events & (EPOLLERR | EPOLLHUP)) != 0) leave(*client);
    }
  }

  void accept_all() {
    while (true) {
      Socket socket(
          accept4(listener_.socket.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (socket.get() < 0) return;  // none, or none that can be taken now
      if (clients_.size() >= options_.connections) {
        const HttpResponse full = sentence(429, "too many connections; close a page");
        const std::string text = response_head(full) + *full.body;
        [[maybe_unused]] const ssize_t sent =
            ::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        continue;
      }
      const int yes = 1;
      setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      const ClientId id = next_id_++;
      watch(socket.get(), id, EPOLLIN, EPOLL_CTL_ADD);
      auto client = std::make_unique<Connection>(
          id, std::move(socket), FrameLimits{.message_bytes = options_.message_bytes},
          options_.messages_per_s, options_.burst, options_.waiting_bytes);
      client->began_s = client->heard_s = client->sent_s = client->pinged_s = now_;
      clients_.emplace(id, std::move(client));
    }
  }

  void read(Connection& client) {
    std::array<char, turn_bytes> buffer;
    const ssize_t count = ::recv(client.socket.get(), buffer.data(), buffer.size(), 0);
    if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
    if (count == 0 && (client.state == Connection::State::awaiting_response ||
                       client.state == Connection::State::leaving)) {
      // It has said all it had to, and still listens.
      client.said_all = true;
      return watch(client);
    }
    if (count <= 0) return leave(client);
    client.heard_s = now_;
    std::string_view bytes(buffer.data(), static_cast<std::size_t>(count));
    switch (client.state) {
      case Connection::State::reading_head:
        return read_head(client, bytes);
      case Connection::State::reading_upload:
        return read_upload(client, bytes);
      case Connection::State::open:
        return read_frames(client, bytes);
      case Connection::State::awaiting_response:
      case Connection::State::leaving:
      case Connection::State::lingering:
        return;  // nothing was asked for
    }
  }

  void read_head(Connection& client, std::string_view bytes) {
    client.head += bytes;
    const std::size_t end = client.head.find("\r\n\r\n");
    if (end == std::string::npos ? client.head.size() > longest_head : end > longest_head) {
      return answer(client, sentence(413, "the head of the request is too long"));
    }
    if (end == std::string::npos) return;
    const auto request = parse_request(std::string_view(client.head).substr(0, end));
    if (!request) return answer(client, sentence(400, "not an HTTP request that can be read"));
    const std::string rest = client.head.substr(end + 4);
    client.head.clear();
    route(client, *request, rest);
  }

  void route(Connection& client, const HttpRequest& request, std::string_view rest) {
    const bool get = request.method == "GET";
    if (request.path == "/ws" || request.path == "/upload" || request.path == "/file") {
      if (const auto why = why_refused(request, options_.token, on_loopback_)) {
        return answer(client, sentence(403, *why));
      }
      if (request.path == "/ws" && get) return open(client, request, rest);
      if (request.path == "/upload" && request.method == "PUT") {
        return begin_upload(client, request, rest);
      }
      if (request.path == "/file" && get) {
        client.state = Connection::State::awaiting_response;
        return site_.file_wanted(client.id, query_value(request, "name"));
      }
      return answer(client, sentence(405, "not what this address is for"));
    }
    if (!get) return answer(client, sentence(405, "pages can only be got"));
    const auto file = site_.page_file(request.path);
    answer(client, file ? *file : sentence(404, "there is no such page"));
  }

  void open(Connection& client, const HttpRequest& request, std::string_view rest) {
    const std::string_view key = request["sec-websocket-key"];
    if (!wants_websocket(request) || request["sec-websocket-version"] != "13" || key.size() != 24) {
      return answer(client, sentence(400, "not a WebSocket handshake of version 13"));
    }
    client.outbox.add(
        fmt::format("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
                    "Upgrade\r\nSec-WebSocket-Accept: {}\r\n\r\n",
                    websocket_accept(key)));
    client.state = Connection::State::open;
    client.next_snapshot_s = now_;
    open_.fetch_add(1, std::memory_order_relaxed);
    site_.opened(client.id);
    write(client);
    if (!gone(client) && !rest.empty()) read_frames(client, rest);
  }

  void begin_upload(Connection& client, const HttpRequest& request, std::string_view rest) {
    const auto length = content_length(request);
    if (!length) return answer(client, sentence(400, "an upload must state its Content-Length"));
    if (*length > options_.upload_bytes) {
      return answer(client, sentence(413, fmt::format("an upload may have {} MiB at most",
                                                      options_.upload_bytes >> 20)));
    }
    const auto under_way = std::ranges::count_if(clients_, [](const auto& other) {
      return other.second->state == Connection::State::reading_upload;
    });
    if (under_way >= static_cast<std::ptrdiff_t>(options_.uploads)) {
      return answer(client, sentence(429, "too many uploads at once; wait for one to end"));
    }
    client.upload_name = query_value(request, "name");
    auto begun = site_.upload_begins(client.upload_name);
    if (auto* const refusal = std::get_if<HttpResponse>(&begun)) return answer(client, *refusal);
    client.upload_path = std::get<std::filesystem::path>(begun);
    client.upload_file =
        ::open(client.upload_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (client.upload_file < 0) {
      client.upload_path.clear();
      return answer(client, sentence(500, "the upload cannot be written"));
    }
    client.upload_left = *length;
    client.state = Connection::State::reading_upload;
    read_upload(client, rest);
  }

  void read_upload(Connection& client, std::string_view bytes) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(client.upload_left, bytes.size()));
    if (::write(client.upload_file, bytes.data(), count) != static_cast<ssize_t>(count)) {
      return answer(client, sentence(500, "the upload cannot be written: the disk is full?"));
    }
    client.upload_left -= count;
    if (client.upload_left > 0) return;
    ::close(std::exchange(client.upload_file, -1));
    client.state = Connection::State::awaiting_response;
    site_.upload_came(client.id, client.upload_name, std::exchange(client.upload_path, {}));
  }

  void read_frames(Connection& client, std::string_view bytes) {
    while (!gone(client) && client.state == Connection::State::open) {
      switch (client.frames.read(bytes)) {
        case FrameReader::Result::need_more:
          return;
        case FrameReader::Result::refused:
          return close(client, client.frames.close_code());
        case FrameReader::Result::message:
          take(client);
      }
    }
  }

  void take(Connection& client) {
    const Opcode opcode = client.frames.opcode();
    const std::string& payload = client.frames.payload();
    if (opcode == Opcode::close) return close(client, CloseCode::normal);
    if (opcode == Opcode::pong) return;
    if (!client.allowance.take(now_)) return drop(client);
    if (opcode == Opcode::ping) {
      client.outbox.add(frame_header(Opcode::pong, payload.size()) + payload);
    } else if (opcode == Opcode::text) {
      client.outbox.add_message(site_.text_not_understood());
    } else {
      return site_.message(client.id, payload);
    }
    write(client);
  }

  void drop(Connection& client) {
    ++client.dropped;
    if (client.dropped > options_.most_dropped) return close(client, CloseCode::policy);
    if (now_ < client.said_s + 1) return;
    client.outbox.add_message(site_.too_many_messages(client.dropped));
    client.dropped = 0;
    client.said_s = now_;
    write(client);
  }

  void answer(Connection& client, const HttpResponse& response) {
    client.outbox.add(response_head(response));
    if (response.body != nullptr) client.outbox.add(response.body);
    client.state = Connection::State::leaving;
    write(client);
  }

  void close(Connection& client, CloseCode code) {
    client.outbox.drop_snapshot();
    client.outbox.add(close_frame(code));
    forget(client);
    client.state = Connection::State::leaving;
    write(client);
  }

  void write(Connection& client) {
    if (gone(client)) return;
    const Outbox::Sent sent = client.outbox.send_to(client.socket.get());
    if (sent != Outbox::Sent::none) client.sent_s = now_;
    const bool overfull = client.state == Connection::State::open && client.outbox.overfull();
    if (sent == Outbox::Sent::broken || overfull) return leave(client);
    if (sent == Outbox::Sent::all && client.state == Connection::State::leaving) {
      if (client.said_all) return leave(client);
      ::shutdown(client.socket.get(), SHUT_WR);
      client.state = Connection::State::lingering;
    }
    const bool more = sent != Outbox::Sent::all;
    if (more == client.wants_to_write) return;
    client.wants_to_write = more;
    watch(client);
  }

  void watch(const Connection& client) const {
    watch(client.socket.get(), client.id,
          (client.said_all ? 0u : EPOLLIN) | (client.wants_to_write ? EPOLLOUT : 0u),
          EPOLL_CTL_MOD);
  }

  // A WebSocket is none any more.
  void forget(Connection& client) {
    if (client.state != Connection::State::open) return;
    open_.fetch_sub(1, std::memory_order_relaxed);
    site_.closed(client.id);
  }

  // Gone at the end of this round: whoever calls may still look at it.
  void leave(Connection& client) {
    if (gone(client)) return;
    forget(client);
    client.state = Connection::State::leaving;
    leaving_.push_back(client.id);
  }

  void reap() {
    for (const ClientId id : leaving_) clients_.erase(id);
    leaving_.clear();
  }

  void do_posted() {
    std::vector<std::function<void()>> work;
    {
      const std::lock_guard lock(posted_mutex_);
      work.swap(posted_);
    }
    for (const auto& each : work) each();
  }

  void send_snapshots() {
    if (now_ < next_snapshot_s_) return;
    next_snapshot_s_ = std::max(next_snapshot_s_ + 1.0 / snapshots_per_s, now_);
    if (open_count() == 0) return;
    if (SharedBytes fresh = site_.newest_snapshot()) snapshot_ = std::move(fresh);
    if (snapshot_ == nullptr) return;
    // Half a period early counts as due: the rounds of this loop are not a client's own.
    constexpr double slack_s = 0.5 / snapshots_per_s;
    for (const auto& [id, client] : clients_) {
      if (client->state != Connection::State::open || client->snapshots_per_s == 0) continue;
      if (now_ + slack_s < client->next_snapshot_s) continue;
      client->next_snapshot_s =
          std::max(client->next_snapshot_s + 1.0 / client->snapshots_per_s, now_);
      client->outbox.offer_snapshot(snapshot_);
      if (!client->wants_to_write) write(*client);
    }
  }

  void look_after_clients() {
    for (const auto& [id, client] : clients_) {
      if (gone(*client)) continue;
      // A ping waits behind what is being sent, and its answer too.
      if (!client->outbox.empty()) client->heard_s = now_;
      const bool silent = now_ > client->heard_s + options_.silence_s;
      const bool stuck = !client->outbox.empty() && now_ > client->sent_s + options_.silence_s;
      const bool slow_head = client->state == Connection::State::reading_head &&
                             now_ > client->began_s + options_.head_s;
      const bool waits = client->state == Connection::State::awaiting_response;
      const bool lingered =
          client->state == Connection::State::lingering && now_ > client->sent_s + longest_linger_s;
      if (stuck || slow_head || lingered || (silent && !waits)) {
        leave(*client);
      } else if (client->state == Connection::State::open &&
                 now_ > client->pinged_s + options_.ping_s) {
        client->pinged_s = now_;
        client->dropped = 0;
        client->outbox.add(frame_header(Opcode::ping, 0));
        write(*client);
      }
    }
  }

  WebOptions options_;
  Site& site_;
  bool on_loopback_;
  Listener listener_;
  Socket poll_, wake_;
  std::unordered_map<ClientId, std::unique_ptr<Connection>> clients_;
  std::vector<ClientId> leaving_;
  ClientId next_id_ = wake_id + 1;
  double now_ = now_s(), next_snapshot_s_ = 0;
  SharedBytes snapshot_;
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> open_{0};
  std::mutex posted_mutex_;
  std::vector<std::function<void()>> posted_;
};

WebServer::WebServer(const WebOptions& options, Site& site) {
  if (!is_loopback(options.address) && options.token.empty()) {
    throw Error({.where = "--bind " + options.address,
                 .what = "an address that other machines reach needs a token, since whoever opens "
                         "the page drives the arm",
                 .hint = "--token and a word that is hard to guess"});
  }
  loop_ = std::make_unique<Loop>(options, site);
}

WebServer::~WebServer() = default;

std::uint16_t WebServer::port() const noexcept { return loop_->listener().port; }
std::string WebServer::address() const { return loop_->listener().address; }
std::size_t WebServer::open_count() const noexcept { return loop_->open_count(); }
void WebServer::run() { loop_->run(); }
void WebServer::stop() noexcept { loop_->stop(); }

void WebServer::send(ClientId client, SharedBytes payload) {
  loop_->post(
      [loop = loop_.get(), client, payload = std::move(payload)] { loop->send(client, payload); });
}

void WebServer::broadcast(SharedBytes payload) {
  loop_->post([loop = loop_.get(), payload = std::move(payload)] { loop->broadcast(payload); });
}

void WebServer::respond(ClientId connection, HttpResponse response) {
  loop_->post([loop = loop_.get(), connection, response = std::move(response)] {
    loop->respond(connection, response);
  });
}

void WebServer::set_rate(ClientId client, int snapshots_per_s) {
  loop_->post(
      [loop = loop_.get(), client, snapshots_per_s] { loop->set_rate(client, snapshots_per_s); });
}

}  // namespace vicinity::viewer
