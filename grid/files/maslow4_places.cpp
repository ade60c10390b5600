// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grid/belts/belt_checks.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/two_frames.hpp"
#include "grid/containers.hpp"
#include "grid/files/belts_checks.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Belt;
using model::kBelts;

std::string line_words(std::size_t line) { return fmt::format("line {}", line); }

/// Medians of single readings; empty if a belt has none or they disagree.
std::optional<model::PerBelt<double>> agreed(
    const model::PerBelt<std::vector<double>>& readings_mm) {
  constexpr double kAgreeMm = 10.0;
  model::PerBelt<double> lengths_mm;
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
  for (std::size_t i = 0; i < run.points.size(); ++i) {
    if (!run.commanded.contains(static_cast<int>(i))) return false;
  }
  return true;
}

void erase_points(const std::vector<bool>& is_out,
                  MeasuredBelts& belts,
                  std::vector<std::size_t>& lines) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < is_out.size(); ++i) {
    if (is_out[i]) continue;
    if (kept != i) {
      belts.points[kept] = std::move(belts.points[i]);
      lines[kept] = lines[i];
    }
    ++kept;
  }
  belts.points.resize(kept);
  lines.resize(kept);
}

/// Warns of the first few, and counts the rest.
void warn_of(const std::vector<Warning>& list, std::string_view rest, Problems& problems) {
  for (std::size_t i = 0; i < std::min(list.size(), Problems::kMostOfAKind); ++i)
    problems.warn(list[i].place, list[i].sentence);
  if (list.size() > Problems::kMostOfAKind) {
    problems.warn("", fmt::format("{} {}", list.size() - Problems::kMostOfAKind, rest));
  }
}

}  // namespace

