// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "grid/containers.hpp"
#include "grid/files/belts_checks.hpp"
#include "grid/files/maslow4_places.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

std::vector<LoggedRun> logged(const std::vector<ScannedRun>& runs) {
  std::vector<LoggedRun> result;
  std::size_t first = 0;
  for (const ScannedRun& run : runs) {
    result.push_back(
        {run.heading, run.points.front().line, {first, first + run.points.size() - 1}});
    first += run.points.size();
  }
  return result;
}

void check_choice(const Maslow4Options& options, const std::vector<LoggedRun>& runs,
                  Problems& problems) {
  const auto& [run, points] = options.part;
  if (run && (*run < 1 || as_size(*run) > runs.size())) {
    problems.add("--runs", fmt::format("{}", *run), ProblemKind::out_of_range,
                 "a run of this file, 1 to {}", runs.size());
  }
  if (points && points->last > runs.back().points.last) {
    problems.add("--runs", fmt::format("{}:{}", points->first, points->last),
                 ProblemKind::out_of_range, "first and last of this file's points, 0:{}",
                 runs.back().points.last);
  }
}

void choose_lengths(const Maslow4Options& options, bool is_list, BeltMachine& machine,
                    Words& assumed) {
  if (options.lengths) {
    machine.lengths = *options.lengths;
    return;
  }
  assumed.emplace_back(
      is_list ? "level lengths from anchor to tool, as printed since October 2024 (older ones are "
                "slanted: --lengths belt_and_arm)"
              : "level lengths from anchor to tool; this note looks older than October 2024, when "
                "they were still slanted by the anchors' heights (--lengths belt_and_arm)");
}

}  // namespace

std::vector<LogPart> log_parts_of(const std::string& text, const std::string& option) {
  return list_of_option(
      text, option,
      "runs, counted from 1, as in 1,2; or first and last point, counted from 0, as in 0:98",
      [](const std::string& part) -> std::optional<LogPart> {
        constexpr int kMost = 1000000;
        const auto points = pair_of(part, ':', 0, kMost);
        if (points && (*points)[0] <= (*points)[1])
          return LogPart{.points = PointRange{as_size((*points)[0]), as_size((*points)[1])}};
        const auto run = whole_number_of(part, 1, kMost);
        return run ? std::optional(LogPart{.run = run}) : std::nullopt;
      });
}

namespace {

/// No readings: describes a log, or why the run in it failed.
void report_nothing(const ScannedLog& log, const BeltMachine& machine, Problems& problems) {
  if (log.refused) {
    problems.explain(line_place(log.refused->line), ProblemKind::unexpected,
                     words_of(*log.refused));
    return;
  }
  if (log.stopped) {
    MeasuredBelts none;
    none.machine = machine;
    problems.add(line_place(log.stopped->line),
                 log.stopped->said.empty() ? "the log's end" : log.stopped->said,
                 ProblemKind::missing,
                 "a list of readings, CLBM:[...]. " + words_of(*log.stopped, none));
    return;
  }
  problems.add("", "no readings", ProblemKind::missing,
               "a log of Find Anchors, or a list of readings: "
               "{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}");
}

/// The places of the range, from the runs that it covers.
PlacesOfLog take_wanted(const std::vector<ScannedRun>& runs, PointRange wanted,
                        Maslow4Import& result, Problems& problems) {
  PlacesOfLog places;
  std::vector<std::pair<std::size_t, PointRange>> parts;
  for (const auto i : each_index(runs)) {
    const PointRange own = result.runs[i].points;
    if (own.last < wanted.first || own.first > wanted.last) continue;
    if (parts.empty()) result.taken = i;
    const PointRange within{std::max(own.first, wanted.first) - own.first,
                            std::min(own.last, wanted.last) - own.first};
    take_places(runs[i], within, result.belts.machine.orientation, places);
    parts.emplace_back(i, within);
  }
  for (const auto& [run, within] : parts)
    report_unreadable(runs[run], within, places.points.size(), problems);
  return places;
}

/// The data of these belts as a whole.
void check_all(MeasuredBelts& belts, Indices& lines, Maslow4Import& result, Problems& problems) {
  const BeltPlaces places{
      "the readings",
      [&lines](std::size_t index, std::string_view) { return line_place(lines[index]); },
      "the settings"};
  leave_out_copies(belts, lines, problems);
  check_belt_points(belts, places, problems);
  problems.throw_if_any();
  leave_out_nowhere(belts, lines, problems);
  result.is_enough = check_belts_together(belts, places, BeltsUse::import, problems);
  problems.throw_if_any();
}

}  // namespace

Maslow4Import parse_maslow4(const std::string& text, const std::string& file,
                            const Maslow4Options& options) {
  Problems problems(file);
  ScannedLog log = scan_maslow4(text, file);
  Maslow4Import result;
  take_machine(options, result, problems);
  // A run cannot be judged with an impossible machine.
  problems.throw_if_any();
  if (log.refused && !log.runs.empty()) {
    problems.warn(line_place(log.refused->line), words_of(*log.refused));
  }
  const std::vector<ScannedRun> runs = runs_of(log, result.belts.machine, problems);
  if (runs.empty()) report_nothing(log, result.belts.machine, problems);
  problems.throw_if_any();
  result.runs = logged(runs);
  check_choice(options, result.runs, problems);
  problems.throw_if_any();
  MeasuredBelts& belts = result.belts;
  belts.name = name_without_folders(file);
  const auto& [run, points] = options.part;
  result.taken = run ? as_size(*run - 1) : runs.size() - 1;
  const PointRange wanted = points.value_or(result.runs[result.taken].points);
  PlacesOfLog places = take_wanted(runs, wanted, result, problems);
  problems.throw_if_any();
  belts.points = std::move(places.points);
  // The machine's own figures refer to the whole run.
  const ScannedRun& taken = runs[result.taken];
  const PointRange all = result.runs[result.taken].points;
  if (wanted.first == all.first && wanted.last == all.last) belts.firmware_fit = taken.fit;
  choose_lengths(options, taken.is_list, belts.machine, result.assumed);
  const bool is_last = result.taken + 1 == runs.size();
  if (is_last && !log.list_has_end) {
    problems.warn("",
                  "the log ends in the middle of a list; the readings before that are used. If the "
                  "list continues, paste it again from beginning to end");
  }
  if (log.first_passed_over) {
    problems.warn(line_place(*log.first_passed_over),
                  "ignored: this line and others like it contain no reading, place, pull or fit");
  }
  check_all(belts, places.lines, result, problems);
  if (is_last && log.stopped) result.stopped = words_of(*log.stopped, belts);
  result.warnings = problems.warnings();
  return result;
}

}  // namespace chaintrue::grid::files
