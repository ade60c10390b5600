// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/plotter_marlin.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

// The numbers on a mural's own page, by their names.
constexpr const char* kTopDistance = "top distance";
constexpr const char* kExtended = "extended";
constexpr const char* kMeasured = "measured";
constexpr const char* kPolargraphWidth = "machine.width";

bool has_line_with(const std::string& text, const std::string& begin) {
  return text.starts_with(begin) || has(text, "\n" + begin);
}

bool is_boot_log_of_polargraph(const std::string& text) {
  return has(text, "Loaded machine width:");
}

bool is_of_polargraph(const std::string& text) {
  return has_line_with(text, kPolargraphWidth) || is_boot_log_of_polargraph(text);
}

/// A fifth of the pins' spacing in from each side and below, as tall as wide, where the machine is as
/// tall.
void assume_area(std::optional<double> height_mm, PlotterMachine& machine, Problems& problems) {
  const double w = machine.pin_spacing_mm;
  const double bottom = std::max(-0.85 * w, -height_mm.value_or(w));
  machine.area = {-0.3 * w, 0.3 * w, -0.25 * w, bottom};
  problems.warn(
      "",
      "the settings do not contain the paper's position. Assumed: a drawing area of {:.0f} x "
      "{:.0f} mm, its top {:.0f} mm below the pins. Enter yours in /set/machine/area",
      0.6 * w, -0.25 * w - bottom, 0.25 * w);
}

SetPlotter of_fluidnc(const std::string& text, Problems& problems) {
  SettingReader settings(yaml_texts(text, problems), problems);
  const auto [left, right] = fluidnc_anchors(settings);
  SetPlotter set;
  set.firmware = PlotterFirmware::fluidnc;
  set.machine.pin_spacing_mm = right.x_mm - left.x_mm;
  set.machine.pin_rise_mm = right.y_mm - left.y_mm;
  set.pins_middle = {0.5 * (left.x_mm + right.x_mm), 0.5 * (left.y_mm + right.y_mm)};
  // FluidNC starts at its own zero.
  set.home = BedPoint{-set.pins_middle.x_mm, -set.pins_middle.y_mm};
  set.steps_per_mm = {settings.find("axes/x/steps_per_mm", kPositive).value_or(0.0),
                      settings.find("axes/y/steps_per_mm", kPositive).value_or(0.0)};
  assume_area(std::nullopt, set.machine, problems);
  warn_of_gondola(set.machine, problems);
  settings.warn_of_others(kSaysWhatHangs);
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
  SettingTexts texts = line_texts(text, ':', "Loaded ");
  for (const auto& [logged, name] : kNames) {
    auto own = texts.extract(logged);
    if (own.empty()) continue;
    own.key() = name;
    texts.insert(std::move(own));
  }
  return texts;
}

/// From the left motor, right and down.
BedPoint polargraph_home(SettingReader& settings, double width, bool is_boot_log,
                         Problems& problems) {
  // PenPlotter's own: half of the width, and how far down.
  if (const auto down = settings.find("machine.homepoint.y", kCoordinateMm)) {
    const auto more = settings.find("machine.homepoint.offsety", kCoordinateMm);
    return {0.5 * width, *down + more.value_or(0.0)};
  }
  if (!is_boot_log) {
    return {settings.need("controller.homepoint.x", kCoordinateMm),
            settings.need("controller.homepoint.y", kCoordinateMm)};
  }
  constexpr double kUsualDownMm = 120.0;
  problems.warn("",
                "a boot log does not contain home. Assumed: the middle, {:g} mm below "
                "the motors. Enter yours in /set/home",
                kUsualDownMm);
  return {0.5 * width, kUsualDownMm};
}

/// The page and the home are on the machine.
void check_within(double width, std::optional<double> height, BedPoint home,
                  const model::DrawingArea& page, Problems& problems) {
  if (problems.any()) return;
  if (home.x_mm <= 0.0 || home.x_mm >= width || home.y_mm <= 0.0 ||
      home.y_mm > height.value_or(home.y_mm)) {
    problems.add("the home", fmt::format("({:g}, {:g}) mm", home.x_mm, home.y_mm),
                 ProblemKind::out_of_range, "a place on the machine, {:g} mm wide{}", width,
                 height ? fmt::format(" and {:g} mm high", *height) : "");
  }
  if (height && -page.bottom_mm > *height) {
    problems.add("the page", fmt::format("down to {:g} mm", -page.bottom_mm),
                 ProblemKind::out_of_range, "a page that ends within the machine's {:g} mm",
                 *height);
  }
}

