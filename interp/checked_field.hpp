// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// An expensive function R2 -> R2, tabulated on demand with a checked error.
///
/// Square cells of a lattice are filled as they are needed. A cell interpolates the function at the
/// sixteen nodes around it (cubic Lagrange in x and in y, continuous from cell to cell; the error is
/// 0.023 h^4 times the fourth derivatives, h the spacing) once it has been compared with the exact
/// value at two places inside: twice the larger difference must be within the bound. A cell that
/// misses it is divided into four, up to a limit, and then abandoned: the caller computes such
/// places. Cells next to a place without a value are treated alike.
///
/// Error: below the bound at the checked places. Memory: 400 bytes a cell, 5 MB for a sheet in cells
/// of 16 mm. Deterministic: the same calls in the same order give the same bits. Not thread safe.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "interp/pair_polynomial.hpp"

namespace chaintrue::interp {

///     CheckedField field(slow, {16.0, 1e-4});
///     const auto z = field.value(x, y);
///     use(z ? *z : slow(x, y));
class CheckedField {
 public:
  using Value = std::array<double, 2>;
  /// Empty if there is no value.
  using Function = std::function<std::optional<Value>(double x, double y)>;
  struct Options {
    double spacing = 1.0;  ///< of the lattice, > 0
    double bound = 0.0;    ///< of the error's absolute value
    int halvings = 0;      ///< of the spacing, in cells that miss the bound
    /// 0: a cell is filled at its first use. Otherwise this many places are left to the caller
    /// first; after that, cells cost no more evaluations than the caller has made.
    std::int64_t left_first = 0;
  };

  CheckedField(Function function, const Options& options);

  /// The interpolated value; empty if the caller computes it.
  std::optional<Value> value(double x, double y);
  /// Largest second derivative along any direction by second differences of the cell's nodes;
  /// infinite where `value` is empty.
  double curvature(double x, double y);

 private:
  enum class State { fresh, interpolates, given_up };
  struct Cell {
    State state = State::fresh;
    double curvature = 0.0;
    PairPolynomial polynomial;
  };
  struct Level {
    double spacing;
    std::unordered_map<std::int64_t, std::optional<Value>> nodes;
    std::unordered_map<std::int64_t, Cell> cells;
    std::int64_t last_key = 0;
    Cell* last = nullptr;
  };
  /// A cell that interpolates, and the place in it from 0 to 1.
  struct Found {
    const Cell* cell = nullptr;
    double u = 0.0;
    double v = 0.0;
  };

  Found find(double x, double y);
  void fill(Level& level, Cell& cell, std::int64_t column, std::int64_t row);

  Function function_;
  Options options_;
  std::vector<Level> levels_;
  std::int64_t left_ = 0;       // places left to the caller
  std::int64_t evaluated_ = 0;  // for the cells
};

}  // namespace chaintrue::interp
