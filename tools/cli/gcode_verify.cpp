// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode verify.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "tools/cli/gcode_verbs.hpp"
#include "tools/cli/progress.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::cli {
namespace {

gcode::VerifySummary verified(const GcodeOptions& options,
                              const GcodeMachine& machine,
                              const GcodeText& original,
                              const GcodeText& run,
                              model::BedPoint run_home,
                              int& code) {
  gcode::VerifyOptions settings;
  settings.tolerance_mm = options.tolerance_mm;
  settings.home = options.home_mm();
  settings.run_home = run_home;
  settings.half_play_mm = machine.half_play_mm();
  settings.rapids_whole = options.keep_rapids_whole;
  auto a = original.open();
  auto b = run.open();
  const auto summary = gcode::verify(a, b, machine.corrector(), options.dialect(), settings);
  if (summary) return *summary;
  code = report(summary.error().in_original ? options.program : options.other,
                summary.error().problem);
  return {};
}

std::string worst_in_words(const gcode::VerifySummary& summary) {
  const bool at_feeds = summary.feeds.largest_mm >= summary.rapids.largest_mm;
  const gcode::Deviation& worst = at_feeds ? summary.feeds : summary.rapids;
  return fmt::format(
      "{:.4f} mm from the intended path, at X{:.3f} Y{:.3f} Z{:.3f} (line {} of the original, line "
      "{} of the file run)",
      worst.largest_mm,
      worst.intended.x_mm,
      worst.intended.y_mm,
      worst.intended.z_mm,
      worst.original_line,
      worst.run_line);
}

}  // namespace

int run_gcode_verify(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText original(options.program);
  const GcodeText other(options.other);
  int code = kDone;
  const auto summary = verified(options, machine, original, other, {}, code);
  if (code != kDone) return code;
  int control_code = kDone;
  const auto control =
      verified(options, machine, original, original, options.home_mm(), control_code);
  const bool holds = summary.largest_mm() <= options.tolerance_mm && summary.words_differ.empty();
  end_progress();
  if (options.json) {
    fmt::print(
        "{{\"holds\": {}, \"largest_mm\": {:.6f}, \"feeds_mm\": {:.6f}, \"rapids_mm\": {:.6f}, "
        "\"original_line\": {}, "
        "\"tolerance_mm\": {}, \"uncompensated_mm\": {}, \"tick_overshoot_mm\": {:.6f}, "
        "\"commands\": {}, \"places\": {}}}\n",
        holds,
        summary.largest_mm(),
        summary.feeds.largest_mm,
        summary.rapids.largest_mm,
        summary.feeds.original_line,
        options.tolerance_mm,
        control_code == kDone ? fmt::format("{:.6f}", control.largest_mm()) : "null",
        summary.tick_overshoot_mm,
        summary.commands,
        summary.places);
  } else {
    fmt::print("{}: the tool strays at most {}\n",
               holds ? "holds" : "does not hold",
               worst_in_words(summary));
    fmt::print("tolerance {} mm, {} commands, {} places compared, controller {}\n",
               options.tolerance_mm,
               summary.commands,
               summary.places,
               machine.corrector().firmware().name);
    if (control_code == kDone) fmt::print("without compensation: {}\n", worst_in_words(control));
    if (summary.tick_overshoot_mm > 0.0) {
      fmt::print(
          "the controller's last tick overshoots a command's end by up to {:.3f} mm and comes "
          "back, as in every file\n",
          summary.tick_overshoot_mm);
    }
    if (!summary.words_differ.empty())
      fmt::print("the words that pass through differ: {}\n", summary.words_differ);
  }
  return holds ? kDone : kCheckFailed;
}

}  // namespace chaintrue::cli
