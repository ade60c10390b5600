// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>

#include "grid/belts/belt_checks.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/two_frames.hpp"
#include "grid/containers.hpp"
#include "grid/files/belts_checks.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/problems.hpp"
#include "grid/files/setting_reader.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::files {
namespace {

// Places of a run of a Maslow 4's log; damaged ones are left out and reported with their lines.
// Private to grid/files.

struct PlacesOfLog {
  std::vector<BeltPoint> points;
  std::vector<std::size_t> lines;  ///< of each point
};

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

/// Adds places that no list has: the median of a belt's single readings, if these agree to a
/// centimetre. Each is reported.
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

/// Appends the readable places of a run, within the range of its points.
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

/// Reports unreadable readings, as problems if fewer than kFewestBeltPoints are readable.
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
    problems.warn(line_words(run.points[within.first].line),
                  "the list has fewer readings than measured places, and which are missing is "
                  "unknown, so the commanded places are left out");
  }
}

/// Leaves out and reports exact copies of other places, unless the log reads places twice on
/// purpose.
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
    left_out.push_back({problems.file(),
                        line_words(lines[i]),
                        fmt::format("this reading is left out: it is a copy, with the same four "
                                    "lengths as line {} to the last digit",
                                    lines[other->second])});
  }
  warn_of(left_out, "further readings are copies and left out", problems);
  erase_points(is_out, belts, lines);
}

/// Leaves out and reports a few places whose lengths do not meet.
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

/// Runs with places in two frames are split.
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

using model::Belt;
using model::BeltMachine;
using model::kBelts;
using model::Orientation;

/// Applies settings of maslow.yaml; missing ones keep their values and are noted.
class Settings {
 public:
  Settings(const Maslow4Options& options, std::vector<std::string>& assumed)
      : problems_(options.settings_file),
        reader_(options.settings ? yaml_texts(*options.settings, problems_) : SettingTexts{},
                problems_),
        assumed_(assumed) {
    if (options.settings && reader_.empty()) {
      problems_.add("", "no settings", "the machine's maslow.yaml", ProblemKind::missing);
    }
  }

  /// The value of the first of these keys that is present; false if none is.
  bool take(const std::vector<std::string>& keys, double& value) {
    constexpr Range kSetting{"", -1e6, 1e6};
    for (const std::string& key : keys) {
      if (reader_.look(key) == nullptr) continue;
      value = reader_.find(key, kSetting).value_or(value);
      return true;
    }
    return false;
  }

  void take_or_assume(const std::vector<std::string>& keys, double& value, std::string_view what) {
    if (!take(keys, value)) assumed_.push_back(fmt::format("{} of {:g} mm", what, value));
  }

  [[nodiscard]] SettingReader& reader() { return reader_; }
  [[nodiscard]] Problems& problems() { return problems_; }

 private:
  Problems problems_;
  SettingReader reader_;
  std::vector<std::string>& assumed_;
};

/// The keys of a setting: today's name, and that of releases before July 2025.
std::vector<std::string> keys_of(const std::string& key) {
  return {"kinematics/MaslowKinematics/" + key, "Maslow_" + key};
}

/// The settings file's names for the anchors, so that an export writes lines that its firmware
/// accepts.
void take_names(Settings& settings, BeltMachine& machine) {
  const auto has = [&](std::size_t names) {
    return any_of(kBelts, [&](Belt belt) {
      return settings.reader().look(keys_of(std::string(name(belt)) + "X")[names]) != nullptr;
    });
  };
  if (!has(0) && has(1)) machine.setting_names = model::SettingNames::top_level;
}

void take_anchors(Settings& settings, BeltMachine& machine, std::vector<std::string>& assumed) {
  int known = 0;
  std::string heights;
  bool heights_known = true;
  for (const Belt belt : kBelts) {
    const std::string corner(name(belt));
    model::Anchor& anchor = machine.anchors[belt];
    const bool is_origin = belt == Belt::bl;
    // bl and the y of br are 0 by definition of the frame, and not always among the settings.
    known += settings.take(keys_of(corner + "X"), anchor.x_mm) || is_origin ? 1 : 0;
    known +=
        settings.take(keys_of(corner + "Y"), anchor.y_mm) || is_origin || belt == Belt::br ? 1 : 0;
    heights_known = settings.take(keys_of(corner + "Z"), anchor.z_mm) && heights_known;
    heights += fmt::format("{}{} {:g}", heights.empty() ? "" : ", ", corner, anchor.z_mm);
  }
  machine.anchors_known = known == 8;
  if (!machine.anchors_known) {
    for (const Belt belt : kBelts) machine.anchors[belt].x_mm = machine.anchors[belt].y_mm = 0.0;
  }
  if (!heights_known) assumed.push_back(fmt::format("heights of the anchors of {} mm", heights));
}

