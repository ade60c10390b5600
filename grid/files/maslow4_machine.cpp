// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/maslow4_places.hpp"
#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {
namespace {

/// Applies settings of maslow.yaml; missing ones keep their values and are noted.
struct Settings : SettingReader {
  /// The value of the first of these keys that is present; false if none is.
  bool take(const Words& keys, double& value) {
    constexpr Range kSetting{"", -1e6, 1e6};
    for (const std::string& key : keys) {
      if (look(key) == nullptr) continue;
      value = find(key, kSetting).value_or(value);
      return true;
    }
    return false;
  }
  void take_or_assume(const Words& keys, double& value, std::string_view what, Words& assumed) {
    if (!take(keys, value)) assumed.push_back(fmt::format("{} of {:g} mm", what, value));
  }
};

/// The keys of a setting: today's name, and that of releases before July 2025.
Words keys_of(const std::string& key) {
  return {"kinematics/MaslowKinematics/" + key, "Maslow_" + key};
}

/// The settings file's names for the anchors, so that an export writes lines that its firmware
/// accepts.
void take_names(Settings& settings, BeltMachine& machine) {
  const auto has = [&](std::size_t names) {
    return any_of(kBelts, [&](Belt belt) {
      return settings.look(keys_of(std::string(name(belt)) + "X")[names]) != nullptr;
    });
  };
  if (!has(0) && has(1)) machine.setting_names = model::SettingNames::top_level;
}

void take_anchors(Settings& settings, BeltMachine& machine, Words& assumed) {
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

BeltMachine machine_of(const Maslow4Options& options, Settings& settings, Words& assumed) {
  BeltMachine machine;
  take_names(settings, machine);
  take_anchors(settings, machine, assumed);
  settings.take_or_assume(keys_of("armLength"), machine.arm_mm, "an arm", assumed);
  settings.take_or_assume(keys_of("beltEndExtension"), machine.end_extension_mm,
                          "an extension of the belt's end", assumed);
  double spoilboard_mm = 0.0;
  double work_mm = 0.0;
  (void)settings.take(keys_of("spoilboardThickness"), spoilboard_mm);
  (void)settings.take(keys_of("workThickness"), work_mm);
  machine.surface_mm = spoilboard_mm + work_mm;
  (void)settings.take(keys_of("Scale_X"), machine.scale_x);
  (void)settings.take(keys_of("Scale_Y"), machine.scale_y);
  const auto vertical = settings.find_word("Maslow_vertical", {"true", "false"});
  if (vertical)
    machine.orientation = *vertical == "true" ? Orientation::upright : Orientation::flat;
  if (options.orientation) {
    machine.orientation = *options.orientation;
  } else if (!vertical) {
    assumed.emplace_back("a frame that stands upright, its lower belts pulled (--orientation)");
  }
  return machine;
}

/// The pull in the settings.
std::optional<BeltPull> settings_pull(Settings& settings) {
  double pull_ma = 0.0;
  const bool is_known = settings.take({"Maslow_Calibration_Current_Threshold"}, pull_ma);
  if (!is_known || !(pull_ma > 0.0)) return std::nullopt;
  return BeltPull{pull_ma, BeltPull::Unit::milliampere};
}

}  // namespace

void take_machine(const Maslow4Options& options, Maslow4Import& result, Problems& problems) {
  Problems own(options.settings_file);
  Settings settings{{options.settings ? yaml_texts(*options.settings, own) : SettingTexts{}, own}};
  if (options.settings && settings.empty())
    own.add("", "no settings", ProblemKind::missing, "the machine's maslow.yaml");
  result.belts.machine = machine_of(options, settings, result.assumed);
  result.settings_pull = settings_pull(settings);
  settings.warn_of_others("describes the anchors of the belts");
  problems.add_warnings(own.warnings());
  problems.add_all(own.list());
  problems.add_all("the settings' ", problems_of(result.belts.machine));
}

}  // namespace chaintrue::grid::files
