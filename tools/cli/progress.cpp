// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress.hpp"

#ifdef __EMSCRIPTEN__
#include <emscripten.h>
#else
#include <unistd.h>
#endif

#include <chrono>
#include <cstdio>
#include <memory>

#include "tools/cli/progress_line.hpp"

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
  return [](const grid::WorkStep& step) {
    state().note(step);
    show_in_page();
  };
}

void progress_is(double finished, double total) {
  state().note_share(total > 0.0 ? finished / total : -1.0);
  show_in_page();
}

void end_progress() { line().reset(); }

}  // namespace chaintrue::cli
