// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/leading.hpp"

namespace chaintrue::grid::diagnosis {

std::string words_of_ends(const DistancePicture& distance) {
  return std::any_of(kSheetEdges.begin(),
                     kSheetEdges.end(),
                     [&](SheetEdge edge) { return grid::name(edge) == distance.to; })
             ? fmt::format("{} to the {} edge", distance.from, distance.to)
             : fmt::format("{}-{}", distance.from, distance.to);
}

std::vector<Outlier> distance_outliers_found(const Session& session, const Analysis& a) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  std::vector<Outlier> result;
  for (std::size_t k = 0; k < session.units(); ++k) {
    if (!marginalised.outliers[k]) continue;
    const auto row = static_cast<Eigen::Index>(k);
    // All that the others know of its holes is in the prediction, with what they leave open.
    const Eigen::RowVectorXd by_setting = a.system.by_setting.row(row);
    const double variance = a.estimate.noise_square +
                            by_setting.dot(a.estimate.setting_covariance * by_setting.transpose());
    const double off = a.estimate.left_beside_discrepancy(row);
    Outlier outlier;
    outlier.index = session.distance_index[k];
    outlier.off_mm = off * a.system.row_sigma_mm(row);
    outlier.distance = std::abs(off) / std::sqrt(variance);
    result.push_back(outlier);
  }
  std::sort(result.begin(), result.end(), [](const Outlier& x, const Outlier& y) {
    return x.index < y.index;
  });
  return result;
}

std::vector<HolePicture> hole_pictures(const Session& session, const Analysis& a) {
  if (!session.distances) return {};
  const State state = with_settings(session, a.state, a.system.setting + a.estimate.setting_change);
  const auto places = session.distances->placed({model::ReadingModel(state.machine), state.sheet});
  const auto& holes = session.distances->set().holes;
  std::vector<HolePicture> result(holes.size());
  for (std::size_t i = 0; i < holes.size(); ++i) {
    result[session.points[i].index] = {
        holes[i].name, holes[i].commanded, places ? (*places)[i].mark : holes[i].commanded};
  }
  return result;
}

std::vector<DistancePicture> distance_pictures(const Session& session, const Analysis& a) {
  if (!session.distances) return {};
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const MeasuredHoles& set = session.distances->set();
  const auto of_machine = [&](const std::vector<int>& regressors) {
    const Estimate fitted = estimate(session, a.system, marginalised, regressors, -1);
    return left_of_machine(a.system, fitted, fitted.left);
  };
  const Shown sets = shown(a);
  const Eigen::VectorXd before = of_machine({});
  const Eigen::VectorXd after = left_of_machine(a.system, a.estimate, a.estimate.left);
  const Eigen::VectorXd best = before - of_machine(sets.best);
  const Eigen::VectorXd rival = before - of_machine(sets.rival);
  std::vector<DistancePicture> result(session.units());
  for (std::size_t k = 0; k < session.units(); ++k) {
    const auto mm = [&](const Eigen::VectorXd& whitened) {
      return error_of_unit(a.system, whitened, k).x();
    };
    const HoleDistance& distance = set.distances[k];
    DistancePicture picture;
    picture.index = session.distance_index[k];
    picture.from = set.holes[distance.from].name;
    picture.to =
        distance.edge ? std::string(grid::name(*distance.edge)) : set.holes[distance.to].name;
    picture.bad = marginalised.outliers[k];
    picture.read_mm = length_of(set, distance);
    picture.before_mm = mm(before);
    picture.after_mm = mm(after);
    picture.noise_sigma_mm = std::sqrt(noise_of_unit_mm2(session, a.system, k));
    picture.best_mm = mm(best);
    picture.rival_mm = mm(rival);
    result[picture.index] = std::move(picture);
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
