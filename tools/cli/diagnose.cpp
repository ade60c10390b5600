// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue diagnose: what the simulation gets wrong on these points, why, what naming the cause
/// gains, and what to measure next.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_error.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/law_declaration.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/diagnosis/trend.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/corrected_data.hpp"
#include "tools/cli/assumed_order.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;
using grid::diagnosis::Diagnosis;

struct DiagnoseCommand {
  GridInput input;
  TapeInput tape;
  std::vector<std::string> with;
  std::string output;
  std::string report;
  std::string extended_machine;
  std::string corrected_grid;
  std::string law;
  std::string held_out;
  std::string before;
  std::string assume_order;
  bool accept_class = false;
  std::string without;  ///< points of belts, from 1
  std::uint64_t seed = 1;
  bool json = false;
};

void assume_order(const DiagnoseCommand& command, grid::MeasuredGrid& measured) {
  if (command.assume_order.empty()) return;
  OptionProblems problems;
  if (std::any_of(measured.points.begin(), measured.points.end(), [](const auto& point) {
        return point.order.has_value();
      })) {
    problems.add("--assume-order",
                 command.assume_order,
                 "to be left out, since these points say in which order they were visited");
    problems.throw_if_any();
  }
  const auto numbers = grid::visit_numbers(measured.points, *order_from_word(command.assume_order));
  if (!numbers) {
    problems.add("--assume-order", command.assume_order, numbers.error());
    problems.throw_if_any();
  }
  for (std::size_t i = 0; i < measured.points.size(); ++i) measured.points[i].order = (*numbers)[i];
}

