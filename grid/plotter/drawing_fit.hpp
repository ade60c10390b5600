// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings of a V-plotter from a test drawing: the estimate (estimation/estimate.hpp) from its
/// lengths and bows, the controller's new settings, and the prediction of the next drawing.
///
/// A drawing fixes the pins' spacing, zeros and scales. It has no reference to the vertical: it
/// shows the pins' rise only through the gondola's tilt, and not at all for a point.
///
/// Slips that a drawing of one machine cannot show are refused with their name, before and after the
/// estimate: inches, bows turned round, a drawing that was scaled when printed, a line measured along
/// its bow, two lengths in each other's row, and measures that fit no settings.
///
/// \code
///   const auto fit = fit_drawing(drawing);
///   if (!fit) say(fit.error().sentence());
///   else for (const PlotterSetting& one : fit->settings) say(one.name, one.found, one.sigma);
/// \endcode
#pragma once

#include <memory>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "grid/plotter/test_drawing.hpp"
#include "interp/eigen.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// A parameter of the mechanism.
struct PlotterSetting {
  std::string_view name;
  double stated = 0.0;
  double found = 0.0;
  double sigma = 0.0;
  bool is_off = false;  ///< by more than chance: kOffSigmas
};
inline constexpr double kOffSigmas = 3.0;

/// A measure after the fit, mm.
struct FittedMeasure {
  double measured_mm = 0.0;
  double found_mm = 0.0;  ///< of the machine as found
  double after_mm = 0.0;  ///< on the next drawing, with the settings typed in
  bool rejected = false;  ///< rejected; it does not fit another row either
};

struct DrawingFit {
  std::shared_ptr<const model::PlotterMechanism> mechanism;  ///< as found
  std::vector<PlotterSetting> settings;
  MatrixXd covariance;  ///< of these settings
  /// In the order of the drawing's measures.
  std::vector<FittedMeasure> measures;
  /// The noise found, as a multiple of the sigmas that went in.
  double noise_factor = 1.0;
  /// The ideal settings; typed_in() gives what the controller can store.
  PlotterMachine to_set;
};

enum class DrawingReason {
  too_few,
  cross_out_of_reach,
  inches,
  scaled_when_printed,
  bow_is_a_length,
  bows_turned,
  rows_exchanged,
  no_settings_fit,
  not_converged,
};
using DrawingFailure = Failure<DrawingReason>;

/// With fewer measures the result has no check.
inline constexpr std::size_t kFewestMeasures = 12;

[[nodiscard]] tl::expected<DrawingFit, DrawingFailure> fit_drawing(const TestDrawing& drawing);

/// The part of a fitted machine that a controller can store. FluidNC stores all of it. Marlin
/// assumes level pins; Polargraph also has one scale for both cords; a mural also has one zero, and
/// whole millimetres between its pins.
PlotterMachine typed_in(model::PlotterFirmware firmware, PlotterMachine found);

/// The pen's position on `found` for a command to a controller with `set`.
[[nodiscard]] tl::expected<ToolPosition, model::MechanismFailure> pen_of_command(
    model::PlotterFirmware firmware, const PlotterMachine& set,
    const model::PlotterMechanism& found, BedPoint command);

}  // namespace chaintrue::grid
