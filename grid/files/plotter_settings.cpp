// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>

#include "grid/files/fluidnc_file.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/yaml_values.hpp"

namespace chaintrue::grid::files {
namespace {

using model::PlotterFirmware;
using model::PlotterMachine;

constexpr Range kOnTheWall{"mm", -20000.0, 20000.0};
constexpr Range kPositive{"", 1e-6, 1e6};

// A mural's: the numbers of its own page, by their names there.
constexpr const char* kTopDistance = "top distance";
constexpr const char* kPulleyDiameter = "effective pulley diameter";
constexpr const char* kHomedOffset = "homed step offset";
constexpr const char* kBotMass = "bot mass";
constexpr const char* kElongation = "belt elongation";
constexpr const char* kExtended = "extended";
constexpr const char* kMeasured = "measured";
constexpr const char* kPolargraphWidth = "machine.width";

bool has_line_with(const std::string& text, const std::string& begin) {
  return text.starts_with(begin) || text.find("\n" + begin) != std::string::npos;
}

/// Values by their keys, each on a line of its own: "key: 12 mm", "key=12".
std::map<std::string, YamlValue> lines_of(const std::string& text, char separator) {
  std::map<std::string, YamlValue> values;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos || line.starts_with("#")) continue;
    const auto trimmed = [](const std::string& part) {
      const std::size_t first = part.find_first_not_of(" \t\r");
      if (first == std::string::npos) return std::string();
      return part.substr(first, part.find_last_not_of(" \t\r") - first + 1);
    };
    std::string value = trimmed(line.substr(at + 1));
    for (const std::string_view unit : {"mm", "kg", "1/N", "/N"}) {
      if (!value.ends_with(unit)) continue;
      value = trimmed(value.substr(0, value.size() - unit.size()));
      break;
    }
    values[trimmed(line.substr(0, at))] = {value, fmt::format("line {}", number)};
  }
  return values;
}

/// Numbers by their keys; one that is missing is reported, or nothing where it need not be there.
class PlotterKeys {
 public:
  PlotterKeys(std::map<std::string, YamlValue> values, Problems& problems)
      : values_(std::move(values)), problems_(problems) {}

  std::optional<double> find(const std::string& key, const Range& range) {
    const auto found = values_.find(key);
    if (found == values_.end()) return std::nullopt;
    return checked_number(found->second.text, found->second.place, key, range, problems_);
  }
  double number(const std::string& key, const Range& range) {
    if (!values_.contains(key)) problems_.add(key, "", range.expected());
    return find(key, range).value_or(0.0);
  }
  /// Of a text in which nothing else can stand.
  void refuse_others(const std::vector<std::string_view>& known) {
    for (const auto& [key, value] : values_) {
      if (std::find(known.begin(), known.end(), key) == known.end())
        problems_.add(value.place, key, fmt::format("one of {}", fmt::join(known, ", ")));
    }
  }

 private:
  std::map<std::string, YamlValue> values_;
  Problems& problems_;
};

/// A fifth of the pins' spacing in from each side and below, as tall as wide.
void assume_area(PlotterMachine& machine, Problems& problems) {
  const double w = machine.pin_spacing_mm;
  machine.area = {-0.3 * w, 0.3 * w, -0.25 * w, -0.85 * w};
  problems.warn("",
                fmt::format("the settings do not say where the paper hangs; assumed is a drawing "
                            "area of {:.0f} x {:.0f} mm, its top {:.0f} mm below the pins: put "
                            "your own into /set/machine/area",
                            0.6 * w,
                            0.6 * w,
                            0.25 * w));
}

void warn_of_gondola(const PlotterMachine& machine, Problems& problems) {
  problems.warn("",
                fmt::format("the settings do not say what hangs on the cords; assumed are cords "
                            "that both end at the pen and {} kg: put your own into "
                            "/set/machine/gondola",
                            machine.gondola.mass_kg));
}

SetPlotter of_fluidnc(const std::string& text, Problems& problems) {
  PlotterKeys settings(yaml_values(text), problems);
  const std::string anchors = "kinematics/WallPlotter/";
  const double left_x = settings.number(anchors + "left_anchor_x", kOnTheWall);
  const double left_y = settings.number(anchors + "left_anchor_y", kOnTheWall);
  const double right_x = settings.number(anchors + "right_anchor_x", kOnTheWall);
  const double right_y = settings.number(anchors + "right_anchor_y", kOnTheWall);
  SetPlotter set;
  set.firmware = PlotterFirmware::fluidnc;
  set.machine.pin_spacing_mm = right_x - left_x;
  set.machine.pin_rise_mm = right_y - left_y;
  set.pins_middle = {0.5 * (left_x + right_x), 0.5 * (left_y + right_y)};
  // FluidNC starts at its own zero.
  set.home = model::BedPoint{-set.pins_middle.x_mm, -set.pins_middle.y_mm};
  set.steps_per_mm = {settings.find("axes/x/steps_per_mm", kPositive).value_or(0.0),
                      settings.find("axes/y/steps_per_mm", kPositive).value_or(0.0)};
  assume_area(set.machine, problems);
  warn_of_gondola(set.machine, problems);
  return set;
}

