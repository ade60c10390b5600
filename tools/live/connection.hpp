// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A connection to FluidNC, by websocket or telnet. It reads in a thread of its own, so that nothing
/// waits while an answer is computed: every byte goes to `save` the moment it comes, then into a
/// bounded inbox. It sends queries and confirmed moves (commands.hpp) and nothing else.
///
/// \code
///   Connection link({"maslow.local", 81, Protocol::websocket}, [&](std::string_view b) { file.write(b); });
///   link.wait(std::chrono::seconds(10));
///   if (link.state() == Connection::State::open) link.send(Query::calibration_state);
///   session.take(link.take());
/// \endcode
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "tools/live/commands.hpp"

namespace chaintrue::live {

enum class Protocol { websocket, telnet };
/// FluidNC's own: the websocket lies one above its page.
inline constexpr int kWebsocketPort = 81;
inline constexpr int kTelnetPort = 23;

struct Address {
  std::string host;
  int port = kWebsocketPort;
  Protocol protocol = Protocol::websocket;
};

class Connection {
 public:
  enum class State { connecting, open, over };
  enum class End {
    none,           ///< it goes on
    no_name,        ///< nobody has that name
    no_connection,  ///< refused, or no way there
    no_websocket,   ///< something else listens at that port
    closed,         ///< by the machine, in an orderly way
    lost,
  };

  /// Begins to connect. `save` is called from another thread.
  Connection(const Address& address, std::function<void(std::string_view)> save);
  /// Closes it.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Until something came, the state changed, or this much time has gone.
  void wait(std::chrono::milliseconds most);
  [[nodiscard]] State state() const;
  [[nodiscard]] End end() const;
  /// In the system's words, of an end that is not in order.
  [[nodiscard]] std::string end_in_words() const;
  /// What came since the last call.
  [[nodiscard]] std::string take();

  void send(Query query);
  void send(const ConfirmedMove& move);

 private:
  class Link;
  std::unique_ptr<Link> link_;
};

}  // namespace chaintrue::live
