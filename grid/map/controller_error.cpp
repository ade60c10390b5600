// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/controller_error.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "model/controllers/payout.hpp"

namespace chaintrue::grid {

std::vector<model::BedPoint> raster_over(const interp::Rectangle& area) {
  constexpr int kColumns = 25;
  constexpr int kRows = 13;
  const double x = 0.5 * (area.x_min + area.x_max);
  const double y = 0.5 * (area.y_min + area.y_max);
  std::vector<model::BedPoint> places;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      places.push_back({x + area.width() * ((column + 0.5) / kColumns - 0.5),
                        y + area.height() * ((row + 0.5) / kRows - 0.5)});
    }
  }
  return places;
}

std::vector<MeasuredPlace> measured_places(const CompensationMap& map, MapFrame frame) {
  const double half_width = 0.5 * map.machine()->bed.width_mm;
  const double half_height = 0.5 * map.machine()->bed.height_mm;
  std::vector<MeasuredPlace> places;
  for (const model::BedPoint at :
       raster_over({-half_width, half_width, -half_height, half_height})) {
    const model::MarkPoint mark =
        frame == MapFrame::bed ? map.to_mark(at) : model::MarkPoint{at.x_mm, at.y_mm};
    if (map.status(mark) != MapStatus::inside) continue;
    if (const auto answer = map.lengths(mark))
      places.push_back({at, answer->lengths, answer->mark_jacobian.inverse()});
  }
  return places;
}

std::optional<Eigen::VectorXd> controller_errors(const model::Machine& machine,
                                                 const model::ControllerSettings& settings,
                                                 const std::vector<MeasuredPlace>& places) {
  model::Machine with_settings = machine;
  with_settings.controller.settings = settings;
  const auto controller = model::make_controller_kinematics(with_settings);
  Eigen::VectorXd errors(2 * static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto paid_out = controller->lengths(places[i].commanded);
    if (!paid_out) return std::nullopt;
    errors.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        places[i].to_tool * Eigen::Vector2d(paid_out->left_mm - places[i].lengths.left_mm,
                                            paid_out->right_mm - places[i].lengths.right_mm);
  }
  return errors;
}

ErrorSummary summary_of_errors(const Eigen::VectorXd& errors) {
  ErrorSummary result;
  const Eigen::Index places = errors.size() / 2;
  for (Eigen::Index i = 0; i < places; ++i)
    result.maximum_mm = std::max(result.maximum_mm, errors.segment<2>(2 * i).norm());
  result.rms_mm = std::sqrt(errors.squaredNorm() / static_cast<double>(places));
  return result;
}

std::optional<ErrorSummary> error_in_use(const CompensationMap& map) {
  if (map.machine() == nullptr) return std::nullopt;
  // A controller without settings of its own believes the file, not what was calibrated.
  const auto machine = stated_machine(map);
  if (!machine) return std::nullopt;
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::marks);
  if (places.empty()) return std::nullopt;
  const auto errors = controller_errors(*machine, machine->controller.settings, places);
  if (!errors) return std::nullopt;
  return summary_of_errors(*errors);
}

}  // namespace chaintrue::grid
