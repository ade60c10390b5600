// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/sweep_file.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "grid/files/sha256.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using sweep::GridLevel;
using sweep::SweepSpec;

struct StatedMachine {
  std::string name;
  std::string machine_file;
  std::string stated_file;
  Model model = Model::elastic;
  double unmodelled_mm = 0.0;
};

Value<GridLevel> grid_size(int least) {
  const std::string expected = fmt::format("columns x rows, each {} to 1000, as in \"7x4\"", least);
  return {[expected, least](const Cursor& at) -> std::optional<GridLevel> {
            const auto word = text().read(at);
            if (!word) return std::nullopt;
            constexpr int kMost = 1000;
            const auto size = pair_of(*word, 'x', least, kMost);
            if (size) return GridLevel{(*size)[0], (*size)[1]};
            return at.expect(expected);
          },
          [](const GridLevel& size) { return Json(fmt::format("{}x{}", size.columns, size.rows)); },
          {expected, {{"type", "string"}, {"pattern", "^[0-9]+x[0-9]+$"}}}};
}

auto noise_level_record() {
  RECORD(sweep::NoiseLevel, "a noise")
  REQUIRED(length_mm, "Noise of a chain reading, 1 sigma.", kNoiseMm)
  REQUIRED(position_mm, "Noise of a mark's position, 1 sigma on each axis.", kNoiseMm);
}

auto stated_machine_record() {
  RECORD(StatedMachine, "a machine")
  REQUIRED(name, "Name of the machine in messages and pages.")
  REQUIRED(machine_file, "Path of the true machine, from this file.")
  SPARSE(stated_file, "Path of the machine that the owner assumes; default: the true one.")
  OPTIONAL(model, "The physics used to simulate readings.", in_order<Model>(kModels))
  OPTIONAL(unmodelled_mm, "Size of smooth errors outside every model.", kNoiseMm);
}

auto effects_record() {
  RECORD(sweep::EffectsLevel, "hidden effects")
  REQUIRED(name, "Name of this level in results.")
  REQUIRED(effects, "Effects of the true machine that are hidden from the fit.");
}

auto use_record() {
  RECORD(sweep::UseLevel, "a machine that the map is used on")
  REQUIRED(name, "Name of this level in results.")
  SPARSE(effects, "Effects in addition to those of the measured machine.")
  OPTIONAL(another_of_the_build,
           "A different machine of the same build, with its settings drawn anew.");
}

SweepSpec default_sweep() {
  SweepSpec spec;
  spec.grids = {GridLevel{}};
  spec.spacings = {synthetic::DesignKind::regular};
  spec.noises = {sweep::NoiseLevel{}};
  spec.jitters_mm = {0.0};
  spec.surfaces = {sweep::SurfaceLevel::residual};
  spec.effects = {{"none", {}}};
  spec.uses = {{"the same machine", {}, false}};
  return spec;
}

/// The content of the file, with machines by their files.
struct StatedSweep : SweepSpec {
  StatedSweep() : SweepSpec(default_sweep()) {}
  std::vector<StatedMachine> machine_files;
};

}  // namespace

