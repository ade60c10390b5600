// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The data without effects of the paper and the visit: true positions of marks, readings without
/// drift, skips, miscounts and hysteresis. A map over the bed is made from these and never contains
/// such an effect.
///
///   mark' = MarkFrame^-1(mark)        reading' = reading - (reading with visit effects - without)
///
/// The visit effects are those of the machine at mark', in the order of the visits. Hysteresis
/// looks only at which way a chain moved, so that the few millimetres by which a stated machine is
/// off matter between two marks of nearly the same length alone.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid {

struct CorrectedData {
  /// Its machine has none of the removed effects, so correcting it again changes nothing.
  MeasuredGrid grid;
  /// Sentences: what was removed, and what could not be.
  std::vector<std::string> notes;
};

/// A grid without a machine, or whose machine has no such effects, is returned unchanged.
[[nodiscard]] tl::expected<CorrectedData, FitFailure> corrected_data(const MeasuredGrid& grid);

/// Distances as read by a true tape, and a machine without these effects, to be fitted with such
/// data. A set without a machine is returned unchanged.
[[nodiscard]] MeasuredHoles with_true_tape(MeasuredHoles set);

}  // namespace chaintrue::grid
