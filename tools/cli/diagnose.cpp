// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue diagnose: what the simulation gets wrong at these points, why, the gain from naming
/// the cause, and what to measure next.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/names.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct DiagnoseCommand {
  GridInput input;
  TapeOptions tape;
  Words with;
  std::string output;
  std::string report;
  std::string extended_machine;
  std::string corrected_grid;
  std::string law;
  std::string held_out;
  std::string assume_order;
  bool without_gain = false;
  std::string without;                  ///< points of belts, from 1
  diagnosis::DiagnosisOptions options;  ///< as stated; diagnosis_options() adds the rest
  bool json = false;
};

void assume_order(const DiagnoseCommand& command, MeasuredGrid& measured) {
  if (command.assume_order.empty()) return;
  const auto refuse_order = [&command](const std::string& expected, ProblemKind kind) {
    refuse("command line", "--assume-order", command.assume_order, expected, kind);
  };
  if (any_of(measured.points, &grid::MeasuredPoint::order)) {
    refuse_order("to be left out, because these points have the order of their visits",
                 ProblemKind::contradiction);
  }
  const auto numbers = visit_numbers(measured.points, *files::visiting_order(command.assume_order));
  if (!numbers) refuse_order(numbers.error(), ProblemKind::bad_syntax);
  for (const auto i : each_index(measured.points)) measured.points[i].order = (*numbers)[i];
}

/// The cost grows with the square of the number and more (docs/reliability.md): these take half a
/// minute, and more would change no name.
constexpr std::size_t kMostDiagnosed = 1200;

void refuse_too_many_to_diagnose(const Measured& measured, const std::string& path) {
  const auto [points, distances, holes] = counts_of(measured);
  if (points + distances <= kMostDiagnosed) return;
  const std::string counted = distances == 0 ? fmt::format("{} points", points)
                              : points == 0
                                  ? fmt::format("{} distances", distances)
                                  : fmt::format("{} points and {} distances", points, distances);
  throw Failed(name_in_messages(path), "too_many",
               fmt::format("{} are more than a diagnosis accepts ({}): leave some out, evenly over "
                           "the bed, and keep those measured twice; chaintrue fit accepts them all",
                           counted, kMostDiagnosed));
}

/// Readings more accurate than the simulation over a bed.
void note_fine_readings(const Measured& measured, Diagnosis& found) {
  constexpr double kFinestMm = 0.01;
  for (const auto* own : measured.grids()) {
    if (!own->noise || own->noise->length_mm >= kFinestMm) continue;
    found.notes.push_back(
        fmt::format("The reading error that you entered, {} mm, is below the numerical accuracy; "
                    "{} mm was used instead.",
                    own->noise->length_mm, kFinestMm));
  }
}

diagnosis::DiagnosisOptions diagnosis_options(const DiagnoseCommand& command) {
  diagnosis::DiagnosisOptions options = command.options;
  options.order_assumed = !command.assume_order.empty();
  options.improvement = !command.without_gain;
  options.progress = shown_progress();
  return options;
}

/// With the file's name where the readings have none. \throws Failed if there is no diagnosis, like
/// those below.
Diagnosis named(tl::expected<Diagnosis, diagnosis::DiagnosisFailure> result,
                const DiagnoseCommand& command) {
  Diagnosis found = value_of(std::move(result), name_in_messages(command.input.grid));
  if (found.grid_name.empty()) found.grid_name = name_without_folders(command.input.grid);
  return found;
}

/// The accuracy with which the result predicts the grid of --held-out.
diagnosis::Transfer held_out(const DiagnoseCommand& command, const MeasuredGrid& measured,
                             const Diagnosis& found) {
  GridInput other = command.input;
  other.grid = command.held_out;
  const MeasuredGrid to = read_grid_input(other);
  auto transferred = value_of(transfer(measured, found, to), name_in_messages(command.held_out));
  if (transferred.to.empty())
    transferred.to = to.name.empty() ? name_without_folders(command.held_out) : to.name;
  return transferred;
}

/// Grids and holes; an order that was assumed is put into `measured`.
Diagnosis diagnosed(const DiagnoseCommand& command, Measured& measured) {
  if (MeasuredGrid* own = measured.first_grid()) assume_order(command, *own);
  refuse_too_many_to_diagnose(measured, command.input.grid);
  grid::keep_freed_memory();
  Diagnosis found = named(diagnose(measured, diagnosis_options(command)), command);
  note_fine_readings(measured, found);
  if (!command.assume_order.empty()) {
    found.notes.insert(
        found.notes.begin(),
        fmt::format("The order of visits was not recorded. Assumed: {}, lines from the top left.",
                    command.assume_order));
  }
  if (!command.held_out.empty())
    found.transferred = held_out(command, *measured.first_grid(), found);
  return found;
}

