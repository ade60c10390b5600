// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/plotter_marlin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "grid/files/marlin_defines.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

/// The words of the last line of such a code: "L-325.00" of M665 as M665/L.
void add_code(const std::string& text, const std::string& code, SettingTexts& texts) {
  each_line(text, [&](std::string_view line, const std::string& place) {
    const std::size_t at = line.find(code + " ");
    if (at == npos) return;
    std::istringstream words(std::string(line.substr(at + code.size())));
    for (std::string word; words >> word && word[0] != ';';) {
      if (word.size() > 1) texts[code + "/" + word[0]] = {word.substr(1), place};
    }
  });
}

/// Marlin's draw area, whose upper corners are its motors, and its home, in its own coordinates.
struct MarlinArea {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  std::optional<double> home_x, home_y;
};

MarlinArea logged_area(SettingReader& settings) {
  return {settings.need("M665/L", kCoordinateMm),
          settings.need("M665/R", kCoordinateMm),
          settings.need("M665/T", kCoordinateMm),
          settings.need("M665/B", kCoordinateMm),
          {},
          {}};
}

const Words kMarlinNames = {"X_BED_SIZE",
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
    const auto from = settings.find(axis + "_MIN_POS", kCoordinateMm);
    const auto to = settings.find(axis + "_MAX_POS", kCoordinateMm);
    const std::string size_name = axis + "_BED_SIZE";
    const double size = from && to ? settings.find(size_name, kCoordinateMm).value_or(0.0)
                                   : settings.need(size_name, kCoordinateMm);
    is_assumed = is_assumed || !from || !to;
    least = from.value_or(-0.5 * size);
    most = to.value_or(least + size);
  };
  ends("X", area.left, area.right);
  ends("Y", area.bottom, area.top);
  area.home_x = settings.find("MANUAL_X_HOME_POS", kCoordinateMm);
  area.home_y = settings.find("MANUAL_Y_HOME_POS", kCoordinateMm);
  if (is_assumed) {
    problems.warn("",
                  "the settings lack some of X_MIN_POS, X_MAX_POS, Y_MIN_POS and Y_MAX_POS. "
                  "Assumed: a bed centred on the middle, {:g} to {:g} and {:g} to {:g}",
                  area.left, area.right, area.bottom, area.top);
  }
  problems.warn("",
                "only these names are read from Configuration.h; the others do not "
                "describe where the pen hangs: {}",
                joined(kMarlinNames));
  return area;
}

/// Sets the page: the widest one that leaves room for a usable height within bed and belt. Sizes are
/// shares of half of the spacing. It stays away from the pins, the corners of Marlin's area: there one
/// cord carries the whole gondola.
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
    problems.add("the page", fmt::format("a bed of {:g} mm, a belt of {:g} mm", bed_mm, belt_mm),
                 ProblemKind::out_of_range,
                 "for {:g} mm between the motors, a bed of at least {:.0f} mm and a "
                 "belt of at least {:.0f} mm, which a page needs",
                 machine.pin_spacing_mm, std::ceil(least),
                 std::ceil(std::hypot((1.0 + kSides[5]) * half, least)));
    return;
  }
  const double bottom = std::min(bed_mm, reach(*side));
  machine.area = {-*side * half, *side * half, -kTop * half, -bottom};
  if (bottom == bed_mm && *side == kSides[0]) return;
  problems.warn(
      "",
      "the longest belt, {:g} mm, does not reach the whole bed: the page is {:.0f} mm wide and "
      "ends {:g} mm below the motors; a belt of {:.0f} mm would reach all of it",
      belt_mm, 2.0 * *side * half, bottom, std::ceil(std::hypot((1.0 + kSides[0]) * half, bed_mm)));
}

/// The pen's place when the controller is switched on: as stated, else with both belts fully paid
/// out.
void place_marlin_home(const MarlinArea& area, double belt, SetPlotter& set, Problems& problems) {
  const double half = 0.5 * set.machine.pin_spacing_mm;
  if (belt <= half) {
    problems.add("the longest belt", fmt::format("{}", belt), ProblemKind::impossible,
                 "more than half of the {} mm between the motors", 2.0 * half);
    return;
  }
  set.home = BedPoint{area.home_x.value_or(set.pins_middle.x_mm) - set.pins_middle.x_mm,
                      -std::sqrt(belt * belt - half * half)};
  if (area.home_y) set.home->y_mm = *area.home_y - area.top;
  const double longest = std::hypot(std::abs(set.home->x_mm) + half, set.home->y_mm);
  if (set.home->y_mm < 0.0 && longest <= belt + 0.5) return;
  problems.add(
      "the home",
      fmt::format("({:.1f}, {:.1f}) mm from the middle between the motors, with {:.1f} mm of belt",
                  set.home->x_mm, set.home->y_mm, longest),
      ProblemKind::out_of_range,
      "a home below the motors within reach of a belt of {:g} mm (MANUAL_X_HOME_POS, "
      "MANUAL_Y_HOME_POS)",
      belt);
}

}  // namespace

void warn_of_gondola(const PlotterMachine& machine, Problems& problems) {
  problems.warn("",
                "the settings do not describe the gondola. Assumed: both cords end at "
                "the pen, and {} kg. Enter yours in /set/machine/gondola",
                machine.gondola.mass_kg);
}

SetPlotter plotter_of_marlin(const std::string& text, Problems& problems) {
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
  const double belt = settings.need(is_log ? "M665/H" : "POLARGRAPH_MAX_BELT_LEN", kCoordinateMm);
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

}  // namespace chaintrue::grid::files
