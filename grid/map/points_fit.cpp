// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/points_fit.hpp"

#include <memory>
#include <string>

#include "grid/estimation/spatial_blocks.hpp"
#include "grid/observation/single_readings.hpp"

namespace chaintrue::grid {
namespace {

estimation::EstimationInput estimation_input(const PointsFitInput& points) {
  estimation::EstimationInput input;
  input.machine = points.machine;
  input.observations = {std::make_shared<const observation::ChainLengthReadings>(
      chain_length_readings(points.points,
                            points.noise,
                            points.noise_scale.degrees_of_freedom,
                            points.sheet))};
  if (!points.readings.empty()) {
    input.observations.push_back(
        std::make_shared<const observation::SingleReadings>(points.readings));
  }
  input.noise = points.noise_scale;
  input.bending_order = points.bending_order;
  input.domain = points.domain;
  input.progress = points.progress;
  input.step = points.step;
  return input;
}

}  // namespace

observation::ChainLengthReadings chain_length_readings(
    const std::vector<LengthPoint>& points,
    observation::PointNoise noise,
    double noise_dof,
    const std::optional<SheetUncertainty>& sheet) {
  std::vector<observation::Place> places;
  for (const LengthPoint& point : points) {
    places.push_back(
        {point.index, std::to_string(point.index + 1), point.mark, point.lengths, 0});
  }
  std::optional<observation::SheetPrior> prior;
  if (sheet) prior = observation::SheetPrior{sheet->shift_mm, 1e-3 * sheet->rotation_mrad};
  return observation::ChainLengthReadings::in_given_order(
      std::move(places), false, noise, noise_dof, prior);
}

std::vector<FittedPoint> fitted_points(const std::vector<LengthPoint>& points,
                                       const estimation::Estimate& estimate,
                                       std::size_t observation) {
  std::vector<FittedPoint> fitted;
  for (const estimation::UnitEstimate& unit : estimate.units) {
    if (unit.observation != observation) continue;
    FittedPoint point;
    point.point = points[unit.unit];
    point.bad = unit.is_set_aside();
    point.distance = unit.distance;
    point.residual_mm = unit.residual;
    point.left_out_residual_mm = unit.left_out;
    point.blocked_residual_mm = unit.left_out_with_group;
    point.mark_jacobian = estimate.observations[observation].places[unit.unit].by_mark;
    fitted.push_back(point);
  }
  return fitted;
}

tl::expected<PointsFit, estimation::EstimationFailure> fit_points(const PointsFitInput& input) {
  estimation::EstimationInput joint = estimation_input(input);
  joint.held_out_together = spatial_blocks(input.points);
  auto estimate = estimation::estimate(joint);
  if (!estimate) return tl::unexpected(estimate.error());
  std::vector<FittedPoint> points = fitted_points(input.points, *estimate, 0);
  return PointsFit{*std::move(estimate), std::move(points)};
}

PointsFit with_plain_calibration(const PointsFitInput& input, PointsFit fit) {
  PointsFitInput alike = input;
  alike.noise = {1.0, 0.0};
  estimation::EstimationInput joint = estimation_input(alike);
  joint.noise = {interp::NoiseKnowledge::unknown, 0.0};
  joint.surface = estimation::SurfaceUse::none;
  Eigen::VectorXd weights(static_cast<Eigen::Index>(fit.points.size()));
  for (std::size_t i = 0; i < fit.points.size(); ++i)
    weights[static_cast<Eigen::Index>(i)] = fit.points[i].bad ? 0.0 : 1.0;
  joint.fixed_weights = weights;
  const auto plain = estimation::estimate(joint);
  if (!plain || !plain->settled) return fit;
  estimation::Estimate& estimate = fit.estimate;
  const Eigen::Index known = estimate.columns.settings + 2;
  const Eigen::VectorXd change = plain->map_unknowns - estimate.map_unknowns;
  estimate.machine = plain->machine;
  estimate.observations.front().sheet = plain->observations.front().sheet;
  estimate.surface.scale = plain->surface.scale;
  estimate.map_unknowns = plain->map_unknowns;
  estimate.covariance.topLeftCorner(known, known) += change * change.transpose();
  return fit;
}

}  // namespace chaintrue::grid
