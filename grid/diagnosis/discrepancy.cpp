// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

double bell(double square) { return std::exp(-0.5 * square); }

/// Density of a half-Cauchy over the logarithm of the strength, but for a constant.
double cauchy_weight(double strength) {
  return strength / (1.0 + std::pow(strength / kDiscrepancyScale, 2));
}

}  // namespace

double log_share_of_discrepancy(int index) {
  double sum = 0.0;
  for (const double strength : kDiscrepancyStrengths) sum += cauchy_weight(strength);
  const auto strengths = static_cast<int>(std::size(kDiscrepancyStrengths));
  return std::log(cauchy_weight(kDiscrepancyStrengths[index % strengths]) / sum) -
         std::log(static_cast<double>(std::size(kDiscrepancyKernels)));
}

Eigen::Matrix2d discrepancy_block(const DiscrepancyKernel& kernel,
                                  const DiscrepancyPlace& a,
                                  const DiscrepancyPlace& b) {
  const double dx = std::pow((a.mark.x_mm - b.mark.x_mm) / kernel.length_mm, 2);
  const double dy = std::pow((a.mark.y_mm - b.mark.y_mm) / kernel.length_mm, 2);
  if (kernel.kind == DiscrepancyKind::chains) return bell(dx + dy) * Eigen::Matrix2d::Identity();
  return 0.5 * (bell(dx) + bell(dy)) * a.by_mark * b.by_mark.transpose();
}

Eigen::Matrix2d discrepancy_between(const LinearisedSystem& system,
                                    const DiscrepancyKernel& kernel,
                                    const SystemUnit& a,
                                    const SystemUnit& b) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const SeenPlace& i : a.places) {
    for (const SeenPlace& j : b.places) {
      sum += i.by_chain *
             discrepancy_block(kernel,
                               discrepancy_place(system.places[i.place]),
                               discrepancy_place(system.places[j.place])) *
             j.by_chain.transpose();
    }
  }
  return sum;
}

DiscrepancyPlace discrepancy_place(const SystemPlace& place) { return {place.mark, place.by_mark}; }

Eigen::MatrixXd discrepancy_covariance(const LinearisedSystem& system,
                                       const std::vector<Eigen::Index>& kept,
                                       const DiscrepancyKernel& kernel) {
  const auto units = units_in(system, kept);
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t a = 0; a < units.size(); ++a) {
    const SystemUnit& own = system.units[units[a].second];
    for (std::size_t b = 0; b <= a; ++b) {
      const SystemUnit& other = system.units[units[b].second];
      const Eigen::Matrix2d block = discrepancy_between(system, kernel, own, other);
      const Eigen::Index row = units[a].first;
      const Eigen::Index column = units[b].first;
      c.block(row, column, own.rows, other.rows) = block.topLeftCorner(own.rows, other.rows);
      c.block(column, row, other.rows, own.rows) =
          block.transpose().topLeftCorner(other.rows, own.rows);
    }
  }
  return c;
}

}  // namespace chaintrue::grid::diagnosis
