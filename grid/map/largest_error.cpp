// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/largest_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include "grid/containers.hpp"
#include "grid/map/map_parts.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "grid/random.hpp"
#include "grid/raster.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

/// The quantile's level is then known to 1.1 %: sqrt(0.95 * 0.05 / 400).
constexpr Index kDraws = 400;
constexpr double kLevel = 0.95;

/// Standard normal draws of z, one in each row.
MatrixXd drawn(Index directions) {
  constexpr std::uint64_t kSeed = 95;
  Random random(kSeed);
  MatrixXd draws(directions, kDraws);
  for (double& z : draws.reshaped()) z = random.normal();
  return draws.transpose();
}

ModelSurface& surface_of(MapContents& contents) {
  auto* surface = std::get_if<ModelSurface>(&contents.surface);
  if (surface == nullptr) throw precondition("a larger error of a map without a machine");
  return *surface;
}

/// Differences of the lengths at one place, a row for each chain; empty if a map does not answer.
Matrix2Xd differences_at(const std::vector<MapDifference>& differences, MarkPoint mark) {
  Matrix2Xd at(2, std::ssize(differences));
  for (const auto k : each_index(differences)) {
    const auto from = differences[k].from.lengths(mark);
    const auto to = differences[k].to.lengths(mark);
    if (!from || !to) return Matrix2Xd(2, 0);
    at.col(as_index(k)) = differences[k].share * difference(to->lengths, from->lengths);
  }
  return at;
}

/// Spline coefficients of the differences, left and right one below the other, a column each.
MatrixXd on_splines(const interp::BsplineBasis& basis,
                    const std::vector<MapDifference>& differences) {
  // Two places for each function of an axis determine the splines; the ridge holds those that no place is near.
  constexpr int kPerFunction = 2;
  constexpr double kRidge = 1e-6;
  const std::vector<MarkPoint> marks =
      raster(basis.rectangle(), kPerFunction * as_int(basis.columns_x()),
             kPerFunction * as_int(basis.columns_y()), RasterOf::nodes);
  const auto count = std::ssize(differences);
  MatrixXd design(std::ssize(marks), basis.size()), response(std::ssize(marks), 2 * count);
  Index used = 0;
  for (const MarkPoint& mark : marks) {
    const Matrix2Xd at = differences_at(differences, mark);
    if (at.cols() != count) continue;
    design.row(used) = basis.row(mark.x_mm, mark.y_mm);
    response.row(used++) = at.reshaped().transpose();
  }
  MatrixXd normal = linear::gram(design.topRows(used));
  normal.diagonal().array() += kRidge;
  const MatrixXd right = linear::inner(design.topRows(used), response.topRows(used));
  return linear::Cholesky(std::move(normal)).solve(right).reshaped(2 * basis.size(), count);
}

}  // namespace

void LargestError::add(const Vector2d& expected_mm, const Matrix2Xd& spread_mm) {
  if (largest_mm2_.size() == 0) {
    draws_ = drawn(spread_mm.cols());
    largest_mm2_ = VectorXd::Zero(kDraws);
  }
  if (spread_mm.cols() != draws_.cols())
    throw precondition("a spread of {} columns after one of {}", spread_mm.cols(), draws_.cols());
  MatrixXd errors = linear::product(draws_, linear::transposed(spread_mm));
  errors.rowwise() += expected_mm.transpose();
  largest_mm2_ = largest_mm2_.cwiseMax(errors.rowwise().squaredNorm());
}

double LargestError::bound_mm() const {
  if (largest_mm2_.size() == 0) return 0.0;
  VectorXd sorted = largest_mm2_;
  const auto at = static_cast<Index>(kLevel * as_double(kDraws));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return std::sqrt(sorted[at]);
}

CompensationMap with_larger_error(const CompensationMap& map, double factor) {
  if (!(factor >= 1.0)) throw precondition("an error {} times as large", factor);
  MapContents contents = map.contents();
  surface_of(contents).covariance_factor *= factor;
  return with_expected_error(std::move(contents));
}

CompensationMap with_differences(const CompensationMap& map,
                                 const std::vector<MapDifference>& differences) {
  MapContents contents = map.contents();
  ModelSurface& surface = surface_of(contents);
  const MatrixXd splines = on_splines(surface.residual.basis, differences);
  MatrixXd directions = MatrixXd::Zero(surface.columns.total(), splines.cols());
  directions.middleRows(surface.columns.spline(Side::left), splines.rows()) = splines;
  surface.covariance_factor =
      lower_factor(linear::outer(surface.covariance_factor) + linear::outer(directions));
  return with_expected_error(std::move(contents));
}

}  // namespace chaintrue::grid
