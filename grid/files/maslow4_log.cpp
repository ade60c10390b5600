// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "grid/files/belts_checks.hpp"
#include "grid/files/maslow4_scan.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/yaml_values.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Belt;
using model::BeltMachine;
using model::kBelts;
using model::Orientation;

/// Applies settings of maslow.yaml; missing ones keep their values and are noted.
class Settings {
 public:
  Settings(const Maslow4Options& options, std::vector<std::string>& assumed)
      : problems_(options.settings_file), assumed_(assumed) {
    if (options.settings) values_ = yaml_values(*options.settings);
    if (options.settings && values_.empty()) {
      problems_.add("", "no settings", "the machine's maslow.yaml");
    }
  }

  /// The value of any of these keys; false if none is present.
  bool take(const std::vector<std::string>& keys, double& value) {
    constexpr Range kSetting{"", -1e6, 1e6};
    for (const std::string& key : keys) {
      const auto found = values_.find(key);
      if (found == values_.end()) continue;
      const auto number =
          checked_number(found->second.text, found->second.place, key, kSetting, problems_);
      if (number) value = *number;
      return true;
    }
    return false;
  }

  void take_or_assume(const std::vector<std::string>& keys, double& value, std::string_view what) {
    if (!take(keys, value)) assumed_.push_back(fmt::format("{} of {:g} mm", what, value));
  }

  [[nodiscard]] std::optional<std::string> word(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? std::nullopt : std::optional(found->second.text);
  }

  [[nodiscard]] Problems& problems() { return problems_; }

 private:
  std::map<std::string, YamlValue> values_;
  Problems problems_;
  std::vector<std::string>& assumed_;
};

/// The keys of a setting: today's name, and that of 2024.
std::vector<std::string> keys_of(const std::string& key) {
  return {"kinematics/MaslowKinematics/" + key, "Maslow_" + key};
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
  const auto vertical = settings.word("Maslow_vertical");
  if (vertical) {
    if (*vertical == "true" || *vertical == "false") {
      machine.orientation = *vertical == "true" ? Orientation::upright : Orientation::flat;
    } else {
      settings.problems().add("Maslow_vertical", *vertical, "true or false");
    }
  }
  if (options.orientation) {
    machine.orientation = *options.orientation;
  } else if (!vertical) {
    assumed.emplace_back("a frame that stands upright, its lower belts pulled (--orientation)");
  }
  return machine;
}

void take_run(const ScannedRun& run,
              PointRange range,
              Orientation orientation,
              MeasuredBelts& belts,
              std::vector<std::size_t>& lines) {
  const bool commands_known = [&] {
    for (std::size_t i = 0; i < run.points.size(); ++i) {
      if (!run.commanded.contains(static_cast<int>(i))) return false;
    }
    return true;
  }();
  for (std::size_t i = range.first; i <= range.last; ++i) {
    const int waypoint = static_cast<int>(i);
    BeltPoint point;
    point.lengths_mm = run.points[i].lengths_mm;
    point.order = static_cast<int>(belts.points.size());
    const auto commanded = run.commanded.find(waypoint);
    if (commanded != run.commanded.end()) point.commanded = commanded->second;
    const auto thrown_away = run.thrown_away_mm.find(waypoint);
    if (thrown_away != run.thrown_away_mm.end()) point.thrown_away_mm = thrown_away->second;
    if (orientation == Orientation::flat && commands_known) {
      const model::BedPoint before = run.commanded.at(std::max(waypoint - 1, 0));
      point.pulled = pulled_after(orientation, before, *point.commanded, i);
    }
    belts.points.push_back(std::move(point));
    lines.push_back(run.points[i].line);
  }
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

void check_choice(const Maslow4Options& options,
                  const std::vector<LoggedRun>& runs,
                  Problems& problems) {
  if (options.run && (*options.run < 1 || static_cast<std::size_t>(*options.run) > runs.size())) {
    problems.add("--run",
                 fmt::format("{}", *options.run),
                 fmt::format("a run of this file, 1 to {}", runs.size()));
  }
  if (options.points && options.points->last > runs.back().points.last) {
    problems.add(
        "--points",
        fmt::format("{}:{}", options.points->first, options.points->last),
        fmt::format("first and last of this file's points, 0:{}", runs.back().points.last));
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
      is_list
          ? "lengths that are level from anchor to tool, as printed since October 2024 (older "
            "prints slant: --lengths belt_and_arm)"
          : "lengths that are level from anchor to tool; this note looks older than October 2024, "
            "when they still slanted by the anchors' heights (--lengths belt_and_arm)");
}

}  // namespace

