// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using diagnosis::DiagnosedCoordinate;
using diagnosis::SecondPass;
using diagnosis::ToolError;

constexpr Range kPerMetre{"mm per metre", 0.0, 1e4};
constexpr int kMostVisits = 1000000000;

auto diagnosed_coordinate_record() {
  return Record<DiagnosedCoordinate>("a coordinate of an anchor with causes")
      .required("coordinate",
                "Which coordinate of which anchor.",
                &DiagnosedCoordinate::name,
                one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
      .optional(
          "stated_mm", "Value in the belts' file.", &DiagnosedCoordinate::stated_mm, kMillimetres)
      .required("before_mm",
                "Fitted with the anchors alone.",
                &DiagnosedCoordinate::before_mm,
                kMillimetres)
      .required("fitted_mm",
                "Fitted with the named causes.",
                &DiagnosedCoordinate::fitted_mm,
                kMillimetres)
      .required(
          "sigma_mm", "Uncertainty of that, 1 sigma.", &DiagnosedCoordinate::sigma_mm, kSigmaMm);
}

auto belt_place_record() {
  const auto numbers = per_belt_record<double>(number(kAnyNumber));
  return Record<BeltPlacePicture>("a place with its belts")
      .place(&BeltPlacePicture::at,
             "x of the tool in the anchors' frame, with the causes.",
             "y of the tool in the anchors' frame, up, with the causes.",
             kMillimetres)
      .optional("order",
                "Number of the visit.",
                &BeltPlacePicture::order,
                integer(-kMostVisits, kMostVisits))
      .required("before_mm",
                "Reading minus fitted value of each belt, with the anchors alone.",
                &BeltPlacePicture::before_mm,
                numbers)
      .required("after_mm", "The same with the causes.", &BeltPlacePicture::after_mm, numbers)
      .required("bad",
                "True if the reading was left out.",
                &BeltPlacePicture::bad,
                per_belt_record<bool>(boolean()));
}

auto tool_record() {
  return Record<ToolError>("the tool's error")
      .optional("stated_mm",
                "Rms over the measured places with the anchors in force, including the "
                "uncertainty from the readings; 0 if no anchors are in force.",
                &ToolError::stated_mm,
                kSigmaMm)
      .required(
          "before_mm", "The same with the anchors fitted alone.", &ToolError::before_mm, kSigmaMm)
      .required("after_mm",
                "Uncertainty from the readings, with the causes.",
                &ToolError::after_mm,
                kSigmaMm)
      .optional("scale_mm_per_m",
                "Uncertainty of a metre, 1 sigma, if a tape determines the scale.",
                &ToolError::scale_mm_per_m,
                kPerMetre);
}

auto second_pass_record() {
  return Record<SecondPass>("a second pass")
      .required(
          "times", "Tension relative to the first pass.", &SecondPass::times, {"", 1.0, 100.0})
      .required("raises_probability_to",
                "Probability of a single right name afterwards.",
                &SecondPass::raises_probability_to,
                kShare);
}

}  // namespace

Record<BeltsFindings> belts_findings_record() {
  Record<BeltsFindings> found("results for four belts");
  found
      .required("machine",
                "The machine, with anchors fitted together with the causes.",
                &BeltsFindings::machine,
                belt_machine_record())
      .required("coordinates",
                "The five free coordinates of the frame.",
                &BeltsFindings::coordinates,
                exactly<5>(object(diagnosed_coordinate_record()), "five coordinates"))
      .required("spread_before_mm",
                "Rms of one belt's reading over the checks, anchors alone.",
                &BeltsFindings::spread_before_mm,
                kSigmaMm)
      .required(
          "spread_mm", "The same with the causes.", &BeltsFindings::residual_sigma_mm, kSigmaMm)
      .required("rms_before_mm",
                "Rms over all readings, as in the machine's own message; anchors alone.",
                &BeltsFindings::rms_before_mm,
                kSigmaMm)
      .required("rms_mm", "The same with the causes.", &BeltsFindings::rms_mm, kSigmaMm)
      .required("checks",
                "Readings minus unknowns, which include the sizes of causes.",
                &BeltsFindings::checks,
                integer(1, 1000000))
      .optional("foretold_before",
                "Lower belts predicted from the upper two, each half of the places from the "
                "other; anchors alone.",
                &BeltsFindings::prediction_before,
                prediction_record())
      .optional("foretold",
                "The same with the causes, their sizes fitted to each half.",
                &BeltsFindings::prediction,
                prediction_record())
      .required("tool",
                "Error of the tool, with free position and rotation of the frame.",
                &BeltsFindings::tool,
                tool_record())
      .optional("scale",
                "True length divided by the belts' length, if a tape determines it.",
                &BeltsFindings::scale,
                scale_record())
      .optional("firmware_fit",
                "The machine's report of its own fit.",
                &BeltsFindings::firmware_fit,
                firmware_fit_record())
      .optional(
          "second_pass",
          "All places measured again with more tension, if nothing less separates the causes.",
          &BeltsFindings::second_pass,
          second_pass_record())
      .required("places",
                "Each place, in the order of the file.",
                &BeltsFindings::places,
                belt_place_record());
  return found;
}

}  // namespace chaintrue::grid::files
