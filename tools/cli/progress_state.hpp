// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The text of a progress line, from the steps received and the time of a given clock.
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

  /// Starts the time of the whole.
  void begin(std::string verb);
  void note(const grid::WorkStep& step);
  /// For the last step received, or the whole if none was; negative if unknown. Cheap enough for
  /// millions of calls.
  void note_share(double share) { share_ = share; }
  /// "fit: 3 s, step 1 of 2, settings and correction, 40 % done, about 2 s left". The time left is
  /// that of the step, or of its pass: that of the others is unknown.
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
