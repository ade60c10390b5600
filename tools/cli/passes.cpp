// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue passes: cut, measure, correct, and again, until the next pass would not pay.
#include <fmt/format.h>

#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/holes_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/planning/calibration_rounds.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct PassesCommand {
  std::vector<std::string> sets;
  std::string machine;
  grid::SimulatedRoundsRequest request;
  std::string map;
  bool json = false;
};

std::string heading(bool is_simulated) {
  return fmt::format("Pass   as cut   left out   rejected    expected   with one more{}\n",
                     is_simulated ? "   true error" : "");
}

std::string line_of(const grid::HolesPass& pass) {
  std::string text = fmt::format("{:>4}{:>9.2f}{:>11.2f}{:>12}{:>11.2f}{:>16.2f}",
                                 pass.number,
                                 pass.as_cut_rms_mm,
                                 pass.left_out_rms_mm,
                                 pass.rejected,
                                 pass.expected_mm,
                                 pass.expected_next_mm);
  if (pass.true_mm) text += fmt::format("{:>13.2f}", *pass.true_mm);
  return text + "\n";
}

/// null where a truth is not known.
std::string as_json(const std::vector<grid::HolesPass>& passes, std::optional<double> before_mm) {
  const auto or_null = [](std::optional<double> value) {
    return value ? fmt::format("{}", *value) : std::string("null");
  };
  std::string text = fmt::format("{{\n  \"before_mm\": {},\n  \"passes\": [", or_null(before_mm));
  const char* separator = "\n";
  for (const grid::HolesPass& pass : passes) {
    fmt::format_to(std::back_inserter(text),
                   "{}    {{\"number\": {}, \"as_cut_rms_mm\": {}, \"left_out_rms_mm\": {}, "
                   "\"set_aside\": {}, \"expected_mm\": {}, \"expected_next_mm\": {}, "
                   "\"next_pays\": {}, \"true_mm\": {}}}",
                   separator,
                   pass.number,
                   pass.as_cut_rms_mm,
                   pass.left_out_rms_mm,
                   pass.rejected,
                   pass.expected_mm,
                   pass.expected_next_mm,
                   pass.next_pays,
                   or_null(pass.true_mm));
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

std::string ending(const grid::HolesPass& last, double worthwhile_mm, std::size_t unused) {
  std::string text =
      "mm: distances as cut minus as wanted; distances left out; expected error over the bed, one "
      "sigma, with the sheet laid at its best.\n";
  const double gain = last.expected_mm - last.expected_next_mm;
  text += last.next_pays
              ? fmt::format("One more pass would take {:.2f} mm off the expected error: it pays.\n",
                            gain)
              : fmt::format(
                    "Stopped: one more pass would take only {:.2f} mm off the expected "
                    "error (less than {:g} mm).\n",
                    gain,
                    worthwhile_mm);
  if (unused > 0) text += fmt::format("{} of the files were not needed.\n", unused);
  return text;
}

int simulate(Verb verb, const PassesCommand& command) {
  const model::Machine machine = read_machine_input(command.machine);
  grid::SimulatedRoundsRequest request = command.request;
  request.progress = shown_progress();
  const auto result = grid::simulate_rounds(machine, request);
  if (!result) {
    fmt::print(stderr, "chaintrue passes: {}\n", result.error().sentence());
    return kNotSupportedOrOutside;
  }
  std::string text =
      fmt::format("Before: the tool errs {:.2f} mm rms over the bed.\n", result->before_mm) +
      heading(true);
  for (const grid::HolesPass& pass : result->passes) text += line_of(pass);
  text += ending(result->passes.back(), command.request.worthwhile_mm, 0);
  if (!command.map.empty()) {
    write_output(command.map, files::write_map(result->fit.map, made_by(verb)));
  }
  end_progress();
  fmt::print("{}", command.json ? as_json(result->passes, result->before_mm) : text);
  if (command.map.empty()) {
    say_next({"plan",
              "--machine",
              command.machine,
              "--holes",
              fmt::format("{}", command.request.plan.holes),
              "-o",
              "holes.csv"});
  } else {
    say_next({"report", command.map, "-o", "map.html"});
  }
  return kDone;
}

int follow(Verb verb, const PassesCommand& command) {
  files::HolesOptions options;
  if (!command.machine.empty()) options.machine = read_machine_input(command.machine);
  std::vector<grid::MeasuredHoles> sets;
  for (const std::string& path : command.sets) {
    const InputFile file = open_input(path);
    require_kind(file,
                 {FileKind::holes},
                 file.kind == FileKind::belt_holes ? "passes are of a machine on two chains" : "");
    files::ReadHoles read = files::parse_holes(file.text, file.name, options);
    print_warnings(read.warnings);
    sets.push_back(std::move(read.holes));
  }
  if (!sets.front().machine) {
    fmt::print(stderr, "{}: the holes name no machine: give --machine\n", command.sets.front());
    return kBadInput;
  }
  grid::HolesRounds passes(*sets.front().machine, command.request.worthwhile_mm);
  std::string text = heading(false);
  std::vector<grid::HolesPass> done;
  std::size_t used = 0;
  for (; used < sets.size(); ++used) {
    shown_progress()(
        {"a set of holes, fitted", static_cast<int>(used) + 1, static_cast<int>(sets.size())});
    const auto pass = passes.add(sets[used]);
    if (!pass) {
      fmt::print(stderr, "{}: {}\n", command.sets[used], pass.error().sentence());
      return kBadInput;
    }
    done.push_back(*pass);
    text += line_of(*pass);
    if (pass->next_pays) continue;
    ++used;
    break;
  }
  text += ending(done.back(), command.request.worthwhile_mm, sets.size() - used);
  if (!command.map.empty()) {
    write_output(command.map, files::write_map(passes.fit()->map, made_by(verb)));
  }
  end_progress();
  fmt::print("{}", command.json ? as_json(done, std::nullopt) : text);
  if (command.map.empty()) {
    say_next({"fit", command.sets[used - 1], "-o", "map.json"});
  } else {
    say_next({"report", command.map, "-o", "map.html"});
  }
  return kDone;
}

int run_passes(Verb verb, const PassesCommand& command) {
  refuse_what_does_nothing(verb, command.sets.empty() ? facts::simulated : facts::measured);
  OptionProblems problems;
  const grid::SimulatedRoundsRequest& request = command.request;
  problems.require("--passes", request.most, 1.0, 100.0);
  problems.require("--worthwhile-mm", request.worthwhile_mm, 0.0, 100.0);
  problems.require(
      "--holes", request.plan.holes, grid::kFewestPlannedHoles, grid::kMostPlannedHoles);
  problems.require("--tape-sigma-mm", request.plan.tape_sigma_mm, 0.001, 100.0);
  problems.require("--hole-sigma-mm", request.plan.hole_sigma_mm, 0.0, 100.0);
  problems.throw_if_any();
  return command.sets.empty() ? simulate(verb, command) : follow(verb, command);
}

}  // namespace

void add_passes(Verb app, Run& run) {
  auto command = std::make_shared<PassesCommand>();
  grid::SimulatedRoundsRequest& request = command->request;
  Verb verb =
      app.add_verb("passes", "Cut, measure, correct and repeat until a pass no longer pays");
  add_input(verb,
            "sets",
            command->sets,
            "chaintrue_holes files, in the order of the passes; none: simulated");
  add_input(verb,
            "--machine",
            command->machine,
            "A chaintrue_machine file: simulated on it, or in place of the sets' own");
  add_number(verb, "--passes", request.most, {"", 1.0, 100.0}, "Simulated: at most so many");
  add_number(verb,
             "--holes",
             request.plan.holes,
             {"", grid::kFewestPlannedHoles, grid::kMostPlannedHoles},
             "Simulated: holes of a pass");
  add_number(verb,
             "--tape-sigma-mm",
             request.plan.tape_sigma_mm,
             grid::files::kTapeSigmaMm,
             "Simulated: of a tape reading");
  add_number(verb,
             "--hole-sigma-mm",
             request.plan.hole_sigma_mm,
             grid::files::kHoleSigmaMm,
             "Simulated: of a hole");
  add_number(verb,
             "--worthwhile-mm",
             request.worthwhile_mm,
             {"mm", 0.0, 100.0},
             "Stop when a pass would lower the expected error by less");
  add_number(verb, "--seed", request.seed, {"", 0.0, 9e15}, "Simulated: same seed, same bytes");
  verb.add_flag("--json", command->json, "All digits, for scripts");
  add_output(
      verb, "-o,--output", command->map, {Origin::map}, "Write the last pass's map to this file");
  verb.footer(
      "Each pass starts from what the one before has learnt. Between passes the "
      "controller's\nsettings may change, the machine file may not.\n\nExamples:\n  "
      "build/chaintrue passes --machine fixtures/machines/classic.json --passes 4 --seed 1\n  "
      "build/chaintrue passes fixtures/holes/nine_holes.json -o map.json");
  verb.when_chosen([command, verb, &run] {
    if (command->sets.empty() && command->machine.empty()) missing_option("--machine");
    run = [command, verb] { return run_passes(verb, *command); };
  });
}

}  // namespace chaintrue::cli
