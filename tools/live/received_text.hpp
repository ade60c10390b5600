// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a machine has printed so far, in bounded memory, as the reader of logs
/// (grid/files/maslow4_log.hpp) takes it.
///
/// Bytes come in packets that end anywhere; what is kept does not depend on where. Lines have the
/// numbers that they have in the file: a status report (`<Idle|MPos:..>`), which the reader skips, is
/// kept as an empty line.
///
/// \code
///   ReceivedText text;
///   text.take("[MSG:INFO: Measured way");
///   text.take("point 7]\n<Idle|MPos:0.000>\n");
///   text.lines();  // "[MSG:INFO: Measured waypoint 7]\n\n"
/// \endcode
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::live {

/// A line that is longer keeps its beginning: the longest that a machine prints, a list of 400 places,
/// has 26 kB.
inline constexpr std::size_t kLongestLine = std::size_t{64} << 10U;
/// Beyond it the older half is forgotten: a hundred runs of 81 places.
inline constexpr std::size_t kMostKept = std::size_t{4} << 20U;

/// By the machine's status reports.
struct MachineStatus {
  std::string state{};   ///< of the last: "Idle", "Home", "Jog", "Alarm"; empty before the first
  std::size_t busy = 0;  ///< how many so far said anything but "Idle"
};

class ReceivedText {
 public:
  void take(std::string_view bytes);

  /// The complete lines, each with its end.
  [[nodiscard]] const std::string& lines() const { return lines_; }
  /// The beginning of a line that has not ended yet.
  [[nodiscard]] const std::string& open_line() const { return open_line_; }
  /// Lines that have ended, the forgotten ones among them.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Those of them that are neither empty nor a status report.
  [[nodiscard]] std::size_t telling() const { return telling_; }
  /// False where older lines were forgotten: numbers of lines then count from a later one.
  [[nodiscard]] bool is_whole() const { return is_whole_; }
  [[nodiscard]] const MachineStatus& status() const { return status_; }
  /// The machine's messages that a person waits for, since the last call: errors, refusals, places that were
  /// measured. Of a hundred and more the last.
  [[nodiscard]] std::vector<std::string> take_messages();

 private:
  void end_line();

  std::string lines_;
  std::string open_line_;
  MachineStatus status_;
  std::vector<std::string> messages_;
  std::size_t count_ = 0;
  std::size_t telling_ = 0;
  bool is_whole_ = true;
};

}  // namespace chaintrue::live
