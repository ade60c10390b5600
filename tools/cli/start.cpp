// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue start: makes a folder with the machine, the next steps, and the sheets to print.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// The texts in the folder of chaintrue start.

/// Expected error of the tool over the bed, one sigma, for each way of measuring.
struct StartWays {
  double marks_mm = 0.0;
  double holes_mm = 0.0;
};

constexpr std::string_view kKeys[][2] = {
    {"bed", "the sheet that the machine can cut, in mm; zero is its middle, x right, y up"},
    {"motors", "where the motors' axes are, from that zero; to a few mm is enough"},
    {"sprocket", "teeth on a motor, and the chain's pitch: 10 and 6.35 mm on every Maslow"},
    {"feed", "over_top where the chains leave over the sprockets' tops, else off_bottom"},
    {"attachment",
     "{\"kind\": \"ring\", \"radius_mm\": from the bit to a chain's end}, or {\"kind\": "
     "\"brackets\", \"spacing_mm\", \"height_mm\", \"cg_below_bit_mm\"}"},
    {"chain", "its mass and its stretch per newton; keep the defaults if unknown"},
    {"sled", "the sled's weight with its router, in kg; a bathroom scale is accurate enough"},
    {"frame", "how far the frame leans back, in degrees"},
    {"uncertainty", "uncertainty of the motors, the chains' zeros and the ring, 1 sigma"},
    {"controller",
     "the firmware's settings: {\"kind\": \"maslow_classic\", \"settings\": {GroundControl's own "
     "names: motorspacingx, motoroffsety, rotationradius, chainsagcorrection, ...}}"},
};

/// The keys' meanings as comments of the machine file.
Words template_comments() {
  Words comments = {"A classic Maslow. Enter your machine's numbers; every key is explained here."};
  for (const auto& [key, meaning] : kKeys) comments.push_back(fmt::format("{}: {}", key, meaning));
  return comments;
}

/// For a folder with a machine file to fill in: the meaning of every key.
std::string template_readme(const std::string& machine_path) {
  std::string text = "machine.json describes a classic Maslow. Enter your numbers:\n\n";
  for (const auto& [key, meaning] : kKeys) text += fmt::format("  {:<13}{}\n", key, meaning);
  return text + fmt::format(
                    "\nThen make the sheets to print:\n\n    chaintrue start {}\n\nIf "
                    "GroundControl, WebControl or FluidNC runs the machine, chaintrue reads its "
                    "settings file instead:\n\n    chaintrue start groundcontrol.ini\n",
                    machine_path);
}

/// For a folder with sheets.
std::string start_readme(const Machine& machine, const StartWays& ways) {
  const bool settings = machine.controller.settings.motor_spacing_mm.has_value();
  return fmt::format(
      R"({0}: what lies here, and what to do with it.

  machine.json   the machine as its settings describe it
  marks.html     28 marks on a page to print, four of them twice, with lines to write on
  marks.csv      the list that the readings are typed into
  marks.nc       a program that drives to the marks and drills them
  holes.html, holes.csv, holes.nc
                 the same with nine holes and a tape

1. Choose a way to measure.

   Marks, for whoever has an evening and a square: the tool is sent to 28 marks, and x and y of
   each are measured from the sheet's middle lines. Four of them come a second time, a little to
   the side: they cost ten minutes and show whether the machine changed meanwhile (a chain that
   jumped a tooth, a zero that moved). To half a millimetre each, the tool will then be known to
   about {1:.1f} mm over the bed.
   Holes, for whoever has an hour and a tape: nine holes and twenty distances, about {2:.1f} mm,
   for the best placement of the sheet.
   Chain lengths, for whoever can read them off the machine: chaintrue plan --machine machine.json
   --measure lengths -o lengths.csv. It is the way that tells causes apart best.

2. Print marks.html (or holes.html), run marks.nc, measure, and type what you read into marks.csv
   with an editor or a spreadsheet. What you leave empty is left out.

3. Make the map:

       chaintrue fit marks.csv --machine machine.json -o map.json

4. Cut with it: rewrite each program,

       chaintrue gcode compensate part.nc --map map.json -o part.true.nc
{3}
5. See why the machine errs:

       chaintrue diagnose marks.csv --machine machine.json --noise-length-mm 0.1 --noise-position-mm 0.5 -o diagnosis.json --report diagnosis.html
)",
      machine.name.empty() ? "Your machine" : machine.name, ways.marks_mm, ways.holes_mm,
      settings ? R"(
   or type better numbers in once:

       chaintrue export groundcontrol map.json --map-after map.after.json

   From then on map.after.json is the map that is right, to check the machine with and, where you
   want what no number can mend, to rewrite programs with.
)"
               : "");
}