FILE_RECORD(sweep, StatedSweep, "a chaintrue_sweep file", kSweepFormat)
REQUIRED(name, "Name of the sweep.")
OPTIONAL(question, "The question it answers, in a sentence.")
OPTIONAL(seed, "Seed of the random draws; the same seed gives the same numbers.", seed_number())
REQUIRED(repetitions, "Number of machines drawn for each combination.", integer(1, 1'000'000))
OPTIONAL(repeats, "Number of marks that are visited twice.", integer(0, 10'000))
OPTIONAL(draw_settings, "Draw motors and zeros from the machine's uncertainty.")
OPTIONAL(whole_bed, "Evaluate the map over the whole bed, not only the measured part.")
OPTIONAL(evaluation, "Columns x rows of places where the map is compared with the truth.",
         grid_size(1))
OPTIONAL(grids, "Columns x rows of marks; a factor.", list(grid_size(2), 1))
OPTIONAL(spacings, "Spacing of the marks; a factor.",
         list(in_order<synthetic::DesignKind>({"regular", "chebyshev"}), 1))
OPTIONAL(noises, "Noise of the readings; a factor.", list(noise_level_record(), 1))
OPTIONAL(jitters_mm, "Largest distance of the sled from its mark; a factor.",
         list(number({"mm", 0.0, 1000.0}), 1))
OPTIONAL(surfaces, "Kind of map; a factor.",
         list(by_name_to(sweep::SurfaceLevel::direct_natural), 1))
NAMED(required, "machines", machine_files, "The machines; a factor.",
      list(stated_machine_record(), 1))
OPTIONAL(effects, "Hidden effects; a factor.", list(effects_record(), 1))
NAMED(optional, "used_on", uses, "The machine that the map is used on; a factor.",
      list(use_record(), 1))
END_FILE_RECORD;

namespace {

void read_machines(const fs::path& path, const Words& effects, StatedSweep& stated,
                   std::set<std::string>& given, Problems& problems) {
  // Several levels may name one file; its warnings are given once.
  std::map<std::string, Machine> known;
  bool effects_are_sound = true;  // their problems are reported once
  const auto alongside = [&](const std::string& name) {
    const auto [at, is_new] = known.try_emplace(name);
    if (!is_new) return at->second;
    try {
      ReadMachine read = files::read(parse_machine, path.parent_path() / name);
      problems.add_warnings(read.warnings);
      at->second = std::move(read.machine);
    } catch (const InputError& error) {
      problems.add_all(error.problems());
    }
    try {
      const std::size_t own = at->second.declared.size();
      if (effects_are_sound) declare_effects(effects, at->second);
      for (std::size_t k = own; k < at->second.declared.size(); ++k)
        given.insert(std::string(at->second.declared[k]->id));
    } catch (const InputError& error) {
      effects_are_sound = false;
      problems.add_all(error.problems());
    }
    return at->second;
  };
  for (const StatedMachine& from : stated.machine_files) {
    sweep::MachineLevel level{from.name, {}, {}, from.model, from.unmodelled_mm};
    level.truth = alongside(from.machine_file);
    level.stated = from.stated_file.empty() ? level.truth : alongside(from.stated_file);
    stated.machines.push_back(level);
  }
}

/// Every effect must be able to act on every machine of the sweep.
void check_effects(const SweepSpec& spec, Problems& problems) {
  const auto check = [&](const std::string& list, std::size_t index,
                         const std::vector<AppliedEffect>& effects) {
    for (const sweep::MachineLevel& level : spec.machines) {
      Machine machine = level.truth;
      machine.effects = effects;
      for (const MachineProblem& problem : model::effects::problems_of_effects(machine)) {
        const std::string place = fmt::format("/{}/{}{}", list, index, problem.parameter);
        if (!problems.at_or_below(place)) problems.add(place, problem);
      }
    }
  };
  for (const auto i : each_index(spec.effects)) check("effects", i, spec.effects[i].effects);
  for (const auto i : each_index(spec.uses)) check("used_on", i, spec.uses[i].effects);
}

/// Unused input is a mistake.
void check_given(const SweepSpec& spec, std::set<std::string> given, Problems& problems) {
  const auto remove = [&](const std::vector<AppliedEffect>& effects) {
    for (const AppliedEffect& own : effects) given.erase(own.effect);
  };
  for (const auto& level : spec.effects) remove(level.effects);
  for (const auto& level : spec.uses) remove(level.effects);
  for (const std::string& id : given)
    problems.add("/effects", "", ProblemKind::missing,
                 "a line that names {}, or --effects without its file", id);
}

}  // namespace

ReadSweep read_sweep(const fs::path& path, const Words& effects) {
  Problems problems(name_in_messages(path));
  StatedSweep stated = read_document(sweep_record(), read_whole_file(path), problems);
  std::set<std::string> given;
  read_machines(path, effects, stated, given, problems);
  problems.throw_if_any();
  check_effects(stated, problems);
  check_given(stated, std::move(given), problems);
  problems.throw_if_any();
  std::string inputs = write_document(sweep_record(), stated);
  for (const sweep::MachineLevel& level : stated.machines)
    inputs += write_machine(level.truth) + write_machine(level.stated);
  return {stated, sha256(inputs), problems.warnings()};
}

}  // namespace chaintrue::grid::files
