// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_for_settings.hpp"

#include <utility>

#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

/// Where the tool landed minus where this controller assumes it; the sheet's placement is
/// unchanged.
void tell_of(const model::ControllerKinematics& controller, MapPoint& point) {
  const auto believed = controller.command(point.lengths);
  if (!believed) return;
  const Vector2d error = difference(point.mark, *believed);
  point.sheet_placed_mm += error - point.as_stated_mm;
  point.as_stated_mm = error;
}

}  // namespace

CompensationMap map_for_settings(const CompensationMap& map, const model::Controller& now,
                                 const std::string& note) {
  MapContents contents = map.contents();
  auto* surface = std::get_if<ModelSurface>(&contents.surface);
  if (surface == nullptr) throw precondition("settings of a map without a machine");
  surface->machine.controller = now;
  Machine believed = stated_machine(map).value();
  believed.controller = now;
  const auto controller = model::make_controller_kinematics(believed);
  for (MapPoint& point : contents.points) tell_of(*controller, point);
  if (!note.empty()) contents.notes.push_back(note);
  return CompensationMap(std::move(contents));
}

Measured commanded_with(const Measured& measured, const model::Controller& now) {
  Measured result;
  for (MeasuredFile file : measured.files()) {
    std::visit(
        [&now](auto& one) {
          if (one.machine) one.machine->controller = now;
        },
        file.measured);
    result.add(std::move(file));
  }
  return result;
}

}  // namespace chaintrue::grid
