// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_file.hpp"

#include <fmt/format.h>

#include "grid/files/belts_record.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/provenance_record.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::Diagnosis;
using diagnosis::Observations;
using diagnosis::Outlier;

auto stated_noise_record() {
  RECORD(StatedNoise, "the noise as entered")
  REQUIRED(length_mm, "Noise of a chain reading, 1 sigma.", kNotNegative)
  REQUIRED(position_mm, "Noise of a mark's position, 1 sigma on each axis.", kNotNegative)
  REQUIRED(dof, "Degrees of freedom with which this is known.", kNotNegative);
}

RECORD_OF(VisitingOrder, "an order of visits line by line")
REQUIRED(rows, "True: row by row. False: column by column.")
REQUIRED(serpentine, "True if every second line was driven in the opposite direction.")
REQUIRED(from_right, "True if the first mark is on the right.")
REQUIRED(from_below, "True if the first mark is at the bottom.")
END_RECORD;

RECORD_OF(diagnosis::VisitingOrderFound, "an order of visits that was found")
REQUIRED(order, "The most probable of the sixteen orders line by line.")
REQUIRED(corner_known,
         "False: the readings determine the lines and the direction along them, not the "
         "corner; the probability is for any corner.")
REQUIRED(probability,
         "Probability that the marks were visited in this order and the readings depend "
         "on it.",
         kShare)
END_RECORD;

RECORD_OF(diagnosis::StatedTape, "the noise of holes and a tape as entered")
REQUIRED(tape_sigma_mm, "Noise of a tape reading, 1 sigma.", kNotNegative)
REQUIRED(hole_sigma_mm, "Error of a hole's position, 1 sigma on each axis.", kNotNegative)
REQUIRED(dof, "Degrees of freedom with which these are known.", kNotNegative)
END_RECORD;

/// x or y, for points only.
void shift_key(Record<Outlier>& shift, const char* key, const char* meaning, Index axis) {
  shift.computed(
      key, meaning, false, number(kMillimetres),
      [axis](Outlier& bad, double value) { bad.shift_mm[axis] = value; },
      [axis](const Outlier& bad) {
        return bad.of == Observations::points ? std::optional(bad.shift_mm[axis]) : std::nullopt;
      });
}

/// The displacement that explains a bad point; or the residual of a bad distance or belt. Its index is
/// in another list.
auto shift_record() {
  RECORD(Outlier, "a bad point's shift")
  ALSO(shift_key, "x_mm", "x that its tool must have had, minus the recorded x.", 0)
  ALSO(shift_key, "y_mm", "y that its tool must have had, minus the recorded y.", 1)
  FIELD(computed, "off_mm", "For a distance: excess of the reading.", false, number(kMillimetres),
        &Outlier::residual_mm, [](const Outlier& bad) {
          return bad.of == Observations::points ? std::nullopt : std::optional(bad.residual_mm);
        })
  NAMED(required, "sigmas", distance, "The same in sigmas.", kNotNegative)
  OPTIONAL(belt, "For belts: the belt that is off; absent: the whole place.", belt_word())
  OPTIONAL(or_belt,
           "The belt that may be off instead: on the line between the two other anchors "
           "the lengths cannot distinguish them.",
           belt_word())
      .check([](const Cursor& at, Outlier&) {
        if (at.clean() && (at.is_null("x_mm") || at.is_null("y_mm")) == at.is_null("off_mm"))
          at.expect("x_mm and y_mm of a point, or off_mm of a distance or of a belt");
      });
}

/// The indices of the outliers that are distances next to points, or of all others.
void outlier_indices(Record<Diagnosis>& record, const char* key, const char* meaning,
                     bool beside_points) {
  const auto is_beside = [](const Diagnosis& object, const Outlier& bad) {
    return bad.of == Observations::distances && object.observations == Observations::both;
  };
  record.computed(
      key, meaning, !beside_points, list(index_number()),
      [beside_points](Diagnosis& object, const Indices& read) {
        for (const std::size_t index : read) {
          Outlier& bad = object.outliers.emplace_back();
          if (beside_points) bad.of = Observations::distances;
          bad.index = index;
        }
      },
      [=](const Diagnosis& object) -> std::optional<Indices> {
        Indices indices;
        for (const Outlier& bad : object.outliers) {
          if (is_beside(object, bad) == beside_points) indices.push_back(bad.index);
        }
        if (beside_points && indices.empty()) return std::nullopt;
        return indices;
      });
}

/// The indices of outliers and their displacements: lists of the same length together.
void outlier_keys(Record<Diagnosis>& record) {
  static const Value<std::vector<Outlier>> shifts = shift_record();
  outlier_indices(record, "bad_points",
                  "Indices of the points (for holes alone: of the distances) that were left out.",
                  false);
  outlier_indices(record, "bad_distances",
                  "Indices of the distances that were left out, if there were points too.", true);
  record.custom(
      "bad_point_shifts", "One for each bad point, and after them for each bad distance.", true,
      shifts.expected,
      [](const Cursor& at, Diagnosis& object) {
        const auto read = shifts.read(at);
        if (!read) return;
        if (read->size() != object.outliers.size())
          return (void)at.expect("as many shifts as there are bad_points");
        for (const auto i : each_index(*read)) {
          Outlier shift = (*read)[i];
          shift.of = object.outliers[i].of;
          shift.index = object.outliers[i].index;
          object.outliers[i] = shift;
        }
      },
      [](const Diagnosis& object) { return shifts.write(object.outliers); });
}

