// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/marlin_defines.hpp"
#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {
namespace {

using model::PlotterFirmware;
using model::PlotterMachine;

constexpr Range kOnTheWall{"mm", -20000.0, 20000.0};
constexpr Range kPositive{"", 1e-6, 1e6};

// The numbers on a mural's own page, by their names.
constexpr const char* kTopDistance = "top distance";
constexpr const char* kPulleyDiameter = "effective pulley diameter";
constexpr const char* kHomedOffset = "homed step offset";
constexpr const char* kBotMass = "bot mass";
constexpr const char* kElongation = "belt elongation";
constexpr const char* kExtended = "extended";
constexpr const char* kMeasured = "measured";
constexpr const char* kPolargraphWidth = "machine.width";
constexpr const char* kBootLine = "Loaded ";

constexpr const char* kSaysWhatHangs = "describes where the pen hangs";

bool has_line_with(const std::string& text, const std::string& begin) {
  return text.starts_with(begin) || text.find("\n" + begin) != std::string::npos;
}

bool is_boot_log_of_polargraph(const std::string& text) {
  return text.find("Loaded machine width:") != std::string::npos;
}

bool is_of_polargraph(const std::string& text) {
  return has_line_with(text, kPolargraphWidth) || is_boot_log_of_polargraph(text);
}

/// For a required key; 0 if it is missing and reported.
double needed(SettingReader& settings, const std::string& key, const Range& range) {
  return settings.need(key, range).value_or(0.0);
}

/// A fifth of the pins' spacing in from each side and below, as tall as wide, where the machine is as
/// tall.
void assume_area(std::optional<double> height_mm, PlotterMachine& machine, Problems& problems) {
  const double w = machine.pin_spacing_mm;
  const double bottom = std::max(-0.85 * w, -height_mm.value_or(w));
  machine.area = {-0.3 * w, 0.3 * w, -0.25 * w, bottom};
  problems.warn(
      "",
      fmt::format(
          "the settings do not contain the paper's position. Assumed: a drawing area of {:.0f} x "
          "{:.0f} mm, its top {:.0f} mm below the pins. Enter yours in /set/machine/area",
          0.6 * w,
          -0.25 * w - bottom,
          0.25 * w));
}

void warn_of_gondola(const PlotterMachine& machine, Problems& problems) {
  problems.warn("",
                fmt::format("the settings do not describe the gondola. Assumed: both cords end at "
                            "the pen, and {} kg. Enter yours in /set/machine/gondola",
                            machine.gondola.mass_kg));
}

SetPlotter of_fluidnc(const std::string& text, Problems& problems) {
  SettingReader settings(yaml_texts(text, problems), problems);
  const std::string anchors = "kinematics/WallPlotter/";
  const double left_x = needed(settings, anchors + "left_anchor_x", kOnTheWall);
  const double left_y = needed(settings, anchors + "left_anchor_y", kOnTheWall);
  const double right_x = needed(settings, anchors + "right_anchor_x", kOnTheWall);
  const double right_y = needed(settings, anchors + "right_anchor_y", kOnTheWall);
  SetPlotter set;
  set.firmware = PlotterFirmware::fluidnc;
  set.machine.pin_spacing_mm = right_x - left_x;
  set.machine.pin_rise_mm = right_y - left_y;
  set.pins_middle = {0.5 * (left_x + right_x), 0.5 * (left_y + right_y)};
  // FluidNC starts at its own zero.
  set.home = model::BedPoint{-set.pins_middle.x_mm, -set.pins_middle.y_mm};
  set.steps_per_mm = {settings.find("axes/x/steps_per_mm", kPositive).value_or(0.0),
                      settings.find("axes/y/steps_per_mm", kPositive).value_or(0.0)};
  assume_area(std::nullopt, set.machine, problems);
  warn_of_gondola(set.machine, problems);
  settings.warn_of_others(kSaysWhatHangs);
  return set;
}

/// The words of the last line of such a code: "L-325.00" of M665 as M665/L.
void add_code(const std::string& text, const std::string& code, SettingTexts& texts) {
  std::istringstream lines(text);
  std::size_t line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    const std::size_t at = line.find(code + " ");
    if (at == std::string::npos) continue;
    std::istringstream words(line.substr(at + code.size()));
    for (std::string word; words >> word && word[0] != ';';) {
      if (word.size() > 1)
        texts[code + "/" + word[0]] = {word.substr(1), fmt::format("line {}", line_number)};
    }
  }
}

