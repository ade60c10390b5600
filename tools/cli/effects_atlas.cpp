// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/effects_atlas.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "grid/files/drawing_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/synthetic/atlas.hpp"
#include "model/reading_model.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "tools/cli/atlas_page.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

struct NamedAtlas {
  synthetic::Atlas atlas;
  std::string machine;
};

NamedAtlas of_plotter(const model::PlotterMachine& machine, const std::string& cause) {
  return {synthetic::atlas_of(*model::make_plotter_mechanism(machine), cause), machine.name};
}

void refuse_declared(const InputFile& file, const std::vector<std::string>& declared) {
  if (declared.empty()) return;
  OptionProblems problems;
  problems.add(
      "--effects",
      declared.front(),
      fmt::format("to be left out, because declared effects act on two chains, which {} does not "
                  "have", file.name),
      ProblemKind::contradiction);
  problems.throw_if_any();
}

NamedAtlas atlas_of_file(const InputFile& file,
                         const std::string& cause,
                         const std::vector<std::string>& declared) {
  if (is_of_a_plotter(file)) {
    refuse_declared(file, declared);
    const files::ReadPlotter read = load_plotter(file);
    print_warnings(read.warnings);
    return of_plotter(read.plotter.set.machine, cause);
  }
  require_kind(file,
               {FileKind::machine,
                FileKind::belts,
                FileKind::anchors,
                FileKind::plotter,
                FileKind::drawing});
  if (file.kind == FileKind::machine) {
    Machine machine = load_machine(file);
    files::declare_effects(declared, machine);
    return {synthetic::atlas_of(*model::make_chain_mechanism(machine), cause), machine.name};
  }
  refuse_declared(file, declared);
  if (file.kind == FileKind::drawing)
    return of_plotter(files::parse_drawing(file.text, file.name).machine, cause);
  const BeltMachine machine = load_belt_machine(file);
  return {synthetic::atlas_of(machine, cause), machine.name};
}

}  // namespace

int write_atlas(const std::string& machine,
                const std::string& cause,
                const std::vector<std::string>& declared,
                const std::string& output) {
  const NamedAtlas named = atlas_of_file(open_input(machine), cause, declared);
  if (named.atlas.pictures.empty() && named.atlas.not_drawn.empty()) {
    OptionProblems problems;
    problems.add("effect",
                 cause,
                 fmt::format("a cause or a setting of {}: without a name all are drawn", machine),
                 ProblemKind::unknown_word);
    problems.throw_if_any();
  }
  end_progress();
  write_output(output, atlas_page(named.atlas, named.machine));
  fmt::print(stderr,
             "{}: {} of possible causes; find the one that looks like your sheet\n",
             output,
             named.atlas.pictures.size() == 1
                 ? "a picture"
                 : fmt::format("{} pictures", named.atlas.pictures.size()));
  for (const std::string& missing : named.atlas.not_drawn)
    fmt::print(
        stderr, "No picture of {}: this machine cannot work with it at its usual size.\n", missing);
  return kDone;
}

}  // namespace chaintrue::cli
