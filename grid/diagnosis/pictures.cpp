// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/leading.hpp"

namespace chaintrue::grid::diagnosis {

std::vector<PointPicture> pictures(const Session& session, const Analysis& a) {
  if (session.distances) return {};
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const Estimate before = estimate(session, a.system, marginalised, {}, -1);
  const auto chain_before = chain_residuals(a.system, before.left);
  const auto chain_after = chain_residuals(a.system, a.estimate.left);
  const auto explained = [&](const std::vector<int>& set) {
    const Estimate fitted = estimate(session, a.system, marginalised, set, -1);
    return chain_residuals(a.system, Eigen::VectorXd(before.left - fitted.left));
  };
  const Shown sets = shown(a);
  const auto by_best = explained(sets.best);
  const auto by_rival = explained(sets.rival);
  std::vector<PointPicture> result;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    const PointState& state = a.system.points[i];
    PointPicture p;
    p.index = session.points[i].index;
    p.mark = session.points[i].mark;
    if (session.ordered) p.order = session.points[i].order;
    p.bad = marginalised.outliers[i];
    p.chain_before_mm = chain_before[i];
    p.chain_after_mm = chain_after[i];
    p.before_mm = tool_shift(state, chain_before[i]);
    p.after_mm = tool_shift(state, chain_after[i]);
    const Eigen::Matrix2d inverse = state.by_mark.inverse();
    const Eigen::Matrix2d covariance =
        inverse * inverse.transpose() * std::pow(session.noise.length_mm, 2) +
        Eigen::Matrix2d::Identity() * std::pow(session.noise.position_mm, 2);
    p.noise_sigma_mm = covariance.diagonal().cwiseSqrt();
    p.best_mm = by_best[i];
    p.rival_mm = by_rival[i];
    p.lengths = session.points[i].lengths;
    const model::Pose& pose = state.reading.pose;
    p.angle_left_rad = pose.chains.left.angle_rad;
    p.angle_right_rad = pose.chains.right.angle_rad;
    p.tension_left_n = pose.chains.left.tension_at_sprocket_n;
    p.tension_right_n = pose.chains.right.tension_at_sprocket_n;
    if (session.ordered) {
      const auto direction_of = [&](double now, double then) { return now < then ? -1 : 1; };
      const auto& last = i > 0 ? a.system.points[i - 1].reading.pose.lengths : pose.lengths;
      p.direction_left = i == 0 ? 1 : direction_of(pose.lengths.left_mm, last.left_mm);
      p.direction_right = i == 0 ? 1 : direction_of(pose.lengths.right_mm, last.right_mm);
    }
    result.push_back(std::move(p));
  }
  std::sort(result.begin(), result.end(), [](const PointPicture& x, const PointPicture& y) {
    return x.index < y.index;
  });
  return result;
}

}  // namespace chaintrue::grid::diagnosis