/// Marlin's draw area, whose upper corners are its motors, and its home, in its own coordinates.
struct MarlinArea {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  std::optional<double> home_x, home_y;
};

MarlinArea logged_area(SettingReader& settings) {
  return {needed(settings, "M665/L", kOnTheWall),
          needed(settings, "M665/R", kOnTheWall),
          needed(settings, "M665/T", kOnTheWall),
          needed(settings, "M665/B", kOnTheWall),
          {},
          {}};
}

const std::vector<std::string> kMarlinNames = {"X_BED_SIZE",
                                               "Y_BED_SIZE",
                                               "X_MIN_POS",
                                               "X_MAX_POS",
                                               "Y_MIN_POS",
                                               "Y_MAX_POS",
                                               "MANUAL_X_HOME_POS",
                                               "MANUAL_Y_HOME_POS",
                                               "POLARGRAPH_MAX_BELT_LEN",
                                               "DEFAULT_AXIS_STEPS_PER_UNIT",
                                               "DEFAULT_SEGMENTS_PER_SECOND"};

MarlinArea defined_area(SettingReader& settings, Problems& problems) {
  MarlinArea area;
  bool is_assumed = false;
  const auto ends = [&](const std::string& axis, double& least, double& most) {
    const auto from = settings.find(axis + "_MIN_POS", kOnTheWall);
    const auto to = settings.find(axis + "_MAX_POS", kOnTheWall);
    const std::string size_name = axis + "_BED_SIZE";
    const auto size =
        from && to ? settings.find(size_name, kOnTheWall) : settings.need(size_name, kOnTheWall);
    is_assumed = is_assumed || !from || !to;
    least = from.value_or(-0.5 * size.value_or(0.0));
    most = to.value_or(least + size.value_or(0.0));
  };
  ends("X", area.left, area.right);
  ends("Y", area.bottom, area.top);
  area.home_x = settings.find("MANUAL_X_HOME_POS", kOnTheWall);
  area.home_y = settings.find("MANUAL_Y_HOME_POS", kOnTheWall);
  if (is_assumed) {
    problems.warn(
        "",
        fmt::format("the settings lack some of X_MIN_POS, X_MAX_POS, Y_MIN_POS and Y_MAX_POS. "
                    "Assumed: a bed centred on the middle, {:g} to {:g} and {:g} to {:g}",
                    area.left,
                    area.right,
                    area.bottom,
                    area.top));
  }
  problems.warn("",
                fmt::format("only these names are read from Configuration.h; the others do not "
                            "describe where the pen hangs: {}",
                            joined(kMarlinNames)));
  return area;
}

/// Where the page hangs: the widest that bed and belt reach as far down as it takes, of half of the
/// spacing. Near the pins, which are the corners of Marlin's area, a cord hangs all of the gondola.
void place_marlin_page(double bed_mm, double belt_mm, PlotterMachine& machine, Problems& problems) {
  constexpr double kTop = 0.4, kLeastHeight = 0.5;
  constexpr double kSides[] = {0.8, 0.7, 0.6, 0.5, 0.4, 0.3};
  const double half = 0.5 * machine.pin_spacing_mm;
  const double least = (kTop + kLeastHeight) * half;
  const auto reach = [&](double side) {
    return std::floor(
        std::sqrt(std::max(0.0, belt_mm * belt_mm - std::pow((1.0 + side) * half, 2))));
  };
  const auto* const side = std::find_if(std::begin(kSides), std::end(kSides), [&](double own) {
    return std::min(bed_mm, reach(own)) >= least;
  });
  if (side == std::end(kSides)) {
    problems.add("the page",
                 fmt::format("a bed of {:g} mm, a belt of {:g} mm", bed_mm, belt_mm),
                 fmt::format("for {:g} mm between the motors, a bed of at least {:.0f} mm and a "
                             "belt of at least {:.0f} mm, which a page needs",
                             machine.pin_spacing_mm,
                             std::ceil(least),
                             std::ceil(std::hypot((1.0 + kSides[5]) * half, least))),
                 ProblemKind::out_of_range);
    return;
  }
  const double bottom = std::min(bed_mm, reach(*side));
  machine.area = {-*side * half, *side * half, -kTop * half, -bottom};
  if (bottom == bed_mm && *side == kSides[0]) return;
  problems.warn(
      "",
      fmt::format(
          "the longest belt, {:g} mm, does not reach the whole bed: the page is {:.0f} mm wide and "
          "ends {:g} mm below the motors; a belt of {:.0f} mm would reach all of it",
          belt_mm,
          2.0 * *side * half,
          bottom,
          std::ceil(std::hypot((1.0 + kSides[0]) * half, bed_mm))));
}

