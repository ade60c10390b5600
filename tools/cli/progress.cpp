// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress_line.hpp"

#include <fmt/format.h>
#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#else
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <utility>

#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

namespace {

ProgressState& state() {
  static ProgressState the_state([] {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
  });
  return the_state;
}

#ifdef __EMSCRIPTEN__

/// A page has neither a terminal nor a second thread: its script, Module.onProgress, receives the
/// words with each step or share, not more often than it can show them.
class Line {
 public:
  void show() {
    constexpr auto kStep = std::chrono::milliseconds(100);
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < kStep) return;
    shown_ = now;
    const std::string words = state().words();
    EM_ASM(
        {
          if (Module.onProgress) Module.onProgress(UTF8ToString($0));
        },
        words.c_str());
  }

 private:
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

std::unique_ptr<Line> shown_line() { return std::make_unique<Line>(); }

#else

using Line = RepeatedLine;

/// No output without a terminal, or for short work.
std::unique_ptr<Line> shown_line() {
  if (::isatty(::fileno(stderr)) == 0) return nullptr;
  constexpr std::chrono::seconds kQuiet(1);
  constexpr std::chrono::milliseconds kStep(250);
  return std::make_unique<Line>(
      stderr, [] { return state().words(); }, kQuiet, kStep);
}

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
  state().begin(verb);
  line() = shown_line();
}

ProgressLine::~ProgressLine() { end_progress(); }

grid::Progress shown_progress() {
  return [](const WorkStep& step) {
    state().note(step);
    show_in_page();
  };
}

void progress_is(double finished, double total) {
  state().note_share(total > 0.0 ? finished / total : -1.0);
  show_in_page();
}

void end_progress() { line().reset(); }

namespace {

std::string left_in_words(double elapsed_s, double done) {
  if (!(done > 0.0)) return "";
  return fmt::format(", {:.0f} % done, about {:.0f} s left", 100.0 * done,
                     elapsed_s * (1.0 - done) / done);
}

}  // namespace

ProgressState::ProgressState(Clock clock)
    : clock_(std::move(clock)), whole_began_s_(clock_()), step_began_s_(whole_began_s_) {}

void ProgressState::begin(std::string verb) {
  const std::scoped_lock lock(mutex_);
  verb_ = std::move(verb);
  whole_began_s_ = clock_();
}

void ProgressState::note(const WorkStep& step) {
  const std::scoped_lock lock(mutex_);
  if (step.number != step_.number || step.what != step_.what || step.pass != step_.pass)
    step_began_s_ = clock_();
  step_ = step;
  share_ = step.share;
}

std::string ProgressState::words() const {
  const std::scoped_lock lock(mutex_);
  const double now_s = clock_();
  const double elapsed_s = now_s - whole_began_s_;
  const double share = std::min(share_.load(), 1.0);
  std::string words = fmt::format("{}: {:.0f} s", verb_, elapsed_s);
  if (step_.what.empty()) return words + left_in_words(elapsed_s, share);
  if (step_.of > 1) words += fmt::format(", step {} of {}", step_.number, step_.of);
  words += fmt::format(", {}", step_.what);
  if (step_.pass > 0)
    words += fmt::format(", pass {}{}", step_.pass, share < 0.0 ? " until it converges" : "");
  return words + left_in_words(now_s - step_began_s_, share);
}

RepeatedLine::RepeatedLine(std::FILE* out, std::function<std::string()> words,
                           std::chrono::milliseconds quiet, std::chrono::milliseconds step)
    : out_(out), words_(std::move(words)), thread_([this, quiet, step] { run(quiet, step); }) {}

RepeatedLine::~RepeatedLine() {
  {
    const std::scoped_lock lock(mutex_);
    is_over_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void RepeatedLine::run(std::chrono::milliseconds quiet, std::chrono::milliseconds step) {
  std::unique_lock lock(mutex_);
  const auto over = [this] { return is_over_; };
  if (wake_.wait_for(lock, quiet, over)) return;
  do {
    fmt::print(out_, "\r\x1b[K{}", words_());
    std::fflush(out_);
  } while (!wake_.wait_for(lock, step, over));
  fmt::print(out_, "\r\x1b[K");
  std::fflush(out_);
}

}  // namespace chaintrue::cli