BeltMachine machine_of(const Maslow4Options& options,
                       Settings& settings,
                       std::vector<std::string>& assumed) {
  BeltMachine machine;
  take_names(settings, machine);
  take_anchors(settings, machine, assumed);
  settings.take_or_assume(keys_of("armLength"), machine.arm_mm, "an arm");
  settings.take_or_assume(
      keys_of("beltEndExtension"), machine.end_extension_mm, "an extension of the belt's end");
  double spoilboard_mm = 0.0;
  double work_mm = 0.0;
  (void)settings.take(keys_of("spoilboardThickness"), spoilboard_mm);
  (void)settings.take(keys_of("workThickness"), work_mm);
  machine.surface_mm = spoilboard_mm + work_mm;
  (void)settings.take(keys_of("Scale_X"), machine.scale_x);
  (void)settings.take(keys_of("Scale_Y"), machine.scale_y);
  const auto vertical = settings.reader().find_word("Maslow_vertical", {"true", "false"});
  if (vertical)
    machine.orientation = *vertical == "true" ? Orientation::upright : Orientation::flat;
  if (options.orientation) {
    machine.orientation = *options.orientation;
  } else if (!vertical) {
    assumed.emplace_back("a frame that stands upright, its lower belts pulled (--orientation)");
  }
  return machine;
}

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

const int* chosen_run(const Maslow4Options& options) {
  return options.part ? std::get_if<int>(&*options.part) : nullptr;
}
const PointRange* chosen_points(const Maslow4Options& options) {
  return options.part ? std::get_if<PointRange>(&*options.part) : nullptr;
}

void check_choice(const Maslow4Options& options,
                  const std::vector<LoggedRun>& runs,
                  Problems& problems) {
  const int* const run = chosen_run(options);
  const PointRange* const points = chosen_points(options);
  if (run != nullptr && (*run < 1 || static_cast<std::size_t>(*run) > runs.size())) {
    problems.add("--runs",
                 fmt::format("{}", *run),
                 fmt::format("a run of this file, 1 to {}", runs.size()),
                 ProblemKind::out_of_range);
  }
  if (points != nullptr && points->last > runs.back().points.last) {
    problems.add("--runs",
                 fmt::format("{}:{}", points->first, points->last),
                 fmt::format("first and last of this file's points, 0:{}", runs.back().points.last),
                 ProblemKind::out_of_range);
  }
}

void choose_lengths(const Maslow4Options& options,
                    bool is_list,
                    BeltMachine& machine,
                    std::vector<std::string>& assumed) {
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
  constexpr int kMost = 1000000;
  std::vector<LogPart> parts;
  for (const std::string& part : parts_at_commas(text)) {
    const auto points = pair_of(part, ':', 0, kMost);
    const auto run = number_of(part);
    if (points && (*points)[0] <= (*points)[1]) {
      parts.emplace_back(PointRange{static_cast<std::size_t>((*points)[0]),
                                    static_cast<std::size_t>((*points)[1])});
    } else if (run && *run >= 1.0 && *run <= kMost && *run == std::floor(*run)) {
      parts.emplace_back(static_cast<int>(*run));
    } else {
      refuse("the command line",
             option,
             shortened(text),
             "runs, counted from 1, as in 1,2; or first and last point, counted from "
             "0, as in 0:98");
    }
  }
  return parts;
}

