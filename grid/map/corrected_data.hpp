// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The data as they would be without what belongs to the paper and to the visit: marks where they
/// truly are, readings without drift, skips, miscounts and hysteresis. A map over the bed is made
/// from these and never holds such an effect.
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
  /// Its machine has none of the effects that were taken out, so that correcting it again changes
  /// nothing.
  MeasuredGrid grid;
  /// What was taken out, and what could not be; whole sentences.
  std::vector<std::string> notes;
};

/// A grid without a machine, or whose machine has no such effects, comes back as it is.
[[nodiscard]] tl::expected<CorrectedData, FitFailure> corrected_data(const MeasuredGrid& grid);

/// Distances as a true tape reads them, and a machine without the same effects, so that they can be
/// fitted with such data. A set without a machine comes back as it is.
[[nodiscard]] MeasuredHoles with_true_tape(MeasuredHoles set);

}  // namespace chaintrue::grid