/// The words of the last line of such a code: "L-325.00" of M665 as L.
std::map<std::string, YamlValue> words_of_code(const std::string& text, const std::string& code) {
  std::map<std::string, YamlValue> values;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const std::size_t at = line.find(code + " ");
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(at + code.size()));
    for (std::string word; words >> word && word[0] != ';';) {
      if (word.size() > 1)
        values[code + " " + word[0]] = {word.substr(1), fmt::format("line {}", number)};
    }
  }
  return values;
}

/// What Configuration.h defines, as M665 and M92 would say it.
std::map<std::string, YamlValue> words_of_configuration(const std::string& text) {
  std::map<std::string, YamlValue> defined;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string define, key, value;
    if (!(words >> define >> key) || define != "#define" || !std::getline(words, value)) continue;
    value.resize(std::min(value.find("//"), value.size()));
    for (char& c : value) c = c == '{' || c == '}' || c == ',' ? ' ' : c;
    std::istringstream numbers(value);
    for (int i = 0; numbers >> value; ++i)
      defined[fmt::format("{} {}", key, i)] = {value, fmt::format("line {}", number)};
  }
  return defined;
}

SetPlotter of_marlin(const std::string& text, Problems& problems) {
  std::map<std::string, YamlValue> words = words_of_code(text, "M665");
  const bool is_log = !words.empty();
  words.merge(is_log ? words_of_code(text, "M92") : words_of_configuration(text));
  PlotterKeys settings(std::move(words), problems);
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  if (is_log) {
    left = settings.number("M665 L", kOnTheWall);
    right = settings.number("M665 R", kOnTheWall);
    top = settings.number("M665 T", kOnTheWall);
    bottom = settings.number("M665 B", kOnTheWall);
  } else {
    right = 0.5 * settings.number("X_BED_SIZE 0", kOnTheWall);
    top = 0.5 * settings.number("Y_BED_SIZE 0", kOnTheWall);
    left = -right;
    bottom = -top;
  }
  const double belt = settings.number(is_log ? "M665 H" : "POLARGRAPH_MAX_BELT_LEN 0", kOnTheWall);
  const auto steps = [&](const char* logged, int place) {
    const std::string key = is_log ? std::string("M92 ") + logged
                                   : fmt::format("DEFAULT_AXIS_STEPS_PER_UNIT {}", place);
    return settings.find(key, kPositive).value_or(0.0);
  };
  SetPlotter set;
  set.firmware = PlotterFirmware::marlin;
  set.steps_per_mm = {steps("X", 0), steps("Y", 1)};
  constexpr Range kASecond{"1/s", 0.1, 1e4};
  if (const auto pieces =
          settings.find(is_log ? "M665 S" : "DEFAULT_SEGMENTS_PER_SECOND 0", kASecond))
    set.segments_per_second = *pieces;
  set.machine.pin_spacing_mm = right - left;
  set.pins_middle = {0.5 * (left + right), top};
  const double half = 0.5 * set.machine.pin_spacing_mm;
  if (belt > half) {
    // Both belts paid out whole.
    set.home = model::BedPoint{0.0, -std::sqrt(belt * belt - half * half)};
  } else if (!problems.any()) {
    problems.add("the longest belt",
                 fmt::format("{}", belt),
                 fmt::format("more than half of the {} mm between the motors", 2.0 * half));
  }
  // Near the pins, which are the corners of Marlin's area, a cord hangs all of the gondola.
  set.machine.area = {-0.8 * half, 0.8 * half, -0.4 * half, bottom - top};
  warn_of_gondola(set.machine, problems);
  return set;
}

