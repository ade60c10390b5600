// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, and what
// to measure next.

#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/reading_record.hpp"
#include "grid/files/record_values.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::files {

namespace {

using diagnosis::DistancePicture;
using diagnosis::HolePicture;
using diagnosis::MeasurementKind;
using diagnosis::NextMeasurement;
using diagnosis::PointPicture;

constexpr Range kRad{"rad", -10.0, 10.0};
constexpr Range kNewton{"N", -1e6, 1e6};

/// Two numbers, as [first, second].
template <class T>
void pair_key(Record<T>& record,
              const char* key,
              const char* meaning,
              const Range& range,
              MemberPath<T, double> first,
              MemberPath<T, double> second) {
  record.computed(
      key,
      meaning,
      true,
      pair_of_numbers(range),
      [=](T& object, const Eigen::Vector2d& pair) {
        first.of(object) = pair[0];
        second.of(object) = pair[1];
      },
      [=](const T& object) { return Eigen::Vector2d(first.of(object), second.of(object)); });
}

template <class T>
void place_keys(Record<T>& record) {
  record
      .required("x_mm",
                "x, to the right of the bed's middle, or of the marks' origin.",
                path(&T::mark, &model::MarkPoint::x_mm),
                kMillimetres)
      .required("y_mm",
                "y, up from the bed's middle, or from the marks' origin.",
                path(&T::mark, &model::MarkPoint::y_mm),
                kMillimetres);
}

}  // namespace

Record<NextMeasurement> next_measurement_record() {
  Record<NextMeasurement> next("a next measurement");
  next.required("kind",
                "A new point, a second visit, a reading of the machine, or a distance.",
                &NextMeasurement::kind,
                choice<MeasurementKind>({{"point", MeasurementKind::point},
                                         {"revisit", MeasurementKind::revisit},
                                         {"reading", MeasurementKind::reading},
                                         {"distance", MeasurementKind::distance}}));
  next.custom(
      "what",
      "The measurement in words.",
      true,
      text().expected,
      [](const Cursor& at, NextMeasurement& object) {
        if (const auto words = text().read(at)) object.words = *words;
      },
      [](const NextMeasurement& object) {
        return std::optional<Json>(object.reading ? Json(std::string(name(*object.reading)))
                                                  : Json(object.words));
      });
  next.nullable("side", "Side of a reading.", &NextMeasurement::side, side_word());
  const auto coordinate = [&next](const char* key,
                                  const char* meaning,
                                  double model::MarkPoint::*member) {
    next.custom(
        key,
        meaning,
        false,
        {"a number in mm", [] { return number_schema(kMillimetres); }},
        [member](const Cursor& at, NextMeasurement& object) {
          const auto value = at.number(kMillimetres);
          if (!value) return;
          if (!object.mark) object.mark.emplace();
          (*object.mark).*member = *value;
        },
        [member](const NextMeasurement& object) {
          return std::optional<Json>(object.mark ? Json((*object.mark).*member) : Json(nullptr));
        });
  };
  coordinate("x_mm", "x of the place.", &model::MarkPoint::x_mm);
  coordinate("y_mm", "y of the place, up.", &model::MarkPoint::y_mm);
  next.required("sigma", "Required accuracy, 1 sigma.", &NextMeasurement::sigma, kNotNegative)
      .required("raises_probability_to",
                "Probability of a single right name afterwards.",
                &NextMeasurement::raises_probability_to,
                kShare)
      .sparse("from",
              "For a distance: the hole at one end; for belts an anchor, point or hole.",
              &NextMeasurement::from)
      .sparse("to", "The other ends.", &NextMeasurement::to, list(text()))
      .sparse("pulled",
              "For a place of four belts: belts that a motor pulls there; default: those for the "
              "frame's orientation.",
              &NextMeasurement::pulled,
              list(belt_word()))
      .check([](const Cursor& at, NextMeasurement& object) {
        const bool is_place =
            object.kind == MeasurementKind::point || object.kind == MeasurementKind::revisit;
        for (const char* key : {"x_mm", "y_mm"}) {
          const Cursor value = at.child(key);
          if (is_place && at.clean() && value.json().is_null()) value.missing("a number in mm");
        }
        if (object.kind != MeasurementKind::reading || !at.clean()) return;
        object.reading = reading_name().read(at.child("what"));
        object.words.clear();
      });
  return next;
}