/// The pen's place when the controller is switched on: as stated, else with both belts fully paid
/// out.
void place_marlin_home(const MarlinArea& area, double belt, SetPlotter& set, Problems& problems) {
  const double half = 0.5 * set.machine.pin_spacing_mm;
  if (belt <= half) {
    problems.add("the longest belt",
                 fmt::format("{}", belt),
                 fmt::format("more than half of the {} mm between the motors", 2.0 * half),
                 ProblemKind::impossible);
    return;
  }
  set.home = model::BedPoint{area.home_x.value_or(set.pins_middle.x_mm) - set.pins_middle.x_mm,
                             -std::sqrt(belt * belt - half * half)};
  if (area.home_y) set.home->y_mm = *area.home_y - area.top;
  const double longest = std::hypot(std::abs(set.home->x_mm) + half, set.home->y_mm);
  if (set.home->y_mm < 0.0 && longest <= belt + 0.5) return;
  problems.add(
      "the home",
      fmt::format("({:.1f}, {:.1f}) mm from the middle between the motors, with {:.1f} mm of belt",
                  set.home->x_mm,
                  set.home->y_mm,
                  longest),
      fmt::format("a home below the motors within reach of a belt of {:g} mm (MANUAL_X_HOME_POS, "
                  "MANUAL_Y_HOME_POS)",
                  belt),
      ProblemKind::out_of_range);
}

SetPlotter of_marlin(const std::string& text, Problems& problems) {
  SettingTexts texts;
  // The comments of a Configuration.h name M665.
  const std::string code = without_comments(text);
  add_code(code, "M665", texts);
  const bool is_log = !texts.empty();
  if (is_log) {
    add_code(code, "M92", texts);
  } else {
    texts = marlin_texts(text, kMarlinNames, problems);
    problems.throw_if_any();
  }
  SettingReader settings(std::move(texts), problems);
  const MarlinArea area = is_log ? logged_area(settings) : defined_area(settings, problems);
  const double belt = needed(settings, is_log ? "M665/H" : "POLARGRAPH_MAX_BELT_LEN", kOnTheWall);
  const auto steps = [&](const char* logged, int place) {
    const std::string key = is_log ? std::string("M92/") + logged
                                   : fmt::format("DEFAULT_AXIS_STEPS_PER_UNIT/{}", place);
    return settings.find(key, kPositive).value_or(0.0);
  };
  SetPlotter set;
  set.firmware = PlotterFirmware::marlin;
  set.steps_per_mm = {steps("X", 0), steps("Y", 1)};
  constexpr Range kASecond{"1/s", 0.1, 1e4};
  if (const auto pieces =
          settings.find(is_log ? "M665/S" : "DEFAULT_SEGMENTS_PER_SECOND", kASecond))
    set.segments_per_second = *pieces;
  set.machine.pin_spacing_mm = area.right - area.left;
  set.pins_middle = {0.5 * (area.left + area.right), area.top};
  settings.warn_of_others(kSaysWhatHangs);
  if (problems.any()) return set;
  set.longest_belt_mm = belt;
  place_marlin_home(area, belt, set, problems);
  if (problems.any()) return set;
  place_marlin_page(area.top - area.bottom, belt, set.machine, problems);
  warn_of_gondola(set.machine, problems);
  return set;
}

