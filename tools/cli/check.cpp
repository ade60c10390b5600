// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue check: a few new points tell whether a map still holds.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/check_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/map_check.hpp"
#include "tools/cli/check_anchors.hpp"
#include "tools/cli/check_document.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct CheckCommand {
  std::string map;
  GridInput input;
  TapeInput tape;
  /// Further files of new points.
  std::vector<std::string> with;
  bool json = false;
  std::string output = "-";
};

/// A valid map says what it is good for; after re-zeroing, and where the points do not decide, a few
/// more tell; a map that no longer holds is made anew.
void say_next_of(const grid::MapCheck& check, const CheckCommand& command) {
  if (check.is_valid_as_it_is()) {
    return say_next({"report", command.map, "--certificate", "-o", "certificate.html"});
  }
  if (check.decided && check.verdict == grid::CheckVerdict::measure_again &&
      !command.input.machine.empty()) {
    return say_next({"plan", "--machine", command.input.machine, "-o", "marks.csv"});
  }
  say_next({"plan", "--check", command.map, "-o", "check.csv"});
}

int check_the_map(const CheckCommand& command,
                  const std::vector<InputFile>& files,
                  const grid::CompensationMap& map) {
  grid::Measured measured;
  for (const InputFile& file : files)
    measured.add(
        load_measured(file, command.input, command.tape, MeasuredUse::check, map.machine()));
  const auto check = grid::check_map(map, measured, shown_progress());
  if (!check) {
    fmt::print(stderr,
               "{}: {}\n",
               grid::files::name_in_messages(command.input.grid),
               check.error().sentence);
    return kBadInput;
  }
  write_output(command.output, command.json ? grid::files::write_check(*check) : report::render_text(check_document(*check)));
  say_next_of(*check, command);
  return check->is_valid_as_it_is() ? kDone : kCheckFailed;
}

int run_check(Verb verb, const CheckCommand& command) {
  const InputFile map = open_input(command.map);
  require_kind(map, {FileKind::map, FileKind::anchors});
  const bool of_belts = map.kind == FileKind::anchors;
  const std::vector<InputFile> files = open_inputs(command.input.grid, command.with);
  Facts facts = of_belts ? facts::anchors : facts::map;
  for (const InputFile& file : files) {
    if (file.kind == FileKind::grid && !of_belts) facts |= facts::grid;
    if (file.kind == FileKind::holes && !of_belts) facts |= facts::holes;
  }
  refuse_what_does_nothing(verb, facts);
  if (of_belts) return check_the_anchors({map, files.front(), command.output, command.json});
  return with_map(map, [&](const grid::CompensationMap& loaded) {
    return check_the_map(command, files, loaded);
  });
}

}  // namespace

void add_check(Verb app, Run& run) {
  auto command = std::make_shared<CheckCommand>();
  Verb verb = app.add_verb(
      "check", "A few new points: is the map still valid, does re-zeroing mend it, or not");
  add_input(verb, "map", command->map, "A chaintrue_map or chaintrue_anchors file").required();
  add_grid_options(verb, command->input);
  add_tape_options(verb, command->tape);
  add_input(verb,
            "--with",
            command->with,
            "More new points, or holes and distances: all are held against the map");
  verb.add_flag("--json", command->json, "All numbers, for scripts");
  add_output(
      verb, "-o,--output", command->output, {Origin::table, Origin::check}, "- is standard output")
      .shows_default();
  verb.footer(
      "Three to five points far from each other will do, or holes and distances between them;\n"
      "chaintrue plan --check sets those points that tell best.\n"
      "The exit code is 1 where the map is not valid as it is.\n"
      "Anchors of four belts are checked by new places in a chaintrue_belts file.\n\n"
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue check map.json fixtures/grids/five_new_points.json");
  verb.when_chosen(
      [command, verb, &run] { run = [command, verb] { return run_check(verb, *command); }; });
}

}  // namespace chaintrue::cli
