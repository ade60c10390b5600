// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A test drawing of a V-plotter: nine crosses on a rectangle with its middle lines and
/// diagonals, and the measurements to take on it with a ruler and a string.
///
///     A --- E --- B
///     |     |     |
///     H --- M --- F
///     |     |     |
///     D --- G --- C
///
/// \code
///   const TestDrawing sheet = planned_drawing({machine, PlotterFirmware::mural});
///   // the person fills in sheet.measures[i].value_mm
///   const auto fit = fit_drawing(sheet);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/drawn_measures.hpp"
#include "model/plotter/plotter_controller.hpp"
#include "model/plotter/plotter_mechanism.hpp"

namespace chaintrue::grid {

/// A cross, in the machine's frame as it was commanded.
struct DrawnCross {
  std::string name;
  BedPoint commanded;
};

/// The homed step offset of a mural's firmware unless it was changed.
inline constexpr double kMuralHomedOffsetMm = 40.0;

/// Lines of G-code that lift the pen and put it down.
struct PenCommands {
  std::string up = "G0 Z5";
  std::string down = "G0 Z0";
};

/// A V-plotter with its controller's settings.
struct SetPlotter {
  PlotterMachine machine;
  model::PlotterFirmware firmware = model::PlotterFirmware::fluidnc;
  /// Steps per turn of a motor; 0: not stated.
  PerSide<double> steps_per_mm{};
  /// The controller's position of the pen when it is switched on, in the machine's frame; for all
  /// but a mural.
  std::optional<BedPoint> home{};
  /// The middle between the pins in the controller's own coordinates.
  BedPoint pins_middle{};
  double homed_offset_mm = kMuralHomedOffsetMm;  ///< of a mural
  PenCommands pen{};
  double feed_mm_per_min = 1500.0;
  /// The longest cord that a controller allows, if stated.
  std::optional<double> longest_belt_mm{};
  /// For Marlin: segments per second of a move (M665 S).
  double segments_per_second = 5.0;
};

struct TestDrawing : SetPlotter {
  std::string name;
  std::vector<DrawnCross> crosses;
  /// Points by their place among the crosses.
  std::vector<observation::DrawnMeasure> measures;
};

/// Sigmas of a ruler, and of where the lines of a cross meet.
inline constexpr double kRulerSigmaMm = 0.5;

/// The crosses over the machine's drawing area, and 24 measures without values: 16 lengths and the
/// bows of eight lines at their middles.
TestDrawing planned_drawing(const SetPlotter& set);

/// The drawing as readings: each cross with what the controller paid out for it. Fails if the
/// controller cannot hold a cross, with its place among the crosses.
using CrossFailure = Failure<model::PlotterReason, std::size_t>;
[[nodiscard]] tl::expected<observation::DrawnMeasures, CrossFailure> drawn_measures_of(
    const TestDrawing& drawing);

/// The first cross for which the controller would let out more belt than it has; empty if there is none.
std::optional<std::size_t> cross_beyond_belt(const TestDrawing& drawing);

/// "the length A-B", "the bow of A-B at E".
std::string words_of(const TestDrawing& drawing, std::size_t measure);

// The page that a V-plotter draws for its test drawing, and the list of what to measure on it.
//
// \code
//   const TestDrawing drawing = planned_drawing({machine, PlotterFirmware::fluidnc});
//   write("page.gcode", drawing_gcode(drawing));
//   write("sheet.txt", measuring_list(drawing));
// \endcode

/// In the controller's coordinates (TestDrawing::pins_middle), millimetres, absolute: a cross at each
/// point, then every line with a bow to measure, from its first cross to its last.
std::string drawing_gcode(const TestDrawing& drawing);

/// For a mural, which is sent a picture: 1 unit is 1 mm, the origin is the left top corner of the
/// drawing area.
std::string drawing_svg(const TestDrawing& drawing);

/// What to measure, a numbered line each with a place for the value, in the order of the measures.
std::string measuring_list(const TestDrawing& drawing);

}  // namespace chaintrue::grid
