// SPDX-License-Identifier: GPL-3.0-or-later
// The answers without some of the readings, and held-out errors row by row.
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
using diagnosis::Removal;

Value<Verdict> verdict_word() { return by_name_to(Verdict::nothing_found); }

namespace {

bool is_line(const Removal& removal) {
  return removal.what == Removal::What::column || removal.what == Removal::What::row;
}

/// Something numbered: a point, a distance or a hole.
struct Numbered {
  Removal::What what;
  const char* key;
  const char* meaning;
  const char* expected;
};
constexpr Numbered kNumbered[] = {
    {Removal::What::point, "point", "Index of the point.", "a point's index"},
    {Removal::What::distance, "distance", "Index of the distance.", "a distance's index"},
    {Removal::What::hole, "hole", "Index of the hole.", "a hole's index"}};

/// The number, for the kind that is left out. Lines have none.
void index_keys(Record<Removal>& record) {
  for (const Numbered& numbered : kNumbered) {
    record.computed(numbered.key, numbered.meaning, false, index_number(), &Removal::index,
                    [what = numbered.what](const Removal& object) {
                      if (object.what == what) return Json(object.index);
                      return what == Removal::What::point ? Json(nullptr) : kLeftOut;
                    });
  }
}

/// The position of a column or row.
void line_key(Record<Removal>& record) {
  record.computed(
      "at_mm", "x of a column, y of a row.", false, number(kMillimetres), &Removal::at_mm,
      [](const Removal& object) { return is_line(object) ? Json(object.at_mm) : Json(nullptr); });
}

RECORD_OF(Removal, "points left out")
REQUIRED(what, "What was left out.",
         in_order<Removal::What>({"point", "column", "row", "distance", "hole"}))
ALSO(index_keys)
ALSO(line_key)
REQUIRED(points, "Number of points left out with it.", index_number(1))
REQUIRED(verdict, "Verdict without it.", verdict_word())
REQUIRED(causes, "Causes named without it.")
REQUIRED(stands, "True if the answer is the same.")
REQUIRED(probability, "Probability of the name without it.", kShare)
REQUIRED(support, "Share of the log evidence that depends on it, in natural logarithms.")
    .check([](const Cursor& at, Removal& object) {
      if (!at.clean() || !at.has("what")) return;
      const char* key = "at_mm";
      const char* expected = "a number in mm";
      for (const Numbered& numbered : kNumbered) {
        if (numbered.what != object.what) continue;
        key = numbered.key;
        expected = numbered.expected;
      }
      const Cursor place = at.child(key);
      if (place.json().is_null()) place.missing(expected);
    }) END_RECORD;

}  // namespace

RECORD_OF(Stability, "whether the name is stable")
REQUIRED(probability, "Smallest probability of the name.", kShare)
REQUIRED(removals, "What was left out, one at a time.")
END_RECORD;

namespace {

void part_keys(Record<PartFinding>& part, const char* leading, const char* named) {
  part.required("units", "Number of readings in it.", &PartFinding::units)
      .required("leading", leading, &PartFinding::likeliest, hypothesis_record())
      .required("named", named, &PartFinding::named, hypothesis_record());
}

}  // namespace

Record<PartFinding> bed_part_record() {
  RECORD(PartFinding, "the probabilities without a quarter of the bed")
  REQUIRED(towards_rad,
           "Direction of the quarter from the middle of the readings; from x towards y.")
  ALSO(part_keys, "Most probable cause without it; nothing if none is more likely than not.",
       "The named causes, with their probabilities without it.");
}

Record<PartFinding> session_record() {
  RECORD(PartFinding, "the probabilities of a session by itself")
  REQUIRED(session, "The file.")
  ALSO(part_keys,
       "Most probable cause for its readings alone; nothing if none is more likely than not.",
       "The named causes, with their probabilities for these readings alone.");
}

namespace {

using diagnosis::HeldOut;

constexpr int kMostFolds = 1000;

/// An object with one figure for every modelling scheme; the sheet's placement alone does not exist
/// for every grid, and another grid is predicted with fewer schemes.
template <class T>
Record<T> figure_record(const Value<HeldOut>& figure) {
  Record<T> record("an object with one number for each model");
  record.required("as_delivered",
                  "As delivered: with the machine file's settings, for commands with the "
                  "controller's. At the measured points; tool_today is over the measured part.",
                  &T::uncalibrated, figure);
  if constexpr (requires { &T::placed; })
    record.optional("placed", "After the best placement of the sheet.", &T::placed, figure);
  record.required("calibrated", "With calibrated settings.", &T::calibrated, figure)
      .required("extended", "With the named causes.", &T::extended, figure)
      .required("extended_and_surface", "With the causes and a smooth surface.",
                &T::extended_and_surface, figure);
  if constexpr (requires { &T::surface_only; })
    record.required("surface_only", "With a smooth surface and no cause.", &T::surface_only,
                    figure);
  return record;
}

Value<HeldOut> single(double HeldOut::*member) {
  const Value<double> value = number(kSigmaMm);
  return partial<HeldOut>(
      value.expected,
      [value, member](const Cursor& at, HeldOut& row) {
        if (const auto read = value.read(at)) row.*member = *read;
      },
      [value, member](const HeldOut& row) { return value.write(row.*member); });
}

template <class T>
void error_figures(Record<T>& record) {
  record
      .part("position_rms_mm", "Rms error at the tool (for holes alone: of a distance).", true,
            figure_record<T>(single(&HeldOut::rms_mm))
                .required("noise_floor", "From noise alone.", &T::noise_floor_mm, kSigmaMm))
      .part("position_percentile_95_mm", "95th percentile of the error.", true,
            figure_record<T>(single(&HeldOut::percentile_95_mm)))
      .part("position_rms_90_percent_mm", "90 % interval of the rms.", true,
            figure_record<T>(members_as_pair(pair_of_numbers(kSigmaMm, true), &HeldOut::low_mm,
                                             &HeldOut::high_mm)));
}

}  // namespace

RECORD_OF(HeldOutImprovement, "the gain")
REQUIRED(scheme, "How points were left out.")
ALSO(error_figures)
REQUIRED(drop_mm2, "Reduction of the mean square.", kSigmaMm)
REQUIRED(drop_share, "The same as a share.", kShare)
REQUIRED(folds, "Number of times that points were left out.", integer(0, kMostFolds))
REQUIRED(folds_agree, "Number of these in which the same was named.", integer(0, kMostFolds))
    .check([](const Cursor& at, HeldOutImprovement& object) {
      if (at.clean() && object.folds_agree > object.folds)
        at.child("folds_agree").expect("at most as many as folds");
    }) END_RECORD;

RECORD_OF(Transfer, "another grid predicted")
REQUIRED(to, "Name of the grid.")
REQUIRED(points, "Number of its points.")
ALSO(error_figures)
END_RECORD;

}  // namespace chaintrue::grid::files
