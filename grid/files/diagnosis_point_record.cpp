// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, and what
// to measure next.

#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"

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
  record.place(&T::mark, "x, to the right of the bed's middle, or of the marks' origin.",
               "y, up from the bed's middle, or from the marks' origin.", kMillimetres);
}

}  // namespace

Record<NextMeasurement> next_measurement_record() {
  RECORD(NextMeasurement, "a next measurement")
  REQUIRED(kind, "A new point, a second visit, a reading of the machine, or a distance.",
           choice<MeasurementKind>({{"point", MeasurementKind::point},
                                    {"revisit", MeasurementKind::revisit},
                                    {"reading", MeasurementKind::reading},
                                    {"distance", MeasurementKind::distance}}))
  FIELD(
      computed, "what", "The measurement in words.", true, text(),
      [](NextMeasurement& object, const std::string& words) { object.words = words; },
      [](const NextMeasurement& object) {
        return object.reading ? std::string(name(*object.reading)) : object.words;
      })
  NULLABLE(side, "Side of a reading.", side_word())
  FIELD(nullable, "x_mm", "x of the place.", path(&NextMeasurement::mark, &model::MarkPoint::x_mm),
        kMillimetres)
  FIELD(nullable, "y_mm", "y of the place, up.",
        path(&NextMeasurement::mark, &model::MarkPoint::y_mm), kMillimetres)
  REQUIRED(sigma, "Required accuracy, 1 sigma.", kNotNegative)
  REQUIRED(raises_probability_to, "Probability of a single right name afterwards.", kShare)
  SPARSE(from, "For a distance: the hole at one end; for belts an anchor, point or hole.")
  SPARSE(to, "The other ends.")
  SPARSE(pulled,
         "For a place of four belts: belts that a motor pulls there; default: those for the "
         "frame's orientation.",
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
}

Record<HolePicture> hole_picture_record() {
  using Place = model::MarkPoint;
  RECORD(HolePicture, "a hole")
  REQUIRED(name, "Any word; without names the holes are numbered from 0.")
  ALSO(place_keys)
  NAMED(required, "commanded_mm", commanded, "Commanded position, [x, y].",
        members_as_pair(pair_of_numbers(kMillimetres), &Place::x_mm, &Place::y_mm));
}

Record<DistancePicture> distance_picture_record() {
  RECORD(DistancePicture, "a distance")
  REQUIRED(index, "Its number in the file.")
  REQUIRED(from, "A hole's name or number.")
  REQUIRED(to, "A hole's name or number, or an edge: left, right, top, bottom.")
  REQUIRED(bad, "Left out as wrong.")
  REQUIRED(read_mm, "The tape reading.", kMillimetres)
  REQUIRED(before_mm, "Measured minus predicted by the calibrated machine.", kMillimetres)
  REQUIRED(after_mm, "The same with the named causes.", kMillimetres)
  REQUIRED(noise_sigma_mm, "1 sigma of the noise there.", kNotNegative)
  REQUIRED(best_mm, "Effect of the named cause.", kMillimetres)
  REQUIRED(rival_mm, "Effect that the rival would have.", kMillimetres);
}

Record<PointPicture> point_picture_record() {
  using Lengths = model::ChainLengths;
  constexpr int kMostOrder = 1000000000;
  const Value<Vector2d> pair = pair_of_numbers(kMillimetres);
  RECORD(PointPicture, "a point")
  REQUIRED(index, "Its number in the file.")
  ALSO(place_keys)
  OPTIONAL(order, "Number of the visit. Either all points have one, all different, or none has.",
           integer(-kMostOrder, kMostOrder))
  REQUIRED(bad, "True if it was left out as wrong.")
  REQUIRED(before_mm, "Measured minus predicted by the calibrated machine.", pair)
  REQUIRED(after_mm, "The same with the named causes.", pair)
  REQUIRED(noise_sigma_mm, "1 sigma of the noise there.", pair)
  REQUIRED(chain_before_mm, "In the chains, [left, right], before.", pair)
  REQUIRED(chain_after_mm, "In the chains, after.", pair)
  REQUIRED(best_mm, "Effect of the named cause.", pair)
  REQUIRED(rival_mm, "Effect that the rival would have.", pair)
  NAMED(required, "lengths_mm", lengths, "Lengths of the chains, [left, right].",
        members_as_pair(pair, &Lengths::left_mm, &Lengths::right_mm))
  FIELD(custom, "angles_rad", "Angles of the chains below the horizontal, [left, right].", true,
        members_as_pair(pair_of_numbers(kRad), &PointPicture::angle_left_rad,
                        &PointPicture::angle_right_rad))
  FIELD(custom, "tensions_n", "Tensions of the chains, [left, right].", true,
        members_as_pair(pair_of_numbers(kNewton), &PointPicture::tension_left_n,
                        &PointPicture::tension_right_n))
  REQUIRED(direction_left,
           "1 if the left chain was paid out on the way there, -1 if taken in, 0 if neither.",
           integer(-1, 1))
  REQUIRED(direction_right, "The same for the right chain.", integer(-1, 1));
}

}  // namespace chaintrue::grid::files
