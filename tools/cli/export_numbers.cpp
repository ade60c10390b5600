// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/export_numbers.hpp"

#include <fmt/format.h>

#include "grid/files/controller_settings.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "model/effects/catalogue.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {
namespace {

/// The controller in force or, if it has no settings, one with the machine's dimensions.
model::Controller controller_of(const Machine& machine) {
  if (machine.controller.settings.motor_spacing_mm) return machine.controller;
  const bool is_holey = machine.controller.kind == ControllerKind::holey;
  return {is_holey ? ControllerKind::holey : ControllerKind::maslow_classic,
          files::measures_as_settings(machine)};
}

/// Next steps: type in, check with the map after, cut with it.
Words next_of(const ExportCommand& command, bool is_worth_typing) {
  const std::string& map = command.input;
  if (!is_worth_typing) return report_words(map);
  if (!command.map_after.empty()) return {"plan", "--check", command.map_after, "-o", "check.csv"};
  return {"export", "groundcontrol", map, "-o", "settings.ini", "--map-after", after_name(map)};
}

/// Causes without a setting in the firmware, with their contribution to the error.
std::string words_of(const grid::Lacking& lacking, const Machine& machine) {
  if (lacking.what == "top_beam_tilt") {
    return fmt::format(
        "GroundControl's own firmware has no setting for the tilt of the beam, which causes {:.2f} "
        "mm of that: level the beam. The holey firmware has topbeamtilt; if you use it, set "
        "\"kind\": \"holey\" in the machine's /controller.\n",
        lacking.costs_mm);
  }
  if (lacking.what == "chain_stretch") {
    return fmt::format(
        "GroundControl's own firmware has no setting for the stretch of the chains, which causes "
        "{:.2f} mm of that.\n",
        lacking.costs_mm);
  }
  const Effect* effect = effects::find_effect(machine, lacking.what);
  return fmt::format("No firmware has a setting for this: {}. It causes {:.2f} mm of that{}.\n",
                     effect != nullptr ? effect->cause : std::string_view(lacking.what),
                     lacking.costs_mm,
                     effect != nullptr ? fmt::format("; {}", effect->remedy) : "");
}

/// Errors before and after, from one evaluation, and the causes of the rest.
std::string words_of(const std::string& today, const Machine& machine,
                     const grid::SettingsToType& typed, bool holds_numbers) {
  std::string words =
      typed.worth_typing || !holds_numbers
          ? fmt::format("{} with these numbers {:.2f} and {:.2f} mm.\n", today, typed.typed.rms_mm,
                        typed.typed.maximum_mm)
          : fmt::format("{} Other numbers would gain less than a tenth, so keep yours.\n", today);
  for (const grid::Lacking& one : typed.lacking) words += words_of(one, machine);
  return words;
}

/// For a map the error today is the same as in every verb; the placement of a hand-laid sheet does
/// not depend on the numbers.
std::string today_in_words(const CompensationMap& map, const grid::SettingsToType& typed) {
  const ErrorSummary today = error_in_use(map).value_or(typed.as_it_is);
  return fmt::format(
      "With today's settings the tool is {:.2f} mm rms off over the measured part, {:.2f} mm at "
      "worst{};",
      today.rms_mm, today.maximum_mm,
      has_placed_sheet(map.contents())
          ? fmt::format(" ({:.2f} and {:.2f} mm with the sheet correctly placed)",
                        typed.as_it_is.rms_mm, typed.as_it_is.maximum_mm)
          : "");
}

/// The map after its numbers are typed in.
std::string map_after_in_words(const ExportCommand& command) {
  if (command.map_after.empty())
    return "The rest is corrected by gcode compensate with the map. Once the numbers are typed in, "
           "this map is out of date; --map-after writes the one to use then.\n";
  return fmt::format(
      "Type them in, measure five marks and check them with {0}. From then on run programs "
      "unchanged or, for better accuracy, compensate them with {0}. Do not use {1} again.\n",
      command.map_after, command.input);
}

/// Old values are given for numbers in force.
files::GroundcontrolText text_of(const Machine& machine, const grid::SettingsToType& typed,
                                 const std::string& by, bool holds_numbers) {
  auto text = files::write_groundcontrol_settings(machine, typed.settings, by);
  if (!holds_numbers) text.remarks.clear();
  return text;
}

/// The map of the machine with its numbers typed in.
CompensationMap map_after_of(const CompensationMap& map, const Machine& before,
                             const model::Controller& now, bool holds_numbers) {
  std::string numbers;
  if (holds_numbers) {
    Machine after = before;
    after.controller = now;
    numbers = fmt::format(" ({})", in_words(changed_settings(files::settings_in_force(before),
                                                             files::settings_in_force(after))));
  }
  return map_for_settings(
      map, now,
      fmt::format("For a controller that holds the numbers from export groundcontrol{}.", numbers));
}

}  // namespace

