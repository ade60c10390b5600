// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Listening to a machine: its connection, the file, the session and the terminal together.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "grid/files/maslow4_log.hpp"
#include "tools/live/connection.hpp"

namespace chaintrue::live {

struct WatchOptions {
  Address address;
  std::string output;  ///< everything received goes there; "-" is standard output
  /// For a connection, and for a word from a machine that was asked for one.
  std::chrono::milliseconds patience{10000};
  std::optional<std::chrono::milliseconds>
      most{};          ///< absent: until somebody or the machine ends it
  int reconnects = 0;  ///< by itself; then it is asked at a terminal
  bool drive = false;  ///< moves are offered, each to be confirmed
  grid::files::Maslow4Options reading{};
};

/// Shows what comes, until it ends. An exit code. \throws grid::files::InputError where there is no
/// machine to listen to, or the file cannot be written.
[[nodiscard]] int watch(const WatchOptions& options);

/// Shows what would have been shown while this log came in, in at most some 200 steps. An exit code.
[[nodiscard]] int replay(const std::string& file, const grid::files::Maslow4Options& reading);

}  // namespace chaintrue::live
