// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/expected_gain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/leading.hpp"
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

/// The first part at whose marks chains were read.
std::size_t chain_part(const Session& session) {
  const auto found = std::find_if(session.parts.begin(),
                                  session.parts.end(),
                                  [](const SessionPart& part) { return part.reads_chains(); });
  return static_cast<std::size_t>(found - session.parts.begin());
}

/// Places over the rectangle that the marks span, in the middle of cells of equal size.
Session over_the_area(const Analysis& a) {
  const Session& session = a.session;
  const std::size_t part = chain_part(session);
  const auto& own =
      dynamic_cast<const observation::ChainLengthReadings&>(*session.parts[part].observation);
  const auto by_x = [](const auto& p, const auto& q) { return p.mark.x_mm < q.mark.x_mm; };
  const auto by_y = [](const auto& p, const auto& q) { return p.mark.y_mm < q.mark.y_mm; };
  const auto x = std::minmax_element(own.places().begin(), own.places().end(), by_x);
  const auto y = std::minmax_element(own.places().begin(), own.places().end(), by_y);
  const auto between = [](double low, double high, int i, int n) {
    return low + (high - low) * (i + 0.5) / n;
  };
  const model::ReadingModel model(a.state.machine);
  const model::SheetPlacement sheet = a.state.sheet_of(session.parts[part]);
  std::vector<observation::Place> places;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const model::BedPoint mark{between(x.first->mark.x_mm, x.second->mark.x_mm, i, kColumns),
                                 between(y.first->mark.y_mm, y.second->mark.y_mm, j, kRows)};
      if (model.at(sheet.to_bed(mark))) places.push_back({0, "", mark, {}, 0});
    }
  }
  // Nobody goes there: no order of visits.
  return with_observations(session,
                           {{std::make_shared<const observation::ChainLengthReadings>(
                                 observation::ChainLengthReadings::in_given_order(
                                     std::move(places), false, own.noise(), own.noise_dof(), own.sheet())),
                             part}});
}

/// Drop and doubt of the tool's, or a distance's, error over some units.
ExpectedGain over_units(const LinearisedSystem& there,
                        const Eigen::VectorXd& moved,
                        const Eigen::MatrixXd& design,
                        const Eigen::MatrixXd& covariance) {
  double drop = 0.0;
  double doubt = 0.0;
  for (const SystemUnit& unit : there.units) {
    const Eigen::MatrixXd by_unknown = design.middleRows(unit.first_row, unit.rows);
    if (unit.reads_chains) {
      const Eigen::Matrix2d to_tool =
          there.places[unit.places.front().place].by_mark.inverse() * unit.whitening.inverse();
      const Eigen::MatrixXd tool = to_tool * by_unknown;
      drop += (to_tool * moved.segment<2>(unit.first_row)).squaredNorm();
      doubt += (tool * covariance * tool.transpose()).trace();
    } else {
      drop += unit.unwhitened(moved).squaredNorm();
      doubt += std::pow(unit.sigma, 2) *
               by_unknown.row(0).dot(covariance * by_unknown.row(0).transpose());
    }
  }
  const auto count = static_cast<double>(there.units.size());
  return {drop / count, drop > 0.0 ? drop / (drop + doubt) : 0.0};
}

/// Over the distances as they were read: what is between them has no place of its own.
ExpectedGain gain_of_distances(const Analysis& a) {
  const Estimate plain = estimate_of(a, {});
  const Estimate named = estimate_of(a, a.decision.regressors);
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
  return over_units(a.system, moved, design, named.covariance);
}

}  // namespace

MarginalisedSystem without_slips(const Analysis& a, const MarginalisedSystem& marginalised) {
  std::vector<bool> outliers = marginalised.outliers;
  set_slips_aside(a, outliers);
  return outliers == marginalised.outliers
             ? marginalised
             : marginalise(a.system, outliers, a.options.steps);
}

ExpectedGain expected_gain(const Analysis& a) {
  if (!a.session.reads_chains()) return gain_of_distances(a);
  const Session area = hangs_on_visits(a) ? a.session : over_the_area(a);
  const auto there = linearise(area, a.state, a.options.steps);
  if (!there || area.units.empty()) return {};
  const std::vector<int>& causes = a.decision.regressors;
  const Estimate plain =
      estimate(a.system, without_slips(a, marginalised_system(a)), {}, -1);
  const Estimate named = estimate_of(a, causes);
  const Eigen::Index settings = a.system.by_setting.cols();
  Eigen::MatrixXd design(there->by_setting.rows(), named.covariance.rows());
  design.leftCols(settings) = there->by_setting;
  Eigen::VectorXd moved = there->by_setting * (plain.setting_change - named.setting_change);
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const Regressor& d = regressor(a, causes[k]);
    const auto g = d.slip ? std::nullopt : signature(area, a.state, *there, d.cause, d.values);
    const Eigen::VectorXd column = g ? *g : Eigen::VectorXd(Eigen::VectorXd::Zero(moved.size()));
    moved -= column * named.coefficient(static_cast<Eigen::Index>(k));
    const auto free = std::find(named.free.begin(), named.free.end(), k);
    if (free != named.free.end()) design.col(settings + (free - named.free.begin())) = column;
  }
  return over_units(*there, moved, design, named.covariance);
}

}  // namespace chaintrue::grid::diagnosis
