// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/expected_improvement.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/other_places.hpp"
#include "grid/raster.hpp"
#include "interp/linear_algebra.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

bool hangs_on_visits(const Analysis& a) {
  return any_of(a.decision.regressors, [&](int k) {
    const Regressor& d = a.system.regressor(k);
    return !d.slip && model::effects::depends_on_visit(*d.cause.effect);
  });
}

/// Places over the rectangle that the marks span, 100 mm apart on a whole bed: waves of a sprocket's
/// turn included.
ObservationSet over_the_area(const Analysis& a) {
  return session_at(a, raster(marked_area(a.session), 25, 13, RasterOf::cells));
}

/// Expected drop and remaining uncertainty of the error over some units.
ExpectedImprovement over_units(const RegressorSystem& there,
                        const Eigen::VectorXd& moved,
                        const Eigen::MatrixXd& design,
                        const Eigen::MatrixXd& covariance) {
  double drop = 0.0;
  double doubt = 0.0;
  for (const SystemUnit& unit : there.units) {
    const Eigen::MatrixXd by_unknown = design.middleRows(unit.first_row, unit.rows);
    if (unit.reads_chains) {
      const Eigen::Matrix2d to_tool =
          there.places[unit.places.front().place].state.by_mark.inverse() * unit.whitening.inverse();
      const Eigen::MatrixXd tool = to_tool * by_unknown;
      drop += (to_tool * moved.segment<2>(unit.first_row)).squaredNorm();
      doubt += linear::carried(tool, covariance).trace();
    } else {
      drop += unit.unwhitened(moved).squaredNorm();
      doubt += std::pow(unit.sigma(), 2) *
               by_unknown.row(0).dot(covariance * by_unknown.row(0).transpose());
    }
  }
  const auto count = as_double(there.units.size());
  return {drop / count, drop > 0.0 ? drop / (drop + doubt) : 0.0};
}

/// Over the distances that were read, because only they have positions.
ExpectedImprovement improvement_of_distances(const Analysis& a) {
  const Estimate plain = estimate_of(a, {});
  const Estimate named = estimate_of(a, a.decision.regressors);
  const Eigen::VectorXd moved =
      left_of_machine(a.system, plain, plain.left) - left_of_machine(a.system, named, named.left);
  const Eigen::Index settings = a.system.by_setting.cols() - a.system.nuisances;
  const auto free = std::ssize(named.free);
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(moved.size(), named.covariance.rows());
  design.leftCols(settings) = a.system.by_setting.leftCols(settings);
  for (Eigen::Index k = 0; k < free; ++k) {
    design.col(a.system.by_setting.cols() + k) =
        a.system.g.col(named.regressors[named.free[as_size(k)]]);
  }
  return over_units(a.system, moved, design, named.covariance);
}

}  // namespace

MarginalisedSystem without_slips(const Analysis& a, const MarginalisedSystem& marginalised) {
  std::vector<bool> outliers = marginalised.outliers;
  reject_slips(a, outliers);
  return outliers == marginalised.outliers ? marginalised
                                           : marginalise_rows(a.system, outliers);
}

ExpectedImprovement expected_improvement(const Analysis& a) {
  if (!a.session.reads_chains()) return improvement_of_distances(a);
  const ObservationSet area = hangs_on_visits(a) ? a.session : over_the_area(a);
  const auto there = linearise(area, a.state);
  if (!there || area.units.empty()) return {};
  const std::vector<int>& causes = a.decision.regressors;
  const Estimate plain = estimate(a.system, without_slips(a, marginalised_system(a)), {}, -1);
  const Estimate named = estimate_of(a, causes);
  const Eigen::Index settings = a.system.by_setting.cols();
  Eigen::MatrixXd design(there->by_setting.rows(), named.covariance.rows());
  design.leftCols(settings) = there->by_setting;
  Eigen::VectorXd moved = linear::product(there->by_setting, plain.setting_change - named.setting_change);
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const Regressor& d = regressor(a, causes[k]);
    const auto g = d.slip ? std::nullopt : signature(area, a.state, *there, d.cause, d.values);
    const Eigen::VectorXd column = g ? *g : Eigen::VectorXd(Eigen::VectorXd::Zero(moved.size()));
    moved -= column * named.coefficient(as_index(k));
    const auto free = std::find(named.free.begin(), named.free.end(), k);
    if (free != named.free.end()) design.col(settings + (free - named.free.begin())) = column;
  }
  return over_units(*there, moved, design, named.covariance);
}

}  // namespace chaintrue::grid::diagnosis
