// SPDX-License-Identifier: GPL-3.0-or-later
// What a diagnosis found on four belts, and on a drawing.
#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using diagnosis::DiagnosedCoordinate;

constexpr Range kPerMetre{"mm per metre", 0.0, 1e4};
constexpr int kMostVisits = 1000000000;

auto diagnosed_coordinate_record() {
  RECORD(DiagnosedCoordinate, "a coordinate of an anchor with causes")
  NAMED(required, "coordinate", name, "Which coordinate of which anchor.",
        one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
  OPTIONAL(stated_mm, "Value in the belts' file.", kMillimetres)
  REQUIRED(before_mm, "Fitted with the anchors alone.", kMillimetres)
  REQUIRED(fitted_mm, "Fitted with the named causes.", kMillimetres)
  REQUIRED(sigma_mm, "Uncertainty of that, 1 sigma.", kSigmaMm);
}

auto belt_place_record() {
  const auto numbers = per_belt_record<double>(number(kAnyNumber));
  RECORD(BeltPlacePicture, "a place with its belts")
  FIELD(place, &BeltPlacePicture::at, "x of the tool in the anchors' frame, with the causes.",
        "y of the tool in the anchors' frame, up, with the causes.", kMillimetres)
  OPTIONAL(order, "Number of the visit.", integer(-kMostVisits, kMostVisits))
  REQUIRED(before_mm, "Reading minus fitted value of each belt, with the anchors alone.", numbers)
  REQUIRED(after_mm, "The same with the causes.", numbers)
  REQUIRED(bad, "True if the reading was left out.", per_belt_record<bool>(boolean()));
}

auto tool_record() {
  RECORD(diagnosis::ToolError, "the tool's error")
  OPTIONAL(stated_mm,
           "Rms over the measured places with the anchors in force, including the "
           "uncertainty from the readings; 0 if no anchors are in force.",
           kSigmaMm)
  REQUIRED(before_mm, "The same with the anchors fitted alone.", kSigmaMm)
  REQUIRED(after_mm, "Uncertainty from the readings, with the causes.", kSigmaMm)
  OPTIONAL(scale_mm_per_m, "Uncertainty of a metre, 1 sigma, if a tape determines the scale.",
           kPerMetre);
}

auto second_pass_record() {
  RECORD(diagnosis::SecondPass, "a second pass")
  REQUIRED(times, "Tension relative to the first pass.", {"", 1.0, 100.0})
  REQUIRED(raises_probability_to, "Probability of a single right name afterwards.", kShare);
}

auto drawn_setting_record() {
  RECORD(diagnosis::DrawnSetting, "a setting of a plotter")
  REQUIRED(name, "Name of the parameter, with its unit.")
  REQUIRED(set, "Value in the controller.", kAnyNumber)
  REQUIRED(found, "Value estimated from the drawing together with the named causes.", kAnyNumber)
  REQUIRED(sigma, "Uncertainty of that, 1 sigma.", kNotNegative)
  REQUIRED(off, "True if the two differ by more than three sigmas.");
}

auto drawn_value_record() {
  RECORD(diagnosis::DrawnValue, "a measure of a drawing")
  REQUIRED(name, "The length or the bow, by its crosses.")
  REQUIRED(measured_mm, "The reading.", kAnyNumber)
  REQUIRED(explained_mm, "The value predicted by the estimated settings and the named causes.",
           kAnyNumber)
  REQUIRED(rejected, "True if it contradicts the others and was left out.");
}

}  // namespace

Record<BeltsFindings> belts_findings_record() {
  RECORD(BeltsFindings, "results for four belts")
  REQUIRED(machine, "The machine, with anchors fitted together with the causes.",
           belt_machine_record())
  REQUIRED(coordinates, "The five free coordinates of the frame.",
           exactly<5>(object(diagnosed_coordinate_record()), "five coordinates"))
  REQUIRED(spread_before_mm, "Rms of one belt's reading over the checks, anchors alone.", kSigmaMm)
  NAMED(required, "spread_mm", residual_sigma_mm, "The same with the causes.", kSigmaMm)
  REQUIRED(rms_before_mm, "Rms over all readings, as in the machine's own message; anchors alone.",
           kSigmaMm)
  REQUIRED(rms_mm, "The same with the causes.", kSigmaMm)
  REQUIRED(checks, "Readings minus unknowns, which include the sizes of causes.",
           integer(1, 1000000))
  NAMED(optional, "foretold_before", prediction_before,
        "Lower belts predicted from the upper two, each half of the places from the "
        "other; anchors alone.",
        prediction_record())
  NAMED(optional, "foretold", prediction,
        "The same with the causes, their sizes fitted to each half.", prediction_record())
  REQUIRED(tool, "Error of the tool, with free position and rotation of the frame.", tool_record())
  OPTIONAL(scale, "True length divided by the belts' length, if a tape determines it.",
           scale_record())
  OPTIONAL(firmware_fit, "The machine's report of its own fit.", firmware_fit_record())
  OPTIONAL(second_pass,
           "All places measured again with more tension, if nothing less separates the causes.",
           second_pass_record())
  REQUIRED(places, "Each place, in the order of the file.", belt_place_record());
}

Record<diagnosis::DrawingFindings> drawing_findings_record() {
  RECORD(diagnosis::DrawingFindings, "results for a drawing")
  REQUIRED(plotter, "Name of the plotter.")
  REQUIRED(settings, "All settings of the controller.", drawn_setting_record())
  REQUIRED(measures, "The measures of the drawing, in order.", drawn_value_record());
}

}  // namespace chaintrue::grid::files
