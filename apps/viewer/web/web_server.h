// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A small web server for one page: files, uploads and WebSockets on one port.
///
/// Written here, on sockets, because what is asked of it decides its shape: a message is refused by
/// what its header announces before any memory is taken for it, a client that takes nothing holds
/// nobody and no thread, and connections, messages, uploads and waiting answers all have limits.
/// One thread serves all clients by epoll. HTTP/1.1 without keep-alive; no TLS: beyond the loopback
/// address it belongs behind a tunnel or a proxy that has it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "web/site.h"

namespace vicinity::viewer {

struct WebOptions {
  std::string address = "127.0.0.1";  ///< IPv4 or IPv6, or localhost
  std::uint16_t port = 0;             ///< 0: any that is free
  std::string token;                  ///< asked for on /ws, /upload and /file; empty: none

  std::size_t connections = 128;             ///< at once; one more is turned away
  std::size_t uploads = 4;                   ///< at once
  std::size_t message_bytes = 262'144;       ///< of a message from a client, at most
  std::uint64_t upload_bytes = 268'435'456;  ///< of one upload, at most
  double messages_per_s = 400, burst = 800;  ///< from one client; what comes beyond is dropped
  std::uint64_t most_dropped = 4000;         ///< of them within a second: the client is closed
  std::size_t waiting_bytes = 64u << 20;     ///< of answers for one client, at most
  double head_s = 10;                        ///< for a request's head to come
  double silence_s = 20;                     ///< until a client that says or takes nothing is gone
  double ping_s = 5;
};

class WebServer {
 public:
  /// Listens from now on; run() serves. Errors: throws Error where the address is none, or cannot
  /// be listened at, and for an address beyond this machine without a token.
  WebServer(const WebOptions& options, Site& site);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  std::uint16_t port() const noexcept;
  /// "http://127.0.0.1:8080/".
  std::string address() const;

  /// Serves until stop(). Called once.
  void run();
  /// From any thread, and from a signal handler.
  void stop() noexcept;

  // From any thread. For a client that is gone they do nothing.

  /// One message to one WebSocket, or to all.
  void send(ClientId client, SharedBytes payload);
  void broadcast(SharedBytes payload);
  /// Answers a request that the site was handed.
  void respond(ClientId connection, HttpResponse response);
  /// How many snapshots a second the client is sent, 0..60; none until this is called.
  void set_rate(ClientId client, int snapshots_per_s);

  /// Clients that listen at this moment, for tests and for the log.
  std::size_t open_count() const noexcept;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace vicinity::viewer
