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

#include <vector>

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::estimation {

/// The places of one observation.
struct PlacesOnSheet {
  std::vector<MarkPoint> commanded;
  std::vector<MarkPoint> marks;
  MatrixXd by_unknown;  ///< G
  VectorXd moved;       ///< g
  ColumnSet free_columns;
  Rows free_rows;  ///< of M, in the same order

  /// M
  MatrixXd whole_motion() const {
    const auto count = std::ssize(commanded);
    Vector2d middle = Vector2d::Zero();
    for (const MarkPoint& c : commanded) middle += vector_of(c) / as_double(count);
    MatrixXd motion = MatrixXd::Zero(3, 2 * count);
    double squares = 0.0;
    for (const Index i : each_below(count)) {
      const Vector2d at = vector_of(commanded[as_size(i)]) - middle;
      motion(0, 2 * i) = motion(1, 2 * i + 1) = 1.0 / as_double(count);
      motion(2, 2 * i) = -at.y();
      motion(2, 2 * i + 1) = at.x();
      squares += at.squaredNorm();
    }
    motion.row(2) /= squares;
    return motion;
  }

  /// m - c
  VectorXd alongside() const {
    VectorXd all(2 * std::ssize(marks));
    for (const auto i : each_index(marks)) {
      all.segment<2>(2 * as_index(i)) = difference(marks[i], commanded[i]);
    }
    return all;
  }

  /// (1)
  struct Following {
    VectorXd constant;    ///< a
    MatrixXd by_unknown;  ///< F by all unknowns, nothing by x_f
  };
  /// Corrects the marks in the free directions.
  Following lay() {
    const MatrixXd motion = whole_motion()(free_rows, Eigen::all);
    const MatrixXd by_free = by_unknown(Eigen::all, free_columns);
    const MatrixXd needed =
        -linear::product(linear::inverse(linear::product(motion, by_free)), motion);
    const VectorXd off = alongside();
    Following following{needed * (off - moved), linear::product(needed, by_unknown)};
    following.by_unknown(Eigen::all, free_columns).setZero();
    const VectorXd shift = by_free * (needed * off);
    for (const auto i : each_index(marks)) {
      marks[i].x_mm += shift[2 * as_index(i)];
      marks[i].y_mm += shift[2 * as_index(i) + 1];
    }
    return following;
  }
};

}  // namespace chaintrue::grid::estimation
