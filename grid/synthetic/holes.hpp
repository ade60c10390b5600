// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Holes cut by a machine that is not quite as stated, and measured with a tape: a set with a known
/// truth. Same seed, same bytes.
///
/// \code
///   const auto made = simulate_holes(plan->set, {.draw_settings = true, .seed = 7});
///   const auto fit = joint_fit(made->set);      // compare with made->truth
/// \endcode
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/measured_holes.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid::synthetic {

struct HolesSpec {
  /// Draw motors and zeros from the stated machine's uncertainty.
  bool draw_settings = false;
  /// Draw each chain's elongation with this sigma.
  double scale_sigma = 0.0;
  std::vector<model::AppliedEffect> hidden{};
  /// Where the sheet lies; edges alone tell.
  model::SheetPlacement sheet{};
  /// Round readings to whole multiples of this; 0: all digits.
  double rounding_mm = 0.0;
  /// So many readings are wrong by bad_size_mm, one way or the other.
  int bad_readings = 0;
  double bad_size_mm = 10.0;
  std::uint64_t seed = 1;
};

struct SyntheticHoles {
  MeasuredHoles set;                     ///< with the machine as stated
  model::Machine truth;                  ///< with what is hidden
  std::vector<model::MarkPoint> places;  ///< where the holes truly are, on the sheet
  /// Per hole: what the controller paid out for it.
  std::vector<model::ChainLengths> lengths{};
  /// Indices into the distances: readings that are wrong.
  std::vector<std::size_t> bad_readings{};
};

struct CutFailure {
  enum class Reason {
    no_lengths,   ///< a command out of the controller's reach
    unreachable,  ///< the true machine has no place for what was paid out
  } reason;
  std::string sentence;
};

/// `design` has holes and the pairs to measure; the tape's sigma and the holes' are those of the
/// noise, the hook is added; of the effects of the paper a tape has only its scale on both axes.
/// Where the truth is to be a given machine (another pass on the same one), `truth` replaces what
/// would be drawn. Fails where a hole cannot be cut. \throws std::invalid_argument for a
/// design without a machine.
[[nodiscard]] tl::expected<SyntheticHoles, CutFailure> simulate_holes(
    const MeasuredHoles& design,
    const HolesSpec& spec,
    const std::optional<model::Machine>& truth = std::nullopt);

/// The stated machine with what a spec hides in it.
[[nodiscard]] model::Machine hidden_truth(const model::Machine& stated, const HolesSpec& spec);

}  // namespace chaintrue::grid::synthetic