namespace {

/// No readings: describes a log, or why the run in it failed.
void report_nothing(const ScannedLog& log, const model::BeltMachine& machine, Problems& problems) {
  if (log.refused) {
    problems.explain(
        fmt::format("line {}", log.refused->line), ProblemKind::unexpected, words_of(*log.refused));
    return;
  }
  if (log.stopped) {
    MeasuredBelts none;
    none.machine = machine;
    problems.add(fmt::format("line {}", log.stopped->line),
                 log.stopped->said.empty() ? "the log's end" : log.stopped->said,
                 "a list of readings, CLBM:[...]. " + words_of(*log.stopped, none),
                 ProblemKind::missing);
    return;
  }
  problems.add("",
               "no readings",
               "a log of Find Anchors, or a list of readings: "
               "{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}",
               ProblemKind::missing);
}

/// The runs with places, each of one frame.
std::vector<ScannedRun> runs_of(ScannedLog& log,
                                const model::BeltMachine& machine,
                                Problems& problems) {
  std::vector<ScannedRun> runs = std::move(log.runs);
  for (ScannedRun& run : runs) rebuild_from_singles(run, problems);
  std::erase_if(runs, [](const ScannedRun& run) { return run.points.empty(); });
  part_frames(machine, runs, problems);
  return runs;
}

/// The pull in the settings.
std::optional<BeltPull> settings_pull(Settings& settings) {
  double pull_ma = 0.0;
  const bool is_known = settings.take({"Maslow_Calibration_Current_Threshold"}, pull_ma);
  if (!is_known || !(pull_ma > 0.0)) return std::nullopt;
  return BeltPull{pull_ma, BeltPull::Unit::milliampere};
}

/// The places of the range, from the runs that it covers.
PlacesOfLog take_wanted(const std::vector<ScannedRun>& runs,
                        PointRange wanted,
                        Maslow4Import& result,
                        Problems& problems) {
  PlacesOfLog places;
  bool is_first = true;
  std::vector<std::pair<std::size_t, PointRange>> parts;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PointRange own = result.runs[i].points;
    if (own.last < wanted.first || own.first > wanted.last) continue;
    if (is_first) result.taken = i;
    is_first = false;
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
void check_all(MeasuredBelts& belts,
               std::vector<std::size_t>& lines,
               Maslow4Import& result,
               Problems& problems) {
  const BeltPlaces places{"the readings",
                          [&lines](std::size_t index, std::string_view) {
                            return fmt::format("line {}", lines[index]);
                          },
                          "the settings"};
  leave_out_copies(belts, lines, problems);
  check_belt_points(belts, places, problems);
  problems.throw_if_any();
  leave_out_nowhere(belts, lines, problems);
  result.is_enough = check_belts_together(belts, places, BeltsUse::import, problems);
  problems.throw_if_any();
}

}  // namespace

Maslow4Import parse_maslow4(const std::string& text,
                            const std::string& file,
                            const Maslow4Options& options) {
  Problems problems(file);
  ScannedLog log = scan_maslow4(text, file);
  Maslow4Import result;
  Settings settings(options, result.assumed);
  result.belts.machine = machine_of(options, settings, result.assumed);
  result.settings_pull = settings_pull(settings);
  settings.reader().warn_of_others("describes the anchors of the belts");
  problems.add_warnings(settings.problems().warnings());
  try {
    settings.problems().throw_if_any();
  } catch (const InputError& error) {
    problems.add_all(error);
  }
  for (const model::MachineProblem& problem : model::problems_of(result.belts.machine)) {
    problems.add(fmt::format("the settings' {}", problem.parameter), problem);
  }
  // A run cannot be judged with an impossible machine.
  problems.throw_if_any();
  if (log.refused && !log.runs.empty()) {
    problems.warn(fmt::format("line {}", log.refused->line), words_of(*log.refused));
  }
  const std::vector<ScannedRun> runs = runs_of(log, result.belts.machine, problems);
  if (runs.empty()) report_nothing(log, result.belts.machine, problems);
  problems.throw_if_any();
  result.runs = logged(runs);
  check_choice(options, result.runs, problems);
  problems.throw_if_any();
  MeasuredBelts& belts = result.belts;
  belts.name = std::filesystem::path(file).filename().string();
  const int* const run = chosen_run(options);
  const PointRange* const points = chosen_points(options);
  result.taken = run != nullptr ? static_cast<std::size_t>(*run - 1) : runs.size() - 1;
  const PointRange wanted = points != nullptr ? *points : result.runs[result.taken].points;
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
    problems.warn(fmt::format("line {}", *log.first_passed_over),
                  "ignored: this line and others like it contain no reading, place, pull or fit");
  }
  check_all(belts, places.lines, result, problems);
  if (is_last && log.stopped) result.stopped = words_of(*log.stopped, belts);
  result.warnings = problems.warnings();
  return result;
}

}  // namespace chaintrue::grid::files
