// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Test drawings of V-plotters with a hidden cause, hung by the second implementation
/// (generator/hidden/plotter.hpp: bodies by the lowest pose of stiff cords, a light pen by cords of many
/// links), and their diagnosis.
///
/// The controller counts K for a cross; the cord that is out is the L with
///
///   (L + added(L)) (1 + scale / 1000) + zero = K                                           (1)
///
/// where the effect of a cause is implemented a second time. Errors of the settings are drawn from
/// their uncertainty. Only the light pen has causes that stretch or weigh down the cords.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "grid/plotter/test_drawing.hpp"

namespace chaintrue::sealed {

/// A mural; a body on motors on the wall; a pen on two spools; a light pen on cords that weigh.
enum class PlotterKind { mural, body, pen, light_pen };
std::string_view name(PlotterKind kind);
inline constexpr PlotterKind kPlotterKinds[] = {PlotterKind::mural, PlotterKind::body,
                                                PlotterKind::pen, PlotterKind::light_pen};

struct HiddenCause {
  std::string effect;  ///< of the product's catalogue; empty: nothing is wrong
  std::string side;
};
/// Those that such a plotter can have.
std::vector<HiddenCause> causes_of(PlotterKind kind);

struct PlotterSet {
  HiddenCause cause;
  /// Length of the cause's signature in units of noise, after projection on the settings.
  double strength = 0.0;
  grid::TestDrawing drawing;
  /// Where the hidden plotter's pen is when its controller has counted these, in the frame of its pins.
  std::function<Eigen::Vector2d(model::ChainLengths)> pen;
};
/// With 24 readings of 0.5 mm. Sizes are drawn until the strength is in the range.
PlotterSet plotter_set(PlotterKind kind, const HiddenCause& cause, double least_strength,
                       double most_strength, std::uint64_t seed);

enum class PlotterOutcome { named, in_set, wrong, nothing, refused };
/// `in_set`: among at most three. Of a sound one anything but a name is `nothing`.
[[nodiscard]] PlotterOutcome outcome_of(const PlotterSet& set);

}  // namespace chaintrue::sealed
