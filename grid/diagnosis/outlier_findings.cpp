// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/linear_algebra.hpp"
#include "grid/observation/drawn_measures.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// What all others together know of a unit of one row leaves it as far off as this.
Outlier outlying_distance(const Analysis& a, const NumberedUnit& own, const SystemUnit& unit) {
  const Eigen::Index row = unit.first_row;
  // All that the others know of its holes is in the prediction, with what they leave open.
  const Eigen::VectorXd by_setting = a.system.by_setting.row(row);
  const double variance =
      a.estimate.noise_square +
      by_setting.dot(linear::product(a.estimate.setting_covariance, by_setting));
  const double off = a.estimate.left_given_discrepancy(row);
  Outlier outlier;
  outlier.of = Observations::distances;
  outlier.index = own.index;
  outlier.residual_mm = off * unit.sigma();
  outlier.distance = std::abs(off) / std::sqrt(variance);
  return outlier;
}

Outlier outlying_point(const Analysis& a, const NumberedUnit& own, const SystemUnit& unit) {
  const Eigen::Vector2d chains = unit.unwhitened(a.estimate.left_given_discrepancy);
  Outlier outlier;
  outlier.index = own.index;
  // Where the tool would have to be, minus its mark.
  outlier.shift_mm = -tool_shift(a.system.places[unit.places.front().place], chains);
  const Eigen::Vector2d whitened = unit.whitening * chains;
  outlier.distance = whitened.norm() / std::sqrt(a.estimate.noise_square);
  return outlier;
}

}  // namespace

std::vector<Outlier> outliers_found(const Analysis& a) {
  std::vector<bool> outliers = marginalised_system(a).outliers;
  // A link counted wrong is an outlier with a name.
  reject_slips(a, outliers);
  std::vector<Outlier> result;
  for (std::size_t u = 0; u < outliers.size(); ++u) {
    if (!outliers[u]) continue;
    const SystemUnit& unit = a.system.units[u];
    result.push_back(unit.reads_chains ? outlying_point(a, a.session.units[u], unit)
                                       : outlying_distance(a, a.session.units[u], unit));
    const ObservationPart& part = a.session.parts[a.session.units[u].part];
    if (&part.observation->kind() == &observation::drawn_measures)
      result.back().of = Observations::drawing;
  }
  sort(result, [](const Outlier& x, const Outlier& y) {
    return std::pair(x.of, x.index) < std::pair(y.of, y.index);
  });
  return result;
}

}  // namespace chaintrue::grid::diagnosis
