// SPDX-License-Identifier: GPL-3.0-or-later
// The export of groundcontrol_file.hpp: a machine as the numbers to type in.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>

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

/// Every import has these; for a machine without them all lines are written.
bool is_imported(const model::ControllerSettings& settings) {
  return settings.bed_width_mm && settings.bed_height_mm && settings.motor_spacing_mm &&
         settings.motor_offset_y_mm;
}

/// Collects the lines, with remarks on how each differs from the controller's present value.
class Lines {
 public:
  Lines(const Machine& machine, GroundcontrolText& out)
      : imported_(is_imported(machine.controller.settings)), out_(out) {}

  void section(const std::string& name) {
    out_.text += fmt::format("{}[{}]\n", out_.text.empty() ? "" : "\n", name);
  }
  /// The value of the file under a key that is not a setting of the controller.
  void number(const std::string& key, double value) {
    word(key, imported_ ? fmt::format("{}", value) : to_type(value));
  }
  void number(const std::string& key,
              double value,
              std::optional<double> now,
              std::string_view by) {
    const std::string typed = to_type(value);
    // The settings went through sines and sums on their way to the machine and back; 1e-9 of them
    // is a thousand roundings, and far below the digits that are typed.
    constexpr double kSame = 1e-9;
    if (now && std::abs(value - *now) <= kSame * std::max(1.0, std::abs(*now))) {
      return word(key, fmt::format("{}", *now));
    }
    // A setting missing from the imported file is written only if something changes it.
    if (imported_ && !now && typed == "0") return;
    word(key, typed);
    if (now || imported_) changes(key, now ? fmt::format("{}", *now) : "not set", typed, by);
  }
  void word(const std::string& key, const std::string& word) {
    out_.text += fmt::format("{} = {}\n", key, word);
  }
  void changes(std::string_view key,
               const std::string& from,
               const std::string& to,
               std::string_view by) {
    out_.remarks.push_back(fmt::format("{} changes from {} to {}, by {}", key, from, to, by));
  }
  [[nodiscard]] bool imported() const { return imported_; }

 private:
  bool imported_;
  GroundcontrolText& out_;
};

/// The machine with the effects that a setting can represent applied to its numbers, and its chain
/// tolerances in GroundControl's terms.
struct TypedMachine {
  Machine machine;
  model::PerSide<double> tolerance_percent;
  /// The pitch is stated by some effect; otherwise the tolerance is unchanged.
  model::PerSide<bool> pitch_is_stated;
  bool stretch_was_named = false;
  bool sag_was_named = false;
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
  for (const Side side : model::kSides) {
    if (effect.side == (side == Side::left ? "right" : "left")) continue;
    typed.tolerance_percent[side] += percent;
    typed.pitch_is_stated[side] = true;
  }
}

void take_sag(TypedMachine& typed, const model::AppliedEffect& effect) {
  typed.machine.chain.mass_kg_per_m *= 1.0 + parameter_of(effect, "relative_weight");
  typed.sag_was_named = true;
}

void take_stretch(TypedMachine& typed, const model::AppliedEffect& effect) {
  typed.machine.chain.compliance_per_n += parameter_of(effect, "compliance_per_n");
  typed.stretch_was_named = true;
}

/// No setting represents it; the remark gives the resulting radius of the sprocket.
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
  TypedMachine typed{machine, {}, {}, false, false};
  for (const model::AppliedEffect& effect : machine.effects) {
    const auto take_up = take_ups().find(effect.effect);
    if (take_up != take_ups().end()) {
      take_up->second(typed, effect);
      continue;
    }
    const model::effects::Effect* known = model::effects::find_effect(machine, effect.effect);
    remarks.push_back(fmt::format("GroundControl has no setting for the effect {}{}{}{}{}",
                                  effect.effect,
                                  effect.side.empty() ? "" : " ",
                                  effect.side,
                                  known != nullptr ? "; what can be done: " : "",
                                  known != nullptr ? known->remedy : ""));
  }
  return typed;
}