SetPlotter of_polargraph(const std::string& text, Problems& problems) {
  PlotterKeys settings(lines_of(text, '='), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::polargraph;
  const double width = settings.number(kPolargraphWidth, kOnTheWall);
  const double x = settings.number("controller.homepoint.x", kOnTheWall);
  const double y = settings.number("controller.homepoint.y", kOnTheWall);
  const double turn = settings.number("machine.motors.mmPerRev", kPositive);
  const double steps = settings.number("machine.motors.stepsPerRev", kPositive) *
                       settings.find("machine.step.multiplier", kPositive).value_or(1.0);
  if (turn > 0.0) set.steps_per_mm = {steps / turn, steps / turn};
  set.machine.pin_spacing_mm = width;
  // Its origin is the left motor, with y downwards.
  set.pins_middle = {0.5 * width, 0.0};
  set.home = model::BedPoint{x - 0.5 * width, -y};
  const auto page_left = settings.find("controller.page.position.x", kOnTheWall);
  const auto page_top = settings.find("controller.page.position.y", kOnTheWall);
  const auto page_width = settings.find("controller.page.width", kOnTheWall);
  const auto page_height = settings.find("controller.page.height", kOnTheWall);
  if (page_left && page_top && page_width && page_height) {
    const double left = *page_left - 0.5 * width;
    set.machine.area = {left, left + *page_width, -*page_top, -*page_top - *page_height};
  } else {
    assume_area(set.machine, problems);
  }
  warn_of_gondola(set.machine, problems);
  return set;
}

/// The firmware's own calibration lets out a length and asks what a tape reads: its pulley counts by the
/// ratio (nikivanov/mural, /estepsCalibrationApply).
void take_calibration(PlotterKeys& settings, PlotterMachine& machine, Problems& problems) {
  constexpr Range kLetOut{"mm", 10.0, 20000.0};
  const auto extended = settings.find(kExtended, kLetOut);
  const auto measured = settings.find(kMeasured, kLetOut);
  if (extended && measured) machine.pulley_radius_mm *= *measured / *extended;
  if (extended.has_value() == measured.has_value()) return;
  problems.add(extended ? kMeasured : kExtended,
               "",
               "both distances of the calibration: what was extended, and what a tape read of it");
}

SetPlotter of_mural(const std::string& text, Problems& problems) {
  PlotterKeys settings(lines_of(text, ':'), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::mural;
  set.machine = model::mural(settings.number(kTopDistance, kOnTheWall));
  settings.refuse_others({kTopDistance, kPulleyDiameter, kHomedOffset, kBotMass, kElongation, kExtended, kMeasured});
  if (const auto diameter = settings.find(kPulleyDiameter, kPositive))
    set.machine.pulley_radius_mm = 0.5 * *diameter;
  if (const auto offset = settings.find(kHomedOffset, {"mm", -1000.0, 1000.0}))
    set.homed_offset_mm = *offset;
  const auto mass = settings.find(kBotMass, {"kg", 0.01, 100.0});
  if (mass) set.machine.gondola.mass_kg = *mass;
  if (const auto elongation = settings.find(kElongation, {"1/N", 0.0, 0.01}))
    set.machine.cord.compliance_per_n = *elongation;
  take_calibration(settings, set.machine, problems);
  problems.warn("",
                fmt::format("assumed is a mural as its firmware has it: {}{} mm between its pulleys",
                            mass ? "" : fmt::format("{} kg, ", set.machine.gondola.mass_kg),
                            set.machine.gondola.spacing_mm));
  return set;
}

bool is_marlin(const std::string& text) {
  return text.find("M665 ") != std::string::npos || text.find("POLARGRAPH") != std::string::npos;
}

SetPlotter settings_of(const std::string& text, Problems& problems) {
  if (is_fluidnc(text)) return of_fluidnc(text, problems);
  if (has_line_with(text, kPolargraphWidth)) return of_polargraph(text, problems);
  if (has_line_with(text, kTopDistance)) return of_mural(text, problems);
  if (is_marlin(text)) return of_marlin(text, problems);
  problems.add("",
               "no settings of a V-plotter",
               "FluidNC's config.yaml with a WallPlotter, Marlin's M665 and M92 or its "
               "Configuration.h, a Polargraph properties file, or for a mural a line such as \"top "
               "distance: 1500 mm\"");
  problems.throw_if_any();
  return {};
}

}  // namespace

bool is_of_a_plotter_alone(const std::string& text) {
  return has_line_with(text, kPolargraphWidth) || has_line_with(text, kTopDistance) ||
         is_marlin(text);
}

ReadPlotter parse_plotter_settings(const std::string& text, const std::string& file) {
  Problems problems(file);
  ReadPlotter read;
  read.plotter.set = settings_of(text, problems);
  problems.throw_if_any();
  PlotterMachine& machine = read.plotter.set.machine;
  machine.name = std::filesystem::path(file).filename().string();
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    problems.add(
        fmt::format("the plotter's {}", problem.parameter), problem.value, problem.expected);
  }
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

}  // namespace chaintrue::grid::files
