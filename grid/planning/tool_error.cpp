// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/tool_error.hpp"

#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "grid/containers.hpp"
#include "grid/raster.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {

using model::MarkPoint;

std::optional<PlannedPlace> planned_place(const model::ReadingModel& model, MarkPoint place) {
  const auto reading = model.at(model::identity_placement(place));
  if (!reading) return std::nullopt;
  Eigen::Matrix<double, 2, estimation::kMachineUnknowns> lengths;
  for (std::size_t i = 0; i < model::kMachineSettings.size(); ++i) {
    lengths.col(as_index(i)) = model.sensitivity(*reading, model::kMachineSettings[i]);
  }
  lengths.rightCols<2>() =
      Eigen::Vector2d(reading->lengths.left_mm, reading->lengths.right_mm).asDiagonal();
  PlannedPlace planned{place, {}};
  planned.by_unknown << -reading->position_jacobian.inverse() * lengths,
      -model::SheetPlacement{}.sensitivity(place);
  return planned;
}

ToolError tool_error(const model::Machine& machine, bool sheet_counts) {
  const model::ReadingModel model(machine);
  std::vector<PlannedPlace> places;
  for (const MarkPoint& place : raster(area_of(machine.bed), 13, 7, RasterOf::cells)) {
    if (const auto planned = planned_place(model, place)) places.push_back(*planned);
  }
  const auto count = std::ssize(places);
  if (count < kPlanUnknowns) {
    return {Eigen::MatrixXd::Zero(kPlanUnknowns, kPlanUnknowns),
            Eigen::MatrixXd::Zero(3, kPlanUnknowns)};
  }
  Eigen::MatrixXd motion(2 * count, kPlanUnknowns);
  Eigen::MatrixXd rigid(2 * count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PlannedPlace& place = places[as_size(i)];
    motion.middleRows<2>(2 * i) = place.by_unknown;
    rigid.middleRows<2>(2 * i) = model::SheetPlacement{}.sensitivity(place.place);
  }
  ToolError error;
  error.whole = linear::least_squares(rigid, motion);
  if (!sheet_counts) linear::add_product(motion, -1.0, rigid, error.whole);
  error.root = linear::upper_triangle(motion) / std::sqrt(as_double(count));
  return error;
}

double tool_sigma_mm(const model::Machine& machine, const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd root =
      tool_error(machine, false).root.leftCols(estimation::kMachineUnknowns);
  return std::sqrt(std::max(0.0, linear::carried(root, covariance).trace()));
}

}  // namespace chaintrue::grid
