// SPDX-License-Identifier: GPL-3.0-or-later
// Places on the bed in a chaintrue_diagnosis file: the points as the pictures show them, what to
// measure next, and what a drawing or the belts show.
#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::MeasurementKind;

constexpr Range kRad{"rad", -10.0, 10.0};
constexpr Range kNewton{"N", -1e6, 1e6};

template <class T>
void place_keys(Record<T>& record) {
  record.place(&T::mark, "x, to the right of the bed's middle, or of the marks' origin.",
               "y, up from the bed's middle, or from the marks' origin.", kMillimetres);
}

}  // namespace

RECORD_OF(NextMeasurement, "a next measurement")
REQUIRED(kind, "A new point, a second visit, a reading of the machine, or a distance.",
         in_order<MeasurementKind>({"point", "revisit", "reading", "distance"}))
FIELD(computed, "what", "The measurement in words.", true, text(), &NextMeasurement::words,
      [](const NextMeasurement& object) {
        return object.reading ? std::string(name(*object.reading)) : object.words;
      })
NULLABLE(side, "Side of a reading.", side_word())
NESTED(nullable, "x_mm", mark, x_mm, "x of the place.", kMillimetres)
NESTED(nullable, "y_mm", mark, y_mm, "y of the place, up.", kMillimetres)
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
    }) END_RECORD;

RECORD_OF(HolePicture, "a hole")
REQUIRED(name, "Any word; without names the holes are numbered from 0.")
ALSO(place_keys)
NAMED(required, "commanded_mm", commanded, "Commanded position, [x, y].",
      members_as_pair(pair_of_numbers(kMillimetres), &MarkPoint::x_mm, &MarkPoint::y_mm))
END_RECORD;

RECORD_OF(DistancePicture, "a distance")
REQUIRED(index, "Its number in the file.")
REQUIRED(from, "A hole's name or number.")
REQUIRED(to, "A hole's name or number, or an edge: left, right, top, bottom.")
REQUIRED(bad, "Left out as wrong.")
REQUIRED(read_mm, "The tape reading.", kMillimetres)
REQUIRED(before_mm, "Measured minus predicted by the calibrated machine.", kMillimetres)
REQUIRED(after_mm, "The same with the named causes.", kMillimetres)
REQUIRED(noise_sigma_mm, "1 sigma of the noise there.", kNotNegative)
REQUIRED(best_mm, "Effect of the named cause.", kMillimetres)
REQUIRED(rival_mm, "Effect that the rival would have.", kMillimetres)
END_RECORD;

Record<PointPicture> point_picture_record() {
  using Lengths = ChainLengths;
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

namespace {

constexpr Range kPerMetre{"mm per metre", 0.0, 1e4};
constexpr int kMostVisits = 1000000000;

auto diagnosed_coordinate_record() {
  RECORD(diagnosis::DiagnosedCoordinate, "a coordinate of an anchor with causes")
  NAMED(required, "coordinate", name, "Which coordinate of which anchor.",
        one_of({"tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"}))
  OPTIONAL(stated_mm, "Value in the belts' file.", kMillimetres)
  REQUIRED(before_mm, "Fitted with the anchors alone.", kMillimetres)
  REQUIRED(fitted_mm, "Fitted with the named causes.", kMillimetres)
  REQUIRED(sigma_mm, "Uncertainty of that, 1 sigma.", kSigmaMm);
}

auto belt_place_record() {
  const auto numbers = per_belt_record<double>(number(kAnyNumber));
  RECORD(diagnosis::BeltPlacePicture, "a place with its belts")
  FIELD(place, &diagnosis::BeltPlacePicture::at,
        "x of the tool in the anchors' frame, with the causes.",
        "y of the tool in the anchors' frame, up, with the causes.", kMillimetres)
  OPTIONAL(order, "Number of the visit.", integer(-kMostVisits, kMostVisits))
  REQUIRED(before_mm, "Reading minus fitted value of each belt, with the anchors alone.", numbers)
  REQUIRED(after_mm, "The same with the causes.", numbers)
  REQUIRED(bad, "True if the reading was left out.", per_belt_record<bool>(boolean()));
}

RECORD_OF(diagnosis::ToolError, "the tool's error")
OPTIONAL(stated_mm,
         "Rms over the measured places with the anchors in force, including the "
         "uncertainty from the readings; 0 if no anchors are in force.",
         kSigmaMm)
REQUIRED(before_mm, "The same with the anchors fitted alone.", kSigmaMm)
REQUIRED(after_mm, "Uncertainty from the readings, with the causes.", kSigmaMm)
OPTIONAL(scale_mm_per_m, "Uncertainty of a metre, 1 sigma, if a tape determines the scale.",
         kPerMetre)
END_RECORD;

RECORD_OF(diagnosis::SecondPass, "a second pass")
REQUIRED(times, "Tension relative to the first pass.", {"", 1.0, 100.0})
REQUIRED(raises_probability_to, "Probability of a single right name afterwards.", kShare)
END_RECORD;

RECORD_OF(diagnosis::DrawnSetting, "a setting of a plotter")
REQUIRED(name, "Name of the parameter, with its unit.")
REQUIRED(set, "Value in the controller.")
REQUIRED(found, "Value estimated from the drawing together with the named causes.")
REQUIRED(sigma, "Uncertainty of that, 1 sigma.", kNotNegative)
REQUIRED(off, "True if the two differ by more than three sigmas.")
END_RECORD;

RECORD_OF(diagnosis::DrawnValue, "a measure of a drawing")
REQUIRED(name, "The length or the bow, by its crosses.")
REQUIRED(measured_mm, "The reading.")
REQUIRED(explained_mm, "The value predicted by the estimated settings and the named causes.")
REQUIRED(rejected, "True if it contradicts the others and was left out.")
END_RECORD;

}  // namespace

RECORD_OF(BeltsFindings, "results for four belts")
REQUIRED(machine, "The machine, with anchors fitted together with the causes.",
         belt_machine_record())
REQUIRED(coordinates, "The five free coordinates of the frame.",
         exactly<5>(object(diagnosed_coordinate_record()), "five coordinates"))
REQUIRED(spread_before_mm, "Rms of one belt's reading over the checks, anchors alone.", kSigmaMm)
NAMED(required, "spread_mm", residual_sigma_mm, "The same with the causes.", kSigmaMm)
REQUIRED(rms_before_mm, "Rms over all readings, as in the machine's own message; anchors alone.",
         kSigmaMm)
REQUIRED(rms_mm, "The same with the causes.", kSigmaMm)
REQUIRED(checks, "Readings minus unknowns, which include the sizes of causes.", integer(1, 1000000))
NAMED(optional, "foretold_before", prediction_before,
      "Lower belts predicted from the upper two, each half of the places from the "
      "other; anchors alone.")
NAMED(optional, "foretold", prediction,
      "The same with the causes, their sizes fitted to each half.")
REQUIRED(tool, "Error of the tool, with free position and rotation of the frame.")
OPTIONAL(scale, "True length divided by the belts' length, if a tape determines it.")
OPTIONAL(firmware_fit, "The machine's report of its own fit.")
OPTIONAL(second_pass,
         "All places measured again with more tension, if nothing less separates the causes.")
REQUIRED(places, "Each place, in the order of the file.", belt_place_record())
END_RECORD;

RECORD_OF(DrawingFindings, "results for a drawing")
REQUIRED(plotter, "Name of the plotter.")
REQUIRED(settings, "All settings of the controller.")
REQUIRED(measures, "The measures of the drawing, in order.")
END_RECORD;

}  // namespace chaintrue::grid::files
