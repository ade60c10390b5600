// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue check: a few new points tell whether a map, or anchors, still hold.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/controller_settings.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/check_settings.hpp"
#include "grid/map/map_check.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/check_document.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/settings_file.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct CheckCommand {
  std::string map;
  GridInput input;
  TapeInput tape;
  /// What the controller held when the new points were commanded.
  std::string settings;
  /// Further files of new points.
  std::vector<std::string> with;
  bool json = false;
  std::string output = "-";
};

/// A valid map says what it is good for; after re-zeroing, and where the points do not decide, a few
/// more tell; a map that no longer holds is made anew.
void say_next_of_map(const grid::Check& check, const CheckCommand& command) {
  if (check.settings_have_changed) {
    return say_next({"export",
                     "groundcontrol",
                     command.map,
                     "-o",
                     "settings.ini",
                     "--map-after",
                     after_name(command.map)});
  }
  if (check.is_valid_as_it_is()) {
    return say_next({"report", command.map, "--certificate", "-o", "certificate.html"});
  }
  if (check.decided && check.verdict == grid::CheckVerdict::measure_again &&
      !command.input.machine.empty()) {
    return say_next({"plan", "--machine", command.input.machine, "-o", "marks.csv"});
  }
  say_next({"plan", "--check", command.map, "-o", "check.csv"});
}

/// The settings of export groundcontrol, where they explain points that the map's own do not.
std::optional<grid::Check> with_typed_settings(const grid::CompensationMap& map,
                                               const grid::Measured& measured,
                                               const grid::Check& found) {
  if (found.is_valid_as_it_is()) return std::nullopt;
  const auto typed = grid::settings_to_type(map);
  if (!typed || !typed->worth_typing) return std::nullopt;
  model::Machine after = *map.machine();
  after.controller.settings = typed->settings;
  auto changed = grid::changed_settings(map, measured, after.controller, found);
  if (!changed) return std::nullopt;
  namespace files = grid::files;
  changed->check.sentence = fmt::format(
      "The settings have changed since this map was measured: with the numbers of export "
      "groundcontrol ({}) the points come out within {:.2f} mm rms in a chain, with the map's own "
      "within {:.2f} mm. Go on with the map of export groundcontrol --map-after. {}",
      files::in_words(files::changed_settings(files::settings_in_force(*map.machine()),
                                              files::settings_in_force(after))),
      changed->with_these_mm,
      changed->as_it_is_mm,
      changed->check.sentence);
  return std::move(changed->check);
}

/// Where a file names a machine whose controller holds other settings than the map is for: its
/// commands went by these, whether they were in force or not.
void say_other_settings(const grid::CompensationMap& map, const grid::Measured& measured) {
  namespace files = grid::files;
  if (map.machine() == nullptr) return;
  const model::ControllerKind kind = map.machine()->controller.kind;
  // The others bear none: what they go by are the motors, which a fit moves.
  if (kind != model::ControllerKind::maslow_classic && kind != model::ControllerKind::holey) return;
  for (const grid::MeasuredFile& file : measured.files()) {
    if (!file.machine() || file.machine()->controller.kind != kind) continue;
    const auto changes = files::changed_settings(files::settings_in_force(*map.machine()),
                                                 files::settings_in_force(*file.machine()));
    if (changes.empty()) continue;
    fmt::print(stderr,
               "The machine of {} holds other settings than the map is for ({}): its commands are "
               "taken to have gone by these. --settings says what the controller held.\n",
               file.name.empty() ? "the new points" : file.name,
               files::in_words(changes));
  }
}

/// The map for the settings of --settings, and the points as commanded with these.
grid::CompensationMap take_settings(const CheckCommand& command,
                                    const grid::CompensationMap& map,
                                    grid::Measured& measured) {
  if (command.settings.empty()) return map;
  const auto stated = grid::stated_machine(map);
  if (!stated) {
    throw grid::files::InputError({{command.map,
                                    "",
                                    "a map that knows no machine",
                                    "--settings to be left out: its points are chain lengths"}});
  }
  const SettingsFile file = read_settings_file(command.settings);
  const model::Controller now = with_settings(*stated, file, nullptr).controller;
  if (now.kind == model::ControllerKind::fluidnc_wallplotter) {
    throw grid::files::InputError({{file.name,
                                    "",
                                    "anchors of a wall plotter",
                                    "the new points with the machine that they were commanded on: "
                                    "--machine takes it"}});
  }
  measured = grid::commanded_with(measured, now);
  return grid::map_for_settings(map, now, "");
}