Exported exported_from(const CompensationMap& map, const std::string& file,
                       const ExportCommand& command) {
  const auto fail = [&file](const grid::SettingsFailure& why) {
    throw InputError({{file, "", "", "", why.sentence()}});
  };
  if (map.machine() == nullptr) fail(grid::settings_to_type(map).error());
  Machine machine = *map.machine();
  const bool holds_numbers = machine.controller.settings.motor_spacing_mm.has_value();
  const bool is_wall_plotter = machine.controller.kind == ControllerKind::fluidnc_wallplotter;
  machine.controller = controller_of(machine);
  const auto typed = grid::settings_to_type(map, machine.controller);
  Exported result;
  if (typed) {
    result = {text_of(machine, *typed, fmt::format("the {} points of {}", typed->points, file),
                      holds_numbers),
              words_of(today_in_words(map, *typed), machine, *typed, holds_numbers),
              next_of(command, (typed->worth_typing || !holds_numbers) && !is_wall_plotter), map};
    if (!typed->worth_typing && holds_numbers) return result;
    if (typed->worth_typing) result.words += map_after_in_words(command);
  } else {
    // If none can be found, the machine's own dimensions are the settings.
    if (holds_numbers) fail(typed.error());
    result = {files::write_groundcontrol(*map.machine()), "", report_words(command.input)};
  }
  model::Controller now = machine.controller;
  if (typed) now.settings = typed->settings;
  result.map_after.reset();
  if (!is_wall_plotter) result.map_after = map_after_of(map, machine, now, holds_numbers);
  return result;
}

namespace {

/// The corners of the bed.
std::vector<BedPoint> corners_of(const Bed& bed) {
  const double x = 0.5 * bed.width_mm, y = 0.5 * bed.height_mm;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

Exported of_machine(const Machine& stated, const std::string& file,
                    const std::vector<BedPoint>& area, Words next) {
  const bool holds_numbers = stated.controller.settings.motor_spacing_mm.has_value();
  if (!files::says_more_than_its_settings(stated))
    return {files::write_groundcontrol(stated), "", std::move(next)};
  Machine machine = stated;
  machine.controller = controller_of(stated);
  const auto typed = grid::settings_to_type(machine, area);
  // If none can be found, the machine's own dimensions are the settings.
  if (!typed) return {files::write_groundcontrol(stated), "", std::move(next)};
  const std::string today = fmt::format(
      "If the machine were as {} describes it, the tool would be {:.2f} mm rms off with {}, {:.2f} "
      "mm at worst;",
      file, typed->as_it_is.rms_mm,
      holds_numbers ? "today's settings" : "its own dimensions as settings",
      typed->as_it_is.maximum_mm);
  return {text_of(machine, *typed, file, holds_numbers),
          words_of(today, machine, *typed, holds_numbers), std::move(next)};
}

/// Named causes that may be the paper's are not in the machine.
std::string left_out_in_words(const Diagnosis& found) {
  std::string words;
  const auto is_of_paper = [](const auto& same) {
    return same.cause.effect->station == Station::paper;
  };
  for (const Cause& cause : causes_left_out(found)) {
    if (none_of(cause.same_as, is_of_paper)) continue;
    words += fmt::format(
        "These numbers leave out an error that may be {}{} or the tape used for the marks. A map "
        "corrects it either way: export its numbers instead.\n",
        cause.cause.effect->cause, side_words(cause.cause));
  }
  return words;
}

/// The area of the marks or holes, or the whole bed.
std::vector<BedPoint> area_of(const Diagnosis& found) {
  std::vector<BedPoint> area;
  for (const auto& point : found.points) area.push_back({point.mark.x_mm, point.mark.y_mm});
  for (const auto& hole : found.holes) area.push_back({hole.mark.x_mm, hole.mark.y_mm});
  constexpr std::size_t kFewest = 3;
  return area.size() < kFewest ? corners_of(found.extended_machine.bed) : area;
}

}  // namespace

Exported exported_from(const Machine& stated, const std::string& file, Words next) {
  return of_machine(stated, file, corners_of(stated.bed), std::move(next));
}

Exported exported_from(const Diagnosis& found, const std::string& file,
                       const ExportCommand& command) {
  Exported exported =
      of_machine(found.extended_machine, file, area_of(found), report_words(command.input));
  exported.words += left_out_in_words(found);
  return exported;
}

}  // namespace chaintrue::cli
