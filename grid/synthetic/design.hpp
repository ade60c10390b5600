// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The positions of the marks and the order in which they are visited.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "grid/random.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::synthetic {

enum class DesignKind {
  regular,    ///< even spacing
  chebyshev,  ///< Chebyshev-Lobatto spacing, denser towards the edges
  random,     ///< uniformly distributed
  given,      ///< a list, such as a planner's
};

/// The part of the bed that was measured.
enum class Region { whole, left, right, top, bottom };

struct Design {
  DesignKind kind = DesignKind::regular;
  int columns = 7;
  int rows = 4;
  /// How many marks a random design has.
  int points = 28;
  /// From the bed's edge to the outermost marks; absent: the bed is rounded down to whole 100 mm.
  std::optional<double> margin_mm;
  /// Leaves the four outermost corners out (clamps, missing sheet).
  bool without_corners = false;
  Region region = Region::whole;
  /// The marks of DesignKind::given, in any order.
  std::vector<MarkPoint> given;
};

/// A mark and its place in the pattern; scattered marks are assigned to a few even bands.
struct Mark {
  MarkPoint place;
  int column = 0;
  int row = 0;
};

/// The marks, row by row from the bottom left. Empty if the region leaves none.
/// \throws std::invalid_argument for fewer than 2 columns or rows, fewer than 1 random point, or a
/// margin that leaves no bed.
std::vector<Mark> marks(const Bed& bed, const Design& design, Random& random);

enum class VisitingOrder { rows, columns, serpentine_rows, serpentine_columns, random };

/// Puts the marks into the order in which they are visited. Rows go from the bottom up, columns
/// from the left; serpentine alternates the direction.
void put_in_order(std::vector<Mark>& marks, VisitingOrder order, Random& random);

/// Identifiers on the command line and in files; empty if unknown.
std::optional<DesignKind> design_kind(std::string_view word);
std::optional<Region> region(std::string_view word);
std::optional<VisitingOrder> visiting_order(std::string_view word);

}  // namespace chaintrue::grid::synthetic
