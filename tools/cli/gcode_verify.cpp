// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode verify.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/talk.hpp"
#include "tools/gcode/emitter.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::cli {
namespace {

std::string in_words(const gcode::Deviation& worst) {
  return fmt::format(
      "{:.4f} mm from the intended path, at X{:.3f} Y{:.3f} Z{:.3f} (line {} of the original, line "
      "{} of the file run)",
      worst.distance_mm, worst.intended.x_mm, worst.intended.y_mm, worst.intended.z_mm,
      worst.original_line, worst.run_line);
}

void print_json(const gcode::VerifySummary& summary, const gcode::Result<gcode::Deviation>& control,
                const PromisedError& promised, double tolerance_mm) {
  fmt::print(
      "{{\"holds\": {}, \"largest_mm\": {:.6f}, \"feeds_mm\": {:.6f}, \"rapids_mm\": {:.6f}, "
      "\"original_line\": {}, \"tolerance_mm\": {}, \"uncompensated_mm\": {}, "
      "\"tick_overshoot_mm\": {:.6f}, \"commands\": {}, \"places\": {}, \"strays\": {}, {}, "
      "\"words_differ\": {}, \"motion_differs\": {}, \"fault\": {}}}\n",
      summary.holds(), summary.largest_mm(), summary.feeds.distance_mm, summary.rapids.distance_mm,
      summary.worst().original_line, tolerance_mm,
      control ? fmt::format("{:.6f}", control->distance_mm) : "null", summary.tick_overshoot_mm,
      summary.commands, summary.places, summary.strays, as_members(promised),
      in_quotes(summary.words_differ), in_quotes(summary.motion_differs), in_quotes(summary.fault));
}

void print_words(const gcode::VerifySummary& summary,
                 const gcode::Result<gcode::Deviation>& control, const PromisedError& promised,
                 const GcodeOptions& options, std::string_view controller) {
  fmt::print("{}: the tool strays at most {}\n", summary.holds() ? "holds" : "does not hold",
             in_words(summary.worst()));
  if (summary.holds()) fmt::print("{}", in_words(promised));
  if (!summary.fault.empty()) fmt::print("the first fault: {}\n", summary.fault);
  fmt::print("tolerance {} mm, {} commands, {} places compared, controller {}\n",
             options.limits.tolerance_mm, summary.commands, summary.places, controller);
  if (control) fmt::print("without compensation: {}\n", in_words(*control));
  if (summary.tick_overshoot_mm > 0.0) {
    fmt::print("Moves overshoot by up to {:.2f} mm and return, as always on this controller.\n",
               summary.tick_overshoot_mm);
  }
  if (!summary.words_differ.empty())
    fmt::print("the words that pass through differ: {}\n", summary.words_differ);
}

}  // namespace

gcode::VerifyOptions verify_options(const GcodeOptions& options, const GcodeMachine& machine) {
  gcode::VerifyOptions result;
  result.tolerance_mm = options.limits.tolerance_mm;
  result.decimals = options.limits.decimals;
  result.half_play_mm = machine.controller.half_play_mm;
  result.rapids_whole = options.limits.keep_rapids_whole;
  // The rounding of F, and of short pieces, takes a hundredth.
  result.speed_share = options.limits.steepest_correction + 0.01;
  return result;
}

namespace {

/// Whether a program without a unit is assumed to be in mm, decided at its first move.
class AssumedUnit final : public gcode::Sink {
 public:
  void note(const Note& note) override {
    if (note.name == "units_assumed") note_ = note;
  }
  /// Ends the program.
  void move(const Move&) override { throw gcode::Refusal({}); }
  const std::optional<Note>& note() const { return note_; }

 private:
  std::optional<Note> note_;
};

std::optional<Note> assumed_unit(const GcodeText& program, const GcodeOptions& options) {
  AssumedUnit unit;
  auto source = program.open();
  (void)run_program(source, options.dialect(), unit);
  return unit.note();
}

/// The current map and program, read before the file that is run because that may come through a
/// pipe too.
std::vector<SourceFile> made_from(const GcodeOptions& options, const GcodeText& original) {
  std::vector<SourceFile> sources = files::sources_read();
  const std::string map = name_without_folders(options.map);
  std::erase_if(sources, [&](const SourceFile& file) { return file.name != map; });
  sources.push_back(original.source());
  return sources;
}

/// If the file states its sources and one of these is not among them.
void say_other_sources(const std::vector<SourceFile>& sources, const GcodeText& run,
                       const std::string& name) {
  const Words hashes = hashes_in_head(run.open());
  if (hashes.empty()) return;
  for (const SourceFile& file : sources) {
    const std::string beginning = file.sha256.substr(0, gcode::kHashDigits);
    if (contains(hashes, beginning)) continue;
    say("{} was made from another version of {}: compensate again.", name_without_folders(name),
        file.name);
  }
}

}  // namespace

int run_gcode_verify(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText original(options.program);
  const std::vector<SourceFile> sources = made_from(options, original);
  const GcodeText other(options.other);
  say_other_sources(sources, other, options.other);
  const auto assumed = assumed_unit(original, options);
  gcode::VerifyOptions settings = verify_options(options, machine);
  gcode::CutPlaces cuts;
  settings.on_move = [&cuts](const Move& move) { cuts.add(move); };
  auto intended = original.open({"the program on the simulated machine", 1, 2});
  auto run = other.open();
  const auto summary = verify(intended, run, machine.corrector, options.dialect(), settings);
  if (!summary) {
    report(summary.error().in_original ? options.program : options.other, summary.error().problem);
    throw GcodeRefused({summary.error().problem});
  }
  auto again = original.open({"the same without compensation", 2, 2});
  const auto control = uncompensated(again, machine.corrector, options.dialect(), settings);
  if (assumed) {
    Findings findings;
    findings.add(*assumed);
    report(options.program, findings);
  }
  PromisedError promised{std::nullopt, summary->largest_mm()};
  // If the original cannot be followed to its end, its cuts are unknown too.
  if (control) promised = promised_along(cuts, machine, summary->largest_mm());
  if (options.json) {
    print_json(*summary, control, promised, options.limits.tolerance_mm);
  } else {
    print_words(*summary, control, promised, options, machine.corrector.firmware().name);
  }
  const bool has_belts = machine.corrector.firmware().name == gcode::firmware_of_four_belts().name;
  if (summary->holds() && has_belts) {
    say_next({"export", "maslow4", options.map});
  } else if (summary->holds()) {
    say_next({"plan", "--check", options.map, "-o", "check.csv"});
  } else if (options.program != "-") {
    say_next(with_map_words(
        options, {"gcode", "explain",
                  fmt::format("{}:{}", options.program, summary->worst().original_line)}));
  }
  return summary->holds() ? kDone : kCheckFailed;
}

}  // namespace chaintrue::cli
