// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/connection.hpp"

#include <array>
#include <utility>
// Boost 1.74 uses std::exchange without its header.
#include <boost/asio/buffer.hpp>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/error.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "tools/live/frames.hpp"

namespace chaintrue::live {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

namespace {

/// What waits to be looked at; the machine waits where more comes.
constexpr std::size_t kLargestInbox = std::size_t{1} << 20U;
/// FluidNC's messages have 1200 bytes.
constexpr std::size_t kLargestMessage = std::size_t{1} << 20U;

}  // namespace

/// All but the public functions runs in the thread.
class Connection::Link {
 public:
  Link(const Address& address, std::function<void(std::string_view)> save)
      : address_(address), save_(std::move(save)), resolver_(io_), stream_(io_), thread_([this] {
          run();
        }) {}

  ~Link() {
    io_.stop();
    {
      const std::lock_guard lock(mutex_);
      is_stopped_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  void wait(std::chrono::milliseconds most) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [this] { return !inbox_.empty() || state_ != seen_; });
    seen_ = state_;
  }
  [[nodiscard]] State state() const {
    const std::lock_guard lock(mutex_);
    return state_;
  }
  [[nodiscard]] End end() const {
    const std::lock_guard lock(mutex_);
    return end_;
  }
  [[nodiscard]] std::string words() const {
    const std::lock_guard lock(mutex_);
    return words_;
  }
  [[nodiscard]] std::string take() {
    const std::lock_guard lock(mutex_);
    changed_.notify_all();
    return std::exchange(inbox_, {});
  }
  void send(std::string text) {
    asio::post(io_, [this, text = std::move(text)]() mutable {
      to_send_.push_back(std::move(text));
      if (to_send_.size() == 1) write();
    });
  }

 private:
  void run() {
    resolver_.async_resolve(address_.host,
                            std::to_string(address_.port),
                            [this](Error error, const Tcp::resolver::results_type& found) {
                              if (error) return finish(End::no_name, error);
                              connect(found);
                            });
    io_.run();
  }

  void connect(const Tcp::resolver::results_type& found) {
    asio::async_connect(socket(), found, [this](Error error, const Tcp::endpoint&) {
      if (error) return finish(End::no_connection, error);
      if (address_.protocol == Protocol::telnet) return opened();
      stream_.read_message_max(kLargestMessage);
      stream_.async_handshake(address_.host, "/", [this](Error refused) {
        if (refused) return finish(End::no_websocket, refused);
        opened();
      });
    });
  }

  void opened() {
    become(State::open);
    read();
  }

  void read() {
    if (address_.protocol == Protocol::telnet) {
      socket().async_read_some(asio::buffer(bytes_), [this](Error error, std::size_t count) {
        received({bytes_.data(), count});
        if (error) return finish(error == asio::error::eof ? End::closed : End::lost, error);
        read();
      });
      return;
    }
    // Where the connection is lost within a message, its beginning is in the buffer.
    stream_.async_read(message_, [this](Error error, std::size_t) {
      const std::string payload = boost::beast::buffers_to_string(message_.data());
      message_.consume(message_.size());
      received(joiner_.take(
          stream_.got_text() ? FrameJoiner::Kind::text : FrameJoiner::Kind::binary, payload));
      if (!error) return read();
      received(joiner_.rest());
      finish(error == websocket::error::closed ? End::closed : End::lost, error);
    });
  }

  void received(std::string_view bytes) {
    if (bytes.empty()) return;
    save_(bytes);
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return inbox_.size() < kLargestInbox || is_stopped_; });
    inbox_.append(bytes);
    changed_.notify_all();
  }

  void write() {
    const auto written = [this](Error error, std::size_t) {
      if (error) return finish(End::lost, error);
      to_send_.pop_front();
      if (!to_send_.empty()) write();
    };
    const auto bytes = asio::buffer(to_send_.front());
    if (address_.protocol == Protocol::websocket) {
      stream_.async_write(bytes, written);
    } else {
      asio::async_write(socket(), bytes, written);
    }
  }

  void become(State state) {
    const std::lock_guard lock(mutex_);
    state_ = state;
    changed_.notify_all();
  }
  void finish(End end, Error error) {
    {
      const std::lock_guard lock(mutex_);
      if (state_ == State::over) return;
      end_ = end;
      words_ = error.message();
    }
    become(State::over);
    io_.stop();
  }

  using Socket = asio::basic_stream_socket<Tcp, asio::io_context::executor_type>;
  using Resolver = asio::ip::basic_resolver<Tcp, asio::io_context::executor_type>;
  Socket& socket() { return stream_.next_layer(); }

  Address address_;
  std::function<void(std::string_view)> save_;
  asio::io_context io_;
  Resolver resolver_;
  websocket::stream<Socket, false> stream_;
  boost::beast::flat_buffer message_;
  std::array<char, 4096> bytes_{};
  FrameJoiner joiner_;
  std::deque<std::string> to_send_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string inbox_;
  State state_ = State::connecting;
  State seen_ = State::connecting;  ///< by wait()
  End end_ = End::none;
  std::string words_;
  bool is_stopped_ = false;
  std::thread thread_;  // last: it uses the others
};

Connection::Connection(const Address& address, std::function<void(std::string_view)> save)
    : link_(std::make_unique<Link>(address, std::move(save))) {}
Connection::~Connection() = default;

void Connection::wait(std::chrono::milliseconds most) { link_->wait(most); }
Connection::State Connection::state() const { return link_->state(); }
Connection::End Connection::end() const { return link_->end(); }
std::string Connection::end_in_words() const { return link_->words(); }
std::string Connection::take() { return link_->take(); }
void Connection::send(Query query) { link_->send(std::string(text_of(query))); }
void Connection::send(const ConfirmedMove& move) { link_->send(move.text()); }

}  // namespace chaintrue::live
