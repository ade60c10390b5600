// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/holes_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/files/belts_record.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/holes_record.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/records.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

RECORD_OF(Tape, "the tape")
OPTIONAL(sigma_mm,
         "Noise of a tape reading, 1 sigma; not taken below the rounding of the readings.",
         kTapeSigmaMm)
NAMED(optional, "hook_offset_mm", tape_zero_offset_mm,
      "Amount by which each reading exceeds the distance.", kTapeZeroOffsetMm)
NAMED(optional, "hook_sigma_mm", tape_zero_offset_sigma_mm,
      "Uncertainty of the hook offset, 1 sigma; default 3 mm.", kHoleSigmaMm)
END_RECORD;

RECORD_OF(SheetSize, "the sheet")
OPTIONAL(width_mm, "Width of the sheet, for distances to its edges.", {"mm", 100.0, 20000.0})
OPTIONAL(height_mm, "Height of the sheet.", {"mm", 100.0, 20000.0})
OPTIONAL(size_sigma_mm, "Uncertainty of its size, 1 sigma.", {"mm", 0.0, 100.0})
END_RECORD;

Record<Hole> hole_record() {
  RECORD(Hole, "a hole")
  SPARSE(name, "Any word; without names the holes are numbered from 0.")
  FIELD(place, &Hole::commanded, "Commanded x of the hole.", "Commanded y of the hole, up.",
        kCoordinateMm);
}

/// A hole by its name or by its number.
Value<std::string> hole_word() {
  static constexpr int kMost = 100000;
  return {[](const Cursor& at) -> std::optional<std::string> {
            if (!at.json().is_number()) return text().read(at);
            const auto number = integer(0, kMost).read(at);
            return number ? std::optional(fmt::format("{}", *number)) : std::nullopt;
          },
          [](const std::string& word) { return word; },
          {"a hole's name or number",
           {{"type", {"string", "integer"}}, {"minimum", 0}, {"maximum", kMost}}}};
}

RECORD_OF(StatedDistance, "a distance")
REQUIRED(from, "A hole's name or number.", hole_word())
REQUIRED(to, "A hole's name or number, or an edge: left, right, top, bottom.", hole_word())
REQUIRED(distance_mm, "The tape reading between the holes' centres. Null if not measured yet.",
         kTapeDistance)
OPTIONAL(sigma_mm, "Noise of this reading, if it differs from the tape's.", kTapeSigmaMm)
    .check([](const Cursor& at, StatedDistance& own) { own.is_spoilt = !at.clean(); }) END_RECORD;

/// A machine with anchors hangs on belts.
void read_stated_machine(const Cursor& at, StatedHoles& stated) {
  if (at.json().is_object() && at.has("anchors")) {
    stated.belt_machine = belt_machine_record().read(at);
    if (stated.belt_machine && !stated.belt_machine->anchors_known && at.clean()) {
      at.child("anchors").expect(
          "x_mm and y_mm of all four anchors, as they were in force when the holes were cut");
    }
  } else {
    stated.machine = machine_record().read(at);
  }
}

Json written_stated_machine(const StatedHoles& stated) {
  if (stated.belt_machine) return belt_machine_record().write(*stated.belt_machine);
  return stated.machine ? machine_record().write(*stated.machine) : kLeftOut;
}

}  // namespace

FILE_RECORD(holes, StatedHoles, "a set of holes", kHolesFormat)
OPTIONAL(name, "Name of the set.")
FIELD(custom, "machine", "The machine with its settings in force; or machine_file.", false,
      {machine_record().expected().words + ", or one with four belts",
       {{"anyOf", {machine_record().expected().schema, belt_machine_record().schema()}}}},
      read_stated_machine, written_stated_machine)
SPARSE(machine_file, "Path of the machine file, from this file.")
OPTIONAL(tape, "Noise and hook offset of the tape.")
OPTIONAL(hole_sigma_mm,
         "Distance of a hole from the position that follows from its chains, 1 sigma on "
         "each axis.",
         kHoleSigmaMm)
OPTIONAL(noise_dof, "Degrees of freedom with which these are known.", kNoiseDof)
OPTIONAL(sheet, "Size of the sheet, for distances to its edges.")
SPARSE(readings, "What was measured besides the distances.", reading_record())
REQUIRED(holes, "The holes as commanded.", hole_record())
NAMED(required, "distances", lines, "The distances between them, and to edges.")
    .schema_also({{"not", {{"required", {"machine", "machine_file"}}}}})
    .check([](const Cursor& at, StatedHoles& stated) {
      stated.tape_zero_is_stated = at.has("tape") && at.child("tape").json().is_object() &&
                                   at.child("tape").has("hook_offset_mm");
      if ((stated.machine || stated.belt_machine) && !stated.machine_file.empty()) {
        at.child("machine_file").expect("either \"machine\" or \"machine_file\", not both");
      }
    }) END_FILE_RECORD;

