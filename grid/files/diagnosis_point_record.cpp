// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, and what
// to measure next.

#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_keys.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/reading_record.hpp"
#include "grid/files/record_values.hpp"

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

const Record<NextMeasurement>& next_measurement_record() {
  static const auto record = [] {
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
  }();
  return record;
}

const Record<HolePicture>& hole_picture_record() {
  static const auto record = [] {
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
  }();
  return record;
}

const Record<DistancePicture>& distance_picture_record() {
  static const auto record =
      Record<DistancePicture>("a distance")
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
          .required("after_mm",
                    "The same with the named causes.",
                    &DistancePicture::after_mm,
                    kMillimetres)
          .required("noise_sigma_mm",
                    "1 sigma of the noise there.",
                    &DistancePicture::noise_sigma_mm,
                    kNotNegative)
          .required(
              "best_mm", "Effect of the named cause.", &DistancePicture::best_mm, kMillimetres)
          .required("rival_mm",
                    "Effect that the rival would have.",
                    &DistancePicture::rival_mm,
                    kMillimetres);
  return record;
}

const Record<PointPicture>& point_picture_record() {
  static const auto record = [] {
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
        .required(
            "direction_left",
            "1 if the left chain was paid out on the way there, -1 if taken in, 0 if neither.",
            &PointPicture::direction_left,
            integer(-1, 1))
        .required("direction_right",
                  "The same for the right chain.",
                  &PointPicture::direction_right,
                  integer(-1, 1));
    return point;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
