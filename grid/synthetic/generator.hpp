// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A simulated session on a machine with hidden effects: true positions, paper, readings, noise,
/// gross errors.
///
/// In this order: the marks of the design; the sled placed up to `jitter_mm` from each; the
/// readings of the whole session with every effect; the coordinates written at the marks (sheet
/// placement, then the paper effects); noise of length and position; gross errors; rounding to the
/// tape. Each of these has its own random stream, so that a change of one does not change the
/// others. Same specification, same bytes.
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

#include "grid/containers.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/progress.hpp"
#include "grid/synthetic/design.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::synthetic {

/// The true noise, one sigma.
struct SyntheticNoise {
  double length_mm = 0.0;
  double position_mm = 0.0;
  /// Student's t with 4 degrees of freedom instead of Gauss, of the same standard deviation.
  bool heavy_tails = false;
  /// Readings are rounded to whole multiples of these. 0: all digits without noise, 0.0001 mm with
  /// noise.
  double length_rounding_mm = 0.0;
  double position_rounding_mm = 0.0;
};

/// Gross errors: the mark is written this far off, in a random direction.
struct BadPoints {
  int count = 0;
  double size_mm = 10.0;
};

/// True setting less the stated one.
struct SettingOffset {
  Setting setting = Setting::motor_left_x_mm;
  double offset = 0.0;
};

/// Applies an offset to the machine, or to the sheet if it is a setting of the sheet.
void offset_setting(Machine& machine, SheetPlacement& sheet, const SettingOffset& offset);

struct SyntheticSpec {
  Design design;
  VisitingOrder order = VisitingOrder::rows;
  /// Repeated visits of marks, spread over the session.
  int repeats = 0;
  double jitter_mm = 0.0;
  SyntheticNoise noise;
  /// The stated noise; absent: the true noise, or none if there is no noise.
  std::optional<StatedNoise> stated;
  BadPoints bad;
  /// In addition to the machine's own effects; not stated in the grid.
  std::vector<AppliedEffect> hidden;
  std::vector<SettingOffset> offsets;
  /// Draws further offsets of motors and zeros from the machine's stated uncertainties.
  bool draw_settings = false;
  /// The sheet was placed by hand with this uncertainty: its true placement is drawn, and the grid
  /// states the uncertainty.
  std::optional<SheetUncertainty> sheet;
  model::Model model = model::Model::elastic;
  /// Amplitude of an unmodelled smooth disturbance of both chains (unmodelled()).
  double unmodelled_mm = 0.0;
  std::uint64_t seed = 1;
};

/// That disturbance for an amplitude of 1 mm: sin(x / 500 + 0.3) cos(y / 400) on the left chain,
/// cos(x / 450) sin(y / 420 + 0.5) on the right one, x and y in mm: most of a period along the bed,
/// half of one up it.
ChainLengths unmodelled(BedPoint place);

/// The true machine: hidden effects appended, settings offset and drawn; and the sheet's true
/// placement.
struct SyntheticTruth {
  Machine machine;
  std::vector<SettingOffset> offsets;
  SheetPlacement sheet;
};
SyntheticTruth truth_of(const Machine& stated, const SyntheticSpec& spec);

/// The truth of a simulation.
struct SyntheticAnswer : SyntheticTruth {
  std::vector<AppliedEffect> hidden;
  /// True position of the tool at each point of the grid, in the bed's frame.
  std::vector<BedPoint> places;
  /// Readings at each point without noise and gross errors.
  std::vector<ChainLengths> lengths;
  /// Indices into the points: gross errors and miscounted links.
  Indices bad_points;
  std::uint64_t seed = 0;
};

struct SyntheticSession {
  /// Its machine is the stated one.
  MeasuredGrid grid;
  SyntheticAnswer answer;
};

/// A mark that the machine cannot reach.
using UnreachableMark = Failure<model::PoseReason, MarkPoint>;

/// \throws std::invalid_argument for a machine or hidden effects with problems (check with
/// problems_of and effects::problems_of_effects on true_machine()), and as marks().
[[nodiscard]] tl::expected<SyntheticSession, UnreachableMark> generate(
    const Machine& stated, const SyntheticSpec& spec, const Progress& progress = {});

/// Readings at given true positions, visited in the order of their numbers, without noise and with
/// all digits. The marks of the grid include the paper effects.
struct PlacesRead {
  MeasuredGrid grid;
  /// Positions that cannot be reached; they are not in the grid and the session.
  std::vector<std::pair<std::size_t, model::PoseReason>> unreachable;
};
PlacesRead read_places(const Machine& stated, const std::vector<AppliedEffect>& hidden,
                       const std::vector<model::Visit>& visits,
                       model::Model model = model::Model::elastic, const Progress& progress = {});

}  // namespace chaintrue::grid::synthetic
