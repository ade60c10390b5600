// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress.hpp"

#include <fmt/format.h>
#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
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

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What was received last. The share is separate: it may change millions of times.
struct LastStep {
  std::mutex mutex;
  grid::WorkStep step;
  Clock::time_point began = Clock::now();
  /// How much of the step is done, 0 to 1; negative while nobody knows.
  std::atomic<double> share{-1.0};
};

LastStep& last_step() {
  static LastStep last;
  return last;
}

void note(const grid::WorkStep& step) {
  const std::scoped_lock lock(last_step().mutex);
  const grid::WorkStep& last = last_step().step;
  if (step.number != last.number || step.what != last.what || step.pass != last.pass) {
    last_step().began = Clock::now();
  }
  last_step().step = step;
  last_step().share = step.share;
}

std::string left_in_words(double elapsed_s, double done) {
  if (!(done > 0.0)) return "";
  return fmt::format(
      ", {:.0f} % done, about {:.0f} s left", 100.0 * done, elapsed_s * (1.0 - done) / done);
}

/// Time left is that of the step, or of its pass: how long the others will take nobody knows.
std::string in_words(const std::string& verb, double elapsed_s) {
  const std::scoped_lock lock(last_step().mutex);
  const grid::WorkStep& step = last_step().step;
  const double share = std::min(last_step().share.load(), 1.0);
  std::string words = fmt::format("{}: {:.0f} s", verb, elapsed_s);
  if (step.what.empty()) return words + left_in_words(elapsed_s, share);
  if (step.of > 1) words += fmt::format(", step {} of {}", step.number, step.of);
  words += fmt::format(", {}", step.what);
  if (step.pass > 0)
    words += fmt::format(", pass {}{}", step.pass, share < 0.0 ? " until it settles" : "");
  return words + left_in_words(seconds_since(last_step().began), share);
}

#ifdef __EMSCRIPTEN__

/// A page has neither a terminal nor a second thread: its script, Module.onProgress, is given the
/// words when a step or a share is, not more often than it can show them.
class Line {
 public:
  explicit Line(std::string verb) : verb_(std::move(verb)) {}

  void show() {
    constexpr auto kStep = std::chrono::milliseconds(100);
    const Clock::time_point now = Clock::now();
    if (now - shown_ < kStep) return;
    shown_ = now;
    const std::string words = in_words(verb_, seconds_since(start_));
    EM_ASM(
        {
          if (Module.onProgress) Module.onProgress(UTF8ToString($0));
        },
        words.c_str());
  }

 private:
  std::string verb_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_ = start_;
};

bool is_watched() { return true; }

#else

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
      fmt::print(stderr, "\r\x1b[K{}", in_words(verb_, seconds_since(start)));
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

bool is_watched() { return ::isatty(STDERR_FILENO) != 0; }

#endif

std::unique_ptr<Line>& line() {
  static std::unique_ptr<Line> the_line;
  return the_line;
}

/// Elsewhere the line shows itself.
void show_in_page() {
#ifdef __EMSCRIPTEN__
  if (line()) line()->show();
#endif
}

}  // namespace

ProgressLine::ProgressLine(const std::string& verb) {
  if (is_watched()) line() = std::make_unique<Line>(verb);
}

ProgressLine::~ProgressLine() { end_progress(); }

grid::Progress shown_progress() {
  return [](const grid::WorkStep& step) {
    note(step);
    show_in_page();
  };
}

void progress_is(double finished, double total) {
  last_step().share = total > 0.0 ? finished / total : -1.0;
  show_in_page();
}

void end_progress() { line().reset(); }

}  // namespace chaintrue::cli
