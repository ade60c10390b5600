// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a compensation map's report says, as plain data: the caller fills it, page_of() lays it
/// out.
///
/// All vectors are where the tool lands minus where it should, at the tool, in mm, x right and y
/// up. "Held out" means that the point was predicted by a map made without it.
///
/// \code
///   MapReport report{.name = "workshop grid", .verdict = "Expect 0.21 mm at the tool."};
///   report.points.push_back({.name = "point 1", .x_mm = -1200, .y_mm = -600, .before = {1.9, 0.4},
///                            .after = {0.1, 0.0}, .held_out = {{0.2, 0.1}}});
///   write_file("report.html", render_html(page_of(report)));
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/bed_chart.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::report {

/// An error at the tool.
struct ToolVector {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

struct ReportPoint {
  std::string name{};  ///< "point 7"
  /// Where the tool truly stood, in the frame of the page.
  double x_mm = 0.0;
  double y_mm = 0.0;
  /// With the machine as stated.
  std::optional<ToolVector> before{};
  /// With the machine calibrated and the residual surface added.
  std::optional<ToolVector> after{};
  std::optional<ToolVector> held_out{};
  /// How surprising the held-out error is, in sigmas.
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

/// One setting as the person stated it and as the points calibrate it.
struct ReportSetting {
  std::string name{};  ///< in words: "left motor, x"
  std::string unit{};  ///< "mm" or "mrad"
  double stated = 0.0;
  double calibrated = 0.0;
  double sigma = 0.0;
  /// One sigma of what was stated; 0: not said.
  double stated_sigma = 0.0;
  /// Further from what was stated than its uncertainty allows.
  bool is_off = false;
};

/// One step on the way to the map, with the error at the tool that is left there.
struct ErrorStep {
  enum class Kind { before, after, reference };
  Kind kind = Kind::after;
  std::string
      what{};  ///< "machine as stated", "points left out one at a time", "noise of the readings"
  double rms_mm = 0.0;
  std::optional<double> max_mm{};
  std::string note{};  ///< what the figure is relative to
};

struct MapReport {
  std::string name{};
  std::string machine_name{};
  Outline sheet{};

  std::string verdict{};
  Tone tone = Tone::good;
  std::vector<std::string> advice{};
  std::string not_proved{};

  std::vector<Figure> figures{};
  /// In the order of the work; the last may be the noise floor.
  std::vector<ErrorStep> steps{};
  std::vector<ReportPoint> points{};
  /// What the points' `before` is: "the machine as stated".
  std::string before_what{"the machine as stated"};
  std::optional<ErrorMap> error_map{};
  /// Rms of the held-out errors, drawn as a line and a ring; 0: computed from the points.
  double held_out_rms_mm = 0.0;
  /// What the readings' own noise amounts to at the tool; 0: not drawn.
  double noise_floor_mm = 0.0;
  std::vector<ReportSetting> settings{};
  /// More findings, one paragraph each: the mirror test, what was assumed, which points were bad.
  std::vector<std::string> findings{};
  std::string provenance{};
};

/// The expected error over the bed as a chart. \throws as page_of; std::invalid_argument without an
/// error map.
[[nodiscard]] Chart error_map_chart(const MapReport& report);

/// Lays the report out as a page; sections without data are left out.
/// \throws std::invalid_argument where the sheet has no extent, or a number is not finite.
[[nodiscard]] Document page_of(const MapReport& report);

}  // namespace chaintrue::report
