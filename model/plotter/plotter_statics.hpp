// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two cords of a V-plotter for a position of its pen: equilibrium of forces, and for a body of
/// two points of moments, with exact derivatives. The equations are in plotter_equations.hpp.
///
/// Newton's steps on all equations at once; derivatives by the implicit function theorem at the
/// solution. Accuracy against 40-digit tables (fixtures/plotter): 1e-9 mm.
///
/// \code
///   const auto cords = cords_at(statics_of(machine), {120.0, -700.0, 1500.0, 0.0});
///   if (cords) use(cords->left.length_mm.value, cords->left.length_mm.d);
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "model/failure.hpp"
#include "model/plotter/plotter_equations.hpp"
#include "model/plotter/plotter_machine.hpp"

namespace chaintrue::model {

enum class PlotterReason {
  above_the_pins,     ///< the gondola is not below both points where its cords are attached
  outside_the_pins,   ///< a cord would have to push: the gondola is not between them
  slack,              ///< the side force is more than the cords hold against
  cords_do_not_meet,  ///< no position has these lengths
  not_converged,
};
MechanismReason named(PlotterReason reason);
using PlotterFailure = Failure<PlotterReason>;

namespace plotter {

/// A number with its derivatives by x, y, pin_spacing and pin_rise.
using Number = Dual<kPlaced>;

struct CordsAtRest {
  CordState<Number> left;
  CordState<Number> right;
  Number tilt_rad;
  const CordState<Number>& operator[](Side side) const { return side == Side::left ? left : right; }
};

Statics statics_of(const PlotterMachine& machine);

[[nodiscard]] tl::expected<CordsAtRest, PlotterFailure> cords_at(const Statics& statics,
                                                                 const Placed<double>& place);

}  // namespace plotter
}  // namespace chaintrue::model
