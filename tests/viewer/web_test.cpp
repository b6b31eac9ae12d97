// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Who is let in, and what is not taken: the web server, from outside.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "served.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"
#include "web/gate.h"

namespace vicinity::viewer_test {
namespace {

using testing::HasSubstr;

std::string origin(const std::string& of) { return "Origin: " + of + "\r\n"; }

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Gate, APageOfAnotherOriginIsRefused) {
  Served served;
  const std::string upgrade =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  for (const char* from : {"http://evil.example", "null", "http://localhost:1", "https://localhost",
                           "http://localhost.evil.example", ""}) {
    const HttpAnswer answer = get(served.port(), "/ws", origin(from) + upgrade);
    EXPECT_EQ(answer.status, 403) << from;
    EXPECT_THAT(answer.body, HasSubstr("origin")) << from;
    EXPECT_EQ(put(served.port(), "/upload?name=a.stl", "x", origin(from)).status, 403) << from;
    EXPECT_EQ(get(served.port(), "/file?name=a.stl", origin(from)).status, 403) << from;
  }
  EXPECT_EQ(served.server().open_count(), 0u);
  EXPECT_NO_THROW(PageClient(served.port()));  // with the server's own origin
}

TEST(Gate, ANameThatWasPointedAtTheLoopbackAddressIsRefused) {
  Served served;
  for (const std::string host :
       {"evil.example", "127.evil.example", "127.0.0.1.evil.example", "localhost.evil.example",
        "127.0.0.1evil", "127.1", "::1", "[::1].evil.example", "127.0.0.1:80:80"}) {
    EXPECT_EQ(exchange(served.port(), "GET /file?name=a.stl HTTP/1.1\r\nHost: " + host +
                                          "\r\nOrigin: http://" + host + "\r\n\r\n")
                  .status,
              403)
        << host;
    EXPECT_FALSE(viewer::is_loopback(host) && host != "::1") << host;
  }
  for (const char* host : {"localhost", "127.0.0.1", "127.9.8.7", "[::1]", "localhost:80"}) {
    EXPECT_EQ(exchange(served.port(),
                       std::string("GET /file?name=a.stl HTTP/1.1\r\nHost: ") + host + "\r\n\r\n")
                  .status,
              404)
        << host;
  }
}

TEST(Gate, ATokenIsAskedForWhereOneWasGiven) {
  viewer::WebOptions options;
  options.token = "secret word";
  Served served(options);
  EXPECT_EQ(get(served.port(), "/file?name=a.stl").status, 403);
  EXPECT_EQ(get(served.port(), "/file?name=a.stl&token=secret").status, 403);
  EXPECT_EQ(get(served.port(), "/file?name=a.stl&token=secret%20word").status, 404);
  EXPECT_THROW(PageClient(served.port()), std::runtime_error);
  PageClient page(served.port(), "/ws?token=secret%20word");
  EXPECT_TRUE(page.next_of(1));
}

TEST(Gate, AnAddressThatOthersReachNeedsAToken) {
  Served served;
  viewer::WebOptions options;
  options.address = "0.0.0.0";
  EXPECT_THROW(viewer::WebServer(options, served.site()), Error);
  options.token = "t";
  EXPECT_NO_THROW(viewer::WebServer(options, served.site()));
  options.address = "not an address";
  EXPECT_THROW(viewer::WebServer(options, served.site()), Error);
}

TEST(Web, NoPathLeadsOutOfTheFolder) {
  Served served;
  served.folder().write("secret.stl", "secret");
  for (const char* name : {"..%2Fsecret.stl", "../secret.stl", "%2e%2e/secret.stl", "/etc/passwd",
                           "..\\secret.stl", ".secret.stl", "meshes/../../secret.stl", "%00.stl",
                           "a%0Ab.stl", "", "secret", "....//secret.stl"}) {
    const HttpAnswer answer = get(served.port(), std::string("/file?name=") + name);
    EXPECT_TRUE(answer.status == 400 || answer.status == 404) << name << ": " << answer.status;
    EXPECT_THAT(answer.body, testing::Not(HasSubstr("secret\n"))) << name;
    const HttpAnswer upload = put(served.port(), std::string("/upload?name=") + name, "x");
    EXPECT_EQ(upload.status, 400) << name;
  }
  for (const char* path : {"/../secret.stl", "/..%2f..%2fetc/passwd", "//etc/passwd", "/%2e%2e/x",
                           "/assets/../../x"}) {
    EXPECT_EQ(get(served.port(), path).status, 404) << path;
  }
  EXPECT_EQ(text_of(served.folder().path() / "secret.stl"), "secret");
}

TEST(Web, WhatIsNoRequestIsRefusedAndTheNextIsServed) {
  Served served;
  for (const char* text :
       {"\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/2.0\r\n\r\n", "GET x HTTP/1.1\r\n\r\n",
        "GET /%zz HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"}) {
    EXPECT_EQ(exchange(served.port(), text).status, 400) << text;
  }
  EXPECT_EQ(exchange(served.port(), "GET /" + std::string(20'000, 'a')).status, 413);
  EXPECT_EQ(exchange(served.port(), "POST / HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 405);
  EXPECT_EQ(get(served.port(), "/").status, 200);
}

TEST(Web, AnUploadIsReadSaidAndKept) {
  Served served;
  const auto file = served.folder().path() / "ball.stl";
  write_stl(primitive::sphere(20), file);
  const std::string bytes = text_of(file);
  const HttpAnswer answer = put(served.port(), "/upload?name=ball.stl", bytes);
  ASSERT_EQ(answer.status, 201) << answer.body;
  const auto json = nlohmann::json::parse(answer.body);
  EXPECT_EQ(json["mesh"], "meshes/ball.stl");
  EXPECT_EQ(json["closed"], true);
  EXPECT_NEAR(json["size"][2].get<double>(), 40, 0.1);
  EXPECT_THAT(json["readings"].get<std::string>(), HasSubstr("if the unit is mm"));
  EXPECT_EQ(get(served.port(), "/file?name=ball.stl").body, bytes);
}

TEST(Web, AnUploadThatIsTooLargeBrokenOrLeftOffLeavesNothing) {
  viewer::WebOptions options;
  options.upload_bytes = 1000;
  Served served(options);
  EXPECT_EQ(put(served.port(), "/upload?name=a.stl", std::string(1001, 'x')).status, 413);
  const HttpAnswer broken = put(served.port(), "/upload?name=a.stl", std::string(1000, 'x'));
  EXPECT_EQ(broken.status, 400);
  EXPECT_EQ(put(served.port(), "/upload?name=a.yaml", "voxel_size: 1").status, 400);
  EXPECT_EQ(put(served.port(), "/upload?name=a.csv", "a,b\n1,2\n").status, 400);
  EXPECT_EQ(
      exchange(served.port(), "PUT /upload?name=a.stl HTTP/1.1\r\nHost: localhost\r\n\r\n").status,
      400);
  {
    Connected half(served.port());
    half.send(
        "PUT /upload?name=a.stl HTTP/1.1\r\nHost: localhost\r\nContent-Length: 900\r\n\r\nabc");
    EXPECT_EQ(get(served.port(), "/").status, 200);
  }
  EXPECT_EQ(get(served.port(), "/").status, 200);
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(served.folder().path() / "files")) {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 0u);
}

TEST(Web, AClientThatSendsTooFastIsToldAndThenClosed) {
  viewer::WebOptions options;
  options.messages_per_s = 10;
  options.burst = 20;
  options.most_dropped = 1000;
  Served served(options);
  PageClient page(served.port());
  ASSERT_TRUE(page.next_of(1));
  for (int n = 0; n < 3000 && page.send(command(76, 1)); ++n) {
  }
  bool told = false, closed = false;
  while (const auto message = page.next()) {
    told |= message->opcode == 2 && message->type() == 14;
    closed |= message->opcode == 8 && message->payload.substr(0, 2) == "\x03\xF0";  // 1008
  }
  EXPECT_TRUE(told);
  EXPECT_TRUE(closed);
}

TEST(Web, ALongAnswerArrivesWholeHoweverSlowlyItIsTaken) {
  viewer::WebOptions options;
  options.waiting_bytes = 100'000;  // of messages; a file is one answer, however long
  options.silence_s = 0.5;
  Served served(options);
  std::string file(24u << 20, '\0');  // more than sockets hold
  for (std::size_t n = 0; n < file.size(); ++n) file[n] = static_cast<char>(n * 2654435761u >> 13);
  std::filesystem::create_directories(served.folder().path() / "files");
  std::ofstream(served.folder().path() / "files/long.vicinity", std::ios::binary) << file;

  Connected slow(served.port());
  // Small, so that what is taken soon makes room for more.
  const int window = 65'536;
  setsockopt(slow.socket(), SOL_SOCKET, SO_RCVBUF, &window, sizeof window);
  slow.send("GET /file?name=long.vicinity HTTP/1.1\r\nHost: localhost\r\n\r\n");
  shutdown(slow.socket(), SHUT_WR);  // it has said all it has to say
  std::string all;
  const auto begin = std::chrono::steady_clock::now();
  while (true) {
    const std::string more = slow.receive(std::chrono::seconds(20));
    if (more.empty()) break;
    all += more;
    // For as long as three silences, little by little.
    if (std::chrono::steady_clock::now() - begin < std::chrono::milliseconds(1500)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  const std::size_t head = all.find("\r\n\r\n");
  ASSERT_NE(head, std::string::npos);
  EXPECT_TRUE(std::string_view(all).substr(head + 4) == file)
      << all.size() - head - 4 << " of " << file.size() << " bytes came";
}

TEST(Web, AConnectionThatNeverFinishesItsRequestIsClosed) {
  viewer::WebOptions options;
  options.head_s = 0.3;
  options.silence_s = 0.5;
  options.ping_s = 60;
  Served served(options);
  Connected silent(served.port()), half(served.port());
  half.send("GET / HT");
  // It ends by itself: the read returns because the stream is over, not because the time is.
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(silent.receive(std::chrono::seconds(20)), "");
  EXPECT_EQ(half.receive(std::chrono::seconds(20)), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(19));
  // A WebSocket whose other side says nothing, not even a pong, is gone too.
  PageClient page(served.port());
  while (page.next(std::chrono::seconds(20))) {
  }
  EXPECT_EQ(served.server().open_count(), 0u);
}

}  // namespace
}  // namespace vicinity::viewer_test
