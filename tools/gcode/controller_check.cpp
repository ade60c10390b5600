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

void ControllerCheck::Occurrences::add(std::size_t where, double size) {
  if (count++ == 0) line = where;
  worst = std::max(worst, size);
}

void ControllerCheck::code(std::size_t line, Code code) {
  if (!knows_code(firmware_, code)) {
    unknown_[name(code)].add(line);
  } else if (const Code other = taken_for(firmware_, code); other != code) {
    misread_[fmt::format("{} as {}", name(code), name(other))].add(line);
  }
}

void ControllerCheck::arc(const Move& move) {
  const Arc& arc = *move.arc;
  const double sweep = std::fabs(arc.sweep_rad);
  if (cuts_straight(firmware_, arc.start_radius_mm, sweep)) {
    straight_arcs_.add(move.line, arc.start_radius_mm * (1.0 - std::cos(0.5 * sweep)));
  }
  const bool upright = arc.first.z_mm != 0.0 || arc.second.z_mm != 0.0;
  if (upright && !knows_code(firmware_, g::plane_zx)) upright_arcs_.add(move.line);
  if (std::abs(arc.turns) > 1 && firmware_.arcs != ArcRule::exact) arc_turns_.add(move.line);
}

void ControllerCheck::move(const Move& move) {
  const double length = length_mm(move);
  if (length == 0.0 && firmware_.phantom_moves) no_length_.add(move.line);
  if (move.kind == MoveKind::rapid || length == 0.0) return;
  if (move.arc) {
    arc(move);
    return;
  }
  const double feed = feed_mm_per_min(move);
  const double speed_mm_per_s = feed / 60.0;
  if (firmware_.tick_s > 0.0 && length < speed_mm_per_s * firmware_.tick_s) {
    short_ticks_.add(move.line);
  }
  // The stopping distance from the feed must be within the planned moves.
  const double stop_mm =
      firmware_.acceleration_mm_per_s2 > 0.0
          ? speed_mm_per_s * speed_mm_per_s / (2.0 * firmware_.acceleration_mm_per_s2)
          : 0.0;
  if (length * firmware_.planned_moves < stop_mm) short_plans_.add(move.line, feed);
}

void ControllerCheck::end(std::size_t /*line*/, std::string_view /*word*/) {
  const auto add = [&](const Occurrences& observed, std::string_view name, std::string sentence) {
    if (observed.count == 0) return;
    if (observed.count > 1) sentence += fmt::format(" ({} lines)", observed.count);
    findings_.add(Note{observed.line, name, std::move(sentence)});
  };
  for (const auto& [code, observed] : unknown_) {
    add(observed,
        "code_not_known",
        fmt::format("{} {} {}", firmware_.name, firmware_.unknown, code));
  }
  for (const auto& [codes, observed] : misread_) {
    add(observed,
        "code_misread",
        fmt::format("{} reads {}; the compensated file has no such code", firmware_.name, codes));
  }
  add(straight_arcs_,
      "arc_cut_straight",
      fmt::format("{} cuts so short or so flat an arc as a straight line, here up to {:.3f} mm "
                  "off; the compensated file has no arcs",
                  firmware_.name,
                  straight_arcs_.worst));
  add(upright_arcs_,
      "arc_plane_not_known",
      fmt::format("{} supports arcs only in X and Y and would cut this one there; the compensated "
                  "file has no arcs",
                  firmware_.name));
  add(arc_turns_,
      "arc_turns_not_known",
      fmt::format("{} {} the P of an arc, its number of turns; the compensated file has no arcs",
                  firmware_.name,
                  firmware_.unknown));
  add(no_length_,
      "move_of_no_length",
      fmt::format("{} misreads a move to the tool's current position; the compensated file has no "
                  "such move",
                  firmware_.name));
  add(short_ticks_,
      "shorter_than_a_tick",
      fmt::format("{} needs at least {:g} ms per move; at their feed these would take less, so the "
                  "tool is slower there",
                  firmware_.name,
                  1000.0 * firmware_.tick_s));
  add(short_plans_,
      "shorter_than_the_plan",
      fmt::format("{} plans {} moves ahead; these are so short that it cannot stop within them "
                  "from F{:g} at its default {:g} mm/s^2, so the tool is slower there",
                  firmware_.name,
                  firmware_.planned_moves,
                  short_plans_.worst,
                  firmware_.acceleration_mm_per_s2));
}

}  // namespace chaintrue::gcode