std::string file_name(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

/// The grid as a fit on the extended machine wants it: marks where they are, readings without what
/// depends on the visit. An order that was only assumed is not handed on as if it were known.
std::string corrected_grid_text(const Diagnosis& found,
                                grid::MeasuredGrid measured,
                                bool order_assumed) {
  measured.machine = found.extended_machine;
  measured.machine->effects.insert(measured.machine->effects.end(),
                                   found.data_corrections.begin(),
                                   found.data_corrections.end());
  auto corrected = grid::corrected_data(measured);
  if (!corrected)
    throw files::InputError({{"corrected grid", "", "", corrected.error().sentence()}});
  for (auto& point : corrected->grid.points) {
    if (order_assumed) point.order.reset();
  }
  return files::write_grid(corrected->grid);
}

std::string extended_machine_text(const Diagnosis& found, const std::string& source) {
  std::string named;
  for (const auto& cause : found.causes) {
    named += fmt::format("{}{}", named.empty() ? "" : "; ", cause_title(cause.cause));
  }
  std::vector<std::string> comments = {
      fmt::format("Made by chaintrue diagnose from {}: settings calibrated, named: {}.",
                  source,
                  named.empty() ? "nothing" : named)};
  for (const auto& correction : found.data_corrections) {
    comments.push_back(
        fmt::format("Not in here, because it belongs to the data: {}.", cause_title(correction)));
  }
  return files::write_machine(found.extended_machine, comments);
}

/// The likeliest law as a file of a declared effect, or the sentence why there is none.
tl::expected<std::string, std::string> law_text(const Diagnosis& found) {
  const std::vector<grid::diagnosis::Law> none;
  const auto declaration = grid::diagnosis::declaration_of(
      found.unexplained ? found.unexplained->laws : none, found.extended_machine.bed);
  if (!declaration) return tl::unexpected(declaration.error());
  return files::write_effect(*declaration);
}

using Outcome = tl::expected<Diagnosis, std::string>;

std::string sentence_of(const std::string& path, const grid::diagnosis::DiagnosisFailure& failure) {
  return fmt::format("{}: {}", files::name_in_messages(path), failure.sentence());
}

/// "28 points and 20 distances"
std::string counted(const grid::Measured& measured) {
  std::size_t points = 0;
  std::size_t distances = 0;
  for (const auto* own : measured.grids()) points += own->points.size();
  for (const auto* set : measured.holes()) distances += set->distances.size();
  if (distances == 0) return fmt::format("{} points", points);
  if (points == 0) return fmt::format("{} distances", distances);
  return fmt::format("{} points and {} distances", points, distances);
}

/// The cost grows with the square of the number and more (docs/reliability.md): these take half a
/// minute, and more would name nothing else.
constexpr std::size_t kMostDiagnosed = 1200;

/// Empty where there are not too many.
std::string too_many_to_diagnose(const grid::Measured& measured) {
  std::size_t units = 0;
  for (const auto* own : measured.grids()) units += own->points.size();
  for (const auto* set : measured.holes()) units += set->distances.size();
  if (units <= kMostDiagnosed) return {};
  return fmt::format(
      "{} are more than a diagnosis takes ({}): leave some out, evenly over the bed, and keep "
      "those that were measured twice; chaintrue fit takes them all",
      counted(measured),
      kMostDiagnosed);
}

/// Readings better than the simulation is computed over a bed.
void note_fine_readings(const grid::Measured& measured, Diagnosis& found) {
  constexpr double kFinestMm = 0.01;
  for (const auto* own : measured.grids()) {
    if (!own->noise || own->noise->length_mm >= kFinestMm) continue;
    found.notes.push_back(
        fmt::format("You said that the readings are good to {} mm, finer than the simulation can "
                    "compute over a bed; {} mm was used instead.",
                    own->noise->length_mm,
                    kFinestMm));
  }
}

Outcome diagnosis_of(const DiagnoseCommand& command, const grid::Measured& measured) {
  grid::diagnosis::DiagnosisOptions options;
  options.seed = command.seed;
  options.order_assumed = !command.assume_order.empty();
  options.accept_class = command.accept_class;
  options.progress = shown_progress();
  auto found = grid::diagnosis::diagnose(measured, options);
  if (!found) return tl::unexpected(sentence_of(command.input.grid, found.error()));
  if (found->grid_name.empty()) found->grid_name = file_name(command.input.grid);
  return *std::move(found);
}

/// How well what was found predicts the grid of --held-out.
tl::expected<grid::diagnosis::Transfer, std::string> held_out(const DiagnoseCommand& command,
                                                              const grid::MeasuredGrid& measured,
                                                              const Diagnosis& found) {
  GridInput other = command.input;
  other.grid = command.held_out;
  const grid::MeasuredGrid to = read_grid_input(other);
  auto transferred = grid::diagnosis::transfer(measured, found, to);
  if (!transferred) return tl::unexpected(sentence_of(command.held_out, transferred.error()));
  if (transferred->to.empty())
    transferred->to = to.name.empty() ? file_name(command.held_out) : to.name;
  return *std::move(transferred);
}

Outcome diagnosed(const DiagnoseCommand& command, grid::Measured& measured) {
  if (grid::MeasuredGrid* own = measured.first_grid()) assume_order(command, *own);
  if (const std::string sentence = too_many_to_diagnose(measured); !sentence.empty()) {
    return tl::unexpected(
        fmt::format("{}: {}", files::name_in_messages(command.input.grid), sentence));
  }
  auto found = diagnosis_of(command, measured);
  if (!found) return found;
  note_fine_readings(measured, *found);
  if (!command.assume_order.empty()) {
    found->notes.insert(found->notes.begin(),
                        fmt::format("The visiting order was not measured but assumed: {}, lines "
                                    "from the top left.",
                                    command.assume_order));
  }
  if (command.held_out.empty()) return found;
  auto transferred = held_out(command, *measured.first_grid(), *found);
  if (!transferred) return tl::unexpected(transferred.error());
  found->transferred = *std::move(transferred);
  return found;
}

std::string page_alongside(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".html").string();
}