void check_diagnosis(const Cursor& at, Diagnosis& object) {
  const bool of_belts = object.observations == Observations::belts;
  const bool of_drawing = object.observations == Observations::drawing;
  if (object.observations == Observations::distances || of_belts || of_drawing) {
    for (Outlier& bad : object.outliers) bad.of = object.observations;
  }
  if (!of_belts && !of_drawing && !at.has("extended_machine"))
    at.child("extended_machine").missing("a chaintrue_machine");
  if (of_belts && !object.belts) at.child("belts").missing("results for four belts");
  if (of_drawing && !object.drawing) at.child("drawing").missing("results for a drawing");
  if (object.drawing) {
    const std::size_t measures = object.drawing->measures.size();
    for (const Outlier& bad : object.outliers) {
      if (of_drawing && bad.index >= measures)
        at.child("bad_points")
            .expect(fmt::format("indices of the drawing's {} measures", measures));
    }
  }
  if (!at.child("verdict").clean() || !at.child("causes").clean()) return;
  const bool names_one = object.verdict == Verdict::named || object.verdict == Verdict::named_set ||
                         object.verdict == Verdict::several_causes;
  if (at.has("verdict") && at.has("causes") && names_one && object.causes.empty()) {
    at.child("causes").report(
        "none", ProblemKind::missing,
        fmt::format("at least one cause with the verdict \"{}\"", diagnosis::name(object.verdict)));
  }
}

}  // namespace

FILE_RECORD(diagnosis, Diagnosis, "a diagnosis", kDiagnosisFormat)
REQUIRED(verdict, "Kind of answer.", verdict_word())
REQUIRED(sentence, "The answer.")
REQUIRED(what_to_do, "What to do now, most urgent first.")
REQUIRED(not_proved, "What the answer does not prove.")
REQUIRED(notes, "Further notes for the reader.")
REQUIRED(causes,
         "The named cause; or the set, most probable first; or the causes that act together.")
REQUIRED(hypotheses, "Every explanation with its probability, most probable first.",
         hypothesis_record())
REQUIRED(left_over, "What remains after the causes are removed.")
OPTIONAL(tool_today,
         "Error of the machine as it is used today, over the measured part: the first "
         "number of a fit, at least the effect of a claimed law at the points. Absent if "
         "no map or anchors can be made.")
OPTIONAL(visiting_order,
         "The order of the visits, if it was not recorded and the readings determine it: "
         "the causes are for this order. Absent otherwise.")
OPTIONAL(unexplained, "What remains besides the causes.")
OPTIONAL(budget, "Breakdown of the error.")
ALSO(outlier_keys)
REQUIRED(not_testable, "Effects that these data cannot test.")
REQUIRED(bounds, "Upper limits for causes that were not found.")
SPARSE(declared,
       "What these readings show about each declared effect of the machine's file; absent "
       "if there is none.")
REQUIRED(settings, "The machine's numbers, as in its file and calibrated.")
NAMED(optional, "gain", improvement,
      "Improvement by the cause at points that it was not fitted to.")
REQUIRED(next_measurements, "What to measure next, most informative first.")
FIELD(computed, "extended_machine", "The machine with what was found.", false,
      object(machine_record()), &Diagnosis::extended_machine, [](const Diagnosis& object) {
        const bool of_chains = object.observations != Observations::belts &&
                               object.observations != Observations::drawing;
        return of_chains ? machine_record().write(object.extended_machine) : kLeftOut;
      })
REQUIRED(data_corrections, "Effects on the data (a tape's scale), not on the machine.")
REQUIRED(noise_factor, "Estimated noise divided by the given noise.", kNotNegative)
REQUIRED(family_wise_p, "How often noise alone makes any effect look as strong.", kShare)
REQUIRED(points, "The points, for pictures.", point_picture_record())
REQUIRED(seed, "Seed of the draws for significance.", seed_number())
REQUIRED(grid_name, "Name of the grid.")
OPTIONAL(stated_noise, "The given noise.", stated_noise_record())
OPTIONAL(stability, "Whether the name survives when points are left out.")
SPARSE(bed_parts,
       "Results without each quarter of the bed, over which the probabilities are averaged; "
       "absent without a pattern.",
       bed_part_record())
SPARSE(sessions, "Results for each of several sessions; absent if nothing is named.",
       session_record())
NAMED(optional, "held_out_grid", transferred, "Another grid, predicted.")
SPARSE(observations, "What was measured; default: points.",
       in_order<Observations>({"points", "distances", "points_and_distances", "belts", "drawing"}))
SPARSE(holes, "The holes, for pictures.")
SPARSE(distances, "The distances, for pictures.")
OPTIONAL(stated_tape, "The given noise of holes and tape.")
OPTIONAL(belts, "Results for four belts, if these were diagnosed.")
OPTIONAL(drawing, "Results for a V-plotter's test drawing, if that was diagnosed.")
ALSO(add_made_by_key).check(check_diagnosis) END_FILE_RECORD;

Diagnosis parse_diagnosis(const std::string& text, const std::string& file) {
  return read_document(diagnosis_record(), text, file);
}

std::string write_diagnosis(const Diagnosis& diagnosis, const std::optional<Provenance>& made_by) {
  return print_json(with_made_by(diagnosis_record().write(diagnosis), made_by));
}

}  // namespace chaintrue::grid::files
