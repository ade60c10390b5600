// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine with hidden effects, visited and read as a person would: true places, paper, readings,
/// noise, slips.
///
/// In this order: the marks of the design; the sled put down up to `jitter_mm` beside each; the
/// readings of the whole session with every effect; what is written beside the marks (sheet
/// placement, then the paper effects); noise of length and position; slips; rounding to the tape.
/// Each of these draws from a stream of its own, so that changing one does not change the others.
/// Same specification, same bytes.
///
/// \code
///   SyntheticSpec spec;
///   spec.hidden = {{"chain_pitch_error", "left", {{"elongation", 0.0012}}}};
///   spec.noise = {.length_mm = 0.2, .position_mm = 0.3};
///   const auto session = generate(machine, spec);
///   if (session) std::cout << files::write_grid(session->grid);
/// \endcode
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "grid/observation/measured_grid.hpp"
#include "grid/progress.hpp"
#include "grid/synthetic/design.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::synthetic {

/// What truly disturbs the numbers, one sigma.
struct SyntheticNoise {
  double length_mm = 0.0;
  double position_mm = 0.0;
  /// Student's t with 4 degrees of freedom instead of Gauss, of the same standard deviation.
  bool heavy_tails = false;
  /// Readings are rounded to whole multiples of these. 0: all digits where there is no noise,
  /// 0.0001 mm where there is.
  double length_rounding_mm = 0.0;
  double position_rounding_mm = 0.0;
};

/// Slips of the pen: the mark written this far off, in any direction.
struct BadPoints {
  int count = 0;
  double size_mm = 10.0;
};

/// By how much a setting truly differs from what the machine file states.
struct SettingOffset {
  model::Setting setting = model::Setting::motor_left_x_mm;
  double offset = 0.0;
};

/// Puts an offset on the machine, or on the sheet where it is of the sheet.
void offset_setting(model::Machine& machine,
                    model::SheetPlacement& sheet,
                    const SettingOffset& offset);

struct SyntheticSpec {
  Design design;
  VisitingOrder order = VisitingOrder::rows;
  /// Second visits of marks that were measured before, spread over the session.
  int repeats = 0;
  double jitter_mm = 0.0;
  SyntheticNoise noise;
  /// What the person states; absent: the true noise, or nothing where there is none.
  std::optional<StatedNoise> stated;
  BadPoints bad;
  /// In addition to the machine's own effects, and not told to the grid.
  std::vector<model::AppliedEffect> hidden;
  std::vector<SettingOffset> offsets;
  /// Draws further offsets of motors and zeros from the machine's stated uncertainties.
  bool draw_settings = false;
  /// The sheet was placed by hand, this well: its true place is drawn and the grid says so.
  std::optional<SheetUncertainty> sheet;
  model::Model model = model::Model::elastic;
  /// Amplitude of a smooth disturbance of both chains that no model has (unmodelled()).
  double unmodelled_mm = 0.0;
  std::uint64_t seed = 1;
};

/// That disturbance for an amplitude of 1 mm: sin(x / 500 + 0.3) cos(y / 400) on the left chain,
/// cos(x / 450) sin(y / 420 + 0.5) on the right one, x and y in mm: most of a wave along the bed,
/// half of one up it.
[[nodiscard]] model::ChainLengths unmodelled(model::BedPoint place);

/// The machine as it truly is: hidden effects appended, settings offset and drawn; and where its
/// sheet lies.
struct SyntheticTruth {
  model::Machine machine;
  std::vector<SettingOffset> offsets;
  model::SheetPlacement sheet;
};
[[nodiscard]] SyntheticTruth truth_of(const model::Machine& stated, const SyntheticSpec& spec);

/// What was hidden.
struct SyntheticAnswer {
  /// The machine as it truly is, every effect on.
  model::Machine machine;
  std::vector<model::AppliedEffect> hidden;
  std::vector<SettingOffset> offsets;
  model::SheetPlacement sheet;
  /// Per point of the grid: where the tool truly was, in the bed's frame.
  std::vector<model::BedPoint> places;
  /// Per point: what would have been read without noise and slips.
  std::vector<model::ChainLengths> lengths;
  /// Indices into the points: slips of the pen and miscounted links.
  std::vector<std::size_t> bad_points;
  std::uint64_t seed = 0;
};

struct SyntheticSession {
  /// Its machine is the stated one.
  MeasuredGrid grid;
  SyntheticAnswer answer;
};

/// A mark that the machine cannot reach.
struct UnreachableMark {
  model::MarkPoint place;
  model::PoseFailure reason = model::PoseFailure::not_converged;
};

/// \throws std::invalid_argument for a machine or hidden effects with problems (check with
/// problems_of and effects::problems_of_effects on true_machine()), and as marks().
[[nodiscard]] tl::expected<SyntheticSession, UnreachableMark> generate(
    const model::Machine& stated, const SyntheticSpec& spec, const Progress& progress = {});

/// The stated machine with the hidden effects appended, before settings are offset.
[[nodiscard]] model::Machine with_effects(const model::Machine& stated,
                                          const std::vector<model::AppliedEffect>& hidden);

/// Readings at given true places, visited in the order of their numbers: no noise, all digits. The
/// marks of the grid are what the paper effects write.
struct PlacesRead {
  MeasuredGrid grid;
  /// Those that cannot be reached; they are left out of the grid and of the session.
  std::vector<std::pair<std::size_t, model::PoseFailure>> unreachable;
};
[[nodiscard]] PlacesRead read_places(const model::Machine& stated,
                                     const std::vector<model::AppliedEffect>& hidden,
                                     const std::vector<model::Visit>& visits,
                                     model::Model model = model::Model::elastic,
                                     const Progress& progress = {});

}  // namespace chaintrue::grid::synthetic