using CheckResult = tl::expected<grid::Check, grid::CheckFailure>;

CheckResult check_of_map(const CheckCommand& command,
                         const std::vector<InputFile>& files,
                         const InputFile& map) {
  return with_map(map, [&](const grid::CompensationMap& as_measured) {
    grid::Measured measured;
    for (const InputFile& file : files)
      measured.add(load_measured(
          file, command.input, command.tape, MeasuredUse::check, as_measured.machine()));
    if (command.settings.empty()) say_other_settings(as_measured, measured);
    const grid::CompensationMap in_force = take_settings(command, as_measured, measured);
    CheckResult check = grid::check_map(in_force, measured, shown_progress());
    if (!check) return check;
    if (auto changed = with_typed_settings(in_force, measured, *check)) check = *std::move(changed);
    return check;
  });
}

CheckResult check_of_anchors(const InputFile& belts, const InputFile& anchors) {
  const grid::files::FittedAnchors loaded = load_anchors(anchors);
  require_kind(belts,
               {FileKind::belts},
               "anchors are checked by what the machine has measured since; holes and belts "
               "together are fitted (chaintrue fit BELTS --with HOLES)");
  const grid::files::ReadBelts read = load_belts(belts, "a check");
  return grid::check_anchors(loaded.fit, read.belts);
}

void write_check(const grid::Check& check, const CheckCommand& command, bool of_belts) {
  if (command.json) {
    write_output(command.output,
                 of_belts ? grid::files::write_anchors_check(check)
                          : grid::files::write_map_check(check));
    return;
  }
  write_output(command.output,
               report::render_text(of_belts ? anchors_check_document(check)
                                            : map_check_document(check)));
}

/// Anchors that hold have a report; those that do not are diagnosed.
void say_next_of_anchors(const grid::Check& check, const CheckCommand& command) {
  if (check.is_valid_as_it_is()) return say_next({"report", command.map, "-o", "anchors.html"});
  say_next({"diagnose", command.input.grid, "-o", "diagnosis.json"});
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
  const CheckResult check =
      of_belts ? check_of_anchors(files.front(), map) : check_of_map(command, files, map);
  if (!check) {
    fmt::print(stderr, "{}: {}\n", files.front().name, check.error().sentence);
    return kBadInput;
  }
  write_check(*check, command, of_belts);
  if (of_belts) {
    say_next_of_anchors(*check, command);
  } else {
    say_next_of_map(*check, command);
  }
  return check->is_valid_as_it_is() ? kDone : kCheckFailed;
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
  add_input(verb,
            "--settings",
            command->settings,
            "What the controller held when the new points were commanded, if other than when the "
            "map was measured: groundcontrol.ini, webcontrol.json, or a machine file");
  verb.add_flag("--json", command->json, "All numbers, for scripts");
  add_output(
      verb, "-o,--output", command->output, {Origin::table, Origin::check}, "- is standard output")
      .shows_default();
  verb.footer(
      "Three to five points far from each other will do, or holes and distances between them;\n"
      "chaintrue plan --check sets those points that tell best.\n"
      "\"Still valid (74 %)\" is how probable it is, by the new points and what usually changes, that\n"
      "nothing has; from 80 % on the points decide. The exit code is 0 where they decide that the map\n"
      "is valid as it is, and 1 otherwise: where it is valid after re-zeroing, is to be measured again,\n"
      "was of other settings than the controller has, or where more points are needed to tell.\n"
      "Anchors of four belts are checked by new places in a chaintrue_belts file.\n\n"
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue check map.json fixtures/grids/five_new_points.json");
  verb.when_chosen(
      [command, verb, &run] { run = [command, verb] { return run_check(verb, *command); }; });
}

}  // namespace chaintrue::cli
