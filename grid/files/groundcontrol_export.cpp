// SPDX-License-Identifier: GPL-3.0-or-later
// The other half of groundcontrol_file.hpp: a machine as the numbers to type in.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "grid/files/groundcontrol_file.hpp"
#include "model/effects/catalogue.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Machine;
using model::Side;

/// Four decimals, without the zeros at their end.
std::string to_type(double value) {
  std::string text = fmt::format("{:.4f}", value);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

/// Gathers the lines, and says where one differs from what the controller has now.
class Lines {
 public:
  explicit Lines(GroundcontrolText& out) : out_(out) {}
  void section(const std::string& name) {
    out_.text += fmt::format("{}[{}]\n", out_.text.empty() ? "" : "\n", name);
  }
  void number(const std::string& key, double value, std::optional<double> now = {}) {
    const std::string typed = to_type(value);
    out_.text += fmt::format("{} = {}\n", key, typed);
    if (now && to_type(*now) != typed) {
      out_.remarks.push_back(fmt::format("{} changes from {} to {}", key, to_type(*now), typed));
    }
  }
  void word(const std::string& key, const std::string& word) {
    out_.text += fmt::format("{} = {}\n", key, word);
  }

 private:
  GroundcontrolText& out_;
};

/// The machine with those effects put into its numbers that a setting can take up, and what its
/// chain tolerances are as GroundControl counts them.
struct TypedMachine {
  Machine machine;
  model::PerSide<double> tolerance_percent;
  bool stretch_was_named = false;
};

double parameter_of(const model::AppliedEffect& effect, const std::string& name) {
  const auto found = effect.parameters.find(name);
  return found == effect.parameters.end() ? 0.0 : found->second;
}

using TakeUp = void (*)(TypedMachine&, const model::AppliedEffect&);

void take_ring_radius(TypedMachine& typed, const model::AppliedEffect& effect) {
  if (auto* ring = std::get_if<model::Ring>(&typed.machine.attachment))
    ring->radius_mm += parameter_of(effect, "offset_mm");
}

void take_pitch_error(TypedMachine& typed, const model::AppliedEffect& effect) {
  const double percent = 100.0 * parameter_of(effect, "elongation");
  if (effect.side != "right") typed.tolerance_percent.left += percent;
  if (effect.side != "left") typed.tolerance_percent.right += percent;
}

void take_sag(TypedMachine& typed, const model::AppliedEffect& effect) {
  typed.machine.chain.mass_kg_per_m *= 1.0 + parameter_of(effect, "relative_weight");
}

void take_stretch(TypedMachine& typed, const model::AppliedEffect& effect) {
  typed.machine.chain.compliance_per_n += parameter_of(effect, "compliance_per_n");
  typed.stretch_was_named = true;
}

/// No setting holds it; the remark on the sprocket says so with the radius that comes of it.
void take_sprocket_radius(TypedMachine& typed, const model::AppliedEffect& effect) {
  model::Sprocket& sprocket = typed.machine.sprocket;
  sprocket.radius_mm = sprocket.effective_radius_mm() + parameter_of(effect, "offset_mm");
}

const std::map<std::string, TakeUp>& take_ups() {
  static const std::map<std::string, TakeUp> by_effect = {
      {"ring_radius", take_ring_radius},
      {"chain_pitch_error", take_pitch_error},
      {"chain_sag", take_sag},
      {"chain_stretch", take_stretch},
      {"sprocket_radius", take_sprocket_radius},
  };
  return by_effect;
}

TypedMachine typed_machine(const Machine& machine, std::vector<std::string>& remarks) {
  TypedMachine typed{machine, {}, false};
  for (const model::AppliedEffect& effect : machine.effects) {
    const auto take_up = take_ups().find(effect.effect);
    if (take_up != take_ups().end()) {
      take_up->second(typed, effect);
      continue;
    }
    const model::effects::Effect* known = model::effects::find_effect(effect.effect);
    remarks.push_back(fmt::format("GroundControl has no setting for the effect {}{}{}{}{}",
                                  effect.effect,
                                  effect.side.empty() ? "" : " ",
                                  effect.side,
                                  known != nullptr ? "; what can be done: " : "",
                                  known != nullptr ? known->remedy : ""));
  }
  return typed;
}

/// GroundControl's own firmware knows no stretch; WebControl and the holey firmware do.
bool knows_stretch(const Machine& machine) {
  return machine.controller.kind == model::ControllerKind::holey ||
         machine.controller.settings.chain_elongation_per_n.has_value();
}

void remark_on_what_cannot_be_typed(const Machine& machine, std::vector<std::string>& remarks) {
  constexpr double kWorthSayingMm = 0.05;
  const double middle_mm = 0.5 * (machine.motors.left.x_mm + machine.motors.right.x_mm);
  if (std::abs(middle_mm) > kWorthSayingMm) {
    remarks.push_back(fmt::format(
        "GroundControl has no setting for a beam whose middle is not above the bed's; here it is "
        "{:.2f} mm to the {}",
        std::abs(middle_mm),
        middle_mm > 0.0 ? "right" : "left"));
  }
  for (const Side side : model::kSides) {
    const bool left = side == Side::left;
    const double zero_mm = machine.chain_zero[side];
    if (std::abs(zero_mm) <= kWorthSayingMm) continue;
    remarks.push_back(fmt::format("the {} chain reads {:.2f} mm too {}; set its zero anew",
                                  left ? "left" : "right",
                                  std::abs(zero_mm),
                                  zero_mm > 0.0 ? "long" : "short"));
  }
  if (machine.sprocket.radius_mm) {
    const double counted_mm =
        machine.sprocket.pitch_mm * machine.sprocket.teeth / (2.0 * std::numbers::pi);
    if (std::abs(*machine.sprocket.radius_mm - counted_mm) > 1e-3) {
      remarks.push_back(
          fmt::format("GroundControl computes the sprocket's radius from pitch and teeth, {:.3f} "
                      "mm; here it is "
                      "{:.3f} mm",
                      counted_mm,
                      *machine.sprocket.radius_mm));
    }
  }
}

void write_attachment(const Machine& machine, Lines& lines) {
  const auto& now = machine.controller.settings;
  if (const auto* ring = std::get_if<model::Ring>(&machine.attachment)) {
    lines.word("kinematicstype", "Triangular");
    lines.number("rotationradius", ring->radius_mm, now.rotation_radius_mm);
    // A parabola in place of the catenary; the firmware uses it with a ring only.
    lines.number("chainsagcorrection",
                 model::equilibrium_parameters(machine).sag_correction,
                 now.chain_sag_correction);
  } else {
    lines.word("kinematicstype", "Quadrilateral");
  }
}

void write_stretch(const TypedMachine& typed, Lines& lines, std::vector<std::string>& remarks) {
  const std::string per_n = fmt::format("{:.4g}", typed.machine.chain.compliance_per_n);
  if (knows_stretch(typed.machine)) {
    lines.word("chainelongationfactor", per_n);
  } else if (typed.stretch_was_named) {
    remarks.push_back(
        fmt::format("GroundControl's own firmware knows no stretch of the chain; WebControl and "
                    "the holey firmware do (chainelongationfactor, $45): {} per N",
                    per_n));
  }
}

}  // namespace

