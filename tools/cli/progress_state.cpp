// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/progress_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace chaintrue::cli {
namespace {

std::string left_in_words(double elapsed_s, double done) {
  if (!(done > 0.0)) return "";
  return fmt::format(
      ", {:.0f} % done, about {:.0f} s left", 100.0 * done, elapsed_s * (1.0 - done) / done);
}

}  // namespace

ProgressState::ProgressState(Clock clock)
    : clock_(std::move(clock)), whole_began_s_(clock_()), step_began_s_(whole_began_s_) {}

void ProgressState::begin(std::string verb) {
  const std::scoped_lock lock(mutex_);
  verb_ = std::move(verb);
  whole_began_s_ = clock_();
}

void ProgressState::note(const grid::WorkStep& step) {
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

}  // namespace chaintrue::cli
