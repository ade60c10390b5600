// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode compensate.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "grid/files/whole_file.hpp"
#include "tools/cli/gcode_verbs.hpp"
#include "tools/report/path_report.hpp"

namespace chaintrue::cli {
namespace {

/// Runs what has been written on the simulated controller and machine; kDone where it holds.
int verified(const GcodeOptions& options,
             const GcodeMachine& machine,
             const GcodeText& text,
             PendingFile& output,
             gcode::VerifySummary& summary) {
  auto original = text.open();
  auto written = output.written();
  const auto outcome = gcode::verify(original,
                                     written,
                                     machine.corrector(),
                                     options.dialect(),
                                     verify_options(options, machine));
  std::string fault;
  if (!outcome) {
    fault = outcome.error().problem.message();
  } else if (!outcome->holds()) {
    fault = outcome->fault;
  } else {
    summary = *outcome;
    return kDone;
  }
  fmt::print(stderr,
             "{}: the compensated program was run on a simulated {} and does not hold {} mm: {}\n"
             "nothing is written; another --tolerance-mm may hold, and --no-verify writes the file "
             "for a look at that line\n",
             grid::files::name_in_messages(options.program),
             machine.corrector().firmware().name,
             options.tolerance_mm,
             fault);
  return kCheckFailed;
}

}  // namespace

int run_gcode_compensate(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText text(options.program);
  auto source = text.open();
  gcode::CompensateOptions settings = compensate_options(options, machine);
  settings.input_hash = text.hash();
  report::PathReport picture;
  if (!options.report.empty()) {
    settings.on_command =
        [&picture](const gcode::Move& move, const gcode::PathSample& from, const gcode::PathSample& to) {
          const auto correction = [](const gcode::PathSample& sample) {
            return report::ToolVector{sample.command.x_mm - sample.target.x_mm,
                                      sample.command.y_mm - sample.target.y_mm};
          };
          picture.add({move.line,
                       move.kind == gcode::MoveKind::rapid,
                       from.target.x_mm,
                       from.target.y_mm,
                       to.target.x_mm,
                       to.target.y_mm,
                       correction(from),
                       correction(to)});
        };
  }
  PendingFile output(options.output);
  gcode::Compensator compensator(
      machine.corrector(), settings, [&](std::string_view bytes) { output.write(bytes); });
  const auto summary = compensator.run(source, options.dialect());
  const int code = report(options.program, compensator.findings());
  if (!summary) return report(options.program, summary.error());
  if (code != kDone) {
    fmt::print(stderr, "nothing is written\n");
    return code;
  }
  gcode::VerifySummary proof;
  if (!options.no_verify) {
    const int held = verified(options, machine, text, output, proof);
    if (held != kDone) return held;
  }
  output.commit();
  const std::string words = fmt::format(
      "{} blocks, {} moves, {:.1f} m of path: {} commands for {}; largest correction {:.2f} mm on "
      "line {}",
      summary->blocks,
      summary->moves,
      summary->path_mm / 1000.0,
      summary->commands,
      machine.corrector().firmware().name,
      summary->largest_correction_mm,
      summary->largest_correction_line);
  fmt::print(stderr, "{}\n", words);
  if (!options.no_verify) {
    fmt::print(stderr,
               "run on a simulated {}: the tool stays within {:.4f} mm of the path, tolerance {} mm\n",
               machine.corrector().firmware().name,
               proof.largest_mm(),
               options.tolerance_mm);
  }
  if (!options.report.empty()) {
    const model::Bed& bed = machine.machine().bed;
    picture.name = options.program;
    picture.verdict = words + ".";
    picture.sheet = {
        -0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
    picture.figures = {
        {fmt::format("{:.2f} mm", summary->largest_correction_mm), "largest correction"},
        {fmt::format("{:g} mm", options.tolerance_mm), "tolerance of the path"},
        {fmt::format("{:.1f} m", summary->path_mm / 1000.0), "path"},
        {fmt::format("{}", summary->commands), "commands written"}};
    grid::files::write_whole_file(options.report, report::render(report::page_of(picture)));
  }
  return kDone;
}

}  // namespace chaintrue::cli
