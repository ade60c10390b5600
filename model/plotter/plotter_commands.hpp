// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The controller of a V-plotter as a controller's kinematics: the lengths that it counts for
/// a command, by paid_out(), and the command for given lengths.
///
/// Commands are in the controller's own coordinates, in which the middle between the pins is
/// `pins_middle`; mm.
///
/// \code
///   const PlotterController controller(PlotterFirmware::marlin, as_set, {500.0, 700.0});
///   const auto lengths = controller.lengths({420.0, 120.0});
///   const auto command = controller.command(*lengths);   // (420, 120) again
/// \endcode
#pragma once

#include "model/controllers/payout.hpp"
#include "model/plotter/plotter_controller.hpp"

namespace chaintrue::model {

class PlotterController final : public ControllerKinematics {
 public:
  PlotterController(PlotterFirmware firmware, const PlotterMachine& as_set, BedPoint pins_middle)
      : firmware_(firmware), as_set_(as_set), pins_middle_(pins_middle) {}
  [[nodiscard]] tl::expected<ChainLengths, PoseFailure> lengths(BedPoint command) const override;
  /// Exact to rounding if cords are straight to the pen; for a mural by Newton to 1e-9 mm.
  [[nodiscard]] tl::expected<BedPoint, PoseFailure> command(ChainLengths lengths) const override;

 private:
  PlotterFirmware firmware_;
  PlotterMachine as_set_;
  BedPoint pins_middle_;
};

}  // namespace chaintrue::model
