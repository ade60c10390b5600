// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue import: converts files of other programs to a machine, a grid or belts.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "grid/files/grid_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/names.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace {

struct OpticalCommand {
  std::string input;
  std::string machine;
  std::string output = "-";
  files::OpticalOptions options;
  std::string order;
};

int import_optical(const OpticalCommand& command) {
  files::OpticalOptions options = command.options;
  options.machine = read_machine_input(command.machine);
  options.order = files::visiting_order(command.order);
  const MeasuredGrid scan = files::read(files::parse_optical, command.input, options);
  write_output(command.output, files::write_grid(scan));
  say("{} of {} squares were visited; the sheet is assumed to be placed by hand, within {} mm and "
      "{} mrad{}",
      scan.points.size(), files::kOpticalSquares, scan.sheet->shift_mm, scan.sheet->rotation_mrad,
      options.order ? "" : "; the order of the visits is not known");
  say_next({"fit", command.output, "-o", "map.json"});
  return kDone;
}

void add_optical(Verb import) {
  auto [verb, c] = import.add_verb<OpticalCommand>(
      "optical",
      "Convert a scan by WebControl's or GroundControl's optical calibration into a grid",
      R"(A scan made with compensation switched on shows only the remaining error and cannot be imported this way.

Example:
  build/chaintrue import optical fixtures/good/optical_scan.csv \
    --machine fixtures/machines/groundcontrol.json -o grid.json)",
      import_optical);
  verb.has(
      {{"file", required(reads(c.input)),
        "The scan: 15 lines of 31 errors in x, an empty line, the same in y"},
       {"--machine", required(reads(c.machine)),
        "The machine with the controller settings in force during the scan"},
       {"--pitch-mm", {c.options.pitch_mm, files::kOpticalPitchMm}, "Distance between squares"},
       {"--order",
        {c.order, files::kVisitingOrders},
        "Order in which the squares were visited, if it is known"},
       {"-o,--output", writes(c.output, {Origin::measured}),
        "The grid file; - is standard output"}});
}

struct GroundcontrolCommand {
  std::string input;
  bool nominal_pitch = false;
  std::string output = "-";
};

int import_groundcontrol(const GroundcontrolCommand& command) {
  const files::ReadMachine read = files::read(
      files::parse_groundcontrol, command.input,
      command.nominal_pitch ? files::Tolerances::unexplained : files::Tolerances::are_pitch);
  write_output(command.output, files::write_machine(read.machine, sentences_of(read.warnings)));
  print_warnings(read.warnings);
  say_next({"plan", "--machine", command.output, "-o", "marks.csv", "--page", "marks.html"});
  return kDone;
}

void add_groundcontrol(Verb import) {
  auto [verb, c] = import.add_verb<GroundcontrolCommand>(
      "groundcontrol", "Convert GroundControl's settings into a machine file",
      R"(Missing values are assumed, and listed here and in the file.

Example:
  build/chaintrue import groundcontrol fixtures/good/groundcontrol_ring.ini \
    -o machine.json)",
      import_groundcontrol);
  verb.has({{"file", required(reads(c.input)), "groundcontrol.ini"},
            {"-o,--output", writes(c.output, {Origin::machine}),
             "The machine file; - is standard output"},
            {"--nominal-pitch", c.nominal_pitch,
             "Do not use the chain tolerances as measurements of the pitch, because their "
             "origin is unknown or they were tuned to hide another error"}});
}

struct Maslow4Command {
  Words inputs;
  std::string settings;
  std::string lengths;
  std::string orientation;
  std::string runs;
  std::string pulls;
  std::string output = "-";
};

files::Maslow4Options options_of(const Maslow4Command& command) {
  files::Maslow4Options options;
  if (!command.settings.empty()) {
    options.settings = read_whole_file(command.settings);
    options.settings_file = name_in_messages(command.settings);
  }
  for (const model::BeltLengths lengths :
       {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span}) {
    if (command.lengths == name(lengths)) options.lengths = lengths;
  }
  if (command.orientation == "upright") options.orientation = Orientation::upright;
  if (command.orientation == "flat") options.orientation = Orientation::flat;
  return options;
}

/// Parts of one log, or the last run of each of several.
std::vector<files::Maslow4Import> runs_of(const Maslow4Command& command) {
  files::Maslow4Options options = options_of(command);
  if (command.inputs.size() > 1 && !command.runs.empty()) {
    refuse("the command line", "--runs",
           fmt::format("together with {} logs", command.inputs.size()),
           "one log; the last run of each of several logs is used");
  }
  std::vector<files::Maslow4Import> runs;
  for (const std::string& input : command.inputs) {
    const std::string text = read_whole_file(input);
    std::vector<files::LogPart> parts(1);
    if (!command.runs.empty()) parts = files::log_parts_of(command.runs, "--runs");
    for (const files::LogPart& part : parts) {
      options.part = part;
      runs.push_back(files::parse_maslow4(text, name_in_messages(input), options));
    }
  }
  return runs;
}

/// Lists the runs, and how to choose another.
void tell_runs(const files::Maslow4Import& read, bool was_chosen) {
  if (read.runs.size() < 2) return;
  say("The log holds {} runs:", read.runs.size());
  for (const auto i : each_index(read.runs)) {
    const files::LoggedRun& run = read.runs[i];
    say("  {} {:>3}  points {}:{}  line {}{}{}", i == read.taken ? '>' : ' ', i + 1,
        run.points.first, run.points.last, run.line, run.heading.empty() ? "" : "  ", run.heading);
  }
  if (!was_chosen) {
    say("The last one is used; --runs selects others.");
  }
}

