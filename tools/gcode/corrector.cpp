// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Map and controller in series.
#include "tools/gcode/corrector.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/effects/catalogue.hpp"

namespace chaintrue::gcode {
namespace {

bool finite(model::BedPoint point) {
  return std::isfinite(point.x_mm) && std::isfinite(point.y_mm);
}

CorrectionFailure out_of_controllers_reach(const model::PoseFailure& why) {
  return CorrectionFailure(CorrectionReason::controller).because_of(model::sentence_of(why.reason));
}

}  // namespace

CorrectionFailure correction_failure(const grid::MapFailure& failure) {
  return CorrectionFailure(static_cast<CorrectionReason>(failure.reason)).because_of(failure.cause);
}

std::string_view sentence_of(CorrectionReason reason) {
  constexpr std::string_view kSentences[] = {
      "is outside the map", "cannot be reached by the machine",
      "cannot be found in the map, because the iteration did not converge",
      "cannot be reached by the controller's own kinematics"};
  return kSentences[static_cast<std::size_t>(reason)];
}

model::ChainLengths half_play_mm(const model::Machine& machine) {
  model::ChainLengths half;
  for (const model::effects::ActingEffect& one : model::effects::acting_effects(machine)) {
    if (!one.effect->by_direction) continue;
    const auto added_mm = [&one](double direction) {
      return one.effect->add({.direction = direction}, one.values).value;
    };
    const double width = 0.5 * (added_mm(1.0) - added_mm(-1.0));
    for (const model::Side side : model::kSides) {
      if (model::effects::acts_on(one.side, side)) half[side] += width;
    }
  }
  return half;
}

Corrected<model::BedPoint> Corrector::command(model::BedPoint target,
                                              model::ChainLengths half_play_mm,
                                              ChainDirections directions) const {
  auto lengths = map_.lengths(target);
  if (!lengths) return tl::unexpected(correction_failure(lengths.error()));
  lengths->left_mm += directions.left * half_play_mm.left_mm;
  lengths->right_mm += directions.right * half_play_mm.right_mm;
  const auto result = kinematics_.command(*lengths);
  if (!result) return tl::unexpected(out_of_controllers_reach(result.error()));
  if (!finite(*result)) return tl::unexpected(CorrectionReason::controller);
  return *result;
}

Corrected<model::ChainLengths> Corrector::paid_out(model::BedPoint command) const {
  return kinematics_.lengths(command).map_error(out_of_controllers_reach);
}

Corrected<model::BedPoint> Corrector::tool(model::BedPoint command) const {
  const auto lengths = paid_out(command);
  if (!lengths) return tl::unexpected(lengths.error());
  const auto point = map_.tool(*lengths);
  if (!point) return tl::unexpected(correction_failure(point.error()));
  if (!finite(*point)) return tl::unexpected(CorrectionReason::not_converged);
  return *point;
}

double Corrector::sampled_curvature_per_mm() const {
  constexpr int kColumns = 24;
  constexpr int kRows = 12;
  const interp::Rectangle& area = map_.domain();
  const double width = area.width();
  const double height = area.height();
  const double step = std::min(width, height) / (4.0 * kRows);
  constexpr double kHalf = 0.5 * std::numbers::sqrt2;
  constexpr double kDirections[][2] = {{1.0, 0.0}, {0.0, 1.0}, {kHalf, kHalf}, {kHalf, -kHalf}};
  double worst = 0.0;
  for (int i = 0; i < kColumns; ++i) {
    for (int k = 0; k < kRows; ++k) {
      const model::BedPoint middle{area.x_min + width * (i + 0.5) / kColumns,
                                   area.y_min + height * (k + 0.5) / kRows};
      const auto at_middle = command(middle);
      for (const auto& direction : kDirections) {
        const auto beside = [&](double way) {
          return command({middle.x_mm + way * direction[0], middle.y_mm + way * direction[1]});
        };
        const auto ahead = beside(step);
        const auto behind = beside(-step);
        if (!at_middle || !ahead || !behind) continue;
        const double x = ahead->x_mm - 2.0 * at_middle->x_mm + behind->x_mm;
        const double y = ahead->y_mm - 2.0 * at_middle->y_mm + behind->y_mm;
        worst = std::max(worst, std::hypot(x, y) / (step * step));
      }
    }
  }
  return worst;
}

namespace {

template <class Place>
interp::CheckedField::Function offsets_of(Place place) {
  return [place](double x, double y) -> std::optional<interp::CheckedField::Value> {
    const Corrected<model::BedPoint> found = place(model::BedPoint{x, y});
    if (!found) return std::nullopt;
    return interp::CheckedField::Value{found->x_mm - x, found->y_mm - y};
  };
}

}  // namespace

interp::CheckedField::Function offsets_of_command(const Corrector& corrector) {
  return offsets_of([&corrector](model::BedPoint target) { return corrector.command(target); });
}

interp::CheckedField::Function offsets_of_tool(const Corrector& corrector) {
  return offsets_of([&corrector](model::BedPoint command) { return corrector.tool(command); });
}

}  // namespace chaintrue::gcode
