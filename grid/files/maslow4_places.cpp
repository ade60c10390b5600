// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/belts/belt_checks.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/two_frames.hpp"
#include "grid/containers.hpp"
#include "grid/files/belts_checks.hpp"
#include "grid/files/measured_entries.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::files {
namespace {

/// Medians of single readings; empty if a belt has none or they disagree.
std::optional<PerBelt<double>> agreed(const PerBelt<std::vector<double>>& readings_mm) {
  constexpr double kAgreeMm = 10.0;
  PerBelt<double> lengths_mm;
  for (const Belt belt : kBelts) {
    const auto& own = readings_mm[belt];
    if (own.empty()) return std::nullopt;
    const auto [least, most] = minmax_element(own);
    if (*most - *least > kAgreeMm) return std::nullopt;
    lengths_mm[belt] = median(own);
  }
  return lengths_mm;
}

/// The waypoints are numbered as the places are: no entry of the list is missing without a trace.
bool are_commands_known(const ScannedRun& run) {
  if (run.list_is_short) return false;
  for (const auto i : each_index(run.points)) {
    if (!run.commanded.contains(as_int(i))) return false;
  }
  return true;
}

/// Warns of the first few, and counts the rest.
void warn_of(const std::vector<Warning>& list, std::string_view rest, Problems& problems) {
  for (std::size_t i = 0; i < std::min(list.size(), Problems::kMostOfAKind); ++i)
    problems.warn(list[i].place, list[i].sentence);
  if (list.size() > Problems::kMostOfAKind) {
    problems.warn("", "{} {}", list.size() - Problems::kMostOfAKind, rest);
  }
}

/// Adds places that no list has: the median of a belt's single readings, if these agree to a
/// centimetre. Each is reported.
void rebuild_from_singles(ScannedRun& run, Problems& problems) {
  if (run.list_is_short) return;
  std::vector<int> rebuilt;
  for (const auto& [waypoint, readings_mm] : run.last_attempt_mm) {
    // The firmware's grids have 81 waypoints at most; a larger number is garbled.
    constexpr int kMostWaypoints = 1000;
    if (waypoint >= kMostWaypoints) continue;
    const auto index = as_size(waypoint);
    if (index < run.points.size() && run.points[index].lengths_mm) continue;
    const auto lengths_mm = agreed(readings_mm);
    if (!lengths_mm) continue;
    if (index >= run.points.size()) run.points.resize(index + 1);
    ScannedReading& place = run.points[index];
    if (place.line == 0) place.line = run.first_line;
    place.lengths_mm = lengths_mm;
    place.problems.clear();
    place.from_single_readings = true;
    rebuilt.push_back(waypoint);
  }
  if (rebuilt.empty()) return;
  problems.warn(line_place(run.first_line),
                "{} of the run's places {} taken from single readings, because no list in the "
                "log has {}: waypoint{} {}",
                rebuilt.size(), rebuilt.size() == 1 ? "is" : "are",
                rebuilt.size() == 1 ? "it" : "them", rebuilt.size() == 1 ? "" : "s",
                fmt::join(rebuilt, ", "));
}

/// A place to be left out, and the reason.
struct LeftOutPlace {
  std::size_t index;
  std::string why;
};

/// Leaves these out and reports them.
void leave_out(const std::vector<LeftOutPlace>& places, std::string_view rest, MeasuredBelts& belts,
               Indices& lines, Problems& problems) {
  Problems left_out(problems.file());
  Indices kept = numbers_below(lines.size());
  for (const LeftOutPlace& own : places) {
    std::erase(kept, own.index);
    left_out.warn(line_place(lines[own.index]), "this reading is left out: {}", own.why);
  }
  warn_of(left_out.warnings(), rest, problems);
  keep_only(kept, belts.points);
  keep_only(kept, lines);
}

/// Runs with places in two frames are split.
void part_frames(const BeltMachine& machine, std::vector<ScannedRun>& runs, Problems& problems) {
  std::vector<ScannedRun> parted;
  for (ScannedRun& run : runs) {
    MeasuredBelts belts;
    belts.machine = machine;
    belts.machine.anchors_known = false;
    Indices slots;
    for (const auto i : each_index(run.points)) {
      if (!run.points[i].lengths_mm) continue;
      belts.points.push_back({.lengths_mm = *run.points[i].lengths_mm});
      slots.push_back(i);
    }
    const auto second =
        belts.points.size() <= kMostBeltPoints ? second_frame_begins(belts) : std::nullopt;
    if (!second) {
      parted.push_back(std::move(run));
      continue;
    }
    ScannedRun other;
    const auto from = run.points.begin() + as_index(slots[*second]);
    other.points.assign(from, run.points.end());
    other.is_list = run.is_list;
    other.first_line = other.points.front().line;
    run.points.erase(from, run.points.end());
    run.fit.reset();
    problems.warn(
        line_place(other.first_line),
        "from here on the readings are from another frame; they are treated as a second run");
    parted.push_back(std::move(run));
    parted.push_back(std::move(other));
  }
  runs = std::move(parted);
}

}  // namespace

