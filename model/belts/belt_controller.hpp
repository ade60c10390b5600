// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the firmware of a Maslow 4 pays out of its upper two belts for a command, and back: its own
/// anchors, arm, extension and heights, with the command's scales applied first.
///
/// `left` is the top left belt. Heights are taken at the bed: machine and firmware share them, so
/// that a raised router does not change a position.
///
/// Source: MaslowCNC/Maslow_4, FluidNC/src/Kinematics/MaslowKinematics.cpp, computeTL, computeTR and
/// computeXYfromBeltLengths.
///
/// \code
///   const BeltController controller(machine_in_force);
///   const auto lengths = controller.lengths({100.0, -200.0});
///   const auto command = controller.command(*lengths);   // (100, -200) again
/// \endcode
#pragma once

#include "model/belts/belt_kinematics.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::model {

class BeltController final : public ControllerKinematics {
 public:
  /// \throws std::logic_error if the anchors are not known.
  explicit BeltController(const BeltMachine& machine);
  /// Closed forms, exact to rounding.
  [[nodiscard]] tl::expected<ChainLengths, PoseFailure> lengths(BedPoint command) const override;
  [[nodiscard]] tl::expected<BedPoint, PoseFailure> command(ChainLengths lengths) const override;

 private:
  BeltMachine machine_;
  FramePoint centre_;
};

}  // namespace chaintrue::model
