// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A log out of the messages of FluidNC's websocket.
///
/// What the machine prints comes in binary messages that end anywhere, also within a line
/// (WebUI/WSChannel.cpp: a buffer that is flushed when it is full, or old). Text messages of its page
/// (`CURRENT_ID:0`, `ACTIVE_ID:1`, `PING:1`) come between them, without an end of line: in the log
/// they become lines of their own behind the line that they interrupt. Other text is of the log.
///
/// \code
///   FrameJoiner joiner;
///   joiner.take(FrameJoiner::Kind::binary, "CLBM:[{bl:29");   // as it is
///   joiner.take(FrameJoiner::Kind::text, "PING:1");           // kept
///   joiner.take(FrameJoiner::Kind::binary, "60.58,..}]\n");   // as it is, then "PING:1\n"
/// \endcode
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::live {

class FrameJoiner {
 public:
  enum class Kind { text, binary };
  /// What the log goes on with.
  [[nodiscard]] std::string take(Kind kind, std::string_view payload);
  /// Messages of the page that no line has ended before.
  [[nodiscard]] std::string rest();

 private:
  std::string notices_;
  bool is_within_line_ = false;
};

}  // namespace chaintrue::live
