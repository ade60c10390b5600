// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue start: makes a folder with the machine, the next steps, and the sheets to print.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/planning/second_visits.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/settings_file.hpp"
#include "tools/cli/sheet_page.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/start_readme.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

namespace fs = std::filesystem;

struct StartCommand {
  std::string file;
  std::string folder = "my-machine";
};

/// The defaults of `chaintrue plan`.
struct Plans {
  grid::MeasurementPlan marks;
  grid::HolesPlan holes;
};

tl::expected<Plans, grid::PlanFailure> plans_for(const Machine& machine) {
  // Half a millimetre for careful reading of a square or a tape.
  constexpr double kByEyeMm = 0.5;
  constexpr double kPaidOutMm = 0.1;
  grid::PlanRequest marks;
  marks.margin_mm = reachable_mm(machine.bed);
  marks.noise = {kPaidOutMm, kByEyeMm};
  HolesPlanRequest holes;
  holes.margin_mm = reachable_mm(machine.bed);
  auto planned_marks = grid::plan_measurement(machine, marks);
  if (!planned_marks) return tl::unexpected(planned_marks.error());
  auto planned_holes = grid::plan_holes(machine, holes);
  if (!planned_holes) return tl::unexpected(planned_holes.error());
  return Plans{*std::move(planned_marks), *std::move(planned_holes)};
}

std::vector<FolderFile> sheets_of(const Machine& machine, const Plans& plans) {
  const Sheet sheet{
      plans.marks.marks,
      SheetOf::places,
      grid::with_second_visits(plans.marks.marks.size(),
                               std::min(grid::kUsualSecondVisits, plans.marks.marks.size() / 3))};
  std::vector<DrillPlace> holes;
  for (const grid::Hole& hole : plans.holes.set.holes)
    holes.push_back({"hole " + hole.name, hole.commanded});
  const StartWays ways{expected_errors(plans.marks.map, machine.bed).rms_mm,
                       plans.holes.expected_rms_mm};
  return {
      {"README.txt", start_readme(machine, ways), Origin::list},
      {"marks.csv", sheet_csv(sheet), Origin::list},
      {"marks.html", sheet_page(sheet, machine, "marks.csv"), Origin::page},
      {"marks.nc", sheet_gcode(sheet, {}), Origin::program},
      {"holes.csv", workshop_list(plans.holes), Origin::list},
      {"holes.html", holes_page(plans.holes, "holes.csv"), Origin::page},
      {"holes.nc", drill_gcode(fmt::format("{} holes", holes.size()), holes, {}), Origin::program},
  };
}

int start_template(Verb verb, const std::string& folder) {
  const std::string path = (fs::path(folder) / "machine.json").string();
  write_folder(verb,
               folder,
               {{"machine.json", files::write_machine({}, template_comments()), Origin::machine},
                {"README.txt", template_readme(path), Origin::list}});
  fmt::print(
      stderr,
      "{} describes a classic Maslow, with every key explained. Enter your machine's numbers.\n",
      path);
  say_next({"start", path});
  return kDone;
}

/// Without a file the only word is the folder.
bool names_a_folder(const std::string& word) {
  std::error_code error;
  return fs::is_directory(word, error) ||
         (!fs::exists(word, error) && fs::path(word).extension().empty());
}

/// An .ini that begins with its first section looks like a list, so its kind is not detected.
InputFile open_settings(const std::string& path) {
  InputFile file{path, files::name_in_messages(path), files::read_whole_file(path)};
  if (files::is_json(file.text) && file.text.find('{') < file.text.find('['))
    file.kind = files::kind_of(file.text, file.name);
  return file;
}

int run_start(Verb verb, const StartCommand& command) {
  if (command.file.empty()) return start_template(verb, command.folder);
  // Beside a folder the first word is a file.
  if (command.file != "-" && !verb.is_given("folder") && names_a_folder(command.file))
    return start_template(verb, command.file);
  const InputFile file = open_settings(command.file);
  if (is_of_a_plotter(file)) {
    const bool stays_next_to_file = file.kind == FileKind::plotter && !verb.is_given("folder");
    return start_plotter(verb, file, stays_next_to_file ? "" : command.folder);
  }
  const SettingsFile started = parse_settings_file(command.file, file.text);
  const Machine& machine = started.read.machine;
  print_warnings(started.read.warnings);
  const auto plans = plans_for(machine);
  if (!plans) {
    fmt::print(stderr, "chaintrue start: {}\n", plans.error().sentence());
    return kNotSupportedOrOutside;
  }
  // Sheets for a chaintrue_machine file are written to its folder.
  std::string folder = command.folder;
  if (started.is_ours && !verb.is_given("folder"))
    folder = fs::path(command.file).parent_path().string();
  if (folder.empty()) folder = ".";
  std::vector<FolderFile> contents = sheets_of(machine, *plans);
  std::string machine_path = (fs::path(folder) / "machine.json").string();
  if (started.is_ours) {
    machine_path = command.file;
  } else {
    std::vector<std::string> comments;
    for (const files::Warning& warning : started.read.warnings)
      comments.push_back(warning.sentence);
    contents.push_back({"machine.json", files::write_machine(machine, comments), Origin::machine});
  }
  write_folder(verb, folder, contents);
  const std::string marks = (fs::path(folder) / "marks.csv").string();
  fmt::print(
      stderr,
      "{} holds the machine and the sheets: print marks.html, cut marks.nc, measure, and write "
      "what you read into marks.csv (README.txt has more, also on holes and a tape).\n",
      folder);
  say_next(
      {"fit", marks, "--machine", machine_path, "-o", (fs::path(folder) / "map.json").string()});
  return kDone;
}

}  // namespace

void add_start(Verb app) {
  auto command = std::make_shared<StartCommand>();
  Verb verb = app.add_verb(
      "start", "Create a folder for your machine: its file, the next steps, and sheets to print");
  add_input(verb,
            "file",
            command->file,
            "groundcontrol.ini, webcontrol.json, FluidNC's yaml, or a chaintrue_machine; for a "
            "V-plotter Marlin's, Polargraph's or a mural's settings, or a chaintrue_plotter; "
            "without one, a machine file to fill in is written");
  add_output_folder(verb, "folder", command->folder, "The folder to create").shows_default();
  verb.footer(
      "Example:\n"
      "  build/chaintrue start fixtures/good/groundcontrol_ring.ini my-machine\n"
      "  build/chaintrue start fixtures/plotter/mural.txt my-mural\n"
      "  build/chaintrue start");
  verb.runs(command, run_start);
}

}  // namespace chaintrue::cli
