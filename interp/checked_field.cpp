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

double size(const Value& value) { return std::hypot(value[0], value[1]); }

/// Powers of t of the cubic through values at -1, 0, 1 and 2.
std::array<double, 4> cubic(double a, double b, double c, double d) {
  return {b,
          c - a / 3.0 - b / 2.0 - d / 6.0,
          (a + c) / 2.0 - b,
          (d - a) / 6.0 + (b - c) / 2.0};
}

Value polynomial(const std::array<double, 32>& powers, double u, double v) {
  Value sum{};
  for (std::size_t i = 4; i-- > 0;) {
    const double* const row = powers.data() + 8 * i;
    for (std::size_t k = 0; k < 2; ++k) {
      sum[k] = sum[k] * u + (((row[6 + k] * v + row[4 + k]) * v + row[2 + k]) * v + row[k]);
    }
  }
  return sum;
}

}  // namespace

CheckedField::CheckedField(Function function, const Options& options)
    : function_(std::move(function)), options_(options) {
  if (!(options.spacing > 0.0) || !(options.bound >= 0.0) || options.halvings < 0) {
    throw std::invalid_argument(fmt::format("a field of spacing {}, error {} and {} halvings",
                                            options.spacing,
                                            options.bound,
                                            options.halvings));
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
  return polynomial(found.cell->powers, found.u, found.v);
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

std::optional<CheckedField::Nodes> CheckedField::nodes_around(Level& level,
                                                              std::int64_t column,
                                                              std::int64_t row) {
  Nodes nodes;
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
      nodes[static_cast<std::size_t>(4 * k + i)] = place->second.value_or(Value{});
    }
  }
  return known ? std::optional(nodes) : std::nullopt;
}

void CheckedField::fill(Level& level, Cell& cell, std::int64_t column, std::int64_t row) {
  cell.state = State::given_up;
  const auto nodes = nodes_around(level, column, row);
  if (!nodes) return;
  const auto at = [&](std::size_t i, std::size_t k) -> const Value& {
    return (*nodes)[4 * k + i];
  };
  for (std::size_t z = 0; z < 2; ++z) {
    std::array<std::array<double, 4>, 4> along;  // powers of u of each row
    for (std::size_t k = 0; k < 4; ++k) {
      along[k] = cubic(at(0, k)[z], at(1, k)[z], at(2, k)[z], at(3, k)[z]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const auto up = cubic(along[0][i], along[1][i], along[2][i], along[3][i]);
      for (std::size_t j = 0; j < 4; ++j) cell.powers[8 * i + 2 * j + z] = up[j];
    }
  }
  const auto difference = [](const Value& a, const Value& b) {
    return Value{a[0] - b[0], a[1] - b[1]};
  };
  double along = 0.0;
  double up = 0.0;
  double mixed = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto second = [&](const Value& before, const Value& after) {
        return size(difference(difference(after, at(i, k)), difference(at(i, k), before)));
      };
      if (i >= 1 && i <= 2) along = std::max(along, second(at(i - 1, k), at(i + 1, k)));
      if (k >= 1 && k <= 2) up = std::max(up, second(at(i, k - 1), at(i, k + 1)));
      if (i < 3 && k < 3) {
        mixed = std::max(mixed,
                         size(difference(difference(at(i + 1, k + 1), at(i, k + 1)),
                                         difference(at(i + 1, k), at(i, k)))));
      }
    }
  }
  cell.curvature = std::sqrt(along * along + up * up + 2.0 * mixed * mixed) /
                   (level.spacing * level.spacing);
  for (const auto& look : kLook) {
    const auto exact = evaluate((static_cast<double>(column) + look[0]) * level.spacing,
                                (static_cast<double>(row) + look[1]) * level.spacing);
    if (!exact) return;
    const double error = size(difference(polynomial(cell.powers, look[0], look[1]), *exact));
    if (!(kErrorSafety * error <= options_.bound)) return;
  }
  cell.state = State::interpolates;
}

}  // namespace chaintrue::interp
