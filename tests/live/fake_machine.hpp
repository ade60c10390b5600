// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine at 127.0.0.1 that prints what a test has it print, at times of its own, by websocket or
/// telnet, and keeps what it is sent.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/live/connection.hpp"

namespace chaintrue::live {

struct Step {
  std::string bytes;
  std::chrono::milliseconds before{0};
  bool is_text = false;  ///< a text message of the websocket
};

/// One connection.
struct Script {
  enum class End { orderly, abrupt, stays };
  std::vector<Step> steps;
  End end = End::orderly;
  /// Accepts the connection and says nothing, not even to a handshake.
  bool is_mute = false;
  /// Of one that stays: what it prints after a line that begins so.
  std::vector<std::pair<std::string, std::string>> replies{};
};

/// Prints this at once.
[[nodiscard]] Script printing(const std::string& text, Script::End end = Script::End::orderly);

class FakeMachine {
 public:
  /// A script for each connection, the last one for all further ones.
  FakeMachine(Protocol protocol, std::vector<Script> scripts);
  ~FakeMachine();
  FakeMachine(const FakeMachine&) = delete;
  FakeMachine& operator=(const FakeMachine&) = delete;

  [[nodiscard]] int port() const { return port_; }
  /// Everything that it was sent.
  [[nodiscard]] std::string heard() const;
  /// How many connections there were.
  [[nodiscard]] int connections() const { return connections_; }

 private:
  class Listener;
  void run();
  void hear(const std::string& bytes);

  Protocol protocol_;
  std::vector<Script> scripts_;
  int port_ = 0;
  std::atomic<int> connections_{0};
  std::atomic<bool> is_over_{false};
  mutable std::mutex mutex_;
  std::string heard_;
  std::unique_ptr<Listener> listener_;
  std::thread thread_;  // last: it uses the others
};

/// A log in packets of this many bytes, with pauses.
[[nodiscard]] std::vector<Step> in_packets(const std::string& log,
                                           std::size_t bytes,
                                           std::chrono::milliseconds between);
/// A port of the loopback at which nobody listens.
[[nodiscard]] int free_port();

}  // namespace chaintrue::live
