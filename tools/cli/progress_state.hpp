// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a line of progress says: the steps that were told, in the time of a clock that is given.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>

#include "grid/progress.hpp"

namespace chaintrue::cli {

/// Safe from any thread.
class ProgressState {
 public:
  /// Seconds since any moment.
  using Clock = std::function<double()>;
  explicit ProgressState(Clock clock);

  /// From here on the time of the whole counts.
  void begin(std::string verb);
  void note(const grid::WorkStep& step);
  /// Of the step that was told last, or of the whole where none was; negative while nobody knows. May
  /// be called millions of times.
  void note_share(double share) { share_ = share; }
  /// "fit: 3 s, step 1 of 2, settings and correction, 40 % done, about 2 s left". The time left is that
  /// of the step, or of its pass: how long the others will take nobody knows.
  [[nodiscard]] std::string words() const;

 private:
  Clock clock_;
  mutable std::mutex mutex_;
  std::string verb_;
  grid::WorkStep step_;
  double whole_began_s_ = 0.0;
  double step_began_s_ = 0.0;
  std::atomic<double> share_{-1.0};
};

}  // namespace chaintrue::cli