namespace {

/// The common part of JSON and CSV, once the fields are read.
ReadHoles finish(StatedHoles set, HolesPlaces places, const MeasuredOptions& options,
                 Problems& problems) {
  Words blanks;
  for (const StatedDistance& line : set.lines) {
    const bool is_blank = !line.distance_mm && !line.is_spoilt;
    blanks.push_back(is_blank ? fmt::format("{}-{}", line.from, line.to) : "");
  }
  keep_only(filled_in(blanks, "distances", "tape readings, written into distance_mm",
                      places.distances, problems),
            set.lines, places.distance);
  if (options.machine) set.belt_machine.reset();
  if (!set.belt_machine) fetch_machine(set.machine, set.machine_file, options, problems);
  const TapeOptions& tape = options.tape;
  set.tape.sigma_mm = tape.sigma_mm.value_or(set.tape.sigma_mm);
  set.tape.tape_zero_offset_mm = tape.zero_offset_mm.value_or(set.tape.tape_zero_offset_mm);
  if (tape.zero_offset_sigma_mm) set.tape.tape_zero_offset_sigma_mm = tape.zero_offset_sigma_mm;
  set.hole_sigma_mm = tape.hole_sigma_mm.value_or(set.hole_sigma_mm);
  check_names(set.holes, places, problems);
  set.distances = resolved_distances(set.lines, set.holes, places, problems);
  if (!problems.any()) {
    const bool tape_zero_is_stated =
        tape.zero_offset_mm || set.tape_zero_is_stated || set.tape.tape_zero_offset_mm != 0.0;
    const std::size_t fewest = options.few ? 1 : kFewestHoleDistances;
    check_holes_together(set, fewest, tape_zero_is_stated, places, problems);
  }
  problems.throw_if_any();
  warn_of_copies(set, places, problems);
  std::optional<BeltMachine> belt_machine = std::move(set.belt_machine);
  return {std::move(set), std::move(belt_machine), problems.warnings()};
}

ReadHoles parse_json_holes(const std::string& text, const MeasuredOptions& options,
                           Problems& problems) {
  const Json json = parse_json(text, problems);
  auto stated = holes_record().read(Cursor(json, problems), true);
  if (!stated) problems.throw_if_any();
  const HolesPlaces places{"/holes", "/distances", place_in_json("/holes"),
                           place_in_json("/distances")};
  return finish(std::move(stated.value()), places, options, problems);
}

ReadHoles parse_csv_holes(const std::string& text, const MeasuredOptions& options,
                          Problems& problems) {
  HolesTables tables =
      read_holes_tables(text, options.inches ? input_checks::kMmPerInch : 1.0, problems);
  return finish(std::move(tables.stated), tables.places, options, problems);
}

}  // namespace

ReadHoles parse_holes(const std::string& text, const std::string& file,
                      const MeasuredOptions& options) {
  Problems problems(file);
  return is_json(text) ? parse_json_holes(text, options, problems)
                       : parse_csv_holes(text, options, problems);
}

namespace {

StatedHoles stated_holes(const MeasuredHoles& set) {
  StatedHoles stated{set, {}, {}, {}, {}};
  for (const HoleDistance& distance : set.distances) {
    stated.lines.push_back(
        {set.holes.at(distance.from).name,
         distance.edge ? std::string(name(*distance.edge)) : set.holes.at(distance.to).name,
         distance.distance_mm, distance.sigma_mm});
  }
  return stated;
}

}  // namespace

std::string write_holes(const MeasuredHoles& set, const std::optional<BeltMachine>& belts) {
  StatedHoles stated = stated_holes(set);
  stated.belt_machine = belts;
  return write_document(holes_record(), stated);
}

std::string write_holes_sheet(const MeasuredHoles& plan) {
  StatedHoles stated = stated_holes(plan);
  for (StatedDistance& line : stated.lines) line.distance_mm.reset();
  Json json = holes_record().write(stated);
  // The tape's zero offset is not known before the measurement.
  json["tape"].erase("hook_offset_mm");
  return print_json(json);
}

}  // namespace chaintrue::grid::files
