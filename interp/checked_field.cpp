// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/checked_field.hpp"

#include <cmath>

#include "interp/require.hpp"

namespace chaintrue::interp {
namespace {

using Value = CheckedField::Value;

/// The places at which a cell is compared with the exact value.
constexpr double kLook[][2] = {{0.5, 0.5}, {0.25, 0.75}};
constexpr double kErrorSafety = 2.0;

/// Farther out than any bed.
constexpr std::int64_t kMostCells = 1'000'000;

/// A number of its own for each cell and node.
std::int64_t key(std::int64_t column, std::int64_t row) { return column * (4 * kMostCells) + row; }

/// The components at the sixteen nodes around a cell, (x, y).
using Nodes = std::array<Matrix4d, 2>;

/// Largest second derivative along any direction, times the spacing squared.
double curvature_of(const Nodes& nodes) {
  const Matrix4d all = Matrix4d::Identity();
  const Eigen::Matrix<double, 3, 4> once = all.bottomRows<3>() - all.topRows<3>();
  const Eigen::Matrix<double, 2, 4> twice = once.bottomRows<2>() - once.topRows<2>();
  // The square of the longest difference, at any place.
  const auto largest = [&](const auto& by_x, const auto& by_y) {
    return ((by_x * nodes[0] * by_y.transpose()).cwiseAbs2() +
            (by_x * nodes[1] * by_y.transpose()).cwiseAbs2())
        .maxCoeff();
  };
  return std::sqrt(largest(twice, all) + largest(all, twice) + 2.0 * largest(once, once));
}

}  // namespace

CheckedField::CheckedField(Function function, const Options& options)
    : function_(std::move(function)), options_(options) {
  require(options.spacing > 0.0 && options.bound >= 0.0 && options.halvings >= 0,
          "a field of spacing {}, error {} and {} halvings", options.spacing, options.bound,
          options.halvings);
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
  return found.cell != nullptr ? found.cell->curvature : HUGE_VAL;
}

CheckedField::Found CheckedField::find(double x, double y) {
  for (Level& level : levels_) {
    const double u = x / level.spacing;
    const double v = y / level.spacing;
    if (!(std::fabs(u) < kMostCells && std::fabs(v) < kMostCells)) return {};
    const double left = std::floor(u);
    const double low = std::floor(v);
    const auto column = static_cast<std::int64_t>(left);
    const auto row = static_cast<std::int64_t>(low);
    const std::int64_t wanted = key(column, row);
    if (level.last == nullptr || wanted != level.last_key) {
      level.last = &level.cells[wanted];
      level.last_key = wanted;
    }
    Cell& cell = *level.last;
    if (cell.state == State::fresh) {
      const bool is_worth_it =
          options_.left_first == 0 || (left_ >= options_.left_first && evaluated_ <= left_);
      if (!is_worth_it) return {};
      fill(level, cell, column, row);
    }
    if (cell.state == State::interpolates) return {&cell, u - left, v - low};
  }
  return {};
}

void CheckedField::fill(Level& level, Cell& cell, std::int64_t column, std::int64_t row) {
  static const Matrix4d kToPowers = powers_through({-1.0, 0.0, 1.0, 2.0});
  cell.state = State::given_up;
  // In spacings from the cell's lower left node.
  const auto exact_at = [&](double u, double v) {
    ++evaluated_;
    return function_((static_cast<double>(column) + u) * level.spacing,
                     (static_cast<double>(row) + v) * level.spacing);
  };
  Nodes nodes;
  bool known = true;
  for (int k = -1; k < 3; ++k) {
    for (int i = -1; i < 3; ++i) {
      const auto [place, fresh] = level.nodes.try_emplace(key(column + i, row + k));
      if (fresh) place->second = exact_at(i, k);
      known = known && place->second;
      for (std::size_t z = 0; known && z < 2; ++z) nodes[z](i + 1, k + 1) = (*place->second)[z];
    }
  }
  if (!known) return;
  for (std::size_t z = 0; z < 2; ++z)
    cell.polynomial.set(z, kToPowers * nodes[z] * kToPowers.transpose());
  cell.curvature = curvature_of(nodes) / (level.spacing * level.spacing);
  for (const auto& [u, v] : kLook) {
    const auto exact = exact_at(u, v);
    if (!exact) return;
    const Value found = cell.polynomial.at(u, v, 1.0, 1.0).value;
    const double error = std::hypot(found[0] - (*exact)[0], found[1] - (*exact)[1]);
    if (!(kErrorSafety * error <= options_.bound)) return;
  }
  cell.state = State::interpolates;
}

}  // namespace chaintrue::interp
