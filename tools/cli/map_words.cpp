// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_words.hpp"

#include <fmt/format.h>

#include "grid/map/controller_error.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

/// The expected rms error with this many marks of the map's quality; empty if none can be planned.
std::optional<double> expected_with(const CompensationMap& map, int points) {
  const grid::MapNoise& noise = map.contents().noise;
  grid::PlanRequest request;
  request.points = points;
  request.noise = {noise.length_mm * noise.factor_found, noise.position_mm * noise.factor_found};
  const auto plan = plan_measurement(*map.machine(), request);
  if (!plan) return std::nullopt;
  return plan->map.contents().accuracy.expected_tool.rms_mm;
}

/// The least number of marks that is expected to reach `wish_mm`: the planned error is scaled to the
/// one that the map has at its own number of points.
std::optional<int> marks_for(const CompensationMap& map, double wish_mm) {
  constexpr int kNumbers[] = {28, 45, 70, 100, 140, grid::kMostPlanned};
  const auto now = as_int(map.contents().points.size());
  const auto here = expected_with(map, std::clamp(now, grid::kFewestPlanned, grid::kMostPlanned));
  if (!here || !(*here > 0.0)) return std::nullopt;
  const double ratio = map.contents().accuracy.expected_tool.rms_mm / *here;
  for (const int number : kNumbers) {
    if (number <= now) continue;
    const auto then = expected_with(map, number);
    if (then && ratio * *then <= wish_mm) return number;
  }
  return std::nullopt;
}

}  // namespace

ErrorSummary summary_of(const MapContents& contents, Residual residual) {
  return summary_of_good(contents.points,
                         [&](const MapPoint& point) { return (point.*residual).norm(); });
}

bool has_placed_sheet(const MapContents& contents) {
  return contents.settings.size() > std::size(kMachineSettings);
}

Residual residual_before(const MapContents& contents) {
  return has_placed_sheet(contents) ? &MapPoint::sheet_placed_mm : &MapPoint::as_stated_mm;
}

std::string_view machine_before(const MapContents& contents) {
  return has_placed_sheet(contents) ? "the machine file as it was, the sheet found"
                                    : "the machine file as it was";
}

std::vector<SettingRow> settings_rows(const CompensationMap& map) {
  std::vector<SettingRow> rows;
  for (const grid::SettingResult& result : map.contents().settings) {
    SettingRow row{result.setting, result.stated, {}, result.calibrated, result.sigma, result.off};
    const auto& of_machine = kMachineSettings;
    if (contains(of_machine, result.setting))
      row.stated_sigma = stated_sigma(*map.machine(), result.setting);
    rows.push_back(row);
  }
  return rows;
}

std::string not_to_cut_with(const CompensationMap& map) {
  const double left_out_mm = map.contents().accuracy.leave_one_out.tool.rms_mm;
  if (!(left_out_mm > kMostToCutWithMm)) return {};
  return fmt::format(
      "Do not cut with this map: at marks left out of the fit it is off by {} mm rms, more than "
      "{:g} mm. Check the marks with the largest errors, the machine's dimensions and the settings "
      "in force, and measure again.",
      about_mm(left_out_mm), kMostToCutWithMm);
}

void require_fit_for_cutting(const std::string& why, bool is_forced) {
  if (is_forced || why.empty()) return;
  say("{} --force continues anyway.", why);
  throw Failed("", "not_to_cut_with", why, kCheckFailed);
}

std::string about_mm(double mm) {
  if (mm < 0.095) return fmt::format("{:.2f}", mm);
  if (mm < 0.95) return fmt::format("{:.1f}", mm);
  return fmt::format("{:.{}f}", mm, mm < 9.95 ? 1 : 0);
}

std::string misses_sentence(const std::optional<ErrorSummary>& today, double expected_mm,
                            const Remedy& remedy) {
  // Both include the map's uncertainty, which limits what it shows about the machine.
  constexpr double kNoMoreThanUncertain = 1.4142;
  if (today && today->rms_mm <= kNoMoreThanUncertain * expected_mm) {
    return fmt::format(
        "Your machine needs no {}: its error is below what these readings can show, about {} mm.",
        remedy.needed, about_mm(expected_mm));
  }
  if (!today) {
    return fmt::format("With {} your machine misses by about {} mm.", remedy.with,
                       about_mm(expected_mm));
  }
  return fmt::format("Your machine misses by about {} mm. With {} it misses by about {} mm.",
                     about_mm(today->rms_mm), remedy.with, about_mm(expected_mm));
}

