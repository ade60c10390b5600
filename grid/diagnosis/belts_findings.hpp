// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of four belts finds beyond causes and their probabilities: anchors with the causes
/// with them, what one belt's reading is off by, what the upper two belts predict of the lower ones,
/// and where the tool is. All "before" with the anchors fitted alone, as the machine itself does, and
/// after with the causes named; but anchors are averaged over all that may act, as a fit
/// has them (averaged_anchors.hpp). In mm of the belts: their scale is not known without a tape.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid::diagnosis {

/// One of tl_x_mm, tl_y_mm, tr_x_mm, tr_y_mm, br_x_mm.
struct DiagnosedCoordinate {
  std::string name;
  std::optional<double> stated_mm;
  double before_mm = 0.0;
  double fitted_mm = 0.0;
  double sigma_mm = 0.0;
};

/// A place in the pictures: read less fitted, of each belt.
struct BeltPlacePicture {
  model::FramePoint at;  ///< with the causes and the anchors
  std::optional<int> order;
  model::PerBelt<double> before_mm;
  model::PerBelt<double> after_mm;
  model::PerBelt<bool> bad;  ///< set aside
};

/// How far off the tool is from where the machine believes it, the upper two belts deciding: over the
/// places that were measured. What the readings leave uncertain of the true anchors is in each.
struct ToolError {
  double stated_mm = 0.0;  ///< rms with the anchors as stated; 0 where none are
  double before_mm = 0.0;  ///< rms, anchors fitted alone
  double after_mm = 0.0;   ///< rms of what the readings leave uncertain, causes with the anchors
  /// One sigma of what a metre is longer or shorter by; empty where nothing taped tells it.
  std::optional<double> scale_mm_per_m;
};

/// All places measured once more with the belts pulled harder.
struct SecondPass {
  double times = 1.0;  ///< as hard
  /// Probability that the right cause is then named alone.
  double raises_probability_to = 0.0;
};
/// What to do, and what it is worth.
[[nodiscard]] std::string in_words(const SecondPass& pass);

struct BeltsFindings {
  model::BeltMachine machine;  ///< with the anchors fitted with the causes
  std::array<DiagnosedCoordinate, 5> coordinates;
  /// sqrt(sum r^2 / checks): what one belt's reading is off by.
  double spread_before_mm = 0.0;
  double residual_sigma_mm = 0.0;
  /// Over all readings, none set aside, as the machine's own message counts.
  double rms_before_mm = 0.0;
  double rms_mm = 0.0;
  int checks = 0;
  std::optional<BeltPrediction> prediction_before;  ///< either half of the places by the other
  std::optional<BeltPrediction> prediction;
  ToolError tool;
  std::optional<BeltScale> scale;
  std::optional<FirmwareFit> firmware_fit;
  std::vector<BeltPlacePicture> places;  ///< in the order of the file
  std::optional<SecondPass> second_pass;  ///< where it parts what nothing less does
};

}  // namespace chaintrue::grid::diagnosis
