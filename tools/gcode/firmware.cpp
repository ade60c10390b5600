// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of controllers' motion.
#include "tools/gcode/firmware.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

constexpr Firmware kFirmwares[] = {
    {model::ControllerKind::ideal, "ideal", false, 0.0, 0.0, false, true, 0.0, 0.0},
    {model::ControllerKind::maslow_classic, "maslow_classic", true, 0.01, 0.0, true, false, 0.0, 0.08},
    {model::ControllerKind::holey, "holey", true, 0.01, 0.0, true, false, 0.0, 0.08},
    {model::ControllerKind::fluidnc_wallplotter, "fluidnc_wallplotter", true, 0.0, 10.0, false, false, 0.002, 0.0},
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

CommandWay::CommandWay(const Firmware& firmware,
                       const model::ControllerKinematics& kinematics,
                       model::BedPoint from,
                       model::BedPoint to,
                       double doubt_mm)
    : firmware_(firmware), kinematics_(kinematics), from_(from), to_(to) {
  if (firmware.chain_linear_piece_mm == 0.0) return;
  const double length = std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm) - doubt_mm;
  pieces_ = static_cast<int>(
      std::clamp(std::floor(length / firmware.chain_linear_piece_mm), 1.0, 1e6));
}

std::optional<model::BedPoint> CommandWay::at(double t) {
  if (firmware_.chain_linear_piece_mm == 0.0) return on_line(t);
  const int piece = std::min(static_cast<int>(t * pieces_), pieces_ - 1);
  if (piece != piece_) {
    const auto lengths = [&](int end) -> std::optional<model::ChainLengths> {
      const auto found = kinematics_.lengths(on_line(static_cast<double>(end) / pieces_));
      return found ? std::optional(*found) : std::nullopt;
    };
    start_ = piece == piece_ + 1 && piece_ >= 0 ? end_ : lengths(piece);
    end_ = lengths(piece + 1);
    piece_ = piece;
  }
  if (!start_ || !end_) return std::nullopt;
  const double u = t * pieces_ - piece;
  const auto command =
      kinematics_.command({start_->left_mm + u * (end_->left_mm - start_->left_mm),
                           start_->right_mm + u * (end_->right_mm - start_->right_mm)});
  return command ? std::optional(*command) : std::nullopt;
}

}  // namespace chaintrue::gcode