void rebuild_from_singles(ScannedRun& run, Problems& problems) {
  if (run.list_is_short) return;
  std::vector<int> rebuilt;
  for (const auto& [waypoint, readings_mm] : run.last_attempt_mm) {
    // The firmware's grids have 81 waypoints at most; a larger number is garbled.
    constexpr int kMostWaypoints = 1000;
    if (waypoint >= kMostWaypoints) continue;
    const auto index = static_cast<std::size_t>(waypoint);
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
  problems.warn(
      line_words(run.first_line),
      fmt::format("{} of the run's places {} taken from single readings, because no list in the "
                  "log has {}: waypoint{} {}",
                  rebuilt.size(),
                  rebuilt.size() == 1 ? "is" : "are",
                  rebuilt.size() == 1 ? "it" : "them",
                  rebuilt.size() == 1 ? "" : "s",
                  fmt::join(rebuilt, ", ")));
}

void take_places(const ScannedRun& run,
                 PointRange within,
                 model::Orientation orientation,
                 PlacesOfLog& places) {
  const bool commands_known = are_commands_known(run);
  const int first_order = places.points.empty() ? 0 : *places.points.back().order + 1;
  for (std::size_t i = within.first; i <= within.last; ++i) {
    if (!run.points[i].lengths_mm) continue;
    const int waypoint = static_cast<int>(i);
    BeltPoint point;
    point.lengths_mm = *run.points[i].lengths_mm;
    point.order = first_order + static_cast<int>(i - within.first);
    if (run.pull_ma) point.pull = BeltPull{*run.pull_ma, BeltPull::Unit::milliampere};
    const auto commanded = run.commanded.find(waypoint);
    if (commanded != run.commanded.end() && !run.list_is_short) point.commanded = commanded->second;
    const auto thrown_away = run.thrown_away_mm.find(waypoint);
    if (thrown_away != run.thrown_away_mm.end() && !run.points[i].from_single_readings)
      point.thrown_away_mm = thrown_away->second;
    if (orientation == model::Orientation::flat && commands_known) {
      const model::BedPoint before = run.commanded.at(std::max(waypoint - 1, 0));
      point.pulled = pulled_after(orientation, before, *point.commanded, i);
    }
    places.points.push_back(std::move(point));
    places.lines.push_back(run.points[i].line);
  }
}

void report_unreadable(const ScannedRun& run,
                       PointRange within,
                       std::size_t readable,
                       Problems& problems) {
  std::vector<Warning> left_out;
  for (std::size_t i = within.first; i <= within.last; ++i) {
    for (const InputProblem& problem : run.points[i].problems) {
      if (readable < kFewestBeltPoints) {
        problems.add(problem.place, problem.value, problem.expected, problem.kind);
      } else if (&problem == &run.points[i].problems.front()) {
        left_out.push_back({problem.file,
                            problem.place,
                            fmt::format("this reading is left out: found {}, expected {}",
                                        problem.value,
                                        problem.expected)});
      }
    }
  }
  warn_of(left_out, "further readings are damaged and left out", problems);
  if (run.list_is_short && !run.commanded.empty()) {
    problems.warn(
        line_words(run.points[within.first].line),
        "the list has fewer readings than measured places, and which are missing is unknown, so "
        "the commanded places are left out");
  }
}

void leave_out_copies(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems) {
  if (holds_repeats(belts)) return;
  std::map<std::array<double, 4>, std::size_t> first_with;
  std::vector<bool> is_out(belts.points.size(), false);
  std::vector<Warning> left_out;
  for (std::size_t i = 0; i < belts.points.size(); ++i) {
    const auto& l = belts.points[i].lengths_mm;
    const auto [other, is_new] = first_with.emplace(std::array{l.tl, l.tr, l.bl, l.br}, i);
    if (is_new) continue;
    is_out[i] = true;
    left_out.push_back(
        {problems.file(),
         line_words(lines[i]),
         fmt::format("this reading is left out: it is a copy, with the same four lengths as line "
                     "{} to the last digit",
                     lines[other->second])});
  }
  warn_of(left_out, "further readings are copies and left out", problems);
  erase_points(is_out, belts, lines);
}

void leave_out_nowhere(MeasuredBelts& belts, std::vector<std::size_t>& lines, Problems& problems) {
  if (belts.points.size() <= kFewestBeltPoints || belts.points.size() > kMostBeltPoints) return;
  const auto frame = frame_of_lengths(belts);
  if (!frame) return;
  const std::vector<NowherePoint> nowhere = points_nowhere(belts, *frame);
  const auto most = static_cast<std::size_t>(
      std::ceil(kMostBadReadings * static_cast<double>(belts.points.size())));
  if (nowhere.empty() || nowhere.size() > most) return;
  std::vector<bool> is_out(belts.points.size(), false);
  std::vector<Warning> left_out;
  for (const NowherePoint& own : nowhere) {
    is_out[own.point] = true;
    left_out.push_back({problems.file(),
                        line_words(lines[own.point]),
                        fmt::format("this reading is left out: its four lengths ({}) do not meet, "
                                    "the best place is off by {:.0f} mm",
                                    lengths_in_words(belts.points[own.point]),
                                    own.residual_mm)});
  }
  warn_of(left_out, "further readings that do not meet are left out", problems);
  erase_points(is_out, belts, lines);
}

void part_frames(const model::BeltMachine& machine,
                 std::vector<ScannedRun>& runs,
                 Problems& problems) {
  std::vector<ScannedRun> parted;
  for (ScannedRun& run : runs) {
    MeasuredBelts belts;
    belts.machine = machine;
    belts.machine.anchors_known = false;
    std::vector<std::size_t> slots;
    for (std::size_t i = 0; i < run.points.size(); ++i) {
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
    const auto from = run.points.begin() + static_cast<std::ptrdiff_t>(slots[*second]);
    other.points.assign(from, run.points.end());
    other.is_list = run.is_list;
    other.first_line = other.points.front().line;
    run.points.erase(from, run.points.end());
    run.fit.reset();
    problems.warn(
        line_words(other.first_line),
        "from here on the readings are from another frame; they are treated as a second run");
    parted.push_back(std::move(run));
    parted.push_back(std::move(other));
  }
  runs = std::move(parted);
}

}  // namespace chaintrue::grid::files
