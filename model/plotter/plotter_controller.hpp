// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lengths that a V-plotter's controller pays out for a command: its published kinematics, in
/// double precision.
///
///   fluidnc, marlin, polargraph
///              the distance from the command to each pin. bdring/FluidNC, Kinematics/WallPlotter.cpp;
///              MarlinFirmware/Marlin, module/polargraph.cpp, which Makelangelo uses;
///              euphy/polargraphcontroller
///   mural      nikivanov/mural, KinematicModel.md and src/kinematics.cpp: tangent points fixed in the
///              body as for cords at 45 degrees, forces as if they met in one point, the tilt from
///              the moments about the middle between the tangent points, the slant to the wall and
///              the stretch; here converged, where the firmware stops at a change of 0.25 degrees
///
/// Pins are as they are set; all but FluidNC take them as level. These lengths are counted with the zero and
/// the scale that are set: (1) of plotter_mechanism.hpp.
#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "model/plotter/plotter_machine.hpp"
#include "model/plotter/plotter_statics.hpp"

namespace chaintrue::model {

enum class PlotterFirmware { fluidnc, marlin, polargraph, mural };
inline constexpr PlotterFirmware kPlotterFirmwares[] = {
    PlotterFirmware::fluidnc, PlotterFirmware::marlin, PlotterFirmware::polargraph,
    PlotterFirmware::mural};
std::string_view name(PlotterFirmware firmware);

/// `as_set` has the controller's settings. The command is in the machine's frame. \throws
/// std::invalid_argument for a mural that is a point.
[[nodiscard]] tl::expected<ChainLengths, PlotterFailure> paid_out(PlotterFirmware firmware,
                                                                  const PlotterMachine& as_set,
                                                                  BedPoint command);

/// A number with its derivatives by x and y of the command.
using ByCommand = Dual<2>;
/// The lengths that a mural pays out before zero and scale. \throws std::invalid_argument for a
/// point.
[[nodiscard]] tl::expected<PerSide<ByCommand>, PlotterFailure> mural_lengths(
    const PlotterMachine& as_set, BedPoint command);

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::PlotterFirmware;
}  // namespace chaintrue
