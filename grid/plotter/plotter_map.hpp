// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map of a V-plotter from its measured test drawing (map/mechanism_map.hpp): the fitted
/// plotter, on a page in the controller's coordinates.
///
///   in_frame(p) = p - pins_middle + t                                                       (1)
///
/// A drawing does not show where on the wall it is. t therefore places the page so that its
/// crosses, as a whole, are drawn where they were commanded: a program that is compensated moves no
/// farther than its lines are wrong. The page is not turned, since the fitted plotter's level is as
/// accurate as the stated height of its pins. Sigmas describe the drawing's shape: plotters one sigma
/// away have the page where its crosses come nearest to those of the fit, turned and moved as a
/// whole.
///
/// \code
///   const MechanismMap map = plotter_map(plotter);
///   const auto lengths = map.lengths({420.0, 120.0});
/// \endcode
#pragma once

#include "grid/map/mechanism_map.hpp"
#include "grid/plotter/found_plotter.hpp"

namespace chaintrue::grid {

/// Over the drawing area; what was measured is the rectangle of the crosses. \throws
/// std::invalid_argument without a fit, or if the controller or the fitted plotter does not reach a
/// cross.
MechanismMap plotter_map(const KnownPlotter& plotter);

}  // namespace chaintrue::grid