namespace fs = std::filesystem;

struct StartCommand {
  std::string file;
  std::string folder = "my-machine";
};

/// The defaults of `chaintrue plan`.
struct Plans {
  grid::MeasurementPlan marks;
  HolesPlan holes;
};

/// \throws Failed
Plans plans_for(const Machine& machine) {
  // Half a millimetre for careful reading of a square or a tape.
  constexpr double kByEyeMm = 0.5;
  constexpr double kPaidOutMm = 0.1;
  grid::PlanRequest marks;
  marks.margin_mm = reachable_mm(machine.bed);
  marks.noise = {kPaidOutMm, kByEyeMm};
  HolesPlanRequest holes;
  holes.margin_mm = reachable_mm(machine.bed);
  const auto planned = [](auto plan) {
    return value_of(std::move(plan), "chaintrue start", kNotSupportedOrOutside);
  };
  return {planned(plan_measurement(machine, marks)), planned(plan_holes(machine, holes))};
}

std::vector<FolderFile> sheets_of(const Machine& machine, const Plans& plans) {
  const Sheet sheet{
      plans.marks.marks, SheetOf::places,
      grid::with_second_visits(plans.marks.marks.size(),
                               std::min(grid::kUsualSecondVisits, plans.marks.marks.size() / 3))};
  const StartWays ways{expected_errors(plans.marks.map, machine.bed).rms_mm,
                       plans.holes.expected_rms_mm};
  return {
      {"README.txt", start_readme(machine, ways), Origin::list},
      {"marks.csv", sheet_csv(sheet), Origin::list},
      {"marks.html", sheet_page(sheet, machine, "marks.csv"), Origin::page},
      {"marks.nc", sheet_gcode(sheet, {}), Origin::program},
      {"holes.csv", workshop_list(plans.holes), Origin::list},
      {"holes.html", holes_page(plans.holes, "holes.csv"), Origin::page},
      {"holes.nc", holes_gcode(plans.holes, {}), Origin::program},
  };
}

int start_template(Verb verb, const std::string& folder) {
  const std::string path = (fs::path(folder) / "machine.json").string();
  write_folder(verb, folder,
               {{"machine.json", files::write_machine({}, template_comments()), Origin::machine},
                {"README.txt", template_readme(path), Origin::list}});
  say("{} describes a classic Maslow, with every key explained. Enter your machine's numbers.",
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
  InputFile file{path, name_in_messages(path), read_whole_file(path)};
  if (is_json(file.text) && file.text.find('{') < file.text.find('['))
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
  const Plans plans = plans_for(machine);
  // Sheets for a chaintrue_machine file are written to its folder.
  std::string folder = command.folder;
  if (started.is_ours && !verb.is_given("folder"))
    folder = fs::path(command.file).parent_path().string();
  if (folder.empty()) folder = ".";
  std::vector<FolderFile> contents = sheets_of(machine, plans);
  std::string machine_path = (fs::path(folder) / "machine.json").string();
  if (started.is_ours) {
    machine_path = command.file;
  } else {
    contents.push_back({"machine.json",
                        files::write_machine(machine, sentences_of(started.read.warnings)),
                        Origin::machine});
  }
  write_folder(verb, folder, contents);
  const std::string marks = (fs::path(folder) / "marks.csv").string();
  say("{} holds the machine and the sheets: print marks.html, cut marks.nc, measure, and write "
      "what you read into marks.csv (README.txt has more, also on holes and a tape).",
      folder);
  say_next(
      {"fit", marks, "--machine", machine_path, "-o", (fs::path(folder) / "map.json").string()});
  return kDone;
}

}  // namespace

void add_start(Verb app) {
  auto [verb, c] = app.add_verb<StartCommand>(
      "start", "Create a folder for your machine: its file, the next steps, and sheets to print",
      R"(Example:
  build/chaintrue start fixtures/good/groundcontrol_ring.ini my-machine
  build/chaintrue start fixtures/plotter/mural.txt my-mural
  build/chaintrue start)",
      run_start);
  verb.has({{"file", reads(c.file),
             "groundcontrol.ini, webcontrol.json, FluidNC's yaml, or a chaintrue_machine; for a "
             "V-plotter Marlin's, Polargraph's or a mural's settings, or a chaintrue_plotter; "
             "without one, a machine file to fill in is written"},
            {"folder", writes_into(c.folder), "The folder to create"}});
}

}  // namespace chaintrue::cli
