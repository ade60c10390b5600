// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/live/fake_machine.hpp"

#include <sys/socket.h>

#include <utility>
// Boost 1.74 uses std::exchange without its header.
#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace chaintrue::live {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

Tcp::endpoint loopback() { return {asio::ip::address_v4::loopback(), 0}; }

}  // namespace

class FakeMachine::Listener {
 public:
  Listener() : acceptor_(io_, loopback()) {}
  asio::io_context io_;
  Tcp::acceptor acceptor_;
};

namespace {

using HeardAll = std::function<void(const std::string&)>;

/// A connection as the scripts see it.
class Peer {
 public:
  Peer(Protocol protocol, Tcp::socket socket) : protocol_(protocol), stream_(std::move(socket)) {}

  bool accept() {
    Error error;
    if (protocol_ == Protocol::websocket) stream_.accept(error);
    return !error;
  }
  void print(const Step& step) {
    Error error;
    if (protocol_ == Protocol::telnet) {
      asio::write(stream_.next_layer(), asio::buffer(step.bytes), error);
      return;
    }
    stream_.binary(!step.is_text);
    stream_.write(asio::buffer(step.bytes), error);
  }
  /// Empty at the end.
  std::string hear() {
    Error error;
    if (protocol_ == Protocol::telnet) return hear_raw();
    boost::beast::flat_buffer buffer;
    stream_.read(buffer, error);
    return error ? std::string() : boost::beast::buffers_to_string(buffer.data());
  }
  std::string hear_raw() {
    Error error;
    std::array<char, 1000> bytes{};
    const std::size_t count = stream_.next_layer().read_some(asio::buffer(bytes), error);
    return {bytes.data(), error ? 0 : count};
  }
  void close(Script::End end) {
    Error error;
    Tcp::socket& socket = stream_.next_layer();
    if (end == Script::End::orderly) {
      if (protocol_ == Protocol::websocket)
        stream_.close(boost::beast::websocket::close_code::normal, error);
      socket.shutdown(Tcp::socket::shutdown_send, error);
      // Unread bytes would make the end a reset.
      while (!hear_raw().empty()) {
      }
    } else {
      socket.set_option(asio::socket_base::linger(true, 0), error);
    }
    socket.close(error);
  }

 private:
  Protocol protocol_;
  boost::beast::websocket::stream<Tcp::socket, false> stream_;
};

void answer(const Script& script, const std::string& heard, Peer& peer) {
  for (const auto& [begin, reply] : script.replies) {
    if (heard.starts_with(begin)) peer.print({reply});
  }
}

void follow(const Script& script, Peer& peer, const HeardAll& hear) {
  if (script.is_mute) {
    while (!peer.hear_raw().empty()) {
    }
    return;
  }
  if (!peer.accept()) return;
  for (const Step& step : script.steps) {
    std::this_thread::sleep_for(step.before);
    peer.print(step);
  }
  if (script.end != Script::End::stays) return peer.close(script.end);
  for (std::string heard = peer.hear(); !heard.empty(); heard = peer.hear()) {
    hear(heard);
    answer(script, heard, peer);
  }
}

}  // namespace

Script printing(const std::string& text, Script::End end) {
  Script script;
  script.steps.push_back({text});
  script.end = end;
  return script;
}

FakeMachine::FakeMachine(Protocol protocol, std::vector<Script> scripts)
    : protocol_(protocol), scripts_(std::move(scripts)), listener_(std::make_unique<Listener>()) {
  port_ = listener_->acceptor_.local_endpoint().port();
  thread_ = std::thread([this] { run(); });
}

FakeMachine::~FakeMachine() {
  is_over_ = true;
  ::shutdown(listener_->acceptor_.native_handle(), SHUT_RDWR);  // accept() returns
  thread_.join();
}

void FakeMachine::run() {
  while (!is_over_) {
    Error error;
    Tcp::socket socket(listener_->io_);
    listener_->acceptor_.accept(socket, error);
    if (error) return;
    const auto number = static_cast<std::size_t>(connections_++);
    Peer peer(protocol_, std::move(socket));
    follow(scripts_[std::min(number, scripts_.size() - 1)], peer, [this](const std::string& bytes) {
      hear(bytes);
    });
  }
}

void FakeMachine::hear(const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  heard_ += bytes;
}

std::string FakeMachine::heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

std::vector<Step> in_packets(const std::string& log,
                             std::size_t bytes,
                             std::chrono::milliseconds between) {
  std::vector<Step> steps;
  for (std::size_t at = 0; at < log.size(); at += bytes)
    steps.push_back({log.substr(at, bytes), between});
  return steps;
}

int free_port() {
  asio::io_context io;
  const Tcp::acceptor acceptor(io, loopback());
  return acceptor.local_endpoint().port();
}

}  // namespace chaintrue::live
