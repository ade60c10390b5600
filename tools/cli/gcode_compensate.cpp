// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode compensate.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "tools/cli/gcode_verbs.hpp"
#include "tools/cli/places.hpp"
#include "tools/report/path_report.hpp"

namespace chaintrue::cli {

int run_gcode_compensate(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText text(options.program);
  auto source = text.open();
  gcode::CompensateOptions settings = compensate_options(options, machine);
  settings.input_hash = text.hash();
  report::PathReport picture;
  if (!options.report.empty()) {
    settings.on_command =
        [&picture](const gcode::Move& move, const gcode::Station& from, const gcode::Station& to) {
          const auto correction = [](const gcode::Station& station) {
            return report::ToolVector{station.command.x_mm - station.target.x_mm,
                                      station.command.y_mm - station.target.y_mm};
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
  grid::files::PendingFile output(options.output);
  gcode::Compensator compensator(
      machine.corrector(), settings, [&](std::string_view bytes) { output.write(bytes); });
  const auto summary = compensator.run(source, options.dialect());
  const int code = report(options.program, compensator.findings());
  if (!summary) return report(options.program, summary.error());
  if (code != kDone) {
    fmt::print(stderr, "nothing is written\n");
    return code;
  }
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
  std::string page;
  if (!options.report.empty()) {
    const model::Bed& bed = machine.machine().bed;
    picture.name = options.program == "-"
                       ? "A program"
                       : std::filesystem::path(options.program).filename().string();
    picture.verdict = words + ".";
    picture.sheet = {
        -0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
    picture.figures = {
        {fmt::format("{:.2f} mm", summary->largest_correction_mm), "largest correction"},
        {fmt::format("{:g} mm", options.tolerance_mm), "tolerance of the path"},
        {fmt::format("{:.1f} m", summary->path_mm / 1000.0), "path"},
        {fmt::format("{}", summary->commands), "commands written"}};
    page = report::render(report::page_of(picture));
  }
  take_place(output, options.output, {{options.report, page}});
  fmt::print(stderr, "{}\n", words);
  return kDone;
}

}  // namespace chaintrue::cli
