// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode compensate.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/report/path_report.hpp"

namespace chaintrue::cli {
namespace {

/// The result of running the output on the simulated controller and machine.
struct Proof {
  std::string fault;  ///< empty if it holds
  double largest_mm = 0.0;
};

Proof prove(const GcodeOptions& options, const GcodeMachine& machine, const GcodeText& text,
            PendingFile& output) {
  auto original = text.open({"the result on the simulated machine", 2, 2});
  auto written = written_so_far(output);
  const auto outcome = verify(original, written, machine.corrector, options.dialect(),
                              verify_options(options, machine));
  if (!outcome) return {outcome.error().problem.message(), 0.0};
  return {outcome->fault, outcome->largest_mm()};
}

/// Verify needs none of these options.
bool is_usual(const GcodeOptions& options) {
  const GcodeOptions usual;
  return options.machine.empty() && options.controller.empty() && options.report.empty() &&
         options.frame == usual.frame && options.home == usual.home &&
         options.limits.tolerance_mm == usual.limits.tolerance_mm &&
         !options.limits.keep_rapids_whole && !options.words.home_is_zero &&
         !options.words.skip_deletable_blocks && !options.words.tools_have_no_diameter;
}

/// A sentence for the page: whether the file is safe to run.
std::string verdict(const GcodeOptions& options, const GcodeMachine& machine, const Proof& proof) {
  const char* controller = machine.corrector.firmware().name;
  if (options.no_verify) {
    return "The file was not run on the simulated machine (--no-verify), so it may not be safe. "
           "Run gcode verify before cutting.";
  }
  if (!proof.fault.empty()) {
    return fmt::format("Not safe to run and not written: on a simulated {} controller, {}.",
                       controller, proof.fault);
  }
  return fmt::format(
      "The file is safe to run: on a simulated {} controller the tool stays within {:.3f} mm of "
      "the path (tolerance {:g} mm), at the intended feeds, with every other word in the right "
      "place.",
      controller, proof.largest_mm, options.limits.tolerance_mm);
}

report::PathPiece drawn(const Move& move, const PathSample& from, const PathSample& to) {
  const auto correction = [](const PathSample& sample) {
    return report::ToolVector{sample.command.x_mm - sample.target.x_mm,
                              sample.command.y_mm - sample.target.y_mm};
  };
  return {move.line,        move.kind == gcode::MoveKind::rapid,
          from.target.x_mm, from.target.y_mm,
          to.target.x_mm,   to.target.y_mm,
          correction(from), correction(to)};
}

/// The map that export wrote from this one, for a controller with the numbers typed in; empty if
/// there is none next to it.
std::string map_after(const std::string& map) {
  const std::string after = after_name(map);
  if (map == "-" || !std::filesystem::is_regular_file(after)) return {};
  return was_made_from(after, map) ? after : std::string{};
}

/// Conditions at the machine for the program to be cut correctly.
void describe_use(const GcodeMachine& machine, const GcodeOptions& options) {
  if (machine.target.as<CompensationMap>() == nullptr) return;
  if (options.settings.empty() && options.machine.empty()) {
    if (const std::string after = map_after(options.map); !after.empty()) {
      say("Have you typed in the numbers for {0}? {1} is for the controller without them; with "
          "them, compensate with {0}.",
          after, options.map);
    }
  }
  const Firmware* firmware = &machine.corrector.firmware();
  const bool adds_home = firmware == &gcode::firmware(ControllerKind::maslow_classic) ||
                         firmware == &gcode::firmware(ControllerKind::holey);
  if (!adds_home || options.words.home_is_zero) return;
  const BedPoint home = options.home_mm();
  if (home.x_mm == 0.0 && home.y_mm == 0.0) {
    say("It assumes home at 0, 0. If you have moved home (Define Home), give its position with "
        "--home X,Y.");
  } else {
    say("Its coordinates include home at {:g}, {:g}: move home back to 0, 0 before you run it.",
        home.x_mm, home.y_mm);
  }
}

/// A compensated program before it is written.
struct Compensated {
  gcode::CompensateSummary summary;
  Proof proof;
  PromisedError promised;
  report::PathReport picture;  ///< filled for --report and --json
};

std::string json_of(const Compensated& result, const Findings& findings,
                    const GcodeOptions& options) {
  Words notes, pieces;
  for (const Note& note : findings.notes) {
    notes.push_back(fmt::format("{{\"line\": {}, \"name\": {}, \"sentence\": {}}}", note.line,
                                in_quotes(note.name), in_quotes(note.sentence)));
  }
  for (const report::PathPiece& piece : result.picture.pieces()) {
    pieces.push_back(fmt::format("[{}, {}, {}, {}, {}, {}, {}, {}, {}, {}]", piece.line,
                                 piece.is_rapid ? 1 : 0, piece.x0_mm, piece.y0_mm, piece.x1_mm,
                                 piece.y1_mm, piece.correction0.x_mm, piece.correction0.y_mm,
                                 piece.correction1.x_mm, piece.correction1.y_mm));
  }
  const gcode::CompensateSummary& summary = result.summary;
  return fmt::format(
      "{{\"moves\": {}, \"commands\": {}, \"path_mm\": {}, \"largest_correction_mm\": {}, "
      "\"largest_correction_line\": {}, \"strays_mm\": {}, {},\n\"notes\": [{}],\n"
      "\"pieces\": [{}]}}\n",
      summary.moves, summary.commands, summary.path_mm, summary.largest_correction_mm,
      summary.largest_correction_line,
      options.no_verify ? "null" : fmt::format("{:.6f}", result.proof.largest_mm),
      as_members(result.promised), fmt::join(notes, ", "), fmt::join(pieces, ",\n"));
}

/// The page of --report.
std::string page_of(Compensated& result, const GcodeMachine& machine, const GcodeOptions& options,
                    const std::optional<Provenance>& made_by) {
  const bool holds = result.proof.fault.empty();
  const gcode::CompensateSummary& summary = result.summary;
  const Rectangle& sheet = machine.controller.sheet;
  report::PathReport& picture = result.picture;
  picture.name = options.program == "-"
                     ? "A program"
                     : std::filesystem::path(options.program).filename().string();
  picture.verdict = verdict(options, machine, result.proof);
  if (holds) {
    std::string expected = in_words(result.promised);
    std::replace(expected.begin(), expected.end(), '\n', ' ');
    picture.verdict += " " + expected;
  }
  picture.sheet = {sheet.x_min, sheet.x_max, sheet.y_min, sheet.y_max};
  if (const auto expected = result.promised.measured_mm(); expected && holds) {
    picture.figures.push_back(
        {fmt::format("{:.2f} mm", *expected),
         result.promised.is_without_scale
             ? "expected error of the tool without that of the scale, one sigma"
             : "expected error of the tool, one sigma"});
  }
  if (!options.no_verify) {
    picture.figures.push_back(
        {fmt::format("{:.3f} mm", result.proof.largest_mm), "largest distance from the path"});
  }
  append_all(picture.figures,
             std::vector<Figure>{
                 {fmt::format("{:.2f} mm", summary.largest_correction_mm), "largest correction"},
                 {fmt::format("{:g} mm", options.limits.tolerance_mm), "tolerance of the path"},
                 {fmt::format("{:.1f} m", summary.path_mm / 1000.0), "path"},
                 {fmt::format("{}", summary.commands), holds ? "commands written" : "commands"}});
  Document document = page_of(picture);
  add_made_by(made_by, document.sections);
  return render_html(document);
}

/// Runs the compensator; its problems are printed. \throws GcodeRefused
gcode::CompensateSummary compensated(gcode::Compensator& compensator, LineSource source,
                                     const GcodeOptions& options) {
  const auto summary = compensator.run(source, options.dialect());
  const Findings& findings = compensator.findings();
  report(options.program, findings);
  if (!summary) {
    report(options.program, summary.error());
    throw GcodeRefused({summary.error()});
  }
  if (!findings.problems.empty()) {
    say("nothing is written");
    throw GcodeRefused(findings.problems);
  }
  return *summary;
}

/// What was done and, if it does not hold, why it is not written. \throws Failed
void report_result(const Compensated& result, const GcodeMachine& machine,
                   const GcodeOptions& options) {
  const char* controller = machine.corrector.firmware().name;
  const auto& [summary, proof, promised, picture] = result;
  say("{} blocks, {} moves, {:.1f} m of path: {} commands for {}; largest correction {:.2f} mm on "
      "line {}",
      summary.blocks, summary.moves, summary.path_mm / 1000.0, summary.commands, controller,
      summary.largest_correction_mm, summary.largest_correction_line);
  if (!proof.fault.empty()) {
    say("{}: run on a simulated {} controller, the compensated program is not within {} mm: "
        "{}\nthe program is not written; try another --tolerance-mm, or --no-verify to inspect "
        "that line",
        name_in_messages(options.program), controller, options.limits.tolerance_mm, proof.fault);
    throw Failed("", "not_held", proof.fault, kCheckFailed);
  }
  if (!options.no_verify) {
    say("run on a simulated {} controller: the tool stays within {:.4f} mm of the path, "
        "tolerance {} mm",
        controller, proof.largest_mm, options.limits.tolerance_mm);
  }
  say_lines(in_words(promised));
}

}  // namespace

int run_gcode_compensate(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  if (const CompensationMap* map = machine.target.as<CompensationMap>())
    require_fit_for_cutting(not_to_cut_with(*map), options.forced);
  const GcodeText text(options.program);
  LineSource source = text.open({"the program", 1, options.no_verify ? 1 : 2});
  CompensateOptions settings = compensate_options(options, machine);
  files::note_source(text.source());
  settings.made_by = made_by(options.verb);
  Compensated result;
  gcode::CutPlaces cuts;
  settings.on_command = [&](const Move& move, const PathSample& from, const PathSample& to) {
    if (move.kind != gcode::MoveKind::rapid) cuts.add(move.line, from.target, to.target);
    if ((options.json || !options.report.empty()) && move.names_xy)
      result.picture.add(drawn(move, from, to));
  };
  PendingFile output(options.output);
  gcode::Compensator compensator(machine.corrector, settings,
                                 [&](std::string_view bytes) { output.write(bytes); });
  result.summary = compensated(compensator, std::move(source), options);
  if (!options.no_verify) result.proof = prove(options, machine, text, output);
  result.promised = promised_along(
      cuts, machine, options.no_verify ? options.limits.tolerance_mm : result.proof.largest_mm);
  Outputs others;
  if (!options.report.empty())
    others.push_back({options.report, page_of(result, machine, options, settings.made_by)});
  if (!result.proof.fault.empty()) {
    write_outputs(others);
  } else {
    if (options.json) others.push_back({"-", json_of(result, compensator.findings(), options)});
    take_place(output, options.output, others);
  }
  report_result(result, machine, options);
  describe_use(machine, options);
  if (is_usual(options))
    say_next(with_map_words(options, {"gcode", "verify", options.program, options.output}));
  return kDone;
}

}  // namespace chaintrue::cli
