// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A progress line: its text, from the steps received and the time of a given clock; and the line of
/// a terminal that a separate thread rewrites.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

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
  std::string words() const;

 private:
  Clock clock_;
  mutable std::mutex mutex_;
  std::string verb_;
  grid::WorkStep step_;
  double whole_began_s_ = 0.0;
  double step_began_s_ = 0.0;
  std::atomic<double> share_{-1.0};
};

/// Silent for `quiet`; then it writes `words` and erases them for the next, each `step`. The line
/// is empty after destruction.
class RepeatedLine {
 public:
  RepeatedLine(std::FILE* out, std::function<std::string()> words, std::chrono::milliseconds quiet,
               std::chrono::milliseconds step);
  ~RepeatedLine();
  RepeatedLine(const RepeatedLine&) = delete;
  RepeatedLine& operator=(const RepeatedLine&) = delete;

 private:
  void run(std::chrono::milliseconds quiet, std::chrono::milliseconds step);

  std::FILE* out_;
  std::function<std::string()> words_;
  bool is_over_ = false;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace chaintrue::cli
