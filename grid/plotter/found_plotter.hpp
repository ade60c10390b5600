// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A V-plotter with its controller's settings, the result of a test drawing, and the plotter after
/// typing in the numbers.
///
/// \code
///   const KnownPlotter known{drawing, found_by(*fit)};
///   const SetPlotter next = once_typed_in(known.set, machine_found(known.set, *known.found));
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "grid/plotter/drawing_fit.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

struct FoundSetting {
  double value = 0.0;
  double sigma = 0.0;
};

/// The mechanism's parameters, by their names.
struct FoundPlotter {
  FoundSetting pin_spacing_mm;
  FoundSetting pin_rise_mm;
  FoundSetting zero_left_mm;
  FoundSetting zero_right_mm;
  FoundSetting scale_left_mm_per_m;
  FoundSetting scale_right_mm_per_m;
  /// Correlation of each with those after it, in this order, row by row: 15 numbers.
  std::vector<double> correlations;

  /// For all six.
  MatrixXd covariance() const;
};

struct KnownPlotter {
  SetPlotter set;
  std::optional<FoundPlotter> found;  ///< none before a drawing was measured
};

FoundPlotter found_by(const DrawingFit& fit);

/// The machine of `set` as it was found.
PlotterMachine machine_found(const SetPlotter& set, const FoundPlotter& found);

/// The controller's settings after typing in settings_to_paste(set, found): it counts the cords
/// correctly and knows the pen's position.
SetPlotter once_typed_in(const SetPlotter& set, const PlotterMachine& found);

/// Counted over true, relative to what the controller already allows for: the factor on the steps
/// per millimetre.
double more_steps(const SetPlotter& set, const PlotterMachine& found, Side side);

}  // namespace chaintrue::grid
