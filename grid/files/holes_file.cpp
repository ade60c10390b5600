// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/holes_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/files/file_type.hpp"
#include "grid/files/holes_record.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

/// The common part of JSON and CSV, once the fields are read.
ReadHoles finish(StatedHoles set, HolesPlaces places, const MeasuredOptions& options,
                 Problems& problems) {
  std::vector<std::string> blanks;
  for (const StatedDistance& line : set.lines) {
    const bool is_blank = !line.distance_mm && !line.is_spoilt;
    blanks.push_back(is_blank ? fmt::format("{}-{}", line.from, line.to) : "");
  }
  constexpr EntryWords kWords{"distances", "tape readings, written into distance_mm"};
  keep_only(filled_in(blanks, kWords, places.distances, problems), set.lines, places.distance);
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
  std::optional<model::BeltMachine> belt_machine = std::move(set.belt_machine);
  return {std::move(set), std::move(belt_machine), problems.warnings()};
}

ReadHoles parse_json_holes(const std::string& text, const MeasuredOptions& options,
                           Problems& problems) {
  const Json json = parse_json(text, problems);
  auto stated = holes_record().read(Cursor(json, problems), true);
  if (!stated) problems.throw_if_any();
  const HolesPlaces places{"/holes", "/distances",
                           [](std::size_t index) { return fmt::format("/holes/{}", index); },
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

std::string write_holes(const MeasuredHoles& set, const std::optional<model::BeltMachine>& belts) {
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
