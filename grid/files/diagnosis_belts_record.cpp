// SPDX-License-Identifier: GPL-3.0-or-later
// The results from belts in a chaintrue_diagnosis file.
#include <algorithm>

#include <fmt/format.h>

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

/// Shared with chaintrue_anchors, which has a value for each belt as well.
constexpr Range kPerMetre{"mm a metre", 0.0, 1e4};
constexpr int kMostVisits = 1000000000;

const Record<DiagnosedCoordinate>& diagnosed_coordinate_record() {
  static const auto record =
      Record<DiagnosedCoordinate>("a coordinate of an anchor with causes")
          .required("coordinate",
                    &DiagnosedCoordinate::name,
                    one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
          .optional("stated_mm", &DiagnosedCoordinate::stated_mm, number(kMillimetres))
          .required("before_mm", &DiagnosedCoordinate::before_mm, number(kMillimetres))
          .required("fitted_mm", &DiagnosedCoordinate::fitted_mm, number(kMillimetres))
          .required("sigma_mm", &DiagnosedCoordinate::sigma_mm, number(kSigmaMm));
  return record;
}

const Record<BeltPlacePicture>& belt_place_record() {
  static const auto record = [] {
    Record<BeltPlacePicture> place("a place with its belts");
    const auto coordinate = [&](const char* key, double model::FramePoint::*member) {
      place.custom(
          key,
          true,
          {kMillimetres.expected(), [] { return number_schema(kMillimetres); }},
          [member](const Cursor& at, BeltPlacePicture& p) {
            if (const auto value = at.number(kMillimetres)) p.at.*member = *value;
          },
          [member](const BeltPlacePicture& p) { return std::optional<Json>(p.at.*member); });
    };
    coordinate("x_mm", &model::FramePoint::x_mm);
    coordinate("y_mm", &model::FramePoint::y_mm);
    place.optional("order", &BeltPlacePicture::order, integer(-kMostVisits, kMostVisits))
        .required("before_mm",
                  &BeltPlacePicture::before_mm,
                  object(per_belt_record<double>(number(kAnyNumber))))
        .required("after_mm",
                  &BeltPlacePicture::after_mm,
                  object(per_belt_record<double>(number(kAnyNumber))))
        .required("bad", &BeltPlacePicture::bad, object(per_belt_record<bool>(boolean())));
    return place;
  }();
  return record;
}

const Record<ToolError>& tool_record() {
  static const auto record =
      Record<ToolError>("the tool's error")
          .optional("stated_mm", &ToolError::stated_mm, number(kSigmaMm))
          .required("before_mm", &ToolError::before_mm, number(kSigmaMm))
          .required("after_mm", &ToolError::after_mm, number(kSigmaMm))
          .optional("scale_mm_per_m", &ToolError::scale_mm_per_m, number(kPerMetre));
  return record;
}

const Record<SecondPass>& second_pass_record() {
  static const auto record =
      Record<SecondPass>("a second pass")
          .required("times", &SecondPass::times, number({"", 1.0, 100.0}))
          .required("raises_probability_to", &SecondPass::raises_probability_to, number(kShare));
  return record;
}

void read_diagnosed_coordinates(const Cursor& at, BeltsFindings& found) {
  const auto read = list(object(diagnosed_coordinate_record())).read(at);
  if (!read) return;
  if (read->size() != found.coordinates.size()) {
    at.problems().add(at.pointer(),
                      fmt::format("{} of them", read->size()),
                      "five coordinates",
                      ProblemKind::wrong_count);
    return;
  }
  std::copy(read->begin(), read->end(), found.coordinates.begin());
}

std::optional<Json> written_coordinates(const BeltsFindings& found) {
  Json all = Json::array();
  for (const DiagnosedCoordinate& c : found.coordinates)
    all.push_back(diagnosed_coordinate_record().write(c));
  return all;
}

}  // namespace

const Record<BeltsFindings>& belts_findings_record() {
  static const auto record = [] {
    Record<BeltsFindings> found("what belts tell");
    found.required("machine", &BeltsFindings::machine, object(belt_machine_record()))
        .custom(
            "coordinates",
            true,
            {"five coordinates", list(object(diagnosed_coordinate_record()), 5).expected.schema},
            read_diagnosed_coordinates,
            written_coordinates)
        .required("spread_before_mm", &BeltsFindings::spread_before_mm, number(kSigmaMm))
        .required("spread_mm", &BeltsFindings::residual_sigma_mm, number(kSigmaMm))
        .required("rms_before_mm", &BeltsFindings::rms_before_mm, number(kSigmaMm))
        .required("rms_mm", &BeltsFindings::rms_mm, number(kSigmaMm))
        .required("checks", &BeltsFindings::checks, integer(1, 1000000))
        .optional("foretold_before", &BeltsFindings::prediction_before, object(prediction_record()))
        .optional("foretold", &BeltsFindings::prediction, object(prediction_record()))
        .required("tool", &BeltsFindings::tool, object(tool_record()))
        .optional("scale", &BeltsFindings::scale, object(scale_record()))
        .optional("firmware_fit", &BeltsFindings::firmware_fit, object(firmware_fit_record()))
        .optional("second_pass", &BeltsFindings::second_pass, object(second_pass_record()))
        .required("places", &BeltsFindings::places, list(object(belt_place_record())));
    return found;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
