// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, and what
// to measure next.
#include <fmt/format.h>

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
              const std::string& key,
              const Range& range,
              MemberPath<T, double> first,
              MemberPath<T, double> second) {
  const Value<Eigen::Vector2d> value = pair_of_numbers(range);
  record.custom(
      key,
      true,
      value.expected,
      [=](const Cursor& at, T& object) {
        const auto pair = value.read(at);
        if (!pair) return;
        first.of(object) = (*pair)[0];
        second.of(object) = (*pair)[1];
      },
      [=](const T& object) {
        return std::optional<Json>(value.write({first.of(object), second.of(object)}));
      });
}

template <class T>
void place_keys(Record<T>& record) {
  record.required("x_mm", path(&T::mark, &model::MarkPoint::x_mm), number(kMillimetres))
      .required("y_mm", path(&T::mark, &model::MarkPoint::y_mm), number(kMillimetres));
}

}  // namespace

const Record<NextMeasurement>& next_measurement_record() {
  static const auto record = [] {
    Record<NextMeasurement> next("a next measurement");
    next.required("kind",
                  &NextMeasurement::kind,
                  choice<MeasurementKind>({{"point", MeasurementKind::point},
                                           {"revisit", MeasurementKind::revisit},
                                           {"reading", MeasurementKind::reading},
                                           {"distance", MeasurementKind::distance}}));
    next.custom(
        "what",
        true,
        text().expected,
        [](const Cursor& at, NextMeasurement& object) {
          if (const auto words = text().read(at)) object.words = *words;
        },
        [](const NextMeasurement& object) {
          return std::optional<Json>(object.reading ? Json(std::string(name(*object.reading)))
                                                    : Json(object.words));
        });
    next.nullable("side", &NextMeasurement::side, side_word());
    const auto coordinate = [&next](const char* key, double model::MarkPoint::*member) {
      next.custom(
          key,
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
    coordinate("x_mm", &model::MarkPoint::x_mm);
    coordinate("y_mm", &model::MarkPoint::y_mm);
    next.required("sigma", &NextMeasurement::sigma, number(kNotNegative))
        .required("raises_probability_to", &NextMeasurement::raises_probability_to, number(kShare))
        .sparse("from", &NextMeasurement::from, text())
        .sparse("to", &NextMeasurement::to, list(text()))
        .sparse("pulled", &NextMeasurement::pulled, list(belt_word()))
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
    hole.required("name", &HolePicture::name, text());
    place_keys(hole);
    pair_key(hole,
             "commanded_mm",
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
          .required("index", &DistancePicture::index, index_number())
          .required("from", &DistancePicture::from, text())
          .required("to", &DistancePicture::to, text())
          .required("bad", &DistancePicture::bad, boolean())
          .required("read_mm", &DistancePicture::read_mm, number(kMillimetres))
          .required("before_mm", &DistancePicture::before_mm, number(kMillimetres))
          .required("after_mm", &DistancePicture::after_mm, number(kMillimetres))
          .required("noise_sigma_mm", &DistancePicture::noise_sigma_mm, number(kNotNegative))
          .required("best_mm", &DistancePicture::best_mm, number(kMillimetres))
          .required("rival_mm", &DistancePicture::rival_mm, number(kMillimetres));
  return record;
}

const Record<PointPicture>& point_picture_record() {
  static const auto record = [] {
    Record<PointPicture> point("a point");
    point.required("index", &PointPicture::index, index_number());
    place_keys(point);
    constexpr int kMostOrder = 1000000000;
    const Value<Eigen::Vector2d> pair = pair_of_numbers(kMillimetres);
    point.optional("order", &PointPicture::order, integer(-kMostOrder, kMostOrder))
        .required("bad", &PointPicture::bad, boolean())
        .required("before_mm", &PointPicture::before_mm, pair)
        .required("after_mm", &PointPicture::after_mm, pair)
        .required("noise_sigma_mm", &PointPicture::noise_sigma_mm, pair)
        .required("chain_before_mm", &PointPicture::chain_before_mm, pair)
        .required("chain_after_mm", &PointPicture::chain_after_mm, pair)
        .required("best_mm", &PointPicture::best_mm, pair)
        .required("rival_mm", &PointPicture::rival_mm, pair);
    pair_key(point,
             "lengths_mm",
             kMillimetres,
             path(&PointPicture::lengths, &model::ChainLengths::left_mm),
             path(&PointPicture::lengths, &model::ChainLengths::right_mm));
    pair_key(point,
             "angles_rad",
             kRad,
             path(&PointPicture::angle_left_rad),
             path(&PointPicture::angle_right_rad));
    pair_key(point,
             "tensions_n",
             kNewton,
             path(&PointPicture::tension_left_n),
             path(&PointPicture::tension_right_n));
    point.required("direction_left", &PointPicture::direction_left, integer(-1, 1))
        .required("direction_right", &PointPicture::direction_right, integer(-1, 1));
    return point;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