SetPlotter of_polargraph(const std::string& text, Problems& problems) {
  const bool is_boot_log = is_boot_log_of_polargraph(text);
  SettingReader settings(is_boot_log ? boot_log_texts(text) : line_texts(text, '='), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::polargraph;
  const double width = settings.need(kPolargraphWidth, kCoordinateMm);
  const BedPoint home = polargraph_home(settings, width, is_boot_log, problems);
  const double turn = settings.need("machine.motors.mmPerRev", kPositive);
  const double steps = settings.need("machine.motors.stepsPerRev", kPositive) *
                       settings.find("machine.step.multiplier", kPositive).value_or(1.0);
  if (turn > 0.0) set.steps_per_mm = {steps / turn, steps / turn};
  set.machine.pin_spacing_mm = width;
  // Its origin is the left motor, with y downwards.
  set.pins_middle = {0.5 * width, 0.0};
  set.home = BedPoint{home.x_mm - 0.5 * width, -home.y_mm};
  const auto height = settings.find("machine.height", kPositive);
  const auto page_left = settings.find("controller.page.position.x", kCoordinateMm);
  const auto page_top = settings.find("controller.page.position.y", kCoordinateMm);
  const auto page_width = settings.find("controller.page.width", kCoordinateMm);
  const auto page_height = settings.find("controller.page.height", kCoordinateMm);
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
      extended ? kMeasured : kExtended, "", ProblemKind::missing,
      "both distances of the calibration: the extended length, and the same length by tape");
}

SetPlotter of_mural(const std::string& text, Problems& problems) {
  SettingReader settings(line_texts(text, ':'), problems);
  SetPlotter set;
  set.firmware = PlotterFirmware::mural;
  set.machine = model::mural(settings.need(kTopDistance, kCoordinateMm));
  if (const auto diameter = settings.find("effective pulley diameter", kPositive))
    set.machine.pulley_radius_mm = 0.5 * *diameter;
  if (const auto offset = settings.find("homed step offset", {"mm", -1000.0, 1000.0}))
    set.homed_offset_mm = *offset;
  const auto mass = settings.find("bot mass", {"kg", 0.01, 100.0});
  if (mass) set.machine.gondola.mass_kg = *mass;
  if (const auto elongation = settings.find("belt elongation", {"1/N", 0.0, 0.01}))
    set.machine.cord.compliance_per_n = *elongation;
  take_calibration(settings, set.machine, problems);
  settings.refuse_others();
  problems.warn("",
                "assumed: a mural with its firmware's defaults: {}{} mm between its "
                "pulleys",
                mass ? "" : fmt::format("{} kg, ", set.machine.gondola.mass_kg),
                set.machine.gondola.spacing_mm);
  return set;
}

bool is_marlin(const std::string& text) { return has(text, "M665 ") || has(text, "POLARGRAPH"); }

SetPlotter settings_of(const std::string& text, Problems& problems) {
  refuse_foreign_settings(text, problems);
  if (is_fluidnc(text)) return of_fluidnc(text, problems);
  if (is_of_polargraph(text)) return of_polargraph(text, problems);
  if (has_line_with(text, kTopDistance)) return of_mural(text, problems);
  if (is_marlin(text)) return plotter_of_marlin(text, problems);
  problems.add("", "no settings of a V-plotter", ProblemKind::missing,
               "FluidNC's config.yaml with a WallPlotter, Marlin's M665 and M92 or its "
               "Configuration.h, a Polargraph properties file, or for a mural a line such as \"top "
               "distance: 1500 mm\"");
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
  machine.name = name_without_folders(file);
  problems.add_all("the plotter's ", problems_of(machine));
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

}  // namespace chaintrue::grid::files
