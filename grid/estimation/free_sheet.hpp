// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A sheet in the directions in which the readings do not depend on its placement: its frame is
/// defined so that the places, as a whole, are where they were commanded. This carries no
/// information about the machine. Private to grid/estimation.
///
/// Notation
///   m_i  marks of the places
///   c_i  where they were commanded
///   G    d(all m)/d(unknowns)
///   g    the displacement of the marks by the current unknowns
///   M    3 x 2N, the displacement of all places from their commands: shift x, shift y, turn (small)
///   x_f  the free directions, which follow from the other unknowns x_r:
///
///   M (m - c + G x - g) = 0   =>   x_f = a + F x_r,
///   F = -(M G_f)^-1 M G_r,   a = -(M G_f)^-1 M (m - c - g)                                  (1)
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/coordinates.hpp"

namespace chaintrue::grid::estimation {

/// Free directions of all sheets.
struct FreeDirections {
  std::vector<Eigen::Index> columns;  ///< x_f
  Eigen::VectorXd constant;           ///< a
  Eigen::MatrixXd following;          ///< F by all unknowns, nothing by x_f
};

/// The places of one observation.
struct PlacesOnSheet {
  std::vector<model::MarkPoint> commanded;
  std::vector<model::MarkPoint> marks;
  Eigen::MatrixXd by_unknown;  ///< G
  Eigen::VectorXd moved;       ///< g
  std::vector<Eigen::Index> free_columns;
  std::vector<Eigen::Index> free_rows;  ///< of M, in the same order
};

/// Adds (1) of one observation.
void add_free_directions(const PlacesOnSheet& places, FreeDirections& free);

/// The marks with the free directions corrected and all else unchanged.
[[nodiscard]] std::vector<model::MarkPoint> placed_rigidly(const PlacesOnSheet& places);

}  // namespace chaintrue::grid::estimation
