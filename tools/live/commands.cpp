// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/commands.hpp"

#include <fmt/format.h>

namespace chaintrue::live {
namespace {

/// Slow enough to reach the machine's own stop button in time: a metre takes more than a minute.
constexpr int kFeedMmPerMin = 800;

}  // namespace

std::string_view text_of(Query query) { return query == Query::status ? "?" : "$GSTATE\n"; }

std::string Move::line() const {
  if (kind == Kind::find_anchors) return "$CAL";
  return fmt::format("$J=G21G90G53X{:.1f}Y{:.1f}F{}", to.x_mm + 0.0, to.y_mm + 0.0, kFeedMmPerMin);
}

std::string Move::question() const {
  const std::string what =
      kind == Kind::find_anchors
          ? "Find Anchors: the sled drives over the sheet by itself and all belts are pulled. Is "
            "the "
            "bit up, are the belts extended, and are hands and tools off the sheet?"
          : fmt::format(
                "The sled drives to x {:.0f} mm, y {:.0f} mm from the centre. Is the bit up, and "
                "are hands and tools off the sheet?",
                to.x_mm + 0.0,
                to.y_mm + 0.0);
  return fmt::format("{}\nType y to send {} (anything else ends): ", what, line());
}

std::optional<ConfirmedMove> ConfirmedMove::ask(
    const Move& move, const std::function<std::optional<std::string>(const std::string&)>& type) {
  const auto typed = type(move.question());
  if (!typed || (*typed != "y" && *typed != "Y")) return std::nullopt;
  return ConfirmedMove(move.line() + "\n");
}

std::optional<Move> Driver::due(const MachineStatus& status,
                                std::size_t places,
                                const std::optional<model::BedPoint>& tells_most) {
  if (status.state != "Idle" || is_done_) return std::nullopt;
  if (busy_before_ && status.busy == *busy_before_) return std::nullopt;
  if (went_ || places == 0) return Move{Move::Kind::find_anchors, {}};
  if (tells_most) return Move{Move::Kind::go_to, *tells_most};
  is_done_ = true;
  return std::nullopt;
}

void Driver::sent(const Move& move, const MachineStatus& status) {
  busy_before_ = status.busy;
  went_ = move.kind == Move::Kind::go_to;
}

}  // namespace chaintrue::live