/// GroundControl's own firmware has no stretch; WebControl and the holey firmware have.
bool knows_stretch(const Machine& machine) {
  return machine.controller.kind == model::ControllerKind::holey ||
         machine.controller.settings.chain_elongation_per_n.has_value();
}

constexpr double kWorthSayingMm = 0.05;

/// For a controller whose settings have no topbeamtilt.
void remark_on_the_beam(double right_above_left_mm, std::vector<std::string>& remarks) {
  if (std::abs(right_above_left_mm) <= kWorthSayingMm) return;
  remarks.push_back(fmt::format(
      "these settings have no topbeamtilt, and the right motor is {:.2f} mm {} than the "
      "left: level the beam, or compensate the G-code with a map",
      std::abs(right_above_left_mm),
      right_above_left_mm > 0.0 ? "higher" : "lower"));
}

void remark_on_what_cannot_be_typed(const Machine& machine, std::vector<std::string>& remarks) {
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
    remarks.push_back(fmt::format("the {} chain reads {:.2f} mm too {}; reset its zero",
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

/// The sources of a change, for remarks.
constexpr std::string_view kByBed = "the machine's bed (/bed)";
constexpr std::string_view kByMotors = "the machine's motors (/motors)";
constexpr std::string_view kByRing = "the machine's ring (/attachment, the effect ring_radius)";
constexpr std::string_view kBySprocket = "the machine's sprocket (/sprocket)";
constexpr std::string_view kByPitch = "the pitch of the chain (the effect chain_pitch_error)";
constexpr std::string_view kBySag = "the weight of the chain (the effect chain_sag)";
constexpr std::string_view kByStretch =
    "the chain's stretch (/chain/compliance_per_n, the effect chain_stretch)";
constexpr std::string_view kBySled = "the sled's mass (/sled/mass_kg)";

void write_attachment_lines(const TypedMachine& typed, Lines& lines) {
  const Machine& machine = typed.machine;
  const auto& now = machine.controller.settings;
  const auto* ring = std::get_if<model::Ring>(&machine.attachment);
  if (ring == nullptr) {
    lines.word("kinematicstype", "Quadrilateral");
    if (now.chain_sag_correction)
      lines.number(
          "chainsagcorrection", *now.chain_sag_correction, now.chain_sag_correction, kBySag);
    return;
  }
  lines.word("kinematicstype", "Triangular");
  lines.number("rotationradius", ring->radius_mm, now.rotation_radius_mm, kByRing);
  // A parabola in place of the catenary; the firmware uses it with a ring only.
  if (typed.sag_was_named || !lines.imported()) {
    lines.number("chainsagcorrection",
                 model::equilibrium_parameters(machine).sag_correction,
                 typed.sag_was_named ? now.chain_sag_correction : std::nullopt,
                 kBySag);
  } else if (now.chain_sag_correction) {
    lines.number("chainsagcorrection", *now.chain_sag_correction, now.chain_sag_correction, kBySag);
  }
}

void write_weights(const TypedMachine& typed, Lines& lines, std::vector<std::string>& remarks) {
  const auto& now = typed.machine.controller.settings;
  if (now.sled_weight_n) {
    lines.number("sledweight",
                 typed.machine.sled.mass_kg * kGroundcontrolGravity_m_per_s2,
                 now.sled_weight_n,
                 kBySled);
  }
  const double compliance = typed.machine.chain.compliance_per_n;
  const std::string per_n = fmt::format("{:.4g}", compliance);
  if (knows_stretch(typed.machine)) {
    const auto& as_it_came = now.chain_elongation_per_n;
    const bool same = as_it_came && std::abs(compliance - *as_it_came) <= 1e-9 * *as_it_came;
    lines.word("chainelongationfactor", same ? fmt::format("{}", *as_it_came) : per_n);
    if (as_it_came && !same) {
      lines.changes("chainelongationfactor", fmt::format("{}", *as_it_came), per_n, kByStretch);
    }
  } else if (typed.stretch_was_named) {
    remarks.push_back(
        fmt::format("GroundControl's own firmware has no chain stretch; WebControl and the holey "
                    "firmware have it (chainelongationfactor, $45): {} per N",
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
  Lines lines(machine, out);
  lines.section("Maslow Settings");
  lines.number("bedwidth", machine.bed.width_mm, now.bed_width_mm, kByBed);
  lines.number("bedheight", machine.bed.height_mm, now.bed_height_mm, kByBed);
  lines.number("motorspacingx", std::hypot(dx_mm, dy_mm), now.motor_spacing_mm, kByMotors);
  lines.number(
      "motoroffsety", middle_y_mm - 0.5 * machine.bed.height_mm, now.motor_offset_y_mm, kByMotors);
  if (const auto* brackets = std::get_if<model::Brackets>(&machine.attachment)) {
    lines.number("sledwidth", brackets->spacing_mm);
    lines.number("sledheight", brackets->height_mm);
    lines.number("sledcg", brackets->cg_below_bit_mm);
  }
  lines.section("Advanced Settings");
  write_attachment_lines(typed, lines);
  if (!lines.imported() || now.top_beam_tilt_deg) {
    lines.number("topbeamtilt",
                 std::atan2(dy_mm, dx_mm) * 180.0 / std::numbers::pi,
                 now.top_beam_tilt_deg,
                 kByMotors);
  } else {
    remark_on_the_beam(dy_mm, out.remarks);
  }
  lines.number("chainpitch", machine.sprocket.pitch_mm, now.chain_pitch_mm, kBySprocket);
  lines.number("gearteeth", machine.sprocket.teeth, now.gear_teeth, kBySprocket);
  const auto tolerance = [&](Side side, std::optional<double> in_force) {
    return typed.pitch_is_stated[side] ? typed.tolerance_percent[side] : in_force.value_or(0.0);
  };
  lines.number("leftchaintolerance",
               tolerance(Side::left, now.left_chain_tolerance_percent),
               now.left_chain_tolerance_percent,
               kByPitch);
  lines.number("rightchaintolerance",
               tolerance(Side::right, now.right_chain_tolerance_percent),
               now.right_chain_tolerance_percent,
               kByPitch);
  write_weights(typed, lines, out.remarks);
  lines.word("chainoversprocket", machine.feed == model::Feed::over_top ? "Top" : "Bottom");
  remark_on_what_cannot_be_typed(machine, out.remarks);
  return out;
}

GroundcontrolText write_groundcontrol_settings(const Machine& machine,
                                               const model::ControllerSettings& settings,
                                               std::string_view by) {
  using S = model::ControllerSettings;
  const S& now = machine.controller.settings;
  GroundcontrolText out;
  Lines lines(machine, out);
  const auto number = [&](const char* key, std::optional<double> S::*setting) {
    if (settings.*setting) lines.number(key, *(settings.*setting), now.*setting, by);
  };
  lines.section("Maslow Settings");
  number("bedwidth", &S::bed_width_mm);
  number("bedheight", &S::bed_height_mm);
  number("motorspacingx", &S::motor_spacing_mm);
  number("motoroffsety", &S::motor_offset_y_mm);
  lines.section("Advanced Settings");
  lines.word("kinematicstype", "Triangular");
  number("rotationradius", &S::rotation_radius_mm);
  number("chainsagcorrection", &S::chain_sag_correction);
  number("topbeamtilt", &S::top_beam_tilt_deg);
  number("chainpitch", &S::chain_pitch_mm);
  number("gearteeth", &S::gear_teeth);
  number("leftchaintolerance", &S::left_chain_tolerance_percent);
  number("rightchaintolerance", &S::right_chain_tolerance_percent);
  number("sledweight", &S::sled_weight_n);
  if (settings.chain_elongation_per_n)
    lines.word("chainelongationfactor", fmt::format("{}", *settings.chain_elongation_per_n));
  lines.word("chainoversprocket",
             settings.chain_over_sprocket_top.value_or(machine.feed == model::Feed::over_top)
                 ? "Top"
                 : "Bottom");
  return out;
}

}  // namespace chaintrue::grid::files
