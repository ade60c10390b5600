// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/machine.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "model/machine_ranges.hpp"

namespace chaintrue::model {
namespace {

constexpr std::string_view kInches = "was it given in inches?";

void check_motors(const Machine& machine, RangeChecks& check) {
  const MotorPosition &l = machine.motors.left, &r = machine.motors.right;
  check.range("/motors/left/x_mm", l.x_mm, -20000, 20000, "mm");
  check.range("/motors/left/y_mm", l.y_mm, -20000, 20000, "mm");
  check.range("/motors/right/x_mm", r.x_mm, -20000, 20000, "mm");
  check.range("/motors/right/y_mm", r.y_mm, -20000, 20000, "mm");
  if (!std::isfinite(l.x_mm + l.y_mm + r.x_mm + r.y_mm)) return;
  const double spacing = r.x_mm - l.x_mm;
  if (spacing <= 0.0) {
    check.add(
        "/motors/left/x_mm", l.x_mm,
        fmt::format("the left motor left of the right one, whose x_mm is {}; were they swapped?",
                    r.x_mm));
  } else if (spacing < 300.0) {
    check.add("/motors/right/x_mm", r.x_mm,
              fmt::format("motors at least 300 mm apart, not {}; {}", spacing, kInches));
  } else if (std::abs(l.y_mm - r.y_mm) > 0.2 * spacing) {
    check.add(
        "/motors/right/y_mm", r.y_mm,
        fmt::format(
            "a beam that rises less than a fifth of its length, but the left motor's y_mm is {}",
            l.y_mm));
  }
  if (!std::isfinite(machine.bed.height_mm)) return;
  const double top = 0.5 * machine.bed.height_mm;
  for (const Side side : kSides) {
    const double y = machine.motors[side].y_mm;
    if (y > top) continue;
    const char* place = side == Side::left ? "/motors/left/y_mm" : "/motors/right/y_mm";
    check.add(place, y,
              fmt::format("a motor above the bed's top edge at y_mm = {} (y points up, the origin "
                          "is the bed's centre)",
                          top));
  }
}

void check_attachment(const Attachment& attachment, RangeChecks& check) {
  if (const auto* ring = std::get_if<Ring>(&attachment)) {
    check.range("/attachment/radius_mm", ring->radius_mm, 0, 1000, "mm");
    if (ring->radius_mm > 0 && ring->radius_mm < 20) {
      check.add("/attachment/radius_mm", ring->radius_mm,
                fmt::format("0 (chains to the bit) or at least 20 mm; {}", kInches));
    }
    return;
  }
  const auto& brackets = std::get<Brackets>(attachment);
  check.range("/attachment/spacing_mm", brackets.spacing_mm, 20, 2000, "mm", kInches);
  check.range("/attachment/height_mm", brackets.height_mm, 0, 2000, "mm");
  check.range("/attachment/cg_below_bit_mm", brackets.cg_below_bit_mm, 0, 2000, "mm");
}

struct ControllerRange {
  std::string_view key;
  std::optional<double> ControllerSettings::*value;
  double least, most;
  std::string_view unit;
};

constexpr ControllerRange kControllerRanges[] = {
    {"bedwidth", &ControllerSettings::bed_width_mm, 100, 20000, "mm"},
    {"bedheight", &ControllerSettings::bed_height_mm, 100, 20000, "mm"},
    {"motorspacingx", &ControllerSettings::motor_spacing_mm, 300, 40000, "mm"},
    {"motoroffsety", &ControllerSettings::motor_offset_y_mm, 0, 10000, "mm"},
    {"rotationradius", &ControllerSettings::rotation_radius_mm, 0, 1000, "mm"},
    {"sledwidth", &ControllerSettings::sled_width_mm, 20, 2000, "mm"},
    {"sledheight", &ControllerSettings::sled_height_mm, 0, 2000, "mm"},
    {"sledcg", &ControllerSettings::sled_cg_mm, 0, 2000, "mm"},
    {"chainsagcorrection", &ControllerSettings::chain_sag_correction, -1000, 1000,
     "(1e-12 / mm^2)"},
    {"leftchaintolerance", &ControllerSettings::left_chain_tolerance_percent, -10, 10, "percent"},
    {"rightchaintolerance", &ControllerSettings::right_chain_tolerance_percent, -10, 10, "percent"},
    {"topbeamtilt", &ControllerSettings::top_beam_tilt_deg, -20, 20, "degrees"},
    {"chainpitch", &ControllerSettings::chain_pitch_mm, 1, 50, "mm"},
    {"gearteeth", &ControllerSettings::gear_teeth, 3, 100, "teeth"},
    {"sledweight", &ControllerSettings::sled_weight_n, 1e-3, 10000, "N"},
    {"chainelongationfactor", &ControllerSettings::chain_elongation_per_n, 0, 1e-3, "1/N"},
};

void check_controller(const ControllerSettings& settings, RangeChecks& check) {
  for (const ControllerRange& own : kControllerRanges) {
    if (const auto& value = settings.*own.value)
      check.range(fmt::format("/controller/settings/{}", own.key), *value, own.least, own.most,
                  own.unit);
  }
}

void check_machine(const Machine& machine, RangeChecks& check) {
  check.range("/bed/width_mm", machine.bed.width_mm, 200, 20000, "mm", kInches);
  check.range("/bed/height_mm", machine.bed.height_mm, 200, 20000, "mm", kInches);
  check_motors(machine, check);
  check.range("/sprocket/teeth", machine.sprocket.teeth, 3, 100, "teeth");
  check.range("/sprocket/pitch_mm", machine.sprocket.pitch_mm, 1, 50, "mm", kInches);
  if (machine.sprocket.radius_mm) {
    check.range("/sprocket/radius_mm", *machine.sprocket.radius_mm, 1, 200, "mm", kInches);
  }
  check_attachment(machine.attachment, check);
  check.range("/chain/mass_kg_per_m", machine.chain.mass_kg_per_m, 0, 5, "kg/m",
              "was it given in grams per metre?");
  check.range("/chain/compliance_per_n", machine.chain.compliance_per_n, 0, 1e-3, "1/N",
              "it is a strain per newton, about 5e-6 for a #25 chain");
  check.range("/chain_zero/left_mm", machine.chain_zero.left_mm, -20000, 20000, "mm");
  check.range("/chain_zero/right_mm", machine.chain_zero.right_mm, -20000, 20000, "mm");
  check.range("/sled/mass_kg", machine.sled.mass_kg, 0.05, 200, "kg", "was it given in grams?");
  check.range("/frame/tilt_from_vertical_deg", machine.frame.tilt_from_vertical_deg, 0, 75,
              "degrees", "it counts from the vertical, not from the floor");
  check.range("/uncertainty/motor_position_mm", machine.uncertainty.motor_position_mm, 0, 1000,
              "mm");
  check.range("/uncertainty/chain_zero_mm", machine.uncertainty.chain_zero_mm, 0, 1000, "mm");
  check.range("/uncertainty/ring_radius_mm", machine.uncertainty.ring_radius_mm, 0, 1000, "mm");
  check_controller(machine.controller.settings, check);
  for (std::size_t i = 0; i < machine.effects.size(); ++i) {
    for (const auto& [key, value] : machine.effects[i].parameters) {
      if (std::isfinite(value)) continue;
      check.add(fmt::format("/effects/{}/parameters/{}", i, key), value, "a finite number");
    }
  }
}

}  // namespace

void RangeChecks::range(std::string_view place, double value, double least, double most,
                        std::string_view unit, std::string_view slip) {
  if (ranges_ != nullptr) ranges_->push_back({std::string(place), least, most, std::string(unit)});
  if (value >= least && value <= most) return;  // false for NaN
  std::string expected = fmt::format("a number from {} to {} {}", least, most, unit);
  while (expected.back() == ' ') expected.pop_back();
  if (std::isfinite(value) && !slip.empty()) expected += fmt::format("; {}", slip);
  add(place, value, std::move(expected));
}

double Sprocket::effective_radius_mm() const {
  return radius_mm.value_or(pitch_mm * teeth / (2.0 * std::numbers::pi));
}

void require_none(const std::vector<MachineProblem>& problems) {
  if (problems.empty()) return;
  const MachineProblem& first = problems.front();
  throw std::invalid_argument(
      fmt::format("{}: found {}, expected {}", first.parameter, first.value, first.expected));
}

std::vector<MachineProblem> problems_of(const Machine& machine) {
  RangeChecks check;
  check_machine(machine, check);
  return check.take();
}

std::vector<MachineRange> machine_ranges() {
  Machine machine;
  machine.sprocket.radius_mm = machine.sprocket.effective_radius_mm();
  for (const ControllerRange& own : kControllerRanges) machine.controller.settings.*own.value = 0.0;
  std::vector<MachineRange> ranges;
  RangeChecks with_ring(&ranges);
  check_machine(machine, with_ring);
  machine.attachment = Brackets{};
  RangeChecks with_brackets(&ranges);
  check_attachment(machine.attachment, with_brackets);
  return ranges;
}

}  // namespace chaintrue::model
