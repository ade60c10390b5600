// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue import: converts files of other programs to a machine, a grid or belts.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "grid/files/grid_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

struct OpticalCommand {
  std::string input;
  std::string machine;
  std::string output = "-";
  double pitch_mm = 76.2;
  std::string order;
};

const std::map<std::string, files::VisitOrder>& orders() {
  static const std::map<std::string, files::VisitOrder> by_name = {
      {"rows", files::VisitOrder::rows},
      {"columns", files::VisitOrder::columns},
      {"serpentine_rows", files::VisitOrder::serpentine_rows},
      {"serpentine_columns", files::VisitOrder::serpentine_columns}};
  return by_name;
}

int import_optical(const OpticalCommand& command) {
  files::OpticalOptions options;
  options.machine = read_machine_input(command.machine);
  options.pitch_mm = command.pitch_mm;
  if (!command.order.empty()) options.order = orders().at(command.order);
  const files::ReadOptical read = files::read_optical(command.input, options);
  write_output(command.output, files::write_grid(read.grid));
  fmt::print(stderr,
             "{} of {} squares were visited; the sheet is assumed to be placed by hand, within {} "
             "mm and {} mrad{}\n",
             read.grid.points.size(),
             read.squares,
             read.grid.sheet->shift_mm,
             read.grid.sheet->rotation_mrad,
             options.order ? "" : "; the order of the visits is not known");
  say_next({"fit", command.output, "-o", "map.json"});
  return kDone;
}

void add_optical(Verb import) {
  auto command = std::make_shared<OpticalCommand>();
  Verb verb = import.add_verb(
      "optical",
      "Convert a scan by WebControl's or GroundControl's optical calibration into a grid");
  add_input(verb,
            "file",
            command->input,
            "The scan: 15 lines of 31 errors in x, an empty line, the same in y")
      .required();
  add_input(verb,
            "--machine",
            command->machine,
            "The machine with the controller settings in force during the scan")
      .required();
  add_number(
      verb, "--pitch-mm", command->pitch_mm, files::kOpticalPitchMm, "Distance between squares");
  verb.add_option(
          "--order", command->order, "Order in which the squares were visited, if it is known")
      .one_of({"rows", "columns", "serpentine_rows", "serpentine_columns"});
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::measured},
             "The grid file; - is standard output")
      .shows_default();
  verb.footer(
      "A scan made with compensation switched on shows only the remaining error and cannot be "
      "imported this way.\n\nExample:\n  build/chaintrue import optical "
      "fixtures/good/optical_scan.csv \\\n    --machine fixtures/machines/groundcontrol.json -o "
      "grid.json");
  verb.runs(command, import_optical);
}

struct GroundcontrolCommand {
  std::string input;
  bool nominal_pitch = false;
  std::string output = "-";
};

int import_groundcontrol(const GroundcontrolCommand& command) {
  const files::ReadMachine read = files::read_groundcontrol(
      command.input,
      command.nominal_pitch ? files::Tolerances::unexplained : files::Tolerances::are_pitch);
  std::vector<std::string> comments;
  for (const files::Warning& warning : read.warnings) comments.push_back(warning.sentence);
  write_output(command.output, files::write_machine(read.machine, comments));
  print_warnings(read.warnings);
  say_next({"plan", "--machine", command.output, "-o", "marks.csv", "--page", "marks.html"});
  return kDone;
}

void add_groundcontrol(Verb import) {
  auto command = std::make_shared<GroundcontrolCommand>();
  Verb verb =
      import.add_verb("groundcontrol", "Convert GroundControl's settings into a machine file");
  add_input(verb, "file", command->input, "groundcontrol.ini").required();
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::machine},
             "The machine file; - is standard output")
      .shows_default();
  verb.add_flag("--nominal-pitch",
                command->nominal_pitch,
                "Do not use the chain tolerances as measurements of the pitch, because their "
                "origin is unknown or they were tuned to hide another error");
  verb.footer(
      "Missing values are assumed, and listed here and in the file.\n\n"
      "Example:\n"
      "  build/chaintrue import groundcontrol fixtures/good/groundcontrol_ring.ini \\\n"
      "    -o machine.json");
  verb.runs(command, import_groundcontrol);
}

}  // namespace

void add_import(Verb app) {
  Verb verb = app.add_verb(
      "import", "Convert files of other programs into machine, plotter, grid and belts files");
  verb.require_verb();
  verb.footer(
      "Example:\n"
      "  build/chaintrue import groundcontrol fixtures/good/groundcontrol_ring.ini \\\n"
      "    -o machine.json");
  add_optical(verb);
  add_groundcontrol(verb);
  add_import_maslow4(verb);
  add_import_plotter(verb);
}

}  // namespace chaintrue::cli
