// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of four belts finds besides causes and their probabilities: anchors, the error
/// of one belt's reading, the prediction of the lower belts by the upper two, and the tool's
/// position. "Before" is with the anchors fitted alone, as the machine does; "after" is with the
/// named causes. Anchors are averaged over all possible causes, as in a fit (belts_analysis.hpp).
/// In the belts' mm: their scale is unknown without a tape.
#pragma once

#include <array>
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
  FramePoint at;  ///< with the causes and the anchors
  std::optional<int> order;
  PerBelt<double> before_mm;
  PerBelt<double> after_mm;
  PerBelt<bool> bad;  ///< rejected
};

/// The distance of the tool from its believed position by the upper two belts, over the measured
/// places. Each includes the remaining uncertainty of the true anchors.
struct ToolError {
  double stated_mm = 0.0;  ///< rms with the stated anchors; 0 if none are stated
  double before_mm = 0.0;  ///< rms, anchors fitted alone
  double after_mm = 0.0;   ///< rms of the remaining uncertainty, causes and anchors
  /// One sigma of the scale per metre; empty if no tape determines it.
  std::optional<double> scale_mm_per_m;
};

/// All places measured again with the belts pulled harder.
struct SecondPass {
  double times = 1.0;  ///< factor on the pull
  /// Probability that the right cause is then named alone.
  double raises_probability_to = 0.0;
};
/// A proposed measurement, and its value.
std::string in_words(const SecondPass& pass);

struct BeltsFindings {
  BeltMachine machine;  ///< with the anchors fitted with the causes
  std::array<DiagnosedCoordinate, 5> coordinates;
  /// sqrt(sum r^2 / checks): the error of one belt's reading.
  double spread_before_mm = 0.0;
  double residual_sigma_mm = 0.0;
  /// Over all readings, including rejected ones, as in the machine's own message.
  double rms_before_mm = 0.0;
  double rms_mm = 0.0;
  int checks = 0;
  std::optional<BeltPrediction> prediction_before;  ///< either half of the places by the other
  std::optional<BeltPrediction> prediction;
  ToolError tool;
  std::optional<BeltScale> scale;
  std::optional<FirmwareFit> firmware_fit;
  std::vector<BeltPlacePicture> places;   ///< in the order of the file
  std::optional<SecondPass> second_pass;  ///< if it separates causes that nothing less separates
};

}  // namespace chaintrue::grid::diagnosis
