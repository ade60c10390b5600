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
};

/// Free directions of all sheets.
struct FreeDirections {
  ColumnSet columns;   ///< x_f
  VectorXd constant;   ///< a
  MatrixXd following;  ///< F by all unknowns, nothing by x_f

  /// Adds (1) of one observation. \returns its marks with the free directions corrected and all else
  /// unchanged.
  std::vector<MarkPoint> add(const PlacesOnSheet& places) {
    std::vector<MarkPoint> marks = places.marks;
    if (places.free_columns.empty()) return marks;
    const MatrixXd motion = places.whole_motion()(places.free_rows, Eigen::all);
    const MatrixXd by_free = places.by_unknown(Eigen::all, places.free_columns);
    const MatrixXd inverse = linear::inverse(linear::product(motion, by_free));
    const VectorXd alongside = places.alongside();
    const auto needed = [&](const VectorXd& off) -> VectorXd {
      return -linear::product(inverse, linear::product(motion, off));
    };
    const Index before = constant.size();
    const Index more = std::ssize(places.free_columns);
    append_all(columns, places.free_columns);
    constant.conservativeResize(before + more);
    constant.tail(more) = needed(alongside - places.moved);
    following.conservativeResize(before + more, places.by_unknown.cols());
    following.bottomRows(more) =
        -linear::product(inverse, linear::product(motion, places.by_unknown));
    following.bottomRows(more)(Eigen::all, places.free_columns).setZero();
    const VectorXd shift = linear::product(by_free, needed(alongside));
    for (const auto i : each_index(marks)) {
      marks[i].x_mm += shift[2 * as_index(i)];
      marks[i].y_mm += shift[2 * as_index(i) + 1];
    }
    return marks;
  }
};

}  // namespace chaintrue::grid::estimation
