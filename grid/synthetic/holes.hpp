// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Simulated holes, cut by a machine that differs from the stated one and measured with a tape: a
/// set with a known truth. Same seed, same bytes.
///
/// \code
///   const auto made = simulate_holes(plan->set, {.draw_settings = true, .seed = 7});
///   const auto fit = joint_fit(made->set);      // compare with made->truth
/// \endcode
#pragma once

#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/measured_holes.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid::synthetic {

struct HolesSpec {
  /// Draw motors and zeros from the stated machine's uncertainty.
  bool draw_settings = false;
  /// Draw each chain's elongation with this sigma.
  double scale_sigma = 0.0;
  std::vector<AppliedEffect> hidden{};
  /// The sheet's placement, observable only by distances to its edges.
  SheetPlacement sheet{};
  /// Round readings to whole multiples of this; 0: all digits.
  double rounding_mm = 0.0;
  /// Number of readings with an error of bad_size_mm, of either sign.
  int bad_readings = 0;
  double bad_size_mm = 10.0;
  std::uint64_t seed = 1;
};

struct SyntheticHoles {
  MeasuredHoles set;              ///< with the stated machine
  Machine truth;                  ///< with the hidden changes
  std::vector<MarkPoint> places;  ///< true positions of the holes on the sheet
  /// For each hole: the lengths that the controller paid out.
  std::vector<ChainLengths> lengths{};
  /// Indices into the distances of the bad readings.
  Indices bad_readings{};
};

enum class CutReason {
  no_lengths,   ///< a command outside the controller's range
  unreachable,  ///< the true machine has no pose with these lengths
};
using CutFailure = Failure<CutReason>;

/// `design` has holes and the pairs to measure; the sigmas of the tape and of the holes are those
/// of the noise, the tape zero offset is added; of the paper effects only the tape's scale on both
/// axes applies. If the true machine is given (another round on the same one), `truth` replaces the
/// drawn one. Fails if a hole cannot be cut. \throws std::invalid_argument for a design without a
/// machine.
[[nodiscard]] tl::expected<SyntheticHoles, CutFailure> simulate_holes(
    const MeasuredHoles& design, const HolesSpec& spec,
    const std::optional<Machine>& truth = std::nullopt);

/// The stated machine with the hidden changes of a spec.
Machine hidden_truth(const Machine& stated, const HolesSpec& spec);

}  // namespace chaintrue::grid::synthetic
