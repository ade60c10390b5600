// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, and what
// to measure next.

#include "grid/files/belts_record.hpp"
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

template <class T>
void place_keys(Record<T>& record) {
  record.place(&T::mark,
               "x, to the right of the bed's middle, or of the marks' origin.",
               "y, up from the bed's middle, or from the marks' origin.",
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
        return object.reading ? std::string(name(*object.reading)) : object.words;
      });
  next.nullable("side", "Side of a reading.", &NextMeasurement::side, side_word());
  next.nullable("x_mm",
                "x of the place.",
                path(&NextMeasurement::mark, &model::MarkPoint::x_mm),
                kMillimetres)
      .nullable("y_mm",
                "y of the place, up.",
                path(&NextMeasurement::mark, &model::MarkPoint::y_mm),
                kMillimetres)
      .required("sigma", "Required accuracy, 1 sigma.", &NextMeasurement::sigma, kNotNegative)
      .required("raises_probability_to",
                "Probability of a single right name afterwards.",
                &NextMeasurement::raises_probability_to,
                kShare)
      .sparse("from",
              "For a distance: the hole at one end; for belts an anchor, point or hole.",
              &NextMeasurement::from)
      .sparse("to", "The other ends.", &NextMeasurement::to)
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
  using Place = model::MarkPoint;
  Record<HolePicture> hole("a hole");
  hole.required(
      "name", "Any word; without names the holes are numbered from 0.", &HolePicture::name);
  place_keys(hole);
  return hole.required("commanded_mm",
                       "Commanded position, [x, y].",
                       &HolePicture::commanded,
                       members_as_pair(pair_of_numbers(kMillimetres), &Place::x_mm, &Place::y_mm));
}

Record<DistancePicture> distance_picture_record() {
  return Record<DistancePicture>("a distance")
      .required("index", "Its number in the file.", &DistancePicture::index)
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
  point.required("index", "Its number in the file.", &PointPicture::index);
  place_keys(point);
  using Lengths = model::ChainLengths;
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
      .required("rival_mm", "Effect that the rival would have.", &PointPicture::rival_mm, pair)
      .required("lengths_mm",
                "Lengths of the chains, [left, right].",
                &PointPicture::lengths,
                members_as_pair(pair, &Lengths::left_mm, &Lengths::right_mm))
      .custom(
          "angles_rad",
          "Angles of the chains below the horizontal, [left, right].",
          true,
          members_as_pair(
              pair_of_numbers(kRad), &PointPicture::angle_left_rad, &PointPicture::angle_right_rad))
      .custom("tensions_n",
              "Tensions of the chains, [left, right].",
              true,
              members_as_pair(pair_of_numbers(kNewton),
                              &PointPicture::tension_left_n,
                              &PointPicture::tension_right_n))
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

}  // namespace chaintrue::grid::files
