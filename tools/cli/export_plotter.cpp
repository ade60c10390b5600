// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <string>

#include "grid/plotter/settings_to_paste.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct ExportPlotterCommand {
  std::string input;
  std::string output = "-";
};

int export_plotter(const ExportPlotterCommand& command) {
  const InputFile file = open_input(command.input);
  require_kind(file, {FileKind::plotter});
  const grid::KnownPlotter plotter = load_plotter(file).plotter;
  if (!plotter.found) {
    throw InputError({{file.name,
                       "/found",
                       "",
                       "results of a test drawing; chaintrue fit drawing.json -o found.json writes "
                       "a plotter with them"}});
  }
  std::string text;
  for (const std::string& line :
       grid::settings_to_paste(plotter.set, grid::machine_found(plotter.set, *plotter.found)))
    text += line + "\n";
  write_output(command.output, text);
  say_next({"start", file.path, "second-drawing"});
  return kDone;
}

}  // namespace

void add_export_plotter(Verb export_verb) {
  auto command = std::make_shared<ExportPlotterCommand>();
  Verb verb = export_verb.add_verb(
      "plotter", "Print the numbers to type into a V-plotter's controller after a test drawing");
  add_input(verb, "file", command->input, "A chaintrue_plotter file that fit wrote from a drawing")
      .required();
  add_output(
      verb, "-o,--output", command->output, {Origin::list}, "Output file; - is standard output")
      .shows_default();
  verb.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/plotter/mural_drawing.json -o found.json\n"
      "  build/chaintrue export plotter found.json");
  verb.runs(command, export_plotter);
}

}  // namespace chaintrue::cli
