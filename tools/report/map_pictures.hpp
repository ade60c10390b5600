// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The charts of a compensation map from plain data: before and after on the bed, the gain of each
/// step, the expected error, every point predicted without itself.
///
/// All vectors are the tool's actual less its intended position, in mm, x right and y up. "Held out"
/// means that the point was predicted by a map fitted without it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/bed_chart.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::report {

/// A measured point.
struct ReportPoint {
  std::string name{};  ///< "point 7"
  /// True position of the tool, in the page's frame.
  double x_mm = 0.0;
  double y_mm = 0.0;
  /// With the machine as stated.
  std::optional<ToolVector> before{};
  /// With the machine calibrated and the residual surface added.
  std::optional<ToolVector> after{};
  std::optional<ToolVector> held_out{};
  /// The held-out error in sigmas.
  double held_out_sigmas = 0.0;
  /// The fit gave this point little or no weight.
  bool is_bad = false;
};

/// Expected error (one sigma at the tool) of one cell of a regular raster.
struct ErrorCell {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double error_mm = 0.0;
  std::string coverage{};  ///< inside, edge or extrapolated; cells outside are left out
};
struct ErrorMap {
  double cell_width_mm = 0.0;
  double cell_height_mm = 0.0;
  std::vector<ErrorCell> cells{};
};

/// One step on the way to the map, with the tool error that remains after it.
struct ErrorStep {
  enum class Kind { before, after, reference };
  Kind kind = Kind::after;
  std::string
      what{};  ///< "machine as stated", "points left out one at a time", "noise of the readings"
  double rms_mm = 0.0;
  std::optional<double> max_mm{};
  std::string note{};  ///< what the figure is relative to
};

struct MapPictures {
  Outline sheet{};
  /// In the order of the work; the last may be the noise.
  std::vector<ErrorStep> steps{};
  std::vector<ReportPoint> points{};
  /// Description of the points' `before`.
  std::string before_what{"the machine file as it was"};
  std::optional<ErrorMap> error_map{};
  /// Rms of the held-out errors, drawn as a line and a ring.
  double held_out_rms_mm = 0.0;
  /// The noise of the readings at the tool; 0: not drawn.
  double noise_floor_mm = 0.0;
};

/// The expected error over the bed. \throws as picture_sections; std::invalid_argument without an
/// error map.
Chart error_map_chart(const MapPictures& map);

/// Sections without data are left out. \throws std::invalid_argument if the sheet has no extent.
std::vector<Section> picture_sections(const MapPictures& map);

}  // namespace chaintrue::report
