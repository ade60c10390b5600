// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/gcode_job.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>
#include <utility>

#include "grid/belts/belt_map.hpp"
#include "grid/files/sha256.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/talk.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {

namespace {

int exit_code(gcode::ProblemName name) {
  return kind(name) == gcode::ProblemKind::bad_input ? kBadInput : kNotSupportedOrOutside;
}

/// \throws InputError, which names what is expected, if it cannot be opened.
LineSource lines_of_file(const std::string& path, const char* expected) {
  auto source = LineSource::from_file(path);
  if (!source) refuse(path, "", expected);
  return std::move(*source);
}

std::string sentence_of(const std::vector<Problem>& problems) {
  return fmt::format("{}", fmt::join(mapped(problems, &Problem::message), "\n"));
}

}  // namespace

void check_limits(const GcodeOptions& options, OptionProblems& problems) {
  const double least_mm = gcode::least_tolerance_mm(options.limits.decimals);
  if (options.map.empty() || options.limits.tolerance_mm > least_mm) return;
  problems.add("--tolerance-mm", fmt::format("{}", options.limits.tolerance_mm),
               fmt::format("more than {:.2g} mm, the rounding to {} decimals; or more --decimals",
                           least_mm, options.limits.decimals),
               ProblemKind::out_of_range);
}

CompensateOptions compensate_options(const GcodeOptions& options, const GcodeMachine& machine) {
  CompensateOptions result = options.limits;
  result.clamp_box = machine.controller.clamp_box;
  result.half_play_mm = machine.controller.half_play_mm;
  for (const files::NamedSetting& setting : machine.controller.settings)
    result.settings.push_back(setting.name + " " + setting.text);
  return result;
}

GcodeText::GcodeText(const std::string& path) : path_(path) {
  // A pipe can be read once only.
  const auto whole = [](std::istream& pipe) {
    return std::string(std::istreambuf_iterator<char>(pipe), std::istreambuf_iterator<char>());
  };
  std::error_code unknown;
  if (path == "-") {
    text_ = whole(std::cin);
  } else if (std::filesystem::is_fifo(path, unknown)) {
    std::ifstream pipe(path, std::ios::binary);
    text_ = whole(pipe);
  } else if (!std::filesystem::is_regular_file(path, unknown)) {
    text_ = read_whole_file(path);  // which reports the problem
  }
}

LineSource GcodeText::open() const {
  return text_ ? LineSource::from_text(*text_) : lines_of_file(path_, "a file that can be read");
}

LineSource GcodeText::open(const WorkStep& step) const {
  LineSource source = open();
  std::error_code unknown;
  const std::uintmax_t size = text_ ? text_->size() : std::filesystem::file_size(path_, unknown);
  shown_progress()(step);
  // Loops go back; the file's progress does not.
  source.on_line([total = unknown ? 0.0 : as_double(size),
                  furthest = std::uint64_t{0}](std::uint64_t offset) mutable {
    furthest = std::max(furthest, offset);
    progress_is(as_double(furthest), total);
  });
  return source;
}

SourceFile GcodeText::source() const {
  const std::string name = name_without_folders(path_);
  if (text_) return {name, files::sha256(*text_)};
  std::ifstream file(path_, std::ios::binary);
  return {name, files::sha256(file)};
}

Words with_map_words(const GcodeOptions& options, Words words) {
  add_option_words(words, "--map", options.map);
  add_option_words(words, "--settings", options.settings);
  return words;
}

std::string compensated_name(const std::string& program) {
  std::filesystem::path path(program);
  return path.replace_extension(".true" + path.extension().string()).string();
}

GcodeRefused::GcodeRefused(std::vector<Problem> found)
    : Failed("", "bad_program", sentence_of(found), exit_code(found.front().name)),
      problems(std::move(found)) {}

std::string in_quotes(std::string_view text) {
  return fmt::format("\"{}\"",
                     report::replaced(std::string(text), {{"\\", "\\\\"}, {"\"", "\\\""}}));
}

int report(const std::string& file, const Problem& problem) {
  end_progress();
  say("{}: {}", name_in_messages(file), problem.message());
  return exit_code(problem.name);
}

int report(const std::string& file, const Findings& findings) {
  end_progress();
  for (const Note& note : findings.notes) {
    say("{}: line {}: note: {}", name_in_messages(file), note.line, note.sentence);
  }
  if (findings.note_count > findings.notes.size()) {
    say("... and {} more notes", findings.note_count - findings.notes.size());
  }
  int code = kDone;
  for (const Problem& problem : findings.problems) {
    const int own = report(file, problem);
    if (code == kDone) code = own;
  }
  if (findings.problem_count > findings.problems.size()) {
    say("... and {} more lines", findings.problem_count - findings.problems.size());
  }
  return code;
}

LineSource written_so_far(PendingFile& file) {
  const std::string place = file.flushed();
  return place.empty() ? LineSource::from_text(file.held())
                       : lines_of_file(place, "room for the whole file");
}

namespace {

using gcode::ErrorAlong;

std::optional<double> with_path(const std::optional<gcode::ExpectedError>& map,
                                const ErrorAlong gcode::ExpectedError::*part, double path_mm) {
  if (!map || !((*map.*part).length_mm > 0.0)) return std::nullopt;
  return (*map.*part).rms_mm + path_mm;
}

std::string or_null(const std::optional<double>& value) {
  return value ? fmt::format("{:.6f}", *value) : "null";
}

}  // namespace

std::optional<double> PromisedError::measured_mm() const {
  return with_path(map, &gcode::ExpectedError::measured, path_mm);
}

std::optional<double> PromisedError::outside_mm() const {
  return with_path(map, &gcode::ExpectedError::outside, path_mm);
}

PromisedError promised_along(const gcode::CutPlaces& cuts, const GcodeMachine& machine,
                             double path_mm) {
  const auto* found = machine.target.as<FittedAnchors>();
  if (found == nullptr || found->fit.scale)
    return {cuts.expected(*machine.target.lengths), path_mm};
  // A scale that was not taped is taken as true, so that the error excludes it.
  BeltsFit taken_as_true = found->fit;
  taken_as_true.scale = grid::BeltScale{};
  return {cuts.expected(grid::BeltMap(taken_as_true, holes_of(*found))), path_mm, true};
}

std::string in_words(const PromisedError& error) {
  std::string words;
  if (const auto measured = error.measured_mm()) {
    const ErrorAlong& along = error.map->measured;
    words += fmt::format("Expect cuts within about {} mm ({} at worst, in line {}).\n",
                         about_mm(*measured), about_mm(along.largest_mm + error.path_mm),
                         along.weakest_line);
  }
  if (const auto outside = error.outside_mm()) {
    const ErrorAlong& along = error.map->outside;
    words += fmt::format(
        "{:.1f} m of cuts are outside the measured part: expect those within about {} mm ({} at "
        "worst, in line {}).\n",
        along.length_mm / 1000.0, about_mm(*outside), about_mm(along.largest_mm + error.path_mm),
        along.weakest_line);
  }
  if (error.is_without_scale && !words.empty()) {
    words +=
        "That is in millimetres of belt. The error of the belts' scale is additional and in "
        "proportion to the part: 1 mm per metre for each tenth of a per cent.\n";
  }
  return words;
}

std::string as_members(const PromisedError& error) {
  return fmt::format("\"expected_mm\": {}, \"outside_mm\": {}, \"expected_outside_mm\": {}",
                     or_null(error.measured_mm()),
                     error.map ? fmt::format("{:.3f}", error.map->outside.length_mm) : "null",
                     or_null(error.outside_mm()));
}

}  // namespace chaintrue::cli
