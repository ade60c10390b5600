// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/reading_shifts.hpp"

#include <algorithm>
#include <cmath>

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {
namespace {

/// Share of a direction's square below which it is rounding.
constexpr double kNoDirection = 1e-12;

}  // namespace

double normal_deviate(double t, double dof) {
  return (8.0 * dof + 1.0) / (8.0 * dof + 3.0) * std::sqrt(dof * std::log1p(t * t / dof));
}

double deleted_deviate(double r, double kept, double s2, double dof) {
  const double left = std::max(s2 * dof - r * r / kept, 1e-12 * s2) / (dof - 1.0);
  return normal_deviate(r / std::sqrt(left * kept), dof - 1.0);
}

MatrixXd without_readings(const SystemUnit& unit, const Rows& rejected) {
  if (rejected.empty()) return MatrixXd::Identity(unit.rows, unit.rows);
  return linear::range_of(unit.by_reading(Eigen::all, rejected)).rest;
}

ReadingShift shift_of(const FittedRows& rows, const SystemUnit& unit, const Rows& rejected,
                      Index reading) {
  Rows others = rejected;
  const bool counts = std::erase(others, reading) == 0;
  const MatrixXd basis = without_readings(unit, others);
  const VectorXd d = basis.transpose() * unit.by_reading.col(reading);
  const double own = d.squaredNorm();
  ReadingShift shift;
  if (own <= kNoDirection * unit.by_reading.col(reading).squaredNorm()) return shift;
  const VectorXd along = basis * d;
  const double r = along.dot(rows.residual.segment(unit.first_row, unit.rows));
  const VectorXd by_unknown = rows.design.middleRows(unit.first_row, unit.rows).transpose() * along;
  const double spread = by_unknown.dot(rows.fit.covariance * by_unknown);
  const double s2 = rows.fit.sigma2;
  const double n = rows.dof;
  if (!counts) {
    shift.residual_mm = r / own;
    if (n >= 1.0) shift.sigmas = normal_deviate(r / std::sqrt(s2 * own + spread), n);
    return shift;
  }
  const double kept = own - spread / s2;
  // The share refers to a whole reading: its effect on the rows is reduced by the estimate of its
  // place.
  const double whole = unit.whitening.row(0).squaredNorm();
  if (kept < kOwnWord * whole || n < 2.0) return shift;
  shift.residual_mm = r / kept;
  shift.sigmas = deleted_deviate(r, kept, s2, n);
  return shift;
}

}  // namespace chaintrue::grid::estimation