GroundcontrolText write_groundcontrol(const Machine& stated) {
  GroundcontrolText out;
  const TypedMachine typed = typed_machine(stated, out.remarks);
  const Machine& machine = typed.machine;
  const auto& now = machine.controller.settings;
  const double dx_mm = machine.motors.right.x_mm - machine.motors.left.x_mm;
  const double dy_mm = machine.motors.right.y_mm - machine.motors.left.y_mm;
  const double middle_y_mm = 0.5 * (machine.motors.left.y_mm + machine.motors.right.y_mm);
  Lines lines(out);
  lines.section("Maslow Settings");
  lines.number("bedwidth", machine.bed.width_mm, now.bed_width_mm);
  lines.number("bedheight", machine.bed.height_mm, now.bed_height_mm);
  lines.number("motorspacingx", std::hypot(dx_mm, dy_mm), now.motor_spacing_mm);
  lines.number("motoroffsety", middle_y_mm - 0.5 * machine.bed.height_mm, now.motor_offset_y_mm);
  if (const auto* brackets = std::get_if<model::Brackets>(&machine.attachment)) {
    lines.number("sledwidth", brackets->spacing_mm);
    lines.number("sledheight", brackets->height_mm);
    lines.number("sledcg", brackets->cg_below_bit_mm);
  }
  lines.section("Advanced Settings");
  write_attachment(machine, lines);
  lines.number(
      "topbeamtilt", std::atan2(dy_mm, dx_mm) * 180.0 / std::numbers::pi, now.top_beam_tilt_deg);
  lines.number("chainpitch", machine.sprocket.pitch_mm, now.chain_pitch_mm);
  lines.number("gearteeth", machine.sprocket.teeth, now.gear_teeth);
  lines.number(
      "leftchaintolerance", typed.tolerance_percent.left, now.left_chain_tolerance_percent);
  lines.number(
      "rightchaintolerance", typed.tolerance_percent.right, now.right_chain_tolerance_percent);
  write_stretch(typed, lines, out.remarks);
  lines.word("chainoversprocket", machine.feed == model::Feed::over_top ? "Top" : "Bottom");
  remark_on_what_cannot_be_typed(machine, out.remarks);
  return out;
}

}  // namespace chaintrue::grid::files