void take_places(const ScannedRun& run, PointRange within, Orientation orientation,
                 PlacesOfLog& places) {
  const bool commands_known = are_commands_known(run);
  const int first_order = places.points.empty() ? 0 : *places.points.back().order + 1;
  for (std::size_t i = within.first; i <= within.last; ++i) {
    if (!run.points[i].lengths_mm) continue;
    const int waypoint = as_int(i);
    BeltPoint point;
    point.lengths_mm = *run.points[i].lengths_mm;
    point.order = first_order + as_int(i - within.first);
    if (run.pull_ma) point.pull = BeltPull{*run.pull_ma, BeltPull::Unit::milliampere};
    const auto commanded = run.commanded.find(waypoint);
    if (commanded != run.commanded.end() && !run.list_is_short) point.commanded = commanded->second;
    const auto thrown_away = run.thrown_away_mm.find(waypoint);
    if (thrown_away != run.thrown_away_mm.end() && !run.points[i].from_single_readings)
      point.thrown_away_mm = thrown_away->second;
    if (orientation == Orientation::flat && commands_known) {
      const BedPoint before = run.commanded.at(std::max(waypoint - 1, 0));
      point.pulled = pulled_after(orientation, before, *point.commanded, i);
    }
    places.points.push_back(std::move(point));
    places.lines.push_back(run.points[i].line);
  }
}

void report_unreadable(const ScannedRun& run, PointRange within, std::size_t readable,
                       Problems& problems) {
  Problems left_out(problems.file());
  for (std::size_t i = within.first; i <= within.last; ++i) {
    for (const InputProblem& problem : run.points[i].problems) {
      if (readable < kFewestBeltPoints) {
        problems.add(problem.place, problem.value, problem.kind, problem.expected);
      } else if (&problem == &run.points[i].problems.front()) {
        left_out.warn(problem.place, "this reading is left out: found {}, expected {}",
                      problem.value, problem.expected);
      }
    }
  }
  warn_of(left_out.warnings(), "further readings are damaged and left out", problems);
  if (run.list_is_short && !run.commanded.empty()) {
    problems.warn(line_place(run.points[within.first].line),
                  "the list has fewer readings than measured places, and which are missing is "
                  "unknown, so the commanded places are left out");
  }
}

void leave_out_copies(MeasuredBelts& belts, Indices& lines, Problems& problems) {
  if (holds_repeats(belts)) return;
  std::vector<LeftOutPlace> copies;
  for (const auto& [point, first] : copies_of(belts.points)) {
    copies.push_back({point, fmt::format("it is a copy, with the same four lengths as line {} to "
                                         "the last digit",
                                         lines[first])});
  }
  leave_out(copies, "further readings are copies and left out", belts, lines, problems);
}

void leave_out_nowhere(MeasuredBelts& belts, Indices& lines, Problems& problems) {
  if (belts.points.size() <= kFewestBeltPoints || belts.points.size() > kMostBeltPoints) return;
  const auto frame = frame_of_lengths(belts);
  if (!frame) return;
  std::vector<LeftOutPlace> nowhere;
  for (const NowherePoint& own : points_nowhere(belts, *frame))
    nowhere.push_back(
        {own.point, fmt::format("its four lengths ({}) do not meet, the best place is off by "
                                "{:.0f} mm",
                                lengths_in_words(belts.points[own.point]), own.residual_mm)});
  if (as_double(nowhere.size()) > std::ceil(kMostBadReadings * as_double(belts.points.size())))
    return;
  leave_out(nowhere, "further readings that do not meet are left out", belts, lines, problems);
}

std::vector<ScannedRun> runs_of(ScannedLog& log, const BeltMachine& machine, Problems& problems) {
  std::vector<ScannedRun> runs = std::move(log.runs);
  for (ScannedRun& run : runs) rebuild_from_singles(run, problems);
  std::erase_if(runs, [](const ScannedRun& run) { return run.points.empty(); });
  part_frames(machine, runs, problems);
  return runs;
}

}  // namespace chaintrue::grid::files
