// SPDX-License-Identifier: GPL-3.0-or-later
// The export of groundcontrol_file.hpp: a machine as the numbers to type in.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/files/groundcontrol_settings.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

/// Four decimals, without the zeros at their end.
std::string to_type(double value) { return fmt::format("{}", std::round(1e4 * value) / 1e4 + 0.0); }

/// Every import has these; for a machine without them all lines are written.
bool is_imported(const ControllerSettings& settings) {
  return settings.bed_width_mm && settings.bed_height_mm && settings.motor_spacing_mm &&
         settings.motor_offset_y_mm;
}

/// Collects the lines, with remarks on how each differs from the controller's present value.
struct Lines {
  bool imported;
  GroundcontrolText& out;

  void section(const std::string& name) {
    out.text += fmt::format("{}[{}]\n", out.text.empty() ? "" : "\n", name);
  }
  void number(const std::string& key, double value, std::optional<double> now,
              std::string_view by) {
    const std::string typed = to_type(value);
    // The settings went through sines and sums on their way to the machine and back; 1e-9 of them
    // is a thousand roundings, and far below the digits that are typed.
    constexpr double kSame = 1e-9;
    if (now && std::abs(value - *now) <= kSame * std::max(1.0, std::abs(*now))) {
      return word(key, fmt::format("{}", *now));
    }
    // A setting missing from the imported file is written only if something changes it.
    if (imported && !now && typed == "0") return;
    word(key, typed);
    if (now || imported) changes(key, now ? fmt::format("{}", *now) : "not set", typed, by);
  }
  void word(const std::string& key, const std::string& word) {
    out.text += fmt::format("{} = {}\n", key, word);
  }
  void changes(std::string_view key, const std::string& from, const std::string& to,
               std::string_view by) {
    out.remarks.push_back(fmt::format("{} changes from {} to {}, by {}", key, from, to, by));
  }
};

/// The pitch of a chain that its tolerance states.
bool is_tolerance(const AppliedEffect& effect, const ControllerSettings& settings) {
  const auto size = effect.parameters.find("elongation");
  if (effect.effect != "chain_pitch_error" || effect.side == "both" ||
      size == effect.parameters.end())
    return false;
  const auto& percent = effect.side == "left" ? settings.left_chain_tolerance_percent
                                              : settings.right_chain_tolerance_percent;
  return size->second == percent.value_or(0.0) / 100.0;
}

}  // namespace

ControllerSettings measures_as_settings(const Machine& machine) {
  const double dx_mm = machine.motors.right.x_mm - machine.motors.left.x_mm;
  const double dy_mm = machine.motors.right.y_mm - machine.motors.left.y_mm;
  ControllerSettings s = machine.controller.settings;
  s.bed_width_mm = machine.bed.width_mm;
  s.bed_height_mm = machine.bed.height_mm;
  s.motor_spacing_mm = std::hypot(dx_mm, dy_mm);
  s.motor_offset_y_mm =
      0.5 * (machine.motors.left.y_mm + machine.motors.right.y_mm) - 0.5 * machine.bed.height_mm;
  if (const auto* ring = std::get_if<Ring>(&machine.attachment)) {
    s.rotation_radius_mm = ring->radius_mm;
    // A parabola in place of the catenary; the firmware uses it with a ring only.
    if (!is_imported(machine.controller.settings))
      s.chain_sag_correction = equilibrium_parameters(machine).sag_correction;
  } else {
    const auto& brackets = std::get<model::Brackets>(machine.attachment);
    s.sled_width_mm = brackets.spacing_mm;
    s.sled_height_mm = brackets.height_mm;
    s.sled_cg_mm = brackets.cg_below_bit_mm;
  }
  if (machine.controller.kind == ControllerKind::holey) {
    s.top_beam_tilt_deg = std::atan2(dy_mm, dx_mm) * 180.0 / std::numbers::pi;
    s.chain_elongation_per_n = machine.chain.compliance_per_n;
  }
  s.chain_pitch_mm = machine.sprocket.pitch_mm;
  s.gear_teeth = machine.sprocket.teeth;
  s.left_chain_tolerance_percent = s.left_chain_tolerance_percent.value_or(0.0);
  s.right_chain_tolerance_percent = s.right_chain_tolerance_percent.value_or(0.0);
  if (s.sled_weight_n) s.sled_weight_n = machine.sled.mass_kg * kGroundcontrolGravity_m_per_s2;
  s.chain_over_sprocket_top = machine.feed == Feed::over_top;
  return s;
}

GroundcontrolText write_groundcontrol(const Machine& machine) {
  return write_groundcontrol_settings(machine, measures_as_settings(machine),
                                      "the machine's dimensions");
}

bool says_more_than_its_settings(const Machine& machine) {
  const auto& settings = machine.controller.settings;
  if (!is_imported(settings)) return true;
  const auto& [left, right] = machine.motors;
  const double tilt_rad = settings.top_beam_tilt_deg.value_or(0.0) * std::numbers::pi / 180.0;
  constexpr double kRoundingMm = 1e-6;
  const bool has_other_beam =
      std::abs(left.x_mm + right.x_mm) > kRoundingMm ||
      std::abs(right.y_mm - left.y_mm - *settings.motor_spacing_mm * std::sin(tilt_rad)) >
          kRoundingMm;
  return has_other_beam || !write_groundcontrol(machine).remarks.empty() ||
         machine.chain_zero.left_mm != 0.0 || machine.chain_zero.right_mm != 0.0 ||
         machine.sprocket.radius_mm || !all_of(machine.effects, [&](const auto& effect) {
           return is_tolerance(effect, settings);
         });
}

GroundcontrolText write_groundcontrol_settings(const Machine& machine,
                                               const ControllerSettings& settings,
                                               std::string_view by) {
  const ControllerSettings& now = machine.controller.settings;
  GroundcontrolText out;
  Lines lines{is_imported(now), out};
  const auto numbers = [&](std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) {
      const auto* own = find_where(kNumberKeys, having(&NumberKey::key, key));
      if (const auto value = settings.*own->setting)
        lines.number(own->key, *value, now.*own->setting, by);
    }
  };
  const bool has_ring = std::holds_alternative<Ring>(machine.attachment);
  lines.section("Maslow Settings");
  numbers({"bedwidth", "bedheight", "motorspacingx", "motoroffsety"});
  if (!has_ring) numbers({"sledwidth", "sledheight", "sledcg"});
  lines.section("Advanced Settings");
  lines.word("kinematicstype", has_ring ? "Triangular" : "Quadrilateral");
  if (has_ring) numbers({"rotationradius"});
  numbers({"chainsagcorrection", "topbeamtilt", "chainpitch", "gearteeth", "leftchaintolerance",
           "rightchaintolerance", "sledweight"});
  if (settings.chain_elongation_per_n) {
    const std::string typed = fmt::format("{}", *settings.chain_elongation_per_n);
    lines.word("chainelongationfactor", typed);
    if (now.chain_elongation_per_n &&
        *now.chain_elongation_per_n != *settings.chain_elongation_per_n)
      lines.changes("chainelongationfactor", fmt::format("{}", *now.chain_elongation_per_n), typed,
                    by);
  }
  lines.word(
      "chainoversprocket",
      settings.chain_over_sprocket_top.value_or(machine.feed == Feed::over_top) ? "Top" : "Bottom");
  return out;
}

}  // namespace chaintrue::grid::files