Record<HolePicture> hole_picture_record() {
  Record<HolePicture> hole("a hole");
  hole.required(
      "name", "Any word; without names the holes are numbered from 0.", &HolePicture::name);
  place_keys(hole);
  pair_key(hole,
           "commanded_mm",
           "Commanded position, [x, y].",
           kMillimetres,
           path(&HolePicture::commanded, &model::MarkPoint::x_mm),
           path(&HolePicture::commanded, &model::MarkPoint::y_mm));
  return hole;
}

Record<DistancePicture> distance_picture_record() {
  return Record<DistancePicture>("a distance")
      .required("index", "Its number in the file.", &DistancePicture::index, index_number())
      .required("from", "A hole's name or number.", &DistancePicture::from)
      .required("to",
                "A hole's name or number, or an edge: left, right, top, bottom.",
                &DistancePicture::to)
      .required("bad", "Left out as wrong.", &DistancePicture::bad)
      .required("read_mm", "The tape reading.", &DistancePicture::read_mm, kMillimetres)
      .required("before_mm",
                "Measured minus predicted by the calibrated machine.",
                &DistancePicture::before_mm,
                kMillimetres)
      .required(
          "after_mm", "The same with the named causes.", &DistancePicture::after_mm, kMillimetres)
      .required("noise_sigma_mm",
                "1 sigma of the noise there.",
                &DistancePicture::noise_sigma_mm,
                kNotNegative)
      .required("best_mm", "Effect of the named cause.", &DistancePicture::best_mm, kMillimetres)
      .required("rival_mm",
                "Effect that the rival would have.",
                &DistancePicture::rival_mm,
                kMillimetres);
}

Record<PointPicture> point_picture_record() {
  Record<PointPicture> point("a point");
  point.required("index", "Its number in the file.", &PointPicture::index, index_number());
  place_keys(point);
  constexpr int kMostOrder = 1000000000;
  const Value<Eigen::Vector2d> pair = pair_of_numbers(kMillimetres);
  point
      .optional("order",
                "Number of the visit. Either all points have one, all different, or none has.",
                &PointPicture::order,
                integer(-kMostOrder, kMostOrder))
      .required("bad", "True if it was left out as wrong.", &PointPicture::bad)
      .required("before_mm",
                "Measured minus predicted by the calibrated machine.",
                &PointPicture::before_mm,
                pair)
      .required("after_mm", "The same with the named causes.", &PointPicture::after_mm, pair)
      .required(
          "noise_sigma_mm", "1 sigma of the noise there.", &PointPicture::noise_sigma_mm, pair)
      .required("chain_before_mm",
                "In the chains, [left, right], before.",
                &PointPicture::chain_before_mm,
                pair)
      .required("chain_after_mm", "In the chains, after.", &PointPicture::chain_after_mm, pair)
      .required("best_mm", "Effect of the named cause.", &PointPicture::best_mm, pair)
      .required("rival_mm", "Effect that the rival would have.", &PointPicture::rival_mm, pair);
  pair_key(point,
           "lengths_mm",
           "Lengths of the chains, [left, right].",
           kMillimetres,
           path(&PointPicture::lengths, &model::ChainLengths::left_mm),
           path(&PointPicture::lengths, &model::ChainLengths::right_mm));
  pair_key(point,
           "angles_rad",
           "Angles of the chains below the horizontal, [left, right].",
           kRad,
           path(&PointPicture::angle_left_rad),
           path(&PointPicture::angle_right_rad));
  pair_key(point,
           "tensions_n",
           "Tensions of the chains, [left, right].",
           kNewton,
           path(&PointPicture::tension_left_n),
           path(&PointPicture::tension_right_n));
  point
      .required("direction_left",
                "1 if the left chain was paid out on the way there, -1 if taken in, 0 if neither.",
                &PointPicture::direction_left,
                integer(-1, 1))
      .required("direction_right",
                "The same for the right chain.",
                &PointPicture::direction_right,
                integer(-1, 1));
  return point;
}

