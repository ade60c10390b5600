// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/frames.hpp"

#include <utility>

namespace chaintrue::live {
namespace {

/// A line that does not end is ended for them: memory stays bounded.
constexpr std::size_t kMostHeld = std::size_t{64} << 10U;

bool is_notice(std::string_view text) {
  if (text.find('\n') != std::string_view::npos) return false;
  for (const std::string_view begin :
       {"CURRENT_ID:", "ACTIVE_ID:", "PING:", "currentID:", "activeID:"}) {
    if (text.starts_with(begin)) return true;
  }
  return false;
}

}  // namespace

std::string FrameJoiner::take(Kind kind, std::string_view payload) {
  if (payload.empty()) return {};
  if (kind == Kind::text && is_notice(payload)) {
    notices_.append(payload).append("\n");
    return is_within_line_ && notices_.size() < kMostHeld ? std::string() : rest();
  }
  std::string log(payload);
  is_within_line_ = log.back() != '\n';
  const std::size_t end = log.find('\n');
  if (end != std::string::npos && !notices_.empty())
    log.insert(end + 1, std::exchange(notices_, {}));
  return log;
}

std::string FrameJoiner::rest() {
  std::string rest = std::exchange(notices_, {});
  if (is_within_line_ && !rest.empty()) rest.insert(0, "\n");
  if (!rest.empty()) is_within_line_ = false;
  return rest;
}

}  // namespace chaintrue::live
