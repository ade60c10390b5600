// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One line of a terminal, rewritten by a separate thread.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace chaintrue::cli {

/// Silent for `quiet`; then it writes `words` and erases them for the next, each `step`. The line
/// is empty after destruction.
class RepeatedLine {
 public:
  RepeatedLine(std::FILE* out,
               std::function<std::string()> words,
               std::chrono::milliseconds quiet,
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