/// The page, where there is none; what to measure next, where that tells more; else a map.
void say_next_of(const DiagnoseCommand& command, const Diagnosis& found) {
  if (!command.output.empty() && command.report.empty())
    return say_next({"report", command.output, "-o", page_alongside(command.output)});
  std::vector<std::string> words;
  const bool parts_causes = std::any_of(
      found.next_measurements.begin(), found.next_measurements.end(), [&](const auto& next) {
        return !found.belts || next.kind != grid::diagnosis::MeasurementKind::distance;
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
  // A plain fit looks for no cause.
  if (words.front() == "plan" || command.input.effects.empty()) return say_next(words);
  words.emplace_back("--causes");
  for (const std::string& own : command.input.effects)
    words.insert(words.end(), {"--effects", own});
  say_next(words);
}

/// The number that a fit of the same belts begins with.
std::optional<grid::ErrorSummary> tool_today(const grid::MeasuredBelts& belts) {
  const auto fit = grid::diagnosis::fit_with_causes(belts);
  const auto error = fit ? grid::error_of_belts(*fit) : std::nullopt;
  return error ? error->today : std::nullopt;
}

/// Belts are diagnosed by themselves, on the machine in their own file.
Outcome diagnosed_belts(const DiagnoseCommand& command, const InputFile& file) {
  const std::vector<std::size_t> without = points_left_out(command.without);
  const files::ReadBelts read = load_belts(file, "a diagnosis", without);
  // Twice as many take four times as long (docs/maslow4.md).
  constexpr std::size_t kMostPlaces = 2000;
  if (read.belts.points.size() > kMostPlaces) {
    return tl::unexpected(
        fmt::format("{}: {} places are more than a diagnosis takes ({}): leave some out, evenly "
                    "over the sheet; "
                    "chaintrue fit takes them all",
                    file.name,
                    read.belts.points.size(),
                    kMostPlaces));
  }
  grid::diagnosis::DiagnosisOptions options;
  options.seed = command.seed;
  options.progress = shown_progress();
  auto found = grid::diagnosis::diagnose(
      read.belts, files::indices_beside(read.belts.points.size(), without), options);
  if (!found) return tl::unexpected(sentence_of(command.input.grid, found.error()));
  if (found->grid_name.empty()) found->grid_name = file_name(command.input.grid);
  found->tool_today = tool_today(read.belts);
  return *std::move(found);
}

/// A test drawing is diagnosed by itself, on the plotter in its own file.
Outcome diagnosed_drawing(const DiagnoseCommand& command, const InputFile& file) {
  grid::diagnosis::DiagnosisOptions options;
  options.seed = command.seed;
  options.progress = shown_progress();
  auto found = grid::diagnosis::diagnose(files::parse_drawing(file.text, file.name), options);
  if (!found) return tl::unexpected(sentence_of(command.input.grid, found.error()));
  if (found->grid_name.empty()) found->grid_name = file_name(command.input.grid);
  return *std::move(found);
}

/// Belts and drawings are diagnosed by themselves, whatever is given with them.
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
  // A wrong file is reported before the work.
  std::optional<Diagnosis> before;
  if (!command.before.empty()) before = files::read_diagnosis(command.before, nullptr);
  const std::vector<InputFile> opened = open_inputs(command.input.grid, command.with);
  const InputFile& file = opened.front();
  require_kind(file,
               {FileKind::grid, FileKind::holes, FileKind::belts, FileKind::drawing},
               file.kind == FileKind::belt_holes ? kBeltHolesAreFitted : "");
  refuse_what_does_nothing(verb, facts_of(opened));
  const bool of_belts = file.kind == FileKind::belts;
  const bool of_drawing = file.kind == FileKind::drawing;
  grid::Measured input;
  if (!of_belts && !of_drawing)
    input = load_measured(opened, command.input, command.tape, MeasuredUse::fit);
  auto found = of_belts     ? diagnosed_belts(command, file)
               : of_drawing ? diagnosed_drawing(command, file)
                            : diagnosed(command, input);
  if (!found) {
    fmt::print(stderr, "{}\n", found.error());
    return kBadInput;
  }
  if (before) found->trend = grid::diagnosis::trend(*before, *found, file_name(command.before));
  const std::string source = file_name(command.input.grid);
  const grid::Provenance origin = made_by(verb);
  const std::string written = files::write_diagnosis(*found, origin);
  std::vector<files::OutputFile> outputs;
  const auto add = [&outputs](const std::string& path, auto&& text) {
    if (!path.empty()) outputs.push_back({path, text()});
  };
  add(command.output, [&] { return written; });
  report::Document document = diagnosis_document(
      *found, source, command.report.empty() ? report::Detail::verbose : report::Detail::page);
  add_made_by(origin, document.sections);
  add(command.report, [&] { return report::render_html(document); });
  add(command.extended_machine, [&] { return extended_machine_text(*found, source); });
  add(command.corrected_grid, [&] {
    const auto ordered =
        found->visiting_order ? grid::diagnosis::visited_in(input, found->visiting_order->order) : std::nullopt;
    grid::MeasuredGrid corrected = ordered ? *ordered->grids().front() : *input.first_grid();
    return corrected_grid_text(*found, std::move(corrected), ordered || !command.assume_order.empty());
  });
  tl::expected<std::string, std::string> law;
  if (!command.law.empty()) law = law_text(*found);
  if (law && !law->empty()) outputs.push_back({command.law, *law});
  const bool is_stdout_taken = std::any_of(
      outputs.begin(), outputs.end(), [](const auto& output) { return output.path == "-"; });
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
  say_next_of(command, *found);
  return kDone;
}

void add_diagnose_outputs(Verb verb, DiagnoseCommand& command) {
  add_output(verb,
             "-o,--output",
             command.output,
             {Origin::diagnosis},
             "The diagnosis with all its numbers (JSON)");
  add_output(verb,
             "--report",
             command.report,
             {Origin::page},
             "The diagnosis as a page for a browser (HTML)");
  add_output(verb,
             "--extended-machine",
             command.extended_machine,
             {Origin::machine},
             "The machine with its settings calibrated and what was named in it");
  add_output(verb,
             "--corrected-grid",
             command.corrected_grid,
             {Origin::measured},
             "The points on that machine, with marks and readings corrected where they are the "
             "cause: fit these");
  // A file of an effect is edited by hand, and replaced with --force alone.
  add_output(verb,
             "--law",
             command.law,
             {Origin::list},
             "The likeliest law of what no cause explains, from 90 % on, as a file for --effects");
  verb.add_flag("--json", command.json, "The diagnosis file on standard output, for programs");
}

}  // namespace

