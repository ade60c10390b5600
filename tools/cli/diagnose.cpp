// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue diagnose: what the simulation gets wrong at these points, why, the gain from naming
/// the cause, and what to measure next.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/containers.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/diagnosed.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/diagnosis_files.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

/// The page if there is none; what to measure next if that helps; else a map.
void say_next_of(const DiagnoseCommand& command, const Diagnosis& found) {
  if (!command.output.empty() && command.report.empty())
    return say_next({"report", command.output, "-o", page_alongside(command.output)});
  std::vector<std::string> words;
  const bool parts_causes = grid::any_of(found.next_measurements, [&](const auto& next) {
    return !found.belts || next.kind != diagnosis::MeasurementKind::distance;
  });
  if (found.belts && (command.output.empty() || !parts_causes || !command.without.empty())) {
    words = {"fit", command.input.grid, "-o", "anchors.json"};
    if (!command.without.empty()) words.insert(words.end(), {"--without", command.without});
  } else if (found.drawing) {
    words = {"fit", command.input.grid, "-o", "found.json"};
  } else if (!command.output.empty() && !found.next_measurements.empty()) {
    words = {"plan", command.input.grid, "--after", command.output};
  } else {
    words = {"fit", command.input.grid, "-o", "map.json"};
    if (!command.input.machine.empty())
      words.insert(words.end(), {"--machine", command.input.machine});
  }
  for (const std::string& other : command.with) words.insert(words.end(), {"--with", other});
  if (words.front() == "fit") {
    for (const std::string& own : command.input.effects)
      words.insert(words.end(), {"--effects", own});
  }
  say_next(words);
}

/// Belts and drawings are diagnosed alone, whatever is given with them.
Facts facts_of(const std::vector<InputFile>& files) {
  if (files.front().kind == FileKind::drawing) return facts::drawing;
  if (files.front().kind == FileKind::belts) return facts::belts;
  Facts facts = 0;
  for (const InputFile& file : files) {
    if (file.kind == FileKind::grid) facts |= facts::grid;
    if (file.kind == FileKind::holes) facts |= facts::holes;
  }
  if (files.size() == 1) facts |= facts & facts::grid ? facts::one_grid : 0U;
  return facts | facts_of_tables(files);
}

int run_diagnose(Verb verb, const DiagnoseCommand& command) {
  const std::vector<InputFile> opened = open_inputs(command.input.grid, command.with);
  const InputFile& file = opened.front();
  require_kind(file,
               {FileKind::grid, FileKind::holes, FileKind::belts, FileKind::drawing},
               file.kind == FileKind::belt_holes ? kBeltHolesAreFitted : "");
  verb.refuse_idle_options(facts_of(opened));
  const bool of_belts = file.kind == FileKind::belts;
  const bool of_drawing = file.kind == FileKind::drawing;
  grid::Measured input;
  if (!of_belts && !of_drawing)
    input = load_measured(opened, command.input, command.tape, MeasuredUse::fit);
  const Diagnosis found = of_belts     ? diagnosed_belts(command, file)
                          : of_drawing ? diagnosed_drawing(command, file)
                                       : diagnosed(command, input);
  const std::string source = file_name(command.input.grid);
  const grid::Provenance origin = made_by(verb);
  const std::string written = files::write_diagnosis(found, origin);
  std::vector<files::OutputFile> outputs;
  const auto add = [&outputs](const std::string& path, auto&& text) {
    if (!path.empty()) outputs.push_back({path, text()});
  };
  add(command.output, [&] { return written; });
  Document document =
      diagnosis_document(found, source, command.report.empty() ? Detail::verbose : Detail::page);
  add_made_by(origin, document.sections);
  add(command.report, [&] { return report::render_html(document); });
  add(command.extended_machine, [&] { return extended_machine_text(found, source); });
  add(command.corrected_grid, [&] {
    const auto ordered = found.visiting_order
                             ? diagnosis::visited_in(input, found.visiting_order->order)
                             : std::nullopt;
    MeasuredGrid corrected = ordered ? *ordered->grids().front() : *input.first_grid();
    return corrected_grid_text(
        found, std::move(corrected), ordered || !command.assume_order.empty());
  });
  tl::expected<std::string, std::string> law;
  if (!command.law.empty()) law = law_text(found);
  if (law && !law->empty()) outputs.push_back({command.law, *law});
  const bool is_stdout_taken =
      grid::any_of(outputs, [](const auto& output) { return output.path == "-"; });
  write_outputs(outputs);
  if (command.json && !is_stdout_taken) {
    fmt::print("{}", written);
  } else {
    fmt::print(is_stdout_taken ? stderr : stdout, "{}", report::render_text(document));
  }
  if (!command.report.empty() && command.report != "-")
    fmt::print(stderr, "The report is {}: open it in any browser.\n", command.report);
  if (!law) {
    fmt::print(stderr, "{}: {}\n", files::name_in_messages(command.input.grid), law.error());
    return kNotSupportedOrOutside;
  }
  say_next_of(command, found);
  return kDone;
}