/// What the firmware prints when it is switched on, under the names of the properties.
SettingTexts boot_log_texts(const std::string& text) {
  constexpr std::pair<const char*, const char*> kNames[] = {
      {"machine width", kPolargraphWidth},
      {"machine height", "machine.height"},
      {"mm per rev", "machine.motors.mmPerRev"},
      {"motor steps per rev", "machine.motors.stepsPerRev"},
      {"motor step multiplier", "machine.step.multiplier"}};
  SettingTexts texts = line_texts(text, ':', kBootLine);
  for (const auto& [logged, name] : kNames) {
    auto own = texts.extract(logged);
    if (own.empty()) continue;
    own.key() = name;
    texts.insert(std::move(own));
  }
  return texts;
}

/// From the left motor, right and down.
model::BedPoint polargraph_home(SettingReader& settings,
                                double width,
                                bool is_boot_log,
                                Problems& problems) {
  // PenPlotter's own: half of the width, and how far down.
  if (const auto down = settings.find("machine.homepoint.y", kOnTheWall)) {
    const auto more = settings.find("machine.homepoint.offsety", kOnTheWall);
    return {0.5 * width, *down + more.value_or(0.0)};
  }
  if (!is_boot_log) {
    return {needed(settings, "controller.homepoint.x", kOnTheWall),
            needed(settings, "controller.homepoint.y", kOnTheWall)};
  }
  constexpr double kUsualDownMm = 120.0;
  problems.warn("",
                fmt::format("a boot log does not contain home. Assumed: the middle, {:g} mm below "
                            "the motors. Enter yours in /set/home",
                            kUsualDownMm));
  return {0.5 * width, kUsualDownMm};
}

/// The page and the home are on the machine.
void check_within(double width,
                  std::optional<double> height,
                  model::BedPoint home,
                  const model::DrawingArea& page,
                  Problems& problems) {
  if (problems.any()) return;
  if (home.x_mm <= 0.0 || home.x_mm >= width || home.y_mm <= 0.0 ||
      home.y_mm > height.value_or(home.y_mm)) {
    problems.add("the home",
                 fmt::format("({:g}, {:g}) mm", home.x_mm, home.y_mm),
                 fmt::format("a place on the machine, {:g} mm wide{}",
                             width,
                             height ? fmt::format(" and {:g} mm high", *height) : ""),
                 ProblemKind::out_of_range);
  }
  if (height && -page.bottom_mm > *height) {
    problems.add("the page",
                 fmt::format("down to {:g} mm", -page.bottom_mm),
                 fmt::format("a page that ends within the machine's {:g} mm", *height),
                 ProblemKind::out_of_range);
  }
}