/// Belts are diagnosed by themselves, on the machine in their own file.
Diagnosis diagnosed_belts(const DiagnoseCommand& command, const InputFile& file) {
  const std::vector<std::size_t> without = points_left_out(command.without);
  const ReadBelts read = load_belts(file, "a diagnosis", without);
  // Twice as many take four times as long (docs/maslow4.md).
  constexpr std::size_t kMostPlaces = 2000;
  if (read.belts.points.size() > kMostPlaces) {
    throw Failed(file.name, "too_many",
                 fmt::format("{} places are more than a diagnosis accepts ({}): leave some out, "
                             "evenly over the sheet; chaintrue fit accepts them all",
                             read.belts.points.size(), kMostPlaces));
  }
  return named(diagnose(read.belts, diagnosis_options(command),
                        files::indices_without(read.belts.points.size(), without)),
               command);
}

/// A test drawing is diagnosed alone, with the plotter in its file.
Diagnosis diagnosed_drawing(const DiagnoseCommand& command, const InputFile& file) {
  return named(diagnose(files::parse_drawing(file.text, file.name), diagnosis_options(command)),
               command);
}

// The additional files of a diagnosis.

/// The grid for a fit on the extended machine: true positions of marks, readings without effects of
/// the visit. An assumed order is not written.
std::string corrected_grid_text(const DiagnoseCommand& command, const Diagnosis& found,
                                const Measured& input) {
  const auto ordered = found.visiting_order
                           ? diagnosis::visited_in(input, found.visiting_order->order)
                           : std::nullopt;
  MeasuredGrid measured = *(ordered ? *ordered : input).grids().front();
  measured.machine = found.extended_machine;
  append_all(measured.machine->effects, found.data_corrections);
  auto corrected = corrected_data(measured);
  if (!corrected) throw InputError({{"corrected grid", "", "", "", corrected.error().sentence()}});
  for (auto& point : corrected->grid.points) {
    if (ordered || !command.assume_order.empty()) point.order.reset();
  }
  return files::write_grid(corrected->grid);
}

/// The calibrated machine with the named causes.
std::string extended_machine_text(const Diagnosis& found, const std::string& source) {
  Words in_here;
  for (const auto& effect : found.extended_machine.effects) {
    if (effect.probability) in_here.push_back(cause_title(effect));
  }
  Words comments = {
      fmt::format("Made by chaintrue diagnose from {}: calibrated settings, with the causes {}.",
                  source, in_here.empty() ? "none" : fmt::format("{}", fmt::join(in_here, "; ")))};
  for (const auto& cause : causes_left_out(found))
    comments.push_back(fmt::format("Named but not included here: {}.", cause_title(cause.cause)));
  for (const auto& correction : found.data_corrections) {
    comments.push_back(fmt::format("Not included here, because it belongs to the data: {}.",
                                   cause_title(correction)));
  }
  return files::write_machine(found.extended_machine, comments);
}

/// The likeliest law as a file of a declared effect, or a sentence that explains why there is none.
tl::expected<std::string, std::string> law_text(const Diagnosis& found) {
  const std::vector<diagnosis::Law> none;
  const auto declaration = declaration_of(found.unexplained ? found.unexplained->laws : none,
                                          found.extended_machine.bed);
  if (!declaration) return tl::unexpected(declaration.error());
  return files::write_effect(*declaration);
}

/// The page if there is none; what to measure next if that helps; else a map.
void say_next_of(const DiagnoseCommand& command, const Diagnosis& found) {
  if (!command.output.empty() && command.report.empty())
    return say_next(report_words(command.output));
  Words words;
  const bool parts_causes = any_of(found.next_measurements, [&](const auto& next) {
    return !found.belts || next.kind != MeasurementKind::distance;
  });
  if (found.belts && (command.output.empty() || !parts_causes || !command.without.empty())) {
    words = {"fit", command.input.grid, "-o", "anchors.json"};
    add_option_words(words, "--without", command.without);
  } else if (found.drawing) {
    words = {"fit", command.input.grid, "-o", "found.json"};
  } else if (!command.output.empty() && !found.next_measurements.empty()) {
    words = {"plan", command.input.grid, "--after", command.output};
  } else {
    words = {"fit", command.input.grid, "-o", "map.json"};
    add_option_words(words, "--machine", command.input.machine);
  }
  add_option_words(words, "--with", command.with);
  if (words.front() == "fit") add_option_words(words, "--effects", command.input.effects);
  say_next(words);
}