void add_diagnose_outputs(Verb verb, DiagnoseCommand& command) {
  add_output(verb,
             "-o,--output",
             command.output,
             {Origin::diagnosis},
             "The diagnosis with all its numbers (JSON)");
  add_output(
      verb, "--report", command.report, {Origin::page}, "The diagnosis as a web page (HTML)");
  add_output(verb,
             "--extended-machine",
             command.extended_machine,
             {Origin::machine},
             "The machine with calibrated settings and the causes that were named")
      .acts_on(facts::chains,
               "to be left out, because belts and drawings are diagnosed with the machine in their "
               "file");
  add_output(verb,
             "--corrected-grid",
             command.corrected_grid,
             {Origin::measured},
             "The points with that machine, with marks and readings corrected where they were the "
             "cause; input for fit")
      .acts_on(facts::one_grid, "to be left out, because only a single grid can be corrected");
  // A file of an effect is edited by hand, and replaced with --force alone.
  add_output(
      verb,
      "--law",
      command.law,
      {Origin::list},
      "The most probable law of the unexplained pattern (90 % or more), as a file for --effects")
      .acts_on(facts::chains, "to be left out, because a declared cause acts on chains");
  verb.add_flag("--json", command.json, "Print the diagnosis file on standard output");
}

}  // namespace

void add_diagnose(Verb app) {
  auto command = std::make_shared<DiagnoseCommand>();
  Verb verb = app.add_verb(
      "diagnose",
      "Find what the machine does wrong and why, and how much knowing the cause improves the map");
  add_grid_options(verb, command->input);
  add_tape_options(verb, command->tape);
  add_effects_option(verb, command->input);
  add_input(
      verb, "--with", command->with, "More grids and holes of the same machine, used together")
      .acts_on(facts::chains,
               "to be left out, because belts and drawings are diagnosed with the machine in their "
               "file");
  add_diagnose_outputs(verb, *command);
  add_input(verb,
            "--held-out",
            command->held_out,
            "Another grid of the same machine, to test how well the result predicts it")
      .acts_on(facts::one_grid, "to be left out, because it compares two grids");
  verb.add_option(
          "--assume-order",
          command->assume_order,
          "Order of visits to assume if the points have none, in lines from the top left. Drift, "
          "skips and hysteresis need an order; the report notes the assumption")
      .one_of({"rows", "columns", "serpentine_rows", "serpentine_columns"})
      .acts_on(facts::grid, "to be left out, because it applies to the points of a grid only");
  add_without_option(verb, command->without);
  verb.add_flag("--accept-class",
                command->accept_class,
                "If the points cannot distinguish long links from a long tape, assume the links, "
                "without measuring them")
      .acts_on(facts::chains, "to be left out, because it applies to chains and the tape for marks "
                              "only");
  verb.add_flag("--no-gain",
                command->without_gain,
                "Do not compute how much naming the causes improves the map, which takes most of "
                "the time")
      .acts_on(facts::chains, "to be left out for belts and drawings, because the gain applies to "
                              "a map");
  add_number(verb,
             "--seed",
             command->seed,
             {"", 0.0, 9e15},
             "Seed of the simulations: same seed, same answer")
      .shows_default();
  verb.footer(
      "The exit code is 0 even if nothing was found.\n"
      "\n"
      "Example:\n"
      "  build/chaintrue simulate --machine fixtures/machines/classic.json --grid 7x5 --repeats 6 "
      "\\\n"
      "    --length-noise-mm 0.2 --position-noise-mm 0.3 --effect "
      "chain_pitch_error:left:elongation=0.0012 -o worn.json\n"
      "  build/chaintrue diagnose worn.json -o diagnosis.json --report diagnosis.html "
      "--extended-machine worn_machine.json\n"
      "  build/chaintrue fit worn.json --machine worn_machine.json -o map.json\n"
      "  build/chaintrue diagnose fixtures/holes/nine_holes.json --report holes.html\n"
      "  build/chaintrue diagnose fixtures/belts/thirty_one_places.json -o belts_diagnosis.json\n"
      "  build/chaintrue diagnose fixtures/plotter/mural_drawing.json");
  verb.runs(command, run_diagnose);
}

}  // namespace chaintrue::cli
