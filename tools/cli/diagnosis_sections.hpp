// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A diagnosis as a document for the terminal and for a browser: the answer first, then its basis.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/coordinates.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/document.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using diagnosis::Cause;
using diagnosis::Hypothesis;
using diagnosis::LeftOver;
using diagnosis::MeasurementKind;
using diagnosis::Observations;
using diagnosis::Outlier;
using diagnosis::PointPicture;
using diagnosis::Verdict;
using report::number_column;
using report::text_column;

/// `source` is the input file's name, for the page's last line. Pictures are made if `detail` is
/// page.
Document diagnosis_document(const Diagnosis& diagnosis, std::string_view source,
                            Detail detail = Detail::page);

/// Every section is made from the diagnosis alone.
using SectionOf = Section(const Diagnosis& found);

/// The parts of the error. Precondition: the diagnosis has a budget.
SectionOf budget_section;
/// The named causes with size, probability and remedy. Precondition: a cause is named.
SectionOf causes_section;
/// Possible variables of the rest. Precondition: some law is reported.
SectionOf laws_section;
/// The result for each declared effect. Precondition: there are some.
SectionOf declared_section;
/// The next measurements, numbered. Precondition: there are some.
SectionOf next_section;
/// The relevant hypotheses, and the remainder.
SectionOf probabilities_section;
SectionOf settings_section;
SectionOf outliers_section;
/// Causes that were looked for and are absent.
SectionOf bounds_section;
SectionOf not_testable_section;
/// Assumptions, noise and corrections of the data.
SectionOf remarks_section;

/// The tool, or the distances, before and with the causes. Precondition of this and the next two:
/// readings.
SectionOf arrows_section;
/// The measured residuals, and those that the cause and its rival predict. Precondition: a cause is
/// named.
SectionOf signature_section;
/// Residuals against lengths, angles and visits.
SectionOf residuals_section;

// The gain of naming: errors at held-out points and distances.

/// Precondition: the diagnosis has a gain.
SectionOf improvement_section;
/// On the points of another grid. Precondition: there is one.
SectionOf transfer_section;
/// For both; empty if there is no gain.
Light corrected_light(const Diagnosis& found);
std::vector<Figure> figures_of_improvement(const Diagnosis& found);

// Sections specific to a diagnosis of four belts. Precondition of all: it is one of belts.

/// The frame with its residuals, before and with the causes.
SectionOf frame_section;
/// The anchors before and with the causes.
SectionOf anchors_section;
/// Errors of the belts and of the tool, before and with the causes.
SectionOf belts_improvement_section;
Light scale_light(const Diagnosis& found);
std::vector<Figure> figures_of_belts(const Diagnosis& found);

// The section on the verdict without some of the readings.

/// Which readings influence the name. Precondition: the diagnosis has a stability.
SectionOf stability_section;

// Sections specific to a diagnosis of a test drawing. Precondition of all: it is one of a drawing.

/// The settings in force and as estimated with the causes.
SectionOf drawn_settings_section;
/// The measures, and their prediction by settings and causes.
SectionOf drawn_measures_section;
Light drawn_settings_light(const Diagnosis& found);

// The pictures of a diagnosis' page. Residuals are measured less predicted; vermilion is before,
// blue is with the causes named.
// The places on the bed are drawn in diagnosis_charts.cpp, what the residuals follow in
// diagnosis_scatter_charts.cpp, the causes alone in diagnosis_pictures.cpp.
/// The bed of the machine as found, about its middle.
report::Outline bed_of(const Diagnosis& found);
/// A point's error of the tool, with one sigma of its noise.
Arrow arrow_of(const PointPicture& point, const Eigen::Vector2d& shift_mm);
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
Chart frame_chart(const BeltsFindings& found, std::string title,
                  PerBelt<double> BeltPlacePicture::*which);

// A diagnosis in the words and units of a workshop, for the terminal and for the report's page.
/// "chain pitch error, left"
std::string cause_title(const diagnosis::CauseId& cause);
std::string cause_title(const AppliedEffect& effect);
/// Named causes that are neither in the diagnosis' machine nor in the corrected data: rivals of
/// those that are, and causes that may be the tape's.
std::vector<Cause> causes_left_out(const Diagnosis& found);
/// Also accepts the hypotheses nothing, unknown, noise and bad_points.
std::string hypothesis_title(const Hypothesis& hypothesis);

/// "point 17", counted from 1.
std::string point_name(std::size_t index);
/// "distance A-B", by its position in the file.
std::string distance_name(const Diagnosis& found, std::size_t index);
/// Whether distances between holes were measured instead of points.
bool is_of_distances(const Diagnosis& found);
/// A bound in a workshop unit.
std::string bound_in_words(const diagnosis::Bound& bound);
/// Noise alone gives as much in less than one of a hundred cases.
bool is_surprising(const LeftOver& left_over);
/// A sentence on the residual with the named causes.
std::string left_over_sentence(const LeftOver& left_over);
/// The files of a diagnosis, as named in a command: GRID, HOLES, both, or BELTS.
std::string_view files_in_words(const Diagnosis& found);

/// The data: "34 points", "20 distances", "34 points and 20 distances", "99 places".
std::string readings_counted(const Diagnosis& found);
/// Whether this outlier is a distance rather than a point.
bool is_distance(const Diagnosis& found, const Outlier& bad);
/// " A single right name then has probability 95 %." of the next measurement with that position;
/// empty if it determines the scale of belts, which does not discriminate between causes.
std::string chance_then(const Diagnosis& diagnosis, std::size_t position);
/// The next measurements as sentences: what to do, where, and how well.
Words follow_ups_in_words(const Diagnosis& diagnosis);
/// Their places, each once: "3, 6" where the third and the sixth are at one mark.
struct FollowUpPlace {
  std::string numbers;
  MarkPoint mark;
  std::string what;
  double raises_probability_to = 0.0;
};
std::vector<FollowUpPlace> follow_up_places(const Diagnosis& diagnosis);

using diagnosis::off_in_words;
using diagnosis::percent;
using diagnosis::sizes_in_words;
/// "the top left belt at point 17: read 80.2 mm too long (31.0 sigmas)"
std::string bad_belt_in_words(const Outlier& bad);
using report::capitalised;
using report::fixed;

/// "left" or "right".
inline const char* chain_name(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace chaintrue::cli
