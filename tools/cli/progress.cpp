// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <memory>
#include <mutex>
#include <thread>

namespace chaintrue::cli {
namespace {

using Clock = std::chrono::steady_clock;

/// How much is done, 0 to 1; nobody has said so while it is negative.
std::atomic<double> share{-1.0};

std::string left_in_words(double elapsed_s, double done) {
  if (!(done > 0.0)) return "";
  return fmt::format(
      ", {:.0f} % done, about {:.0f} s left", 100.0 * done, elapsed_s * (1.0 - done) / done);
}

/// Writes its line over and over, in a thread of its own, until it goes.
class Line {
 public:
  explicit Line(std::string verb) : verb_(std::move(verb)), thread_([this] { run(); }) {}
  ~Line() {
    {
      const std::scoped_lock lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

 private:
  void run() {
    constexpr auto kQuiet = std::chrono::seconds(1);
    constexpr auto kStep = std::chrono::milliseconds(250);
    const Clock::time_point start = Clock::now();
    std::unique_lock lock(mutex_);
    const auto over = [this] { return is_over_; };
    if (wake_.wait_for(lock, kQuiet, over)) return;
    do {
      const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
      fmt::print(
          stderr, "\r\x1b[K{}: {:.0f} s{}", verb_, elapsed_s, left_in_words(elapsed_s, share));
      std::fflush(stderr);
    } while (!wake_.wait_for(lock, kStep, over));
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }

  std::string verb_;
  bool is_over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;  // last: it uses the others
};

std::unique_ptr<Line>& line() {
  static std::unique_ptr<Line> the_line;
  return the_line;
}

}  // namespace

Progress::Progress(const std::string& verb) {
  if (::isatty(STDERR_FILENO) != 0) line() = std::make_unique<Line>(verb);
}

Progress::~Progress() { end_progress(); }

void progress_is(double finished, double total) { share = total > 0.0 ? finished / total : -1.0; }

void end_progress() { line().reset(); }

}  // namespace chaintrue::cli