/// The pulls of the belts, if more than one is known.
void tell_pulls(const MeasuredBelts& belts) {
  const std::vector<double> different = different_pulls(belts);
  if (different.size() < 2) return;
  say("One session with {} pulls: the lowest {}, the others {:.3g} times as strong.",
      different.size(), grid::words_of(*reference_pull(belts)),
      fmt::join(different.begin() + 1, different.end(), ", "));
}

int import_maslow4(const Maslow4Command& command) {
  std::vector<grid::BeltPull> pulls;
  if (!command.pulls.empty()) pulls = files::pulls_of(command.pulls, "--pulls");
  std::vector<files::Maslow4Import> runs = runs_of(command);
  const bool is_one = runs.size() == 1;
  const files::Maslow4Import read = files::one_session(std::move(runs), pulls);
  Words comments;
  for (const std::string& sentence : read.assumed) comments.push_back("assumed: " + sentence);
  write_output(command.output, files::write_belts(read.belts, comments));
  print_warnings(read.warnings);
  if (is_one) tell_runs(read, !command.runs.empty());
  tell_pulls(read.belts);
  say("{} points read.", read.belts.points.size());
  for (const std::string& sentence : read.assumed) say("Assumed: {}.", sentence);
  if (!read.belts.machine.anchors_known) {
    say("The anchors in force are unknown; --settings maslow.yaml supplies them, with the arm and "
        "the heights.");
  }
  if (read.stopped) say("{}", *read.stopped);
  if (read.is_enough) say_next({"fit", command.output, "-o", "anchors.json"});
  return kDone;
}

void add_import_maslow4(Verb import) {
  auto [verb, c] = import.add_verb<Maslow4Command>(
      "maslow4", "Convert the log of a Maslow 4's Find Anchors into a belts file",
      R"(Missing values are assumed, and listed here and in the file.

Examples:
  build/chaintrue import maslow4 fixtures/good/maslow4_log.txt \
    --settings fixtures/machines/maslow.yaml -o belts.json
  build/chaintrue import maslow4 fixtures/good/maslow4_log.txt fixtures/good/maslow4_log.txt \
    --pulls 1,1.6 -o two_pulls.json)",
      import_maslow4);
  verb.has(
      {{"file", required(reads(c.inputs)),
        "The log, or a list of readings {bl:.., br:.., tr:.., tl:..}; - is standard input. "
        "Several logs are runs of one session on one frame, each with its own pull"},
       {"--settings", reads(c.settings), "The machine's maslow.yaml"},
       {"--lengths",
        {c.lengths, {"belt", "belt_and_arm", "span"}},
        "Meaning of a length: the slanting belt alone; the belt with its extension and arm, as "
        "printed before October 2024; or the level span from anchor to tool, as printed since"},
       {"--orientation", {c.orientation, {"upright", "flat"}}, "Position of the frame"},
       {"--runs", c.runs,
        "Runs of the log to use, such as 2 or 1,2; several form one session. A run may be given by "
        "its first and last point, counted from 0 over all runs, such as 0:98. Default: the last"},
       {"--pulls", c.pulls,
        "Pull on the belts in each run: a ratio (1,1.6), the motors' current "
        "(1300mA,1900mA; Maslow_Calibration_Current_Threshold) or a force (150N,240N). "
        "Default: as the log prints that setting"},
       {"-o,--output", writes(c.output, {Origin::measured}),
        "The belts file; - is standard output"}});
}

struct PlotterCommand {
  std::string input;
  std::string output = "-";
};

int import_plotter(const PlotterCommand& command) {
  const files::ReadPlotter read = load_plotter(open_input(command.input));
  write_output(command.output, files::write_plotter(read.plotter, sentences_of(read.warnings)));
  print_warnings(read.warnings);
  say_next({"start", command.output, "test-drawing"});
  return kDone;
}

void add_import_plotter(Verb import) {
  auto [verb, c] = import.add_verb<PlotterCommand>(
      "plotter", "Convert the settings of a V-plotter's controller into a plotter file",
      R"(Missing values are assumed, and listed here and in the file.

Example:
  build/chaintrue import plotter fixtures/plotter/mural.txt -o plotter.json)",
      import_plotter);
  verb.has({{"file", required(reads(c.input)),
             "FluidNC's config.yaml with a WallPlotter, Marlin's M665 and M92 or its "
             "Configuration.h, Polargraph's properties, or a mural's numbers, one per line"},
            {"-o,--output", writes(c.output, {Origin::machine}),
             "The plotter file; - is standard output"}});
}

}  // namespace

void add_import(Verb app) {
  Verb verb = app.add_verb(
      "import", "Convert files of other programs into machine, plotter, grid and belts files",
      R"(Example:
  build/chaintrue import groundcontrol fixtures/good/groundcontrol_ring.ini \
    -o machine.json)");
  verb.require_verb();
  add_optical(verb);
  add_groundcontrol(verb);
  add_import_maslow4(verb);
  add_import_plotter(verb);
}

}  // namespace chaintrue::cli
