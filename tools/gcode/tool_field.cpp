// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A lazily filled lattice.
#include "tools/gcode/tool_field.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

/// The points at which a cell is compared with the exact value.
constexpr double kLook[][2] = {{0.5, 0.5}, {0.25, 0.75}};
constexpr double kErrorSafety = 2.0;
/// Used if the curvature is unknown.
constexpr double kCarefulStepMm = 1.0;
constexpr double kLongestStepMm = 24.0;

std::uint64_t key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(column) << 32U) ^
         (static_cast<std::uint64_t>(row) & 0xFFFFFFFFU);
}

/// Commands far outside any bed are not cached.
bool near(model::BedPoint command) {
  constexpr double kFarMm = 1e5;
  return std::fabs(command.x_mm) < kFarMm && std::fabs(command.y_mm) < kFarMm;
}

/// Weights of the nodes at -1, 0, 1 and 2.
std::array<double, 4> weights(double t) {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0,
          (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
          -(t + 1.0) * t * (t - 2.0) / 2.0,
          (t + 1.0) * t * (t - 1.0) / 6.0};
}

}  // namespace

ToolField::Node ToolField::node(std::int64_t column, std::int64_t row) {
  const auto [place, fresh] = nodes_.try_emplace(key(column, row));
  if (fresh) {
    const model::BedPoint command{static_cast<double>(column) * kSpacingMm,
                                  static_cast<double>(row) * kSpacingMm};
    if (const auto tool = corrector_.tool(command)) {
      place->second = {tool->x_mm - command.x_mm, tool->y_mm - command.y_mm, true};
    }
  }
  return place->second;
}

model::BedPoint ToolField::interpolated(const Cell& cell, double u, double v) {
  const auto across = weights(u);
  const auto up = weights(v);
  model::BedPoint sum;
  for (std::size_t k = 0; k < 4; ++k) {
    double dx = 0.0;
    double dy = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      dx += across[i] * cell.nodes[4 * k + i].dx_mm;
      dy += across[i] * cell.nodes[4 * k + i].dy_mm;
    }
    sum.x_mm += up[k] * dx;
    sum.y_mm += up[k] * dy;
  }
  return sum;
}

void ToolField::fill(Cell& cell, std::int64_t column, std::int64_t row) {
  bool known = true;
  for (std::int64_t k = 0; k < 4; ++k) {
    for (std::int64_t i = 0; i < 4; ++i) {
      const Node one = node(column - 1 + i, row - 1 + k);
      known = known && one.known;
      cell.nodes[static_cast<std::size_t>(4 * k + i)] = one;
    }
  }
  if (!known) return;
  const auto at = [&](std::size_t i, std::size_t k) -> const Node& {
    return cell.nodes[4 * k + i];
  };
  const auto second = [](const Node& a, const Node& b, const Node& c) {
    return std::hypot(a.dx_mm - 2.0 * b.dx_mm + c.dx_mm, a.dy_mm - 2.0 * b.dy_mm + c.dy_mm);
  };
  double along = 0.0;
  double up = 0.0;
  double mixed = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (i >= 1 && i <= 2) along = std::max(along, second(at(i - 1, k), at(i, k), at(i + 1, k)));
      if (k >= 1 && k <= 2) up = std::max(up, second(at(i, k - 1), at(i, k), at(i, k + 1)));
      if (i >= 3 || k >= 3) continue;
      const double dx =
          at(i + 1, k + 1).dx_mm - at(i, k + 1).dx_mm - at(i + 1, k).dx_mm + at(i, k).dx_mm;
      const double dy =
          at(i + 1, k + 1).dy_mm - at(i, k + 1).dy_mm - at(i + 1, k).dy_mm + at(i, k).dy_mm;
      mixed = std::max(mixed, std::hypot(dx, dy));
    }
  }
  cell.curvature_per_mm = kCurvatureSafety *
                          std::sqrt(along * along + up * up + 2.0 * mixed * mixed) /
                          (kSpacingMm * kSpacingMm);
  for (const auto& look : kLook) {
    const model::BedPoint command{(static_cast<double>(column) + look[0]) * kSpacingMm,
                                  (static_cast<double>(row) + look[1]) * kSpacingMm};
    const auto exact = corrector_.tool(command);
    if (!exact) return;
    const model::BedPoint guess = interpolated(cell, look[0], look[1]);
    const double error = std::hypot(command.x_mm + guess.x_mm - exact->x_mm,
                                    command.y_mm + guess.y_mm - exact->y_mm);
    if (!(kErrorSafety * error <= bound_mm_)) return;
  }
  cell.interpolates = true;
}

const ToolField::Cell& ToolField::cell(model::BedPoint command) {
  const auto column = static_cast<std::int64_t>(std::floor(command.x_mm / kSpacingMm));
  const auto row = static_cast<std::int64_t>(std::floor(command.y_mm / kSpacingMm));
  const std::uint64_t wanted = key(column, row);
  if (last_ != nullptr && wanted == last_key_) return *last_;
  const auto [place, fresh] = cells_.try_emplace(wanted);
  if (fresh) fill(place->second, column, row);
  last_key_ = wanted;
  last_ = &place->second;
  return place->second;
}

tl::expected<model::BedPoint, CorrectionFailure> ToolField::tool(model::BedPoint command) {
  if (!near(command)) return corrector_.tool(command);
  const Cell& found = cell(command);
  if (!found.interpolates) return corrector_.tool(command);
  const double x = command.x_mm / kSpacingMm;
  const double y = command.y_mm / kSpacingMm;
  const model::BedPoint offset = interpolated(found, x - std::floor(x), y - std::floor(y));
  return model::BedPoint{command.x_mm + offset.x_mm, command.y_mm + offset.y_mm};
}

double ToolField::straight_mm(model::BedPoint command, double flatness_mm) {
  if (!near(command)) return kCarefulStepMm;
  const Cell& found = cell(command);
  if (!found.interpolates) return kCarefulStepMm;
  return std::min(kLongestStepMm,
                  std::sqrt(8.0 * flatness_mm / std::max(found.curvature_per_mm, 1e-12)));
}

}  // namespace chaintrue::gcode
