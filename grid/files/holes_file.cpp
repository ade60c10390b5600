// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/holes_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/files/file_type.hpp"
#include "grid/files/holes_record.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/input_checks/number_checks.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;

/// The common part of JSON and CSV, once the fields are read.
ReadHoles finish(StatedHoles stated,
                 HolesPlaces places,
                 const HolesOptions& options,
                 Problems& problems) {
  std::vector<std::string> blanks;
  for (const StatedDistance& distance : stated.distances) {
    const bool is_blank = !distance.distance_mm && !distance.is_spoilt;
    blanks.push_back(is_blank ? fmt::format("{}-{}", distance.from, distance.to) : "");
  }
  constexpr EntryWords kWords{"distances", "tape readings, written into distance_mm"};
  keep_only(
      filled_in(blanks, kWords, places.distances, problems), stated.distances, places.distance);
  if (options.machine) stated.belt_machine.reset();
  if (!stated.belt_machine) {
    fetch_machine(
        stated.machine, stated.machine_file, options.machine, options.otherwise, problems);
  }
  ReadHoles read;
  MeasuredHoles& set = read.holes;
  set.name = std::move(stated.name);
  set.machine = std::move(stated.machine);
  read.belt_machine = std::move(stated.belt_machine);
  set.tape = stated.tape;
  set.tape.sigma_mm = options.tape_sigma_mm.value_or(set.tape.sigma_mm);
  set.tape.tape_zero_offset_mm = options.tape_zero_offset_mm.value_or(set.tape.tape_zero_offset_mm);
  if (options.tape_zero_offset_sigma_mm)
    set.tape.tape_zero_offset_sigma_mm = options.tape_zero_offset_sigma_mm;
  set.hole_sigma_mm = options.hole_sigma_mm.value_or(stated.hole_sigma_mm);
  set.noise_dof = stated.noise_dof;
  set.sheet = stated.sheet;
  set.readings = std::move(stated.readings);
  set.holes = std::move(stated.holes);
  check_names(set.holes, places, problems);
  set.distances = resolved_distances(stated.distances, set.holes, places, problems);
  if (!problems.any()) {
    const bool tape_zero_is_stated = options.tape_zero_offset_mm || stated.tape_zero_is_stated ||
                                     set.tape.tape_zero_offset_mm != 0.0;
    check_holes_together(set, options.fewest_distances, tape_zero_is_stated, places, problems);
  }
  problems.throw_if_any();
  warn_of_copies(set, places, problems);
  read.warnings = problems.warnings();
  return read;
}

ReadHoles parse_json_holes(const std::string& text,
                           const HolesOptions& options,
                           Problems& problems) {
  const Json json = parse_json(text, problems);
  auto stated = holes_record().read(Cursor(json, problems), true);
  if (!stated) problems.throw_if_any();
  const HolesPlaces places{"/holes",
                           "/distances",
                           [](std::size_t index) { return fmt::format("/holes/{}", index); },
                           place_in_json("/distances")};
  return finish(std::move(stated.value()), places, options, problems);
}

ReadHoles parse_csv_holes(const std::string& text,
                          const HolesOptions& options,
                          Problems& problems) {
  HolesTables tables =
      read_holes_tables(text, options.inches ? input_checks::kMmPerInch : 1.0, problems);
  return finish(std::move(tables.stated), tables.places, options, problems);
}

}  // namespace

ReadHoles parse_holes(const std::string& text,
                      const std::string& file,
                      const HolesOptions& options) {
  Problems problems(file);
  return is_json(text) ? parse_json_holes(text, options, problems)
                       : parse_csv_holes(text, options, problems);
}

ReadHoles read_holes(const fs::path& path, const HolesOptions& options) {
  return parse_holes(read_whole_file(path), name_in_messages(path), options);
}

namespace {

StatedHoles stated_holes(const MeasuredHoles& set) {
  StatedHoles stated;
  stated.name = set.name;
  stated.machine = set.machine;
  stated.tape = set.tape;
  stated.hole_sigma_mm = set.hole_sigma_mm;
  stated.noise_dof = set.noise_dof;
  stated.sheet = set.sheet;
  stated.readings = set.readings;
  stated.holes = set.holes;
  for (const HoleDistance& distance : set.distances) {
    stated.distances.push_back(
        {set.holes.at(distance.from).name,
         distance.edge ? std::string(name(*distance.edge)) : set.holes.at(distance.to).name,
         distance.distance_mm,
         distance.sigma_mm});
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
  for (StatedDistance& distance : stated.distances) distance.distance_mm.reset();
  Json json = holes_record().write(stated);
  // The tape's zero offset is not known before the measurement.
  json["tape"].erase("hook_offset_mm");
  return print_json(json);
}

}  // namespace chaintrue::grid::files
