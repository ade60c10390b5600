// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/length_points.hpp"

#include <fmt/format.h>

#include <memory>

#include "grid/plane_vectors.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

tl::unexpected<std::string> no_lengths(std::size_t index, const std::string& why) {
  return tl::unexpected(
      fmt::format("point {} gives a command and no lengths, but {}", index + 1, why));
}

}  // namespace

tl::expected<std::vector<LengthPoint>, std::string> length_points(const MeasuredGrid& grid) {
  const bool commands =
      any_of(grid.points, [](const MeasuredPoint& point) { return !point.lengths; });
  std::unique_ptr<const model::ControllerKinematics> controller;
  if (commands && grid.machine) controller = make_controller_kinematics(*grid.machine);
  std::vector<LengthPoint> points;
  for (const auto i : each_index(grid.points)) {
    const MeasuredPoint& point = grid.points[i];
    LengthPoint result{i, std::to_string(i + 1), point.mark, {}, point.order.value_or(0)};
    if (point.lengths) {
      result.lengths = *point.lengths;
    } else {
      if (!controller) return no_lengths(i, "no machine with a controller is given");
      if (!point.commanded) return no_lengths(i, "the command is missing");
      const auto paid_out = controller->lengths(*point.commanded);
      if (!paid_out)
        return no_lengths(
            i, fmt::format("the controller cannot go there: {}", paid_out.error().sentence()));
      result.lengths = *paid_out;
      result.commanded = point.commanded;
    }
    points.push_back(result);
  }
  return points;
}

observation::ChainLengthReadings chain_length_readings(
    const std::vector<LengthPoint>& points, observation::PointNoise noise, double noise_dof,
    const std::optional<SheetUncertainty>& sheet) {
  std::optional<observation::SheetPrior> prior;
  if (sheet) prior = observation::SheetPrior{sheet->shift_mm, 1e-3 * sheet->rotation_mrad};
  return observation::ChainLengthReadings::in_given_order(points, false, noise, noise_dof, prior);
}

std::vector<Indices> repeat_groups(const std::vector<LengthPoint>& points) {
  std::vector<Indices> groups;
  for (const auto i : each_index(points)) {
    const auto near = [&](const Indices& group) {
      const MarkPoint first = points[group.front()].mark;
      return distance_mm(first, points[i].mark) <= kRepeatDistanceMm;
    };
    auto* group = find_where(groups, near);
    if (group == nullptr) {
      groups.push_back({i});
    } else {
      group->push_back(i);
    }
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

}  // namespace chaintrue::grid