int run_diagnose(Verb verb, const DiagnoseCommand& command) {
  const InputFiles opened = open_inputs(command.input.grid, command.with);
  const InputFile& file = opened.front();
  require_kind(file, {FileKind::grid, FileKind::holes, FileKind::belts, FileKind::drawing});
  // Belts and drawings are diagnosed alone, whatever is given with them.
  const bool is_alone = file.kind == FileKind::belts || file.kind == FileKind::drawing;
  verb.refuse_idle_options(is_alone ? file.fact() : facts_of(opened));
  Measured input;
  if (!is_alone) input = load_measured(opened, command.input, command.tape, MeasuredUse::fit);
  const Diagnosis found = !is_alone                      ? diagnosed(command, input)
                          : file.kind == FileKind::belts ? diagnosed_belts(command, file)
                                                         : diagnosed_drawing(command, file);
  const std::string source = name_without_folders(command.input.grid);
  const Provenance origin = made_by(verb);
  const std::string written = files::write_diagnosis(found, origin);
  Outputs outputs;
  const auto add = [&outputs](const std::string& path, auto&& text) {
    if (!path.empty()) outputs.push_back({path, text()});
  };
  add(command.output, [&] { return written; });
  Document document =
      diagnosis_document(found, source, command.report.empty() ? Detail::verbose : Detail::page);
  add_made_by(origin, document.sections);
  add(command.report, [&] { return render_html(document); });
  add(command.extended_machine, [&] { return extended_machine_text(found, source); });
  add(command.corrected_grid, [&] { return corrected_grid_text(command, found, input); });
  tl::expected<std::string, std::string> law;
  if (!command.law.empty()) law = law_text(found);
  if (law) outputs.push_back({command.law, *law});
  const bool is_stdout_taken = any_of(outputs, having(&files::OutputFile::path, "-"));
  write_outputs(outputs);
  if (command.json && !is_stdout_taken) {
    fmt::print("{}", written);
  } else {
    fmt::print(is_stdout_taken ? stderr : stdout, "{}", render_text(document));
  }
  if (!command.report.empty() && command.report != "-")
    say("The report is {}: open it in any browser.", command.report);
  if (!law) {
    say("{}: {}", name_in_messages(command.input.grid), law.error());
    return kNotSupportedOrOutside;
  }
  say_next_of(command, found);
  return kDone;
}

}  // namespace

void add_diagnose(Verb app) {
  using namespace facts;
  auto [verb, c] = app.add_verb<DiagnoseCommand>(
      "diagnose",
      "Find what the machine does wrong and why, and how much knowing the cause improves the map",
      R"(The exit code is 0 even if nothing was found.

Example:
  build/chaintrue simulate --machine fixtures/machines/classic.json --grid 7x5 --repeats 6 \
    --length-noise-mm 0.2 --position-noise-mm 0.3 --effect chain_pitch_error:left:elongation=0.0012 -o worn.json
  build/chaintrue diagnose worn.json -o diagnosis.json --report diagnosis.html --extended-machine worn_machine.json
  build/chaintrue fit worn.json --machine worn_machine.json -o map.json
  build/chaintrue diagnose fixtures/holes/nine_holes.json --report holes.html
  build/chaintrue diagnose fixtures/belts/thirty_one_places.json -o belts_diagnosis.json
  build/chaintrue diagnose fixtures/plotter/mural_drawing.json)",
      run_diagnose);
  add_grid_options(verb, c.input);
  add_tape_options(verb, c.tape);
  verb.has(
      {effects_row(c.input),
       {"--with", reads(c.with), "More grids and holes of the same machine, used together", chains,
        "to be left out, because belts and drawings are diagnosed with the machine in their "
        "file"},
       {"-o,--output", writes(c.output, {Origin::diagnosis}),
        "The diagnosis with all its numbers (JSON)"},
       {"--report", writes(c.report, {Origin::page}), "The diagnosis as a web page (HTML)"},
       {"--extended-machine", writes(c.extended_machine, {Origin::machine}),
        "The machine with calibrated settings and the causes that were named", chains,
        "to be left out, because belts and drawings are diagnosed with the machine in their "
        "file"},
       {"--corrected-grid", writes(c.corrected_grid, {Origin::measured}),
        "The points with that machine, with marks and readings corrected where they were the "
        "cause; input for fit",
        one_grid, "to be left out, because only a single grid can be corrected"},
       {"--law", writes(c.law, {Origin::list}),  // edited by hand: replaced with --force alone
        "The most probable law of the unexplained pattern (90 % or more), as a file for --effects",
        chains, "to be left out, because a declared cause acts on chains"},
       {"--json", c.json, "Print the diagnosis file on standard output"},
       {"--held-out", reads(c.held_out),
        "Another grid of the same machine, to test how well the result predicts it", one_grid,
        "to be left out, because it compares two grids"},
       {"--assume-order",
        {c.assume_order, files::kVisitingOrders},
        "Order of visits to assume if the points have none, in lines from the top left. "
        "Drift, skips and hysteresis need an order; the report notes the assumption",
        grid,
        "to be left out, because it applies to the points of a grid only"},
       without_row(c.without),
       {"--accept-class", c.options.accept_class,
        "If the points cannot distinguish long links from a long tape, assume the links, "
        "without measuring them",
        chains, "to be left out, because it applies to chains and the tape for marks only"},
       {"--no-gain", c.without_gain,
        "Do not compute how much naming the causes improves the map, which takes most of "
        "the time",
        chains, "to be left out for belts and drawings, because the gain applies to a map"},
       {"--seed",
        {c.options.seed, {"", 0.0, 9e15}},
        "Seed of the simulations: same seed, same answer"}});
}

}  // namespace chaintrue::cli
