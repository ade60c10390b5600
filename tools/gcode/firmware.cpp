// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of controllers' motion.
#include "tools/gcode/firmware.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

constexpr Firmware kFirmwares[] = {
    {model::ControllerKind::ideal, "ideal", false, 0.0, 0.0, false, 0.0, 0.0},
    {model::ControllerKind::maslow_classic, "maslow_classic", true, 0.01, 0.0, true, 0.0, 0.08},
    {model::ControllerKind::holey, "holey", true, 0.01, 0.0, true, 0.0, 0.08},
    {model::ControllerKind::fluidnc_wallplotter, "fluidnc_wallplotter", true, 0.0, 10.0, false, 0.002, 0.0},
};

}  // namespace

const Firmware& firmware(model::ControllerKind kind) {
  return *std::find_if(std::begin(kFirmwares),
                       std::end(kFirmwares) - 1,
                       [&](const Firmware& candidate) { return candidate.kind == kind; });
}

std::optional<ClampBox> clamp_box(const model::Machine& machine) {
  if (!firmware(machine.controller.kind).clamps_to_bed) return std::nullopt;
  const model::ControllerSettings& settings = machine.controller.settings;
  return ClampBox{0.5 * settings.bed_width_mm.value_or(machine.bed.width_mm),
                  0.5 * settings.bed_height_mm.value_or(machine.bed.height_mm)};
}

std::optional<model::BedPoint> on_the_way(const Firmware& firmware,
                                          const model::ControllerKinematics& kinematics,
                                          model::BedPoint from,
                                          model::BedPoint to,
                                          double t) {
  const auto on_line = [&](double u) {
    return model::BedPoint{from.x_mm + u * (to.x_mm - from.x_mm),
                           from.y_mm + u * (to.y_mm - from.y_mm)};
  };
  if (firmware.chain_linear_piece_mm == 0.0) return on_line(t);
  const double length = std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm);
  const double pieces = std::max(1.0, std::floor(length / firmware.chain_linear_piece_mm));
  const double piece = std::min(std::floor(t * pieces), pieces - 1.0);
  const auto a = kinematics.lengths(on_line(piece / pieces));
  const auto b = kinematics.lengths(on_line((piece + 1.0) / pieces));
  if (!a || !b) return std::nullopt;
  const double u = t * pieces - piece;
  const auto command = kinematics.command(
      {a->left_mm + u * (b->left_mm - a->left_mm), a->right_mm + u * (b->right_mm - a->right_mm)});
  if (!command) return std::nullopt;
  return *command;
}

}  // namespace chaintrue::gcode
