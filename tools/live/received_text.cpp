// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/received_text.hpp"

#include <algorithm>
#include <utility>

namespace chaintrue::live {
namespace {

constexpr std::size_t kMostMessages = 100;

std::string_view without_return(std::string_view line) {
  while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

/// A status report has no braces, which only readings have.
bool is_status_report(std::string_view line) {
  return line.size() > 1 && line.front() == '<' &&
         line.find_first_of("{}") == std::string_view::npos;
}

/// What a person waits for, as the machine says it; empty for other lines.
std::string_view message_in(std::string_view line) {
  for (const std::string_view begin :
       {"[MSG:ERR: ", "[MSG:INFO: Measured waypoint ", "[MSG:INFO: Cannot "}) {
    const std::size_t at = line.find(begin);
    if (at == std::string_view::npos) continue;
    const std::size_t first = line.find(": ", at) + 2;
    const std::size_t end = std::min(line.find(']', first), line.size());
    return line.substr(first, end - first);
  }
  return line.starts_with("error:") || line.starts_with("ALARM:") ? line : std::string_view();
}

}  // namespace

void ReceivedText::take(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view part = bytes.substr(0, end);
    const std::size_t room = kLongestLine - std::min(kLongestLine, open_line_.size());
    open_line_.append(part.substr(0, room));
    if (end == std::string_view::npos) return;
    bytes.remove_prefix(end + 1);
    end_line();
  }
}

void ReceivedText::end_line() {
  const std::string_view line = without_return(open_line_);
  if (is_status_report(line)) {
    status_.state = std::string(line.substr(1, line.find_first_of("|:>", 1) - 1));
    status_.busy += status_.state == "Idle" ? 0 : 1;
  } else if (!line.empty()) {
    lines_.append(line);
    ++telling_;
    const std::string_view message = message_in(line);
    if (!message.empty()) messages_.emplace_back(message);
    if (messages_.size() > kMostMessages) messages_.erase(messages_.begin());
  }
  lines_ += '\n';
  ++count_;
  open_line_.clear();
  if (lines_.size() <= kMostKept) return;
  lines_.erase(0, lines_.find('\n', kMostKept / 2) + 1);
  is_whole_ = false;
}

std::vector<std::string> ReceivedText::take_messages() { return std::exchange(messages_, {}); }

}  // namespace chaintrue::live
