// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Programs compensated and verified, from text to text; options, map and controller are those of
/// `chaintrue gcode`.
#include <fmt/format.h>

#include <optional>
#include <utility>

#include "grid/files/file_type.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/gcode_expected.hpp"
#include "tools/cli/gcode_job.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/report/path_report.hpp"

namespace chaintrue::python {
namespace {

using cli::GcodeMachine;
using cli::GcodeOptions;

/// The text of a map's or of anchors' file in place of the file.
GcodeMachine machine_of(GcodeOptions& options, const std::string& text) {
  const cli::FileKind kind = grid::files::kind_of(text, "");
  options.map = kind == cli::FileKind::anchors ? "the anchors" : "the map";
  options.map_file = cli::InputFile{options.map, options.map, text, kind};
  return GcodeMachine(options);
}

[[noreturn]] void refuse(std::vector<gcode::Problem> problems, std::uint64_t count) {
  std::string sentence;
  for (const gcode::Problem& problem : problems)
    sentence += (sentence.empty() ? "" : "\n") + problem.message();
  if (count > problems.size())
    sentence += fmt::format("\n... and {} more lines", count - problems.size());
  throw GcodeFailure(sentence, std::move(problems));
}

template <class T>
T value_or_refuse(gcode::Result<T> result) {
  if (!result) refuse({std::move(result.error())}, 1);
  return *std::move(result);
}

gcode::VerifySummary verified(const GcodeOptions& options,
                              const GcodeMachine& machine,
                              const std::string& original,
                              const std::string& run,
                              gcode::VerifyOptions settings) {
  auto intended = gcode::LineSource::from_text(original);
  auto written = gcode::LineSource::from_text(run);
  auto summary = gcode::verify(intended, written, machine.corrector(), options.dialect(), settings);
  if (!summary) refuse({summary.error().problem}, 1);
  return *std::move(summary);
}

struct Compensated {
  std::string text;
  gcode::CompensateSummary summary;
  std::vector<gcode::Note> notes;
  report::PathReport path;
  std::optional<gcode::VerifySummary> proof;
  cli::PromisedError promised;
};

report::PathPiece piece(const gcode::Move& move,
                        const gcode::PathSample& from,
                        const gcode::PathSample& to) {
  return {move.line,
          move.kind == gcode::MoveKind::rapid,
          from.target.x_mm,
          from.target.y_mm,
          to.target.x_mm,
          to.target.y_mm,
          {from.command.x_mm - from.target.x_mm, from.command.y_mm - from.target.y_mm},
          {to.command.x_mm - to.target.x_mm, to.command.y_mm - to.target.y_mm}};
}

Compensated compensated(const std::string& program,
                        const GcodeOptions& options,
                        const GcodeMachine& machine,
                        const grid::Provenance& made_by) {
  Compensated result;
  gcode::CompensateOptions settings = cli::compensate_options(options, machine);
  settings.made_by = made_by;
  gcode::CutPlaces cuts;
  settings.on_command =
      [&](const gcode::Move& move, const gcode::PathSample& from, const gcode::PathSample& to) {
        if (move.kind != gcode::MoveKind::rapid) cuts.add(move.line, from.target, to.target);
        if (move.names_xy) result.path.add(piece(move, from, to));
      };
  gcode::Compensator compensator(
      machine.corrector(), settings, [&](std::string_view bytes) { result.text += bytes; });
  auto source = gcode::LineSource::from_text(program);
  auto summary = compensator.run(source, options.dialect());
  const gcode::Findings& findings = compensator.findings();
  if (!findings.problems.empty()) refuse(findings.problems, findings.problem_count);
  result.summary = value_or_refuse(std::move(summary));
  result.notes = findings.notes;
  if (!options.no_verify) {
    result.proof =
        verified(options, machine, program, result.text, cli::verify_options(options, machine));
    if (!result.proof->holds()) {
      throw cli::Failed("the program", "not_held",
                    fmt::format("Run on a simulated {} controller, the compensated program does "
                                "not hold {} mm: {}. Try another tolerance_mm.",
                                machine.corrector().firmware().name,
                                options.tolerance_mm,
                                result.proof->fault));
    }
  }
  result.promised = {cuts.expected(machine.target()),
                     result.proof ? result.proof->largest_mm() : options.tolerance_mm};
  return result;
}

/// line, 1 for a rapid, start x y, end x y, correction at the start x y and at the end x y.
Pairs rows_of(const report::PathReport& path) {
  Pairs rows = new_rows(path.pieces().size(), 10);
  double* number = rows.mutable_data();
  for (const report::PathPiece& piece : path.pieces()) {
    for (const double value : {static_cast<double>(piece.line),
                               piece.is_rapid ? 1.0 : 0.0,
                               piece.x0_mm,
                               piece.y0_mm,
                               piece.x1_mm,
                               piece.y1_mm,
                               piece.correction0.x_mm,
                               piece.correction0.y_mm,
                               piece.correction1.x_mm,
                               piece.correction1.y_mm})
      *number++ = value;
  }
  return rows;
}

py::dict handed_over(const Compensated& done) {
  py::list notes;
  for (const gcode::Note& note : done.notes)
    notes.append(py::make_tuple(note.line, note.name, note.sentence));
  return py::dict(
      "text"_a = done.text,
      "moves"_a = done.summary.moves,
      "commands"_a = done.summary.commands,
      "path_mm"_a = done.summary.path_mm,
      "largest_correction_mm"_a = done.summary.largest_correction_mm,
      "largest_correction_line"_a = done.summary.largest_correction_line,
      "strays_mm"_a = done.proof ? std::optional(done.proof->largest_mm()) : std::nullopt,
      "expected_mm"_a = done.promised.measured_mm(),
      "notes"_a = notes,
      "pieces"_a = rows_of(done.path));
}

py::dict compensate(const std::string& program,
                    const std::string& target,
                    GcodeOptions options,
                    const MadeBy& made_by) {
  const Compensated done = [&] {
    const py::gil_scoped_release others_may_work;
    grid::Provenance from = provenance_of(made_by);
    grid::files::forget_sources();
    for (const grid::SourceFile& source : from.inputs) grid::files::note_source(source);
    const GcodeMachine machine = machine_of(options, target);
    if (machine.map() != nullptr && !options.forced) {
      const std::string why = cli::not_to_cut_with(*machine.map());
      if (!why.empty())
        throw cli::Failed("the map", "not_to_cut_with", why + " force=True continues anyway.");
    }
    // What the machine reads is known now.
    from.inputs = grid::files::sources_read();
    return compensated(program, options, machine, from);
  }();
  return handed_over(done);
}

py::dict verify(const std::string& original,
                const std::string& run,
                const std::string& target,
                GcodeOptions options) {
  gcode::VerifySummary summary;
  std::optional<double> uncompensated_mm;
  cli::PromisedError promised;
  {
    const py::gil_scoped_release others_may_work;
    const GcodeMachine machine = machine_of(options, target);
    gcode::VerifyOptions settings = cli::verify_options(options, machine);
    gcode::CutPlaces cuts;
    settings.on_move = [&cuts](const gcode::Move& move) { cuts.add(move); };
    summary = verified(options, machine, original, run, settings);
    auto again = gcode::LineSource::from_text(original);
    const auto control =
        gcode::uncompensated(again, machine.corrector(), options.dialect(), settings);
    if (control) uncompensated_mm = control->distance_mm;
    promised = {control ? cuts.expected(machine.target()) : std::nullopt, summary.largest_mm()};
  }
  return py::dict("holds"_a = summary.holds(),
                  "largest_mm"_a = summary.largest_mm(),
                  "line"_a = summary.worst().original_line,
                  "feeds_mm"_a = summary.feeds.distance_mm,
                  "rapids_mm"_a = summary.rapids.distance_mm,
                  "uncompensated_mm"_a = uncompensated_mm,
                  "expected_mm"_a = promised.measured_mm(),
                  "tick_overshoot_mm"_a = summary.tick_overshoot_mm,
                  "commands"_a = summary.commands,
                  "fault"_a = summary.fault);
}

}  // namespace

void add_gcode(py::module_& module) {
  py::class_<GcodeOptions> options(module, "GcodeOptions");
  options.def(py::init<>());
#define CHAINTRUE_OPTION(name) options.def_readwrite(#name, &GcodeOptions::name)
  CHAINTRUE_OPTION(tolerance_mm);
  CHAINTRUE_OPTION(decimals);
  CHAINTRUE_OPTION(largest_correction_mm);
  CHAINTRUE_OPTION(steepest_correction);
  CHAINTRUE_OPTION(controller);
  CHAINTRUE_OPTION(machine);
  CHAINTRUE_OPTION(settings);
  CHAINTRUE_OPTION(frame);
  CHAINTRUE_OPTION(home);
  CHAINTRUE_OPTION(keep_rapids_whole);
  CHAINTRUE_OPTION(home_is_zero);
  CHAINTRUE_OPTION(skip_deletable);
  CHAINTRUE_OPTION(tools_have_no_diameter);
  CHAINTRUE_OPTION(no_verify);
  CHAINTRUE_OPTION(forced);
#undef CHAINTRUE_OPTION
  module.def("compensate", compensate);
  module.def("verify", verify);
}

}  // namespace chaintrue::python