PointRange point_range_of(const std::string& text, const std::string& option) {
  const std::size_t colon = text.find(':');
  const auto whole = [](const std::optional<double>& number) {
    constexpr double kMost = 1e6;
    return number && *number >= 0.0 && *number <= kMost && *number == std::floor(*number);
  };
  if (colon != std::string::npos) {
    const auto first = number_of(text.substr(0, colon));
    const auto last = number_of(text.substr(colon + 1));
    if (whole(first) && whole(last) && *first <= *last)
      return {static_cast<std::size_t>(*first), static_cast<std::size_t>(*last)};
  }
  throw InputError({{"the command line",
                     option,
                     shortened(text),
                     "first and last point, counted from 0, as in 0:98"}});
}

Maslow4Import parse_maslow4(const std::string& text,
                            const std::string& file,
                            const Maslow4Options& options) {
  Problems problems(file);
  const std::vector<ScannedRun> runs = scan_maslow4(text, problems);
  if (runs.empty() && !problems.any()) {
    problems.add("",
                 "no readings",
                 "a log of Find Anchors, or a list of readings: "
                 "{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}");
  }
  Maslow4Import result;
  Settings settings(options, result.assumed);
  result.belts.machine = machine_of(options, settings, result.assumed);
  problems.add_warnings(settings.problems().warnings());
  try {
    settings.problems().throw_if_any();
  } catch (const InputError& error) {
    problems.add_all(error);
  }
  problems.throw_if_any();
  result.runs = logged(runs);
  check_choice(options, result.runs, problems);
  problems.throw_if_any();
  MeasuredBelts& belts = result.belts;
  belts.name = std::filesystem::path(file).filename().string();
  result.taken = options.run ? static_cast<std::size_t>(*options.run - 1) : runs.size() - 1;
  const PointRange wanted = options.points.value_or(result.runs[result.taken].points);
  std::vector<std::size_t> lines;
  bool is_first = true;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PointRange own = result.runs[i].points;
    if (own.last < wanted.first || own.first > wanted.last) continue;
    if (is_first) result.taken = i;
    is_first = false;
    const PointRange within{std::max(own.first, wanted.first) - own.first,
                            std::min(own.last, wanted.last) - own.first};
    take_run(runs[i], within, belts.machine.orientation, belts, lines);
  }
  // The machine's own figures refer to the whole run.
  const ScannedRun& taken = runs[result.taken];
  if (taken.points.size() == belts.points.size()) belts.firmware_fit = taken.fit;
  choose_lengths(options, taken.is_list, belts.machine, result.assumed);
  const BeltPlaces places{"the readings",
                          [&lines](std::size_t index, std::string_view) {
                            return fmt::format("line {}", lines[index]);
                          },
                          ""};
  for (const model::MachineProblem& problem : model::problems_of(belts.machine)) {
    problems.add(
        fmt::format("the settings' {}", problem.parameter), problem.value, problem.expected);
  }
  check_belt_points(belts, places, problems);
  problems.throw_if_any();
  check_belts_together(belts, places, BeltsUse::import, problems);
  problems.throw_if_any();
  result.warnings = problems.warnings();
  return result;
}

}  // namespace chaintrue::grid::files
