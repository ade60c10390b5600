// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Checks codes, arcs and short moves against a controller's table.
#include "tools/gcode/controller_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/gcode/block.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {

namespace {

struct Row {
  const char* name;
  /// Of the firmware's name, what it does with an unknown code, the codes, the largest size, ms a
  /// tick, planned moves and acceleration.
  const char* sentence;
};
constexpr Row kRows[] = {
    {"code_not_known", "{0} {1} {2}"},
    {"code_misread", "{0} reads {2}; the compensated file has no such code"},
    {"arc_cut_straight",
     "{0} cuts so short or so flat an arc as a straight line, here up to {3:.3f} mm off; the "
     "compensated file has no arcs"},
    {"arc_plane_not_known",
     "{0} supports arcs only in X and Y and would cut this one there; the compensated file has no "
     "arcs"},
    {"arc_turns_not_known",
     "{0} {1} the P of an arc, its number of turns; the compensated file has no arcs"},
    {"move_of_no_length",
     "{0} misreads a move to the tool's current position; the compensated file has no such move"},
    {"shorter_than_a_tick",
     "{0} needs at least {4:g} ms per move; at their feed these would take less, so the tool is "
     "slower there"},
    {"shorter_than_the_plan",
     "{0} plans {5} moves ahead; these are so short that it cannot stop within them from F{3:g} at "
     "its default {6:g} mm/s^2, so the tool is slower there"},
};

}  // namespace

void ControllerCheck::add(Kind kind, std::size_t line, double size, std::string codes) {
  Occurrences& all =
      observed_.try_emplace({kind, std::move(codes)}, Occurrences{line}).first->second;
  ++all.count;
  all.worst = std::max(all.worst, size);
}

void ControllerCheck::code(std::size_t line, Code code) {
  if (!knows_code(firmware_, code)) {
    add(Kind::unknown_code, line, 0.0, name(code));
  } else if (const Code other = taken_for(firmware_, code); other != code) {
    add(Kind::misread_code, line, 0.0, fmt::format("{} as {}", name(code), name(other)));
  }
}

void ControllerCheck::arc(const Move& move) {
  const Arc& arc = *move.arc;
  const double sweep = std::fabs(arc.sweep_rad);
  if (cuts_straight(firmware_, arc.start_radius_mm, sweep)) {
    add(Kind::straight_arc, move.line, arc.start_radius_mm * (1.0 - std::cos(0.5 * sweep)));
  }
  if (arc.is_upright() && !knows_code(firmware_, g::plane_zx)) add(Kind::upright_arc, move.line);
  if (std::abs(arc.turns) > 1 && firmware_.arcs != ArcRule::exact) add(Kind::arc_turns, move.line);
}

void ControllerCheck::move(const Move& move) {
  const double length = length_mm(move);
  if (length == 0.0 && firmware_.phantom_moves) add(Kind::no_length, move.line);
  if (move.kind == MoveKind::rapid || length == 0.0) return;
  if (move.arc) {
    arc(move);
    return;
  }
  const double feed = feed_mm_per_min(move);
  const double speed_mm_per_s = feed / 60.0;
  if (firmware_.tick_s > 0.0 && length < speed_mm_per_s * firmware_.tick_s) {
    add(Kind::short_tick, move.line);
  }
  // The stopping distance from the feed must be within the planned moves.
  const double stop_mm =
      firmware_.acceleration_mm_per_s2 > 0.0
          ? speed_mm_per_s * speed_mm_per_s / (2.0 * firmware_.acceleration_mm_per_s2)
          : 0.0;
  if (length * firmware_.planned_moves < stop_mm) add(Kind::short_plan, move.line, feed);
}

void ControllerCheck::end(std::size_t /*line*/, std::string_view /*word*/) {
  for (const auto& [key, all] : observed_) {
    const auto& [name, form] = kRows[static_cast<std::size_t>(key.first)];
    std::string sentence = fmt::format(fmt::runtime(form), firmware_.name, firmware_.unknown,
                                       key.second, all.worst, 1000.0 * firmware_.tick_s,
                                       firmware_.planned_moves, firmware_.acceleration_mm_per_s2);
    if (all.count > 1) sentence += fmt::format(" ({} lines)", all.count);
    findings_.add(Note{all.line, name, std::move(sentence)});
  }
}

}  // namespace chaintrue::gcode
