// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "grid/files/linuxcnc_kinematics.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ExportLinuxcncCommand {
  std::string map;
  std::string output = "chaintrue_kins.c";
};

/// The component is called as its file is: halcompile takes the name from there.
std::string module_name(const std::string& output) {
  return output == "-" ? "chaintrue_kins" : std::filesystem::path(output).stem().string();
}

void check_linuxcnc(const ExportLinuxcncCommand& command, OptionProblems& problems) {
  const std::string name = module_name(command.output);
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  const bool is_identifier =
      !name.empty() && is_letter(static_cast<unsigned char>(name.front())) &&
      std::all_of(name.begin(), name.end(), [&](char c) {
        return is_letter(static_cast<unsigned char>(c)) || (c >= '0' && c <= '9');
      });
  if (!is_identifier) {
    problems.add(
        "--output",
        command.output,
        "a file such as chaintrue_kins.c: LinuxCNC calls the module by its name, of letters, "
        "digits and _",
        grid::ProblemKind::output_place);
  }
}

int export_linuxcnc(Verb verb, const ExportLinuxcncCommand& command) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map});
  const grid::CompensationMap map = load_map(file);
  if (!verb.is_given("--force") && refuses_to_cut_with(map)) return kCheckFailed;
  const std::string name = module_name(command.output);
  const auto module = files::linuxcnc_kinematics(
      grid::MapInFrame(map), {name, std::filesystem::path(file.name).filename().string()});
  if (!module) {
    fmt::print(stderr,
               "{}: {}. A table needs lengths all over the map; fit it with --outside continued\n",
               file.name,
               module.error().sentence());
    return kNotSupportedOrOutside;
  }
  write_output(command.output, module->source);
  fmt::print(stderr,
             "{} x {} lengths of both chains, {:.0f} mm apart; between them the table is within "
             "{:.4f} mm of the map{}.\nBuild and install it where LinuxCNC (2.9 or later) runs: "
             "halcompile --install {}.c. In the machine's INI file: [KINS] KINEMATICS = {} and "
             "JOINTS = 3, [TRAJ] LINEAR_UNITS = mm.\n",
             module->columns,
             module->rows,
             module->spacing_mm,
             module->largest_error_mm,
             module->largest_error_mm > files::kTableErrorMm
                 ? ", more than it should be: this map bends within millimetres"
                 : "",
             name,
             name);
  return kDone;
}

}  // namespace

void add_export_linuxcnc(Verb export_verb) {
  auto command = std::make_shared<ExportLinuxcncCommand>();
  Verb verb =
      export_verb.add_verb("linuxcnc",
                           "Write the map as a kinematics module for LinuxCNC, which then needs no "
                           "compensated files");
  add_input(verb, "map", command->map, "A chaintrue_map file").required();
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::table},
             "The module's source (C); - is standard output")
      .shows_default();
  verb.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/start/marks.csv --machine "
      "fixtures/machines/groundcontrol.json "
      "-o map.json\n"
      "  build/chaintrue export linuxcnc map.json -o chaintrue_kins.c");
  add_option_check(verb,
                   [command](OptionProblems& problems) { check_linuxcnc(*command, problems); });
  verb.runs(command, export_linuxcnc);
}

}  // namespace chaintrue::cli