namespace {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using diagnosis::DiagnosedCoordinate;
using diagnosis::SecondPass;
using diagnosis::ToolError;

/// Shared with chaintrue_anchors, which has a value for each belt as well.
constexpr Range kPerMetre{"mm per metre", 0.0, 1e4};
constexpr int kMostVisits = 1000000000;

Record<DiagnosedCoordinate> diagnosed_coordinate_record() {
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

Record<BeltPlacePicture> belt_place_record() {
  Record<BeltPlacePicture> place("a place with its belts");
  using model::FramePoint;
  place
      .required("x_mm",
                "x of the tool in the anchors' frame, with the causes.",
                path(&BeltPlacePicture::at, &FramePoint::x_mm),
                kMillimetres)
      .required("y_mm",
                "y of the tool in the anchors' frame, up, with the causes.",
                path(&BeltPlacePicture::at, &FramePoint::y_mm),
                kMillimetres);
  place
      .optional("order",
                "Number of the visit.",
                &BeltPlacePicture::order,
                integer(-kMostVisits, kMostVisits))
      .required("before_mm",
                "Reading minus fitted value of each belt, with the anchors alone.",
                &BeltPlacePicture::before_mm,
                per_belt_record<double>(number(kAnyNumber)))
      .required("after_mm",
                "The same with the causes.",
                &BeltPlacePicture::after_mm,
                per_belt_record<double>(number(kAnyNumber)))
      .required("bad",
                "True if the reading was left out.",
                &BeltPlacePicture::bad,
                per_belt_record<bool>(boolean()));
  return place;
}

Record<ToolError> tool_record() {
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

Record<SecondPass> second_pass_record() {
  return Record<SecondPass>("a second pass")
      .required("times",
                "Tension relative to the first pass.",
                &SecondPass::times,
                number({"", 1.0, 100.0}))
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
                list(belt_place_record()));
  return found;
}

namespace {

using diagnosis::CauseId;
using diagnosis::DrawingFindings;
using diagnosis::DrawnSetting;
using diagnosis::DrawnValue;

Record<DrawnSetting> drawn_setting_record() {
  return Record<DrawnSetting>("a setting of a plotter")
      .required("name", "Name of the parameter, with its unit.", &DrawnSetting::name)
      .required("set", "Value in the controller.", &DrawnSetting::set, kAnyNumber)
      .required("found",
                "Value estimated from the drawing together with the named causes.",
                &DrawnSetting::found,
                kAnyNumber)
      .required("sigma", "Uncertainty of that, 1 sigma.", &DrawnSetting::sigma, kNotNegative)
      .required("off", "True if the two differ by more than three sigmas.", &DrawnSetting::off);
}

Record<DrawnValue> drawn_value_record() {
  return Record<DrawnValue>("a measure of a drawing")
      .required("name", "The length or the bow, by its crosses.", &DrawnValue::name)
      .required("measured_mm", "The reading.", &DrawnValue::measured_mm, kAnyNumber)
      .required("explained_mm",
                "The value predicted by the estimated settings and the named causes.",
                &DrawnValue::explained_mm,
                kAnyNumber)
      .required(
          "rejected", "True if it contradicts the others and was left out.", &DrawnValue::rejected);
}

void take_cause_of_cords(CauseId& cause) {
  for (const model::effects::Effect* own : model::plotter::plotter_effects()) {
    if (cause.effect != nullptr && cause.effect->id == own->id) cause.effect = own;
  }
}

}  // namespace

Record<DrawingFindings> drawing_findings_record() {
  return Record<DrawingFindings>("results for a drawing")
      .required("plotter", "Name of the plotter.", &DrawingFindings::plotter)
      .required("settings",
                "All settings of the controller.",
                &DrawingFindings::settings,
                list(drawn_setting_record()))
      .required("measures",
                "The measures of the drawing, in order.",
                &DrawingFindings::measures,
                list(drawn_value_record()));
}

void take_causes_of_cords(diagnosis::Diagnosis& d) {
  for (diagnosis::Cause& own : d.causes) {
    take_cause_of_cords(own.cause);
    for (diagnosis::SameCause& other : own.same_as) take_cause_of_cords(other.cause);
    if (own.rival) take_cause_of_cords(*own.rival);
  }
  for (auto& own : d.not_testable) take_cause_of_cords(own.cause);
  for (auto& own : d.bounds) take_cause_of_cords(own.cause);
  for (auto& own : d.declared) take_cause_of_cords(own.cause);
}

}  // namespace chaintrue::grid::files
