// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export: a machine as the numbers that another program wants typed in.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/machine_input.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ExportCommand {
  std::string machine;
  std::string output = "-";
};

int export_groundcontrol(const ExportCommand& command) {
  const files::GroundcontrolText settings =
      files::write_groundcontrol(read_machine_input(command.machine));
  write_output(command.output, settings.text);
  for (const std::string& remark : settings.remarks) fmt::print(stderr, "{}\n", remark);
  return kDone;
}

}  // namespace

void add_export(CLI::App& app, Run& run) {
  CLI::App* verb = app.add_subcommand("export", "Turn a machine into settings for other programs");
  verb->require_subcommand(1);
  constexpr const char* kExample =
      "Example:\n  build/chaintrue export groundcontrol fixtures/machines/groundcontrol.json";
  verb->footer(kExample);
  auto command = std::make_shared<ExportCommand>();
  CLI::App* groundcontrol =
      verb->add_subcommand("groundcontrol", "The numbers to type into GroundControl's settings");
  add_input(*groundcontrol, "machine", command->machine, "A chaintrue_machine file")->required();
  add_output(*groundcontrol,
             "-o,--output",
             command->output,
             {Origin::list},
             "Where they go; - is standard output")
      ->capture_default_str();
  groundcontrol->footer(kExample);
  groundcontrol->callback(
      [command, &run] { run = [command] { return export_groundcontrol(*command); }; });
}

}  // namespace chaintrue::cli
