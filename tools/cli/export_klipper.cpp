// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "grid/files/input_error.hpp"
#include "grid/files/klipper_kinematics.hpp"
#include "grid/map/map_in_frame.hpp"
#include "grid/map/straight_settings.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ExportKlipperCommand {
  std::string map;
  std::string output = "chaintrue.py";
};

int export_klipper(Verb verb, const ExportKlipperCommand& command) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map});
  const grid::CompensationMap map = load_map(file);
  if (!verb.is_given("--force") && refuses_to_cut_with(map)) return kCheckFailed;
  const auto nearest = grid::straight_settings(map, grid::Anchors::free);
  if (!nearest) {
    fmt::print(stderr, "{}: {}\n", file.name, nearest.error().sentence());
    return kNotSupportedOrOutside;
  }
  const auto module =
      files::klipper_kinematics(grid::MapInFrame(map),
                                {nearest->anchors, nearest->longer_mm},
                                std::filesystem::path(file.name).filename().string());
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
             "{:.4f} mm of the map, and moves go in pieces of at most {:g} mm.\nCopy it as "
             "chaintrue.py into klippy/kinematics, and say kinematics: chaintrue in printer.cfg, "
             "with a [stepper_left] and a [stepper_right]. The file's first lines say the rest.\n",
             module->columns,
             module->rows,
             module->spacing_mm,
             module->largest_error_mm,
             module->piece_mm);
  return kDone;
}

}  // namespace

void add_export_klipper(Verb export_verb) {
  auto command = std::make_shared<ExportKlipperCommand>();
  Verb verb =
      export_verb.add_verb("klipper",
                           "Write the map as a kinematics module for Klipper, which then needs no "
                           "compensated files");
  add_input(verb, "map", command->map, "A chaintrue_map file").required();
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::table},
             "The module's source (Python); - is standard output")
      .shows_default();
  verb.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/start/marks.csv --machine "
      "fixtures/machines/groundcontrol.json "
      "-o map.json\n"
      "  build/chaintrue export klipper map.json -o chaintrue.py");
  verb.runs(command, export_klipper);
}

}  // namespace chaintrue::cli
