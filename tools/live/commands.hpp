// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All that is ever sent to a machine: two queries, which move nothing, and two moves, each of which a
/// person confirmed. A connection takes these types and no text.
///
/// The queries, by the public firmware (MaslowCNC/Maslow_4, firmware/FluidNC/src):
///
///   ?        Serial.cpp, execute_realtime_command: a status report is printed at once, nothing else
///   $GSTATE  ProcessSettings.cpp, maslow_get_state: Calibration.cpp prints "Current state: 7"
///
/// Neither is kept for later, writes a setting, or changes a state; both are taken in any state.
/// `$CD`, `$S` and other lists of settings are not sent: the machine reads its file system for them,
/// and stops its motors where that takes longer than 100 ms while it moves (Maslow.cpp, update).
///
/// The moves:
///
///   $J=G21G90G53X..Y..F..  ProcessSettings.cpp, doJog: the sled goes to a place, in coordinates of the
///                          machine, so that no offset of a workpiece moves it elsewhere
///   $CAL                   maslow_start_calibration: Find Anchors, which measures where the sled is,
///                          at five places around it, and at those of its own grid (Calibration.cpp)
///
/// \code
///   link.send(Query::status);
///   if (const auto move = ConfirmedMove::ask({Move::Kind::go_to, {300, -200}}, type)) link.send(*move);
/// \endcode
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "model/coordinates.hpp"
#include "tools/live/received_text.hpp"

namespace chaintrue::live {

enum class Query { status, calibration_state };
/// As it is sent, with its end of line where it has one.
[[nodiscard]] std::string_view text_of(Query query);

struct Move {
  enum class Kind { go_to, find_anchors } kind = Kind::go_to;
  model::BedPoint to{};  ///< of go_to, mm from the centre of the frame

  /// The line that is sent, without its end.
  [[nodiscard]] std::string line() const;
  /// What the machine does then, and what to see to before.
  [[nodiscard]] std::string question() const;
};

/// Made by ask() alone.
class ConfirmedMove {
 public:
  /// `type` shows a question and returns what was typed, nothing at the end of input. `y` or `Y` alone
  /// confirms; empty for everything else.
  [[nodiscard]] static std::optional<ConfirmedMove> ask(
      const Move& move, const std::function<std::optional<std::string>(const std::string&)>& type);
  /// As it is sent, with its end of line.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  explicit ConfirmedMove(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// Says when a move is due: never while the machine works, and never twice for one answer.
class Driver {
 public:
  /// What is to be asked now, with the places read so far and the place that would tell most.
  [[nodiscard]] std::optional<Move> due(const MachineStatus& status,
                                        std::size_t places,
                                        const std::optional<model::BedPoint>& tells_most);
  /// The move was sent, with these reports before it.
  void sent(const Move& move, const MachineStatus& status);
  /// Nothing is left to drive to: the places that were read tell all that places can.
  [[nodiscard]] bool is_done() const { return is_done_; }

 private:
  std::optional<std::size_t>
      busy_before_;    ///< the last move; it is over once a report was busy, then idle
  bool went_ = false;  ///< the sled stands where it is to measure next
  bool is_done_ = false;
};

}  // namespace chaintrue::live
