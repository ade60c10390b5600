// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>
#include <vector>

#include "grid/files/plotter_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

struct PlotterCommand {
  std::string input;
  std::string output = "-";
};

int import_plotter(const PlotterCommand& command) {
  const files::ReadPlotter read = load_plotter(open_input(command.input));
  std::vector<std::string> comments;
  for (const files::Warning& warning : read.warnings) comments.push_back(warning.sentence);
  write_output(command.output, files::write_plotter(read.plotter, comments));
  print_warnings(read.warnings);
  say_next({"start", command.output, "test-drawing"});
  return kDone;
}

}  // namespace

void add_import_plotter(Verb import) {
  auto command = std::make_shared<PlotterCommand>();
  Verb verb = import.add_verb(
      "plotter", "Convert the settings of a V-plotter's controller into a plotter file");
  add_input(verb,
            "file",
            command->input,
            "FluidNC's config.yaml with a WallPlotter, Marlin's M665 and M92 or its "
            "Configuration.h, Polargraph's properties, or a mural's numbers, one per line")
      .required();
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::machine},
             "The plotter file; - is standard output")
      .shows_default();
  verb.footer(
      "Missing values are assumed, and listed here and in the file.\n\n"
      "Example:\n"
      "  build/chaintrue import plotter fixtures/plotter/mural.txt -o plotter.json");
  verb.runs(command, import_plotter);
}

}  // namespace chaintrue::cli
