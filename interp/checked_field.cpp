// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/checked_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

using Value = CheckedField::Value;

/// The places at which a cell is compared with the exact value.
constexpr double kLook[][2] = {{0.5, 0.5}, {0.25, 0.75}};
constexpr double kErrorSafety = 2.0;

std::uint64_t key(std::int64_t column, std::int64_t row) {
  return (static_cast<std::uint64_t>(column) << 32U) ^
         (static_cast<std::uint64_t>(row) & 0xFFFFFFFFU);
}

/// One component at the sixteen nodes around a cell, (x, y).
using Nodes = Matrix4d;

/// The largest length of what `of` makes of the components, at any place.
template <class Of>
double largest(const std::array<Nodes, 2>& nodes, Of of) {
  return std::sqrt((of(nodes[0]).cwiseAbs2() + of(nodes[1]).cwiseAbs2()).maxCoeff());
}

/// Largest second derivative along any direction, times the spacing squared.
double curvature_of(const std::array<Nodes, 2>& nodes) {
  const double along_x = largest(nodes, [](const Nodes& f) -> Eigen::Matrix<double, 2, 4> {
    return f.topRows<2>() - 2.0 * f.middleRows<2>(1) + f.bottomRows<2>();
  });
  const double along_y = largest(nodes, [](const Nodes& f) -> Eigen::Matrix<double, 4, 2> {
    return f.leftCols<2>() - 2.0 * f.middleCols<2>(1) + f.rightCols<2>();
  });
  const double mixed = largest(nodes, [](const Nodes& f) -> Eigen::Matrix3d {
    return f.topLeftCorner<3, 3>() - f.topRightCorner<3, 3>() - f.bottomLeftCorner<3, 3>() +
           f.bottomRightCorner<3, 3>();
  });
  return std::sqrt(along_x * along_x + along_y * along_y + 2.0 * mixed * mixed);
}

}  // namespace

CheckedField::CheckedField(Function function, const Options& options)
    : function_(std::move(function)), options_(options) {
  if (!(options.spacing > 0.0) || !(options.bound >= 0.0) || options.halvings < 0) {
    throw std::invalid_argument(fmt::format("a field of spacing {}, error {} and {} halvings",
                                            options.spacing, options.bound, options.halvings));
  }
  for (int k = 0; k <= options.halvings; ++k) {
    levels_.push_back({std::ldexp(options.spacing, -k), {}, {}});
  }
}

std::optional<Value> CheckedField::value(double x, double y) {
  const Found found = find(x, y);
  if (found.cell == nullptr) {
    ++left_;
    return std::nullopt;
  }
  return found.cell->polynomial.at(found.u, found.v, 1.0, 1.0).value;
}

double CheckedField::curvature(double x, double y) {
  const Found found = find(x, y);
  return found.cell != nullptr ? found.cell->curvature : std::numeric_limits<double>::infinity();
}

CheckedField::Found CheckedField::find(double x, double y) {
  for (Level& level : levels_) {
    const double u = x / level.spacing;
    const double v = y / level.spacing;
    // Farther out than any bed.
    constexpr double kMostCells = 1e6;
    if (!(std::fabs(u) < kMostCells && std::fabs(v) < kMostCells)) return {};
    const double left = std::floor(u);
    const double low = std::floor(v);
    const auto column = static_cast<std::int64_t>(left);
    const auto row = static_cast<std::int64_t>(low);
    const std::uint64_t wanted = key(column, row);
    if (level.last == nullptr || wanted != level.last_key) {
      level.last = &level.cells[wanted];
      level.last_key = wanted;
    }
    Cell& cell = *level.last;
    if (cell.state == State::fresh) {
      if (!may_fill()) return {};
      fill(level, cell, column, row);
    }
    if (cell.state == State::interpolates) return {&cell, u - left, v - low};
  }
  return {};
}

bool CheckedField::may_fill() const {
  return options_.left_first == 0 || (left_ >= options_.left_first && evaluated_ <= left_);
}

std::optional<Value> CheckedField::evaluate(double x, double y) {
  ++evaluated_;
  return function_(x, y);
}

std::optional<std::array<Nodes, 2>> CheckedField::nodes_around(Level& level, std::int64_t column,
                                                               std::int64_t row) {
  std::array<Nodes, 2> nodes;
  bool known = true;
  for (std::int64_t k = 0; k < 4; ++k) {
    for (std::int64_t i = 0; i < 4; ++i) {
      const std::int64_t x = column - 1 + i;
      const std::int64_t y = row - 1 + k;
      const auto [place, fresh] = level.nodes.try_emplace(key(x, y));
      if (fresh) {
        place->second = evaluate(static_cast<double>(x) * level.spacing,
                                 static_cast<double>(y) * level.spacing);
      }
      known = known && place->second;
      const Value value = place->second.value_or(Value{});
      for (std::size_t z = 0; z < 2; ++z) nodes[z](i, k) = value[z];
    }
  }
  return known ? std::optional(nodes) : std::nullopt;
}

void CheckedField::fill(Level& level, Cell& cell, std::int64_t column, std::int64_t row) {
  static const Matrix4d kToPowers = powers_through({-1.0, 0.0, 1.0, 2.0});
  cell.state = State::given_up;
  const auto nodes = nodes_around(level, column, row);
  if (!nodes) return;
  for (std::size_t z = 0; z < 2; ++z)
    cell.polynomial.set(z, kToPowers * (*nodes)[z] * kToPowers.transpose());
  cell.curvature = curvature_of(*nodes) / (level.spacing * level.spacing);
  for (const auto& look : kLook) {
    const auto exact = evaluate((static_cast<double>(column) + look[0]) * level.spacing,
                                (static_cast<double>(row) + look[1]) * level.spacing);
    if (!exact) return;
    const Value found = cell.polynomial.at(look[0], look[1], 1.0, 1.0).value;
    const double error = std::hypot(found[0] - (*exact)[0], found[1] - (*exact)[1]);
    if (!(kErrorSafety * error <= options_.bound)) return;
  }
  cell.state = State::interpolates;
}

}  // namespace chaintrue::interp
