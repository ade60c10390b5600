// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/repeated_line.hpp"

#include <fmt/format.h>

#include <utility>

namespace chaintrue::cli {

RepeatedLine::RepeatedLine(std::FILE* out,
                           std::function<std::string()> words,
                           std::chrono::milliseconds quiet,
                           std::chrono::milliseconds step)
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
