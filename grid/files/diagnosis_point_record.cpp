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
              const std::function<Eigen::Vector2d(const T&)>& get,
              const std::function<void(T&, const Eigen::Vector2d&)>& set) {
  const Value<std::vector<double>> value = list(number(range), 2);
  const std::string expected =
      fmt::format("a pair of numbers{}{}", range.unit.empty() ? "" : " in ", range.unit);
  record.custom(
      key,
      true,
      {expected,
       [value] {
         Json schema = value.expected.schema();
         schema["maxItems"] = 2;
         return schema;
       }},
      [value, set, expected](const Cursor& at, T& object) {
        const auto read = value.read(at);
        if (read && read->size() == 2) {
          set(object, Eigen::Vector2d((*read)[0], (*read)[1]));
        } else if (read && read->size() > 2) {
          at.expect(expected);
        }
      },
      [get](const T& object) {
        const Eigen::Vector2d pair = get(object);
        return std::optional<Json>(Json::array({pair[0] + 0.0, pair[1] + 0.0}));
      });
}

void vector_key(Record<PointPicture>& record,
                const std::string& key,
                Eigen::Vector2d PointPicture::*member) {
  pair_key<PointPicture>(
      record,
      key,
      kMillimetres,
      [member](const PointPicture& point) { return point.*member; },
      [member](PointPicture& point, const Eigen::Vector2d& pair) { point.*member = pair; });
}

/// One number for each chain, as [left, right].
void chains_key(Record<PointPicture>& record,
                const std::string& key,
                const Range& range,
                double PointPicture::*left,
                double PointPicture::*right) {
  pair_key<PointPicture>(
      record,
      key,
      range,
      [left, right](const PointPicture& point) {
        return Eigen::Vector2d(point.*left, point.*right);
      },
      [left, right](PointPicture& point, const Eigen::Vector2d& pair) {
        point.*left = pair[0];
        point.*right = pair[1];
      });
}

template <class T>
void place_keys(Record<T>& record,
                const std::function<model::MarkPoint&(T&)>& place,
                const std::function<const model::MarkPoint&(const T&)>& const_place) {
  const auto coordinate = [&](const char* key, double model::MarkPoint::*member) {
    record.custom(
        key,
        true,
        {"a number in mm", [] { return number_schema(kMillimetres); }},
        [place, member](const Cursor& at, T& object) {
          if (const auto value = at.number(kMillimetres)) place(object).*member = *value;
        },
        [const_place, member](const T& object) {
          return std::optional<Json>(const_place(object).*member);
        });
  };
  coordinate("x_mm", &model::MarkPoint::x_mm);
  coordinate("y_mm", &model::MarkPoint::y_mm);
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
    nullable_text(next, "side", &NextMeasurement::side, side_word());
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
    place_keys<HolePicture>(
        hole,
        [](HolePicture& object) -> model::MarkPoint& { return object.mark; },
        [](const HolePicture& object) -> const model::MarkPoint& { return object.mark; });
    pair_key<HolePicture>(
        hole,
        "commanded_mm",
        kMillimetres,
        [](const HolePicture& object) {
          return Eigen::Vector2d(object.commanded.x_mm, object.commanded.y_mm);
        },
        [](HolePicture& object, const Eigen::Vector2d& pair) {
          object.commanded = {pair[0], pair[1]};
        });
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
    place_keys<PointPicture>(
        point,
        [](PointPicture& object) -> model::MarkPoint& { return object.mark; },
        [](const PointPicture& object) -> const model::MarkPoint& { return object.mark; });
    constexpr int kMostOrder = 1000000000;
    point.optional("order", &PointPicture::order, integer(-kMostOrder, kMostOrder))
        .required("bad", &PointPicture::bad, boolean());
    vector_key(point, "before_mm", &PointPicture::before_mm);
    vector_key(point, "after_mm", &PointPicture::after_mm);
    vector_key(point, "noise_sigma_mm", &PointPicture::noise_sigma_mm);
    vector_key(point, "chain_before_mm", &PointPicture::chain_before_mm);
    vector_key(point, "chain_after_mm", &PointPicture::chain_after_mm);
    vector_key(point, "best_mm", &PointPicture::best_mm);
    vector_key(point, "rival_mm", &PointPicture::rival_mm);
    pair_key<PointPicture>(
        point,
        "lengths_mm",
        kMillimetres,
        [](const PointPicture& object) {
          return Eigen::Vector2d(object.lengths.left_mm, object.lengths.right_mm);
        },
        [](PointPicture& object, const Eigen::Vector2d& pair) {
          object.lengths = {pair[0], pair[1]};
        });
    chains_key(
        point, "angles_rad", kRad, &PointPicture::angle_left_rad, &PointPicture::angle_right_rad);
    chains_key(point,
               "tensions_n",
               kNewton,
               &PointPicture::tension_left_n,
               &PointPicture::tension_right_n);
    point.required("direction_left", &PointPicture::direction_left, integer(-1, 1))
        .required("direction_right", &PointPicture::direction_right, integer(-1, 1));
    return point;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