SetPlotter of_polargraph(const std::string& text, Problems& problems) {
  const bool is_boot_log = is_boot_log_of_polargraph(text);
  SettingReader settings(is_boot_log ? boot_log_texts(text) : line_texts(text, '='), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::polargraph;
  const double width = needed(settings, kPolargraphWidth, kOnTheWall);
  const model::BedPoint home = polargraph_home(settings, width, is_boot_log, problems);
  const double turn = needed(settings, "machine.motors.mmPerRev", kPositive);
  const double steps = needed(settings, "machine.motors.stepsPerRev", kPositive) *
                       settings.find("machine.step.multiplier", kPositive).value_or(1.0);
  if (turn > 0.0) set.steps_per_mm = {steps / turn, steps / turn};
  set.machine.pin_spacing_mm = width;
  // Its origin is the left motor, with y downwards.
  set.pins_middle = {0.5 * width, 0.0};
  set.home = model::BedPoint{home.x_mm - 0.5 * width, -home.y_mm};
  const auto height = settings.find("machine.height", kPositive);
  const auto page_left = settings.find("controller.page.position.x", kOnTheWall);
  const auto page_top = settings.find("controller.page.position.y", kOnTheWall);
  const auto page_width = settings.find("controller.page.width", kOnTheWall);
  const auto page_height = settings.find("controller.page.height", kOnTheWall);
  if (page_left && page_top && page_width && page_height) {
    const double left = *page_left - 0.5 * width;
    set.machine.area = {left, left + *page_width, -*page_top, -*page_top - *page_height};
  } else {
    assume_area(height, set.machine, problems);
  }
  check_within(width, height, home, set.machine.area, problems);
  warn_of_gondola(set.machine, problems);
  settings.warn_of_others(kSaysWhatHangs);
  return set;
}

/// The firmware's own calibration lets out a length and asks what a tape reads: its pulley counts by the
/// ratio (nikivanov/mural, /estepsCalibrationApply).
void take_calibration(SettingReader& settings, PlotterMachine& machine, Problems& problems) {
  constexpr Range kLetOut{"mm", 10.0, 20000.0};
  const auto extended = settings.find(kExtended, kLetOut);
  const auto measured = settings.find(kMeasured, kLetOut);
  if (extended && measured) machine.pulley_radius_mm *= *measured / *extended;
  if (extended.has_value() == measured.has_value()) return;
  problems.add(
      extended ? kMeasured : kExtended,
      "",
      "both distances of the calibration: the extended length, and the same length by tape",
      ProblemKind::missing);
}

SetPlotter of_mural(const std::string& text, Problems& problems) {
  SettingReader settings(line_texts(text, ':'), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::mural;
  set.machine = model::mural(needed(settings, kTopDistance, kOnTheWall));
  if (const auto diameter = settings.find(kPulleyDiameter, kPositive))
    set.machine.pulley_radius_mm = 0.5 * *diameter;
  if (const auto offset = settings.find(kHomedOffset, {"mm", -1000.0, 1000.0}))
    set.homed_offset_mm = *offset;
  const auto mass = settings.find(kBotMass, {"kg", 0.01, 100.0});
  if (mass) set.machine.gondola.mass_kg = *mass;
  if (const auto elongation = settings.find(kElongation, {"1/N", 0.0, 0.01}))
    set.machine.cord.compliance_per_n = *elongation;
  take_calibration(settings, set.machine, problems);
  settings.refuse_others();
  problems.warn("",
                fmt::format("assumed: a mural with its firmware's defaults: {}{} mm between its "
                            "pulleys",
                            mass ? "" : fmt::format("{} kg, ", set.machine.gondola.mass_kg),
                            set.machine.gondola.spacing_mm));
  return set;
}

bool is_marlin(const std::string& text) {
  return text.find("M665 ") != std::string::npos || text.find("POLARGRAPH") != std::string::npos;
}

SetPlotter settings_of(const std::string& text, Problems& problems) {
  refuse_foreign_settings(text, problems);
  if (is_fluidnc(text)) return of_fluidnc(text, problems);
  if (is_of_polargraph(text)) return of_polargraph(text, problems);
  if (has_line_with(text, kTopDistance)) return of_mural(text, problems);
  if (is_marlin(text)) return of_marlin(text, problems);
  problems.add("",
               "no settings of a V-plotter",
               "FluidNC's config.yaml with a WallPlotter, Marlin's M665 and M92 or its "
               "Configuration.h, a Polargraph properties file, or for a mural a line such as \"top "
               "distance: 1500 mm\"",
               ProblemKind::missing);
  problems.throw_if_any();
  return {};
}

}  // namespace

bool is_of_a_plotter_alone(const std::string& text) {
  return is_of_polargraph(text) || has_line_with(text, kTopDistance) || is_marlin(text);
}

ReadPlotter parse_plotter_settings(const std::string& text, const std::string& file) {
  Problems problems(file);
  ReadPlotter read;
  read.plotter.set = settings_of(text, problems);
  problems.throw_if_any();
  PlotterMachine& machine = read.plotter.set.machine;
  machine.name = std::filesystem::path(file).filename().string();
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    problems.add(fmt::format("the plotter's {}", problem.parameter), problem);
  }
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

}  // namespace chaintrue::grid::files
