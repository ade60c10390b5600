// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/expected_gain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kColumns = 25;  // 100 mm apart on a whole bed: waves of a sprocket's turn included
constexpr int kRows = 13;

bool hangs_on_visits(const Analysis& a) {
  return std::any_of(a.decision.regressors.begin(), a.decision.regressors.end(), [&](int k) {
    const Regressor& d = a.system.regressors[static_cast<std::size_t>(k)];
    return !d.slip && model::effects::depends_on_visit(*d.cause.effect);
  });
}

/// Places over the rectangle that the marks span, in the middle of cells of equal size.
Session over_the_area(const Session& session, const Analysis& a) {
  const auto by_x = [](const SessionPoint& p, const SessionPoint& q) {
    return p.mark.x_mm < q.mark.x_mm;
  };
  const auto by_y = [](const SessionPoint& p, const SessionPoint& q) {
    return p.mark.y_mm < q.mark.y_mm;
  };
  const auto x = std::minmax_element(session.points.begin(), session.points.end(), by_x);
  const auto y = std::minmax_element(session.points.begin(), session.points.end(), by_y);
  const auto between = [](double low, double high, int i, int n) {
    return low + (high - low) * (i + 0.5) / n;
  };
  const model::ReadingModel model(a.state.machine);
  std::vector<SessionPoint> places;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const model::BedPoint mark{between(x.first->mark.x_mm, x.second->mark.x_mm, i, kColumns),
                                 between(y.first->mark.y_mm, y.second->mark.y_mm, j, kRows)};
      if (model.at(a.state.sheet.to_bed(mark))) places.push_back({0, mark, {}, 0});
    }
  }
  Session area = with_points(session, std::move(places));
  area.ordered = false;  // nobody goes there
  return area;
}

}  // namespace

MarginalisedSystem without_slips(const Session& session,
                                 const LinearisedSystem& system,
                                 const MarginalisedSystem& marginalised,
                                 const std::vector<int>& regressors,
                                 const Steps& steps) {
  std::vector<bool> outliers = marginalised.outliers;
  for (const int k : regressors) {
    const Regressor& d = system.regressors[static_cast<std::size_t>(k)];
    if (!d.slip) continue;
    for (std::size_t i = 0; i < session.points.size(); ++i) {
      if (session.points[i].order == static_cast<int>(d.values.back())) outliers[i] = true;
    }
  }
  return outliers == marginalised.outliers ? marginalised : marginalise(system, outliers, steps);
}

namespace {

/// Over the distances as they were read: what is between them has no place of its own.
ExpectedGain gain_of_distances(const Session& session, const Analysis& a) {
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[a.decision.marginalised];
  const Estimate plain = estimate(session, a.system, marginalised, {}, -1);
  const Estimate named = estimate(session, a.system, marginalised, a.decision.regressors, -1);
  const Eigen::VectorXd moved =
      left_of_machine(a.system, plain, plain.left) - left_of_machine(a.system, named, named.left);
  const Eigen::Index settings = a.system.by_setting.cols() - a.system.nuisances;
  const auto free = static_cast<Eigen::Index>(named.free.size());
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(moved.size(), named.covariance.rows());
  design.leftCols(settings) = a.system.by_setting.leftCols(settings);
  for (Eigen::Index k = 0; k < free; ++k) {
    design.col(a.system.by_setting.cols() + k) =
        a.system.g.col(named.regressors[named.free[static_cast<std::size_t>(k)]]);
  }
  double drop = 0.0;
  double doubt = 0.0;
  for (std::size_t i = 0; i < session.units(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::RowVectorXd by_unknown = design.row(row);
    drop += error_of_unit(a.system, moved, i).squaredNorm();
    doubt += std::pow(a.system.row_sigma_mm(row), 2) *
             by_unknown.dot(named.covariance * by_unknown.transpose());
  }
  const auto count = static_cast<double>(session.units());
  return {drop / count, drop > 0.0 ? drop / (drop + doubt) : 0.0};
}

}  // namespace

ExpectedGain expected_gain(const Session& session, const Analysis& a, const Steps& steps) {
  if (session.distances) return gain_of_distances(session, a);
  const Session area = hangs_on_visits(a) ? session : over_the_area(session, a);
  const auto there = linearise(area, a.state, steps);
  if (!there || area.points.empty()) return {};
  const std::vector<int>& causes = a.decision.regressors;
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[a.decision.marginalised];
  const Estimate plain = estimate(
      session, a.system, without_slips(session, a.system, marginalised, causes, steps), {}, -1);
  const Estimate named = estimate(session, a.system, marginalised, causes, -1);
  const Eigen::Index settings = a.system.by_setting.cols();
  Eigen::MatrixXd design(there->by_setting.rows(), named.covariance.rows());
  design.leftCols(settings) = there->by_setting;
  Eigen::VectorXd moved = there->by_setting * (plain.setting_change - named.setting_change);
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const Regressor& d = a.system.regressors[static_cast<std::size_t>(causes[k])];
    const auto g = d.slip ? std::nullopt : signature(area, a.state, *there, d.cause, d.values);
    const Eigen::VectorXd column = g ? *g : Eigen::VectorXd(Eigen::VectorXd::Zero(moved.size()));
    moved -= column * named.coefficient(static_cast<Eigen::Index>(k));
    const auto free = std::find(named.free.begin(), named.free.end(), k);
    if (free != named.free.end()) design.col(settings + (free - named.free.begin())) = column;
  }
  double drop = 0.0;
  double doubt = 0.0;
  for (std::size_t i = 0; i < area.points.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const PointState& point = there->points[i];
    const Eigen::Matrix2d to_tool = point.by_mark.inverse() * point.whitening.inverse();
    const Eigen::MatrixXd by_unknown = to_tool * design.middleRows<2>(row);
    drop += (to_tool * moved.segment<2>(row)).squaredNorm();
    doubt += (by_unknown * named.covariance * by_unknown.transpose()).trace();
  }
  const auto count = static_cast<double>(area.points.size());
  return {drop / count, drop > 0.0 ? drop / (drop + doubt) : 0.0};
}

}  // namespace chaintrue::grid::diagnosis
