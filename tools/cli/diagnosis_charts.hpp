// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The pictures of a diagnosis' page. Residuals are measured less predicted; vermilion is before,
/// blue is with the causes named.
/// The places on the bed are drawn in diagnosis_charts.cpp, what the residuals follow in
/// diagnosis_scatter_charts.cpp, the causes alone in diagnosis_pictures.cpp.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The bed of the machine as found, about its middle.
report::Outline bed_of(const Diagnosis& found);
/// A point's error of the tool, with one sigma of its noise.
Arrow arrow_of(const diagnosis::PointPicture& point, const Eigen::Vector2d& shift_mm);
/// Titles for the causes named, and for the first one's rival, which it must have. Precondition: a cause is named.
std::string title_of_causes(const Diagnosis& found);
std::string title_of_rival(const Diagnosis& found);

/// True if the visits of all points are numbered.
bool has_order(const Diagnosis& found);
/// The follow-up's places on the bed.
Chart next_points_chart(const Diagnosis& found);

// A picture of each named cause: the shift of the tool at the measured places by this cause alone,
// at its fitted size (synthetic::signature of the machine without it). First order, as signature()
// is; settings are not refitted.

/// In the order of the causes; without those that put a measured place out of reach or, in a file,
/// have impossible numbers. Empty for belts.
std::vector<Chart> cause_charts(const Diagnosis& found);

// The pictures of a diagnosis whose readings are distances between holes: one line for each
// distance, vermilion if read longer than predicted, blue if shorter, with a width proportional to
// the residual.

/// The calibrated machine next to the machine with the named causes.
Chart distance_chart(const Diagnosis& found);
/// Measured, best cause, rival, remainder. Precondition: a cause is named.
Chart distance_strip_chart(const Diagnosis& found);
/// Residuals against the distance's length, and against the way it was measured.
ChartRow distance_scatter_charts(const Diagnosis& found);
/// What was measured, in grey, and what to measure next.
Chart next_distances_chart(const Diagnosis& found);

// A chart of residuals against a possible cause: dots of two colours and a curve.

struct ResidualDot {
  std::string name;
  double x = 0.0;
  double y_mm = 0.0;
  bool is_first = true;  ///< of the first colour
  bool is_bad = false;
};

struct ResidualScatter {
  std::string title{};
  std::string caption{};
  std::string x_title{};
  std::vector<ResidualDot> dots{};
  std::vector<std::pair<double, double>> curve{};  ///< x and mm
  std::vector<double> y_also_mm{};  ///< in the window, like good dots, 0 and the curve
  double least_span_mm = 0.2;       ///< of the window
  std::string first_label{};
  std::string second_label{};  ///< empty: one colour
  const char* first_color = report::kBeforeColor;
  const char* second_color = report::kAfterColor;
};

/// Bad dots are drawn at the rim, so that they do not flatten the rest.
Chart residual_scatter_chart(const ResidualScatter& scatter);

// The drawing of a four-belt frame: anchors with their ellipses, and at each place a stroke for each
// belt as long as its residual.

inline constexpr const char* kFrameCaption =
    "Each stroke follows its belt, in that anchor's colour: towards the anchor if the belt reads "
    "long, away from it if it reads short. Circled: left out.";

inline constexpr const char* kAnchorsCaption =
    "From the bottom left anchor, x to the bottom right one: tl is the top left anchor. Sigma: one "
    "standard deviation.";
/// "tl x" of tl_x_mm
inline std::string coordinate_title(const std::string& name) {
  return name.substr(0, 2) + " " + name.substr(3, 1);
}

/// All strokes of the same findings have one scale.
Chart frame_chart(const diagnosis::BeltsFindings& found, std::string title,
                  model::PerBelt<double> diagnosis::BeltPlacePicture::*which);

}  // namespace chaintrue::cli