std::string worst_sentence(double x_mm, double y_mm, double worst_mm) {
  return fmt::format(
      "At worst it misses by about {} mm, in 95 of 100 sessions. The error is largest near "
      "({:.0f}, {:.0f}).",
      about_mm(worst_mm), x_mm, y_mm);
}

std::string fit_sentence(const CompensationMap& map) {
  if (map.machine() == nullptr) return points_sentence(map);
  if (!not_to_cut_with(map).empty())
    return "These readings disagree with each other, so the map is not fit for cutting.";
  return misses_sentence(error_in_use(map), map.contents().accuracy.expected_tool.rms_mm,
                         {"this map", "map"});
}

std::string points_sentence(const CompensationMap& map) {
  const MapContents& contents = map.contents();
  const std::size_t bad = count_where(contents.points, &MapPoint::bad);
  const std::size_t points = contents.points.size();
  const grid::HeldOutError& left_out = contents.accuracy.leave_one_out;
  if (map.machine() == nullptr && left_out.tool.maximum_mm == 0.0) {
    return fmt::format(
        "Splines through the lengths of {} points. There are too few rows and columns to leave one "
        "out, so their error was not tested.",
        points);
  }
  if (map.machine() == nullptr) {
    return fmt::format(
        "Splines through the lengths of {} points: each row and column, left out in turn, is "
        "predicted to {:.2f} mm rms ({:.2f} mm at worst).",
        points, left_out.tool.rms_mm, left_out.tool.maximum_mm);
  }
  if (contents.distances) {
    const grid::DistancesUsed& used = *contents.distances;
    return fmt::format(
        "{} distances between {} holes: each one, left out in turn, is predicted to {:.2f} mm "
        "rms{}.",
        used.used, points, used.left_out_good.rms_mm,
        used.rejected == 0 ? "" : fmt::format("; {} more were left out as wrong", used.rejected));
  }
  return fmt::format(
      "At the {} points{} the machine is {:.2f} mm rms off, the map {:.2f} mm; each point, left "
      "out in turn, is predicted to {:.2f} mm rms{}.",
      points, has_placed_sheet(contents) ? ", for the best placement of the sheet," : "",
      summary_of(contents, &MapPoint::sheet_placed_mm).rms_mm,
      summary_of(contents, &MapPoint::mapped_mm).rms_mm, left_out.tool.rms_mm,
      bad == 0 ? "" : fmt::format("; {} were left out as wrong", bad));
}

std::string wish_sentence(const CompensationMap& map, double wish_mm) {
  const double expected_mm = map.contents().accuracy.expected_tool.rms_mm;
  const std::string held = fmt::format("Your target is {:g} mm: ", wish_mm);
  if (map.machine() == nullptr || !not_to_cut_with(map).empty())
    return held + "these readings do not show whether it is reached.";
  if (expected_mm <= wish_mm) return held + "reached.";
  if (map.contents().distances)
    return held + "not reached. More distances or a better tape would reduce the error.";
  const auto marks = marks_for(map, wish_mm);
  if (marks)
    return held + fmt::format(
                      "not reached. About {} marks measured as accurately as these would reach it.",
                      *marks);
  return held + fmt::format(
                    "not reached, not even with {} marks measured as accurately as these: measure "
                    "each mark more accurately.",
                    grid::kMostPlanned);
}

const SettingWords& setting_words(Setting setting) {
  static constexpr SettingWords kSettingWords[] = {
      {"left motor, x"},       {"left motor, y"},     {"right motor, x"},
      {"right motor, y"},      {"left chain's zero"}, {"right chain's zero"},
      {"sheet offset, right"}, {"sheet offset, up"},  {"sheet rotation, left", "mrad", 1000.0},
  };  // by Setting
  return kSettingWords[as_size(setting)];
}

Table settings_table(const std::vector<SettingRow>& settings) {
  Table table{.columns = {text_column("Settings", 26),
                          number_column("in the file", 14),
                          {.heading = "+- in the file", .is_number = true, .detail = Detail::page},
                          number_column("calibrated", 12),
                          number_column("+- sigma", 11),
                          {.gap = 1},
                          {.gap = 2}},
              .is_headed = true,
              .head_width = 27};
  for (const SettingRow& row : settings) {
    const SettingWords& words = setting_words(row.setting);
    const auto value = [&](double of) { return words.factor * of; };
    table.add(
        {words.words, value(row.stated), row.stated_sigma ? Cell(value(*row.stated_sigma)) : Cell(),
         value(row.calibrated), value(row.sigma), words.unit},
        row.is_off, "off: by more than the uncertainty in your file");
  }
  return table;
}

}  // namespace chaintrue::cli
