// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "grid/files/anchors_file.hpp"
#include "grid/precondition.hpp"
#include "model/effects/effect.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::Verdict;

/// Commands are multiplied by this, and the result is paid out in the belts' own millimetres.
double scale_of(const BeltScale& scale) { return 1.0 / scale.factor; }

bool is_in_force(const BeltMachine& machine, const BeltScale& scale) {
  constexpr double kDetectableSigmas = 2.0;
  const double detectable = kDetectableSigmas * scale.sigma;
  return std::abs(machine.scale_x - scale_of(scale)) < detectable &&
         std::abs(machine.scale_y - scale_of(scale)) < detectable;
}

void add_line(Maslow4Settings& settings, const BeltMachine& machine, Belt belt, char axis,
              double value) {
  const bool is_top_level = machine.setting_names == model::SettingNames::top_level;
  settings.text +=
      fmt::format("$/{}{}{}={:.2f}\n", is_top_level ? "Maslow_" : "kinematics/MaslowKinematics/",
                  name(belt), axis, value);
}

void add_scale(const BeltMachine& machine, const std::optional<BeltScale>& found,
               std::string_view why_unknown, Maslow4Settings& settings) {
  if (!found) {
    settings.remarks.push_back(
        fmt::format("Maslow_Scale_X and Maslow_Scale_Y are unchanged: {}, "
                    "so the scale is unknown.",
                    why_unknown));
    return;
  }
  const double scale = scale_of(*found);
  if (is_in_force(machine, *found)) {
    settings.remarks.push_back(
        fmt::format("Maslow_Scale_X and Maslow_Scale_Y are unchanged: the taped distances give "
                    "{:.5f} +- {:.5f}, which is already in force.",
                    scale, found->sigma));
    return;
  }
  for (const char axis : {'X', 'Y'}) {
    settings.text += fmt::format("$/Maslow_Scale_{}={:.5f}\n", axis, scale);
  }
}

Maslow4Settings anchors_of(const BeltMachine& machine) {
  Maslow4Settings settings;
  for (const Belt belt : kBelts) {
    add_line(settings, machine, belt, 'X', machine.anchors[belt].x_mm);
    add_line(settings, machine, belt, 'Y', machine.anchors[belt].y_mm);
  }
  return settings;
}

/// A height is a setting of the machine; other effects cannot be removed by a setting.
void add_cause(const diagnosis::Cause& cause, const BeltMachine& machine,
               Maslow4Settings& settings) {
  const auto belt = model::belt_of(name(cause.cause.side));
  if (cause.cause.effect->id == "anchor_height" && belt && !cause.parameters.empty()) {
    add_line(settings, machine, *belt, 'Z',
             machine.anchors[*belt].z_mm + cause.parameters.front().value);
    return;
  }
  settings.remarks.push_back(fmt::format("No setting corrects this: {}. {}.",
                                         cause.cause.effect->cause, cause.cause.effect->remedy));
}

}  // namespace

BeltMachine machine_as_pasted(const BeltsFit& fit) {
  BeltMachine machine = fit.machine;
  if (fit.scale && !is_in_force(machine, *fit.scale))
    machine.scale_x = machine.scale_y = scale_of(*fit.scale);
  return machine;
}

Maslow4Settings write_maslow4_settings(const BeltsFit& fit) {
  Maslow4Settings settings = anchors_of(fit.machine);
  add_scale(fit.machine, fit.scale, "no distance was taped", settings);
  return settings;
}

Maslow4Settings write_maslow4_settings(const diagnosis::Diagnosis& found) {
  if (!found.belts) throw precondition("settings of four belts from a diagnosis of none");
  const BeltMachine& machine = found.belts->machine;
  Maslow4Settings settings = anchors_of(machine);
  if (found.verdict == Verdict::named || found.verdict == Verdict::several_causes) {
    for (const diagnosis::Cause& cause : found.causes) add_cause(cause, machine, settings);
  } else if (found.verdict == Verdict::named_set) {
    settings.remarks.emplace_back(
        "Several causes are possible; the anchors are for the most probable one. First find out "
        "which one acts; the diagnosis proposes measurements.");
  }
  add_scale(machine, found.belts->scale, "no distance was taped, or none fits the causes",
            settings);
  return settings;
}

}  // namespace chaintrue::grid::files