void add_diagnose(Verb app, Run& run) {
  auto command = std::make_shared<DiagnoseCommand>();
  Verb verb = app.add_verb("diagnose",
                           "What the machine does wrong, why, and what knowing the cause gains");
  add_grid_options(verb, command->input);
  add_tape_options(verb, command->tape);
  add_effects_option(verb, command->input);
  add_input(verb,
            "--with",
            command->with,
            "More grids and holes of the same machine: all are used together");
  add_diagnose_outputs(verb, *command);
  add_input(verb,
            "--held-out",
            command->held_out,
            "Another grid of the same machine: how well the result predicts it");
  add_input(verb,
            "--before",
            command->before,
            "An earlier diagnosis of the same machine (JSON): says what changed since");
  verb.add_option("--assume-order",
                  command->assume_order,
                  "Order of the visits if the points have none, lines from the top left; for "
                  "drift, skips and hysteresis; the verdict says that it was assumed")
      .one_of({"rows", "columns", "serpentine_rows", "serpentine_columns"});
  add_without_option(verb, command->without);
  verb.add_flag("--accept-class",
                command->accept_class,
                "Where points cannot tell a long chain from a long tape: take it to be the chain, "
                "without a reading of its links");
  add_number(verb,
             "--seed",
             command->seed,
             {"", 0.0, 9e15},
             "For the simulated chances: same seed, same answer")
      .shows_default();
  verb.footer(
      "The exit code is 0 also where nothing was found.\n\nExample:\n  build/chaintrue simulate "
      "--machine fixtures/machines/classic.json --grid 7x5 --repeats 6 \\\n    --length-noise-mm "
      "0.2 --position-noise-mm 0.3 --effect chain_pitch_error:left:elongation=0.0012 -o "
      "worn.json\n  build/chaintrue diagnose worn.json -o diagnosis.json --report diagnosis.html "
      "--extended-machine worn_machine.json\n  build/chaintrue fit worn.json --machine "
      "worn_machine.json -o map.json\n  build/chaintrue diagnose fixtures/holes/nine_holes.json "
      "--report holes.html\n  build/chaintrue diagnose fixtures/belts/thirty_one_places.json -o "
      "belts_diagnosis.json\n  build/chaintrue diagnose fixtures/plotter/mural_drawing.json\n  build/chaintrue diagnose "
      "worn.json --before diagnosis.json");
  verb.when_chosen(
      [command, verb, &run] { run = [command, verb] { return run_diagnose(verb, *command); }; });
}

}  // namespace chaintrue::cli
