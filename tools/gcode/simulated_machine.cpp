// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Straight commands, pieces that are linear in chain length, arcs as cut by the firmwares.
#include "tools/gcode/simulated_machine.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

/// With play the tool's track has kinks where a chain reverses.
constexpr double kPlayStepMm = 1.0;
/// The radius of curvature of a path linear in chain lengths is at least this: the shortest
/// chain's.
constexpr double kShortestChainMm = 400.0;

/// Volatile: where GCC 12 makes a vector of X and Y, it leaves the rounding out.
double in_single_precision(double value) {
  const volatile float rounded = static_cast<float>(value);
  return rounded;
}

[[noreturn]] void no_place(const CorrectionFailure& failure, Point command, std::size_t line) {
  const bool controller = failure.reason == CorrectionReason::controller;
  refuse(controller ? outside_controller : outside_map, {line}, "{}: the tool's position {}",
         in_xy(command), failure.sentence());
}

}  // namespace

Point SimulatedMachine::as_read(Point point) const {
  if (!corrector_.firmware().single_precision) return point;
  return {in_single_precision(point.x_mm), in_single_precision(point.y_mm),
          in_single_precision(point.z_mm)};
}

Point SimulatedMachine::place(Point command, std::size_t line) {
  return tool(as_read(command), line);
}

model::ChainLengths SimulatedMachine::follow(model::ChainLengths motors) {
  model::ChainLengths chains;
  for (const model::Side side : model::kSides) {
    const double least = motors[side] - options_.half_play_mm[side];
    const double most = motors[side] + options_.half_play_mm[side];
    // Both begin paid out.
    chains[side] = std::clamp(chains_mm_[side].value_or(least), least, most);
    chains_mm_[side] = chains[side];
  }
  return chains;
}

Point SimulatedMachine::tool(Point command, std::size_t line) {
  if (!play_) {
    if (const auto offset = field_.value(command.x_mm, command.y_mm)) {
      return Point{command.x_mm + (*offset)[0], command.y_mm + (*offset)[1], command.z_mm};
    }
    const auto found = corrector_.tool(command);
    if (!found) no_place(found.error(), command, line);
    return Point{found->x_mm, found->y_mm, command.z_mm};
  }
  const auto paid = corrector_.paid_out(command);
  if (!paid) no_place(paid.error(), command, line);
  const auto found = corrector_.map().tool(follow(*paid));
  if (!found) no_place(CorrectionReason::outside_map, command, line);
  return Point{found->x_mm, found->y_mm, command.z_mm};
}

/// How far a straight command may continue from here until the tool's path bows by the flatness from
/// its chord.
double SimulatedMachine::straight_mm(Point command) {
  constexpr double kCarefulStepMm = 1.0;  // where the curvature is unknown
  constexpr double kLongestStepMm = 24.0;
  const double curvature = kCurvatureSafety * field_.curvature(command.x_mm, command.y_mm);
  if (!std::isfinite(curvature)) return kCarefulStepMm;
  return std::min(kLongestStepMm,
                  std::sqrt(8.0 * options_.flatness_mm / std::max(curvature, 1e-12)));
}

void SimulatedMachine::count_ticks(const Move& move) {
  const double tick_s = corrector_.firmware().tick_s;
  if (tick_s == 0.0 || move.kind == MoveKind::rapid) return;
  const double length = length_mm(move);
  const double way_mm = feed_mm_per_min(move) / 60.0 * tick_s;
  if (!(way_mm > 0.0)) return;
  const double ticks = length / way_mm;
  tick_overshoot_mm_ = std::max(tick_overshoot_mm_, (std::ceil(ticks) - ticks) * way_mm);
}

void SimulatedMachine::run(const Move& move, const Visit& visit) {
  count_ticks(move);
  const Point from = as_read(move.from);
  const Point to = as_read(move.to);
  if (options_.rapids_whole && move.kind == MoveKind::rapid) {
    visit(tool(to, move.line), to);
  } else if (move.arc) {
    arc(move, visit);
  } else {
    straight(from, to, move, visit);
  }
}

bool SimulatedMachine::straight(Point from, Point to, const Move& move, const Visit& visit) {
  const double length = level_mm(to - from);
  if (is_chain_linear(corrector_.firmware()) && length > 0.0) {
    return chain_linear(from, to, move, visit);
  }
  for (double gone = 0.0; gone < length;) {
    double step = kPlayStepMm;
    if (!play_) {
      const auto way = [&](double along) {
        return straight_mm(between(from, to, std::min(1.0, along / length)));
      };
      step = way(gone);
      step = std::min(step, std::max(0.25 * step, way(gone + step)));
    }
    gone += step;
    if (gone >= length) break;
    const Point here = as_read(between(from, to, gone / length));
    if (!visit(tool(here, move.line), here)) return false;
  }
  return visit(tool(to, move.line), to);
}

/// A whole number of pieces, summed in single precision.
bool SimulatedMachine::chain_linear(Point from, Point to, const Move& move, const Visit& visit) {
  const double length = level_mm(to - from);
  const double pieces = pieces_of(corrector_.firmware(), length, feed_mm_per_min(move));
  // Quotients, as the firmware computes them.
  const Point way = to - from;
  const Point step{way.x_mm / pieces, way.y_mm / pieces, way.z_mm / pieces};
  const double looks =
      std::ceil(length / pieces / std::sqrt(8.0 * options_.flatness_mm * kShortestChainMm));
  Point here = from;
  auto paid = corrector_.paid_out(here);
  for (double piece = 1.0; paid && piece <= pieces; piece += 1.0) {
    const Point next = as_read(here + step);
    const auto arrived = corrector_.paid_out(next);
    if (!arrived) no_place(arrived.error(), next, move.line);
    for (double look = 1.0; look <= looks; look += 1.0) {
      const double share = look / looks;
      model::ChainLengths lengths{paid->left_mm + share * (arrived->left_mm - paid->left_mm),
                                  paid->right_mm + share * (arrived->right_mm - paid->right_mm)};
      if (play_) lengths = follow(lengths);
      const auto where = corrector_.map().tool(lengths);
      const Point command = between(here, next, share);
      if (!where) no_place(CorrectionReason::outside_map, command, move.line);
      if (!visit({where->x_mm, where->y_mm, command.z_mm}, command)) return false;
    }
    here = next;
    paid = arrived;
  }
  if (!paid) no_place(paid.error(), here, move.line);
  return true;
}

void SimulatedMachine::arc(const Move& move, const Visit& visit) {
  Point here = as_read(move.from);
  for_each_chord(corrector_.firmware(), move, options_.flatness_mm, [&](Point end) {
    const Point next = as_read(end);
    return straight(std::exchange(here, next), next, move, visit);
  });
}

}  // namespace chaintrue::gcode
