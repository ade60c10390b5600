// SPDX-License-Identifier: GPL-3.0-or-later
// The stability of a diagnosis, in a chaintrue_diagnosis file: its results without some of the points
// or parts of the bed.
#include "grid/files/diagnosis_keys.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {

using diagnosis::PartFinding;
using diagnosis::Removal;
using diagnosis::Stability;
using diagnosis::Verdict;

Value<Verdict> verdict_word() {
  return by_name({Verdict::named,
                  Verdict::named_set,
                  Verdict::several_causes,
                  Verdict::model_discrepancy,
                  Verdict::noise_larger_than_stated,
                  Verdict::outliers,
                  Verdict::nothing_found});
}

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
void index_key(const Numbered& numbered, Record<Removal>& record) {
  static const Value<int> whole = integer(0, kMostNumbered);
  record.custom(
      numbered.key,
      numbered.meaning,
      false,
      whole.expected,
      [](const Cursor& at, Removal& object) {
        if (const auto value = whole.read(at)) object.index = static_cast<std::size_t>(*value);
      },
      [what = numbered.what](const Removal& object) {
        if (object.what == what) return std::optional<Json>(object.index);
        return what == Removal::What::point ? std::optional<Json>(nullptr) : std::nullopt;
      });
}

/// The position of a column or row.
void line_key(Record<Removal>& record) {
  record.custom(
      "at_mm",
      "x of a column, y of a row.",
      false,
      {"a number in mm", [] { return number_schema(kMillimetres); }},
      [](const Cursor& at, Removal& object) {
        if (const auto value = at.number(kMillimetres)) object.at_mm = *value;
      },
      [](const Removal& object) {
        return std::optional<Json>(is_line(object) ? Json(object.at_mm) : Json(nullptr));
      });
}

Record<Removal> removal_record() {
  Record<Removal> removal("points left out");
  removal.required("what",
                   "What was left out.",
                   &Removal::what,
                   choice<Removal::What>({{"point", Removal::What::point},
                                          {"column", Removal::What::column},
                                          {"row", Removal::What::row},
                                          {"distance", Removal::What::distance},
                                          {"hole", Removal::What::hole}}));
  for (const Numbered& numbered : kNumbered) index_key(numbered, removal);
  line_key(removal);
  removal
      .required("points", "Number of points left out with it.", &Removal::points, index_number(1))
      .required("verdict", "Verdict without it.", &Removal::verdict, verdict_word())
      .required("causes", "Causes named without it.", &Removal::causes, list(cause_id_record()))
      .required("stands", "True if the answer is the same.", &Removal::stands)
      .required("probability", "Probability of the name without it.", &Removal::probability, kShare)
      .required("support",
                "Share of the log evidence that depends on it, in natural logarithms.",
                &Removal::support,
                kAnyNumber)
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
      });
  return removal;
}

}  // namespace

const Record<Stability>& stability_record() {
  static const auto record =
      Record<Stability>("whether the name is stable")
          .required(
              "probability", "Smallest probability of the name.", &Stability::probability, kShare)
          .required("removals",
                    "What was left out, one at a time.",
                    &Stability::removals,
                    list(removal_record()));
  return record;
}

namespace {

void part_keys(Record<PartFinding>& part, const char* leading, const char* named) {
  part.required("units", "Number of readings in it.", &PartFinding::units, index_number())
      .required("leading", leading, &PartFinding::likeliest, hypothesis_record())
      .required("named", named, &PartFinding::named, list(hypothesis_record()));
}

}  // namespace

const Record<PartFinding>& bed_part_record() {
  static const auto record = [] {
    Record<PartFinding> part("the probabilities without a quarter of the bed");
    part.required("towards_rad",
                  "Direction of the quarter from the middle of the readings; from x towards y.",
                  &PartFinding::towards_rad,
                  kAnyNumber);
    part_keys(part,
              "Most probable cause without it; nothing if none is more likely than not.",
              "The named causes, with their probabilities without it.");
    return part;
  }();
  return record;
}

const Record<PartFinding>& session_record() {
  static const auto record = [] {
    Record<PartFinding> part("the probabilities of a session by itself");
    part.required("session", "The file.", &PartFinding::session);
    part_keys(
        part,
        "Most probable cause for its readings alone; nothing if none is more likely than not.",
        "The named causes, with their probabilities for these readings alone.");
    return part;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
