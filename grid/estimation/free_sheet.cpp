// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header.
#include "grid/estimation/free_sheet.hpp"

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {
namespace {

using model::MarkPoint;

/// M
Eigen::MatrixXd whole_motion(const std::vector<MarkPoint>& commanded) {
  const auto count = std::ssize(commanded);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const MarkPoint& c : commanded) middle += Eigen::Vector2d(c.x_mm, c.y_mm) / as_double(count);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(3, 2 * count);
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const MarkPoint c = commanded[as_size(i)];
    const double x = c.x_mm - middle.x();
    const double y = c.y_mm - middle.y();
    motion(0, 2 * i) = motion(1, 2 * i + 1) = 1.0 / as_double(count);
    motion(2, 2 * i) = -y;
    motion(2, 2 * i + 1) = x;
    squares += x * x + y * y;
  }
  motion.row(2) /= squares;
  return motion;
}

/// m - c
Eigen::VectorXd alongside(const PlacesOnSheet& places) {
  Eigen::VectorXd all(2 * std::ssize(places.marks));
  for (std::size_t i = 0; i < places.marks.size(); ++i) {
    const auto at = 2 * as_index(i);
    all[at] = places.marks[i].x_mm - places.commanded[i].x_mm;
    all[at + 1] = places.marks[i].y_mm - places.commanded[i].y_mm;
  }
  return all;
}

}  // namespace

void add_free_directions(const PlacesOnSheet& places, FreeDirections& free) {
  if (places.free_columns.empty()) return;
  const Eigen::MatrixXd motion = whole_motion(places.commanded)(places.free_rows, Eigen::all);
  const Eigen::MatrixXd by_unknown = linear::product(motion, places.by_unknown);
  const Eigen::MatrixXd inverse = linear::inverse(by_unknown(Eigen::all, places.free_columns));
  Eigen::MatrixXd following = -linear::product(inverse, by_unknown);
  following(Eigen::all, places.free_columns).setZero();
  const Eigen::Index before = free.constant.size();
  const Eigen::Index more = following.rows();
  append_all(free.columns, places.free_columns);
  free.constant.conservativeResize(before + more);
  free.constant.tail(more) =
      -linear::product(inverse, linear::product(motion, alongside(places) - places.moved));
  free.following.conservativeResize(before + more, following.cols());
  free.following.bottomRows(more) = following;
}

std::vector<MarkPoint> placed_rigidly(const PlacesOnSheet& places) {
  std::vector<MarkPoint> marks = places.marks;
  if (places.free_columns.empty()) return marks;
  const Eigen::MatrixXd motion = whole_motion(places.commanded)(places.free_rows, Eigen::all);
  const Eigen::MatrixXd by_free = places.by_unknown(Eigen::all, places.free_columns);
  const Eigen::MatrixXd inverse = linear::inverse(linear::product(motion, by_free));
  const Eigen::VectorXd shift = -linear::product(
      by_free, linear::product(inverse, linear::product(motion, alongside(places))));
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto at = 2 * as_index(i);
    marks[i].x_mm += shift[at];
    marks[i].y_mm += shift[at + 1];
  }
  return marks;
}

}  // namespace chaintrue::grid::estimation
