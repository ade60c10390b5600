// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/groundcontrol_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/groundcontrol_settings.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/sources.hpp"
#include "model/chain_formulas.hpp"
#include "model/effects/catalogue.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {

namespace {

constexpr double kDegreeRad = std::numbers::pi / 180.0;

/// The unit of a file in which the router is too small for mm.
std::optional<input_checks::WrittenUnit> other_unit_of(SettingReader& settings) {
  // A bed is at least 200 mm high; motors lie half a metre beyond the widest in centimetres.
  constexpr double kShortest = 10.0;
  const std::pair<const char*, double> most[] = {
      {"bedheight", 200.0}, {"motorspacingx", 500.0}, {"bedwidth", kWidestOfOtherUnit}};
  double value = 0.0;
  for (const auto& [key, longest] : most) {
    const SettingText* setting = settings.look(key);
    value = setting != nullptr ? number_of(setting->text).value_or(0.0) : 0.0;
    if (value < kShortest || value > longest) return std::nullopt;
  }
  return other_unit(value);
}

void place_motors(const ControllerSettings& numbers, Machine& machine) {
  const double half_spacing = 0.5 * numbers.motor_spacing_mm.value();
  const double y = 0.5 * machine.bed.height_mm + numbers.motor_offset_y_mm.value();
  const double tilt = numbers.top_beam_tilt_deg.value_or(0.0) * kDegreeRad;
  // (1)
  machine.motors.left = {-half_spacing * std::cos(tilt), y - half_spacing * std::sin(tilt)};
  machine.motors.right = {half_spacing * std::cos(tilt), y + half_spacing * std::sin(tilt)};
}

void attach_sled(const ControllerSettings& numbers, bool has_brackets, Machine& machine) {
  if (has_brackets) {
    machine.attachment = model::Brackets{
        numbers.sled_width_mm.value(), numbers.sled_height_mm.value(), numbers.sled_cg_mm.value()};
  } else {
    machine.attachment = Ring{numbers.rotation_radius_mm.value()};
  }
}

/// For the motors' gears and encoders, 28 x 289.78 (MaslowCNC/Firmware); the 8148 of the first releases
/// took the gears for 291 to 1.
constexpr double kCountsOfATurn = 8113.73;

/// Relative excess of chain paid out over the controller's count: what it counts as one turn of the
/// sprocket is more than one.
double more_by_encoder(SettingReader& settings, Problems& problems) {
  constexpr Range kCounts{"counts a turn", 100.0, 1e6};
  // Beyond this the motors are different ones with other counts.
  constexpr double kSameMotors = 0.02;
  constexpr double kNotice = 1e-5;
  const auto counts = settings.find("encodersteps", kCounts);
  if (!counts) return 0.0;
  const double more = *counts / kCountsOfATurn - 1.0;
  if (std::abs(more) < kNotice) return 0.0;
  const std::string place = settings.look("encodersteps")->place;
  if (std::abs(more) > kSameMotors) {
    problems.warn(place,
                  "encodersteps {:g}: not the standard Maslow motors, which turn once "
                  "in {:g} counts; assumed right for yours",
                  *counts, kCountsOfATurn);
    return 0.0;
  }
  problems.warn(
      place,
      "encodersteps {:g}: a turn is {:g} counts, so {:.2f} % {} chain runs out than the "
      "controller counts; entered as links that are {} by this amount (/effects). An export "
      "corrects for it; if you set {:g} at the machine instead, import its settings again",
      *counts, kCountsOfATurn, 100.0 * std::abs(more), more > 0.0 ? "more" : "less",
      more > 0.0 ? "longer" : "shorter", kCountsOfATurn);
  return more;
}

/// A tolerance other than 0 is the pitch that the owner measured for this chain.
void state_pitch(const ControllerSettings& numbers, Tolerances tolerances, double more_by_encoder,
                 Machine& machine, Problems& problems) {
  Words links;
  for (const auto& [stated, side] : {std::pair(numbers.left_chain_tolerance_percent, "left"),
                                     std::pair(numbers.right_chain_tolerance_percent, "right")}) {
    const double percent = tolerances == Tolerances::are_pitch ? stated.value_or(0.0) : 0.0;
    const double elongation = (1.0 + percent / 100.0) * (1.0 + more_by_encoder) - 1.0;
    if (percent == 0.0 && more_by_encoder == 0.0) continue;
    machine.effects.push_back(
        {"chain_pitch_error",
         side,
         {{"elongation", more_by_encoder == 0.0 ? percent / 100.0 : elongation}}});
    if (percent == 0.0) continue;
    links.push_back(fmt::format("{:g} % {} ({})", std::abs(percent),
                                percent > 0.0 ? "longer" : "shorter", side));
  }
  if (links.empty()) return;
  const Effect* effect = model::effects::find_effect("chain_pitch_error");
  problems.warn("", "chain tolerance: links {} than new, each value within {:g} % (/effects)",
                fmt::join(links, " and "), 100.0 * effect->parameters.front().prior_sigma);
}

/// Sled, chain and frame: from the file if stated, otherwise the default machine's, with a warning.
void weigh(const ControllerSettings& numbers, Machine& machine, Problems& problems) {
  const auto assume = [&problems](std::string what) {
    problems.warn("", "not in the settings: {}", std::move(what));
  };
  if (const auto weight_n = numbers.sled_weight_n) {
    machine.sled.mass_kg = *weight_n / kGroundcontrolGravity_m_per_s2;
  } else {
    assume(fmt::format("the sled's weight; assumed {} kg (/sled/mass_kg)", machine.sled.mass_kg));
  }
  if (const auto compliance = numbers.chain_elongation_per_n) {
    machine.chain.compliance_per_n = *compliance;
  } else {
    // The default elongation of MaslowCNC/Firmware (setting $45).
    machine.chain.compliance_per_n = 5.1685e-6;
    assume(fmt::format("the chain's stretch; assumed {} per N (/chain/compliance_per_n)",
                       machine.chain.compliance_per_n));
  }
  assume(fmt::format("the chain's weight; assumed {} kg/m (/chain/mass_kg_per_m)",
                     machine.chain.mass_kg_per_m));
  assume(
      fmt::format("the frame's lean; assumed {} degrees from the vertical "
                  "(/frame/tilt_from_vertical_deg)",
                  machine.frame.tilt_from_vertical_deg));
  assume(fmt::format(
      "how accurately the machine was measured; assumed: motor positions within {} mm, chain "
      "zeros within {} mm and the ring's radius within {} mm, 1 sigma (/uncertainty)",
      machine.uncertainty.motor_position_mm, machine.uncertainty.chain_zero_mm,
      machine.uncertainty.ring_radius_mm));
}

/// The behaviour of releases before a setting existed, and a sentence for it.
struct OldReleases {
  SettingReader& settings;
  Problems& problems;
  Words assumed = {};

  /// The first of `words` if the file states none.
  std::string word(const char* key, const Words& words) {
    if (settings.look(key) != nullptr)
      return settings.find_word(key, words).value_or(words.front());
    assumed.push_back(fmt::format("{} {}", key, words.front()));
    return words.front();
  }
  /// For a missing setting; empty if it has always existed.
  std::optional<double> number(std::string_view key, const ControllerSettings& others) {
    const auto assume = [&](double value) {
      assumed.push_back(fmt::format("{} {:g}", key, value));
      return value;
    };
    if (key == "chainpitch") return assume(6.35);
    if (key == "gearteeth") return assume(10.0);
    if (key != "motorspacingx") return std::nullopt;
    // Until 2017 it was how far a motor is beyond the bed's side.
    const auto beyond_mm = settings.find("motoroffsetx", {"mm", 1.0, 10000.0});
    const auto width_mm = others.bed_width_mm;
    if (!beyond_mm || !width_mm) return std::nullopt;
    return assume(*width_mm + 2.0 * *beyond_mm);
  }
  void say() const {
    if (assumed.empty()) return;
    problems.warn("", "assumed, as in releases of GroundControl without this setting: {}",
                  fmt::join(assumed, ", "));
  }
};

ControllerSettings read_numbers(SettingReader& settings, bool has_brackets, OldReleases& old) {
  ControllerSettings numbers;
  for (const NumberKey& key : kNumberKeys) {
    const bool is_of_other_sled = key.need == (has_brackets ? Need::ring : Need::brackets);
    // Every file contains the settings of the other kind of sled, which have no meaning.
    if (is_of_other_sled) continue;
    std::optional<double>& number = numbers.*key.setting;
    number = settings.find(key.key, key.range);
    if (key.need == Need::never || settings.look(key.key) != nullptr) continue;
    number = old.number(key.key, numbers);
    if (!number) settings.need(key.key, key.range);
  }
  return numbers;
}

/// Owners' calibrations put more into the sag than the chain's own.
void check_sag(SettingReader& settings, const Machine& machine, Problems& problems) {
  constexpr double kFarFrom = 2.0;
  const double set = machine.controller.settings.chain_sag_correction.value_or(0.0);
  const model::EquilibriumParameters hangs = equilibrium_parameters(machine);
  const double own =
      model::closed_form_sag_correction(hangs.chain_weight_n_per_mm, hangs.sled_weight_n);
  if (set == 0.0 || (set < kFarFrom * own && kFarFrom * set > own)) return;
  problems.warn(settings.look("chainsagcorrection")->place,
                "chainsagcorrection {:g}: the weights of chain and sled suggest "
                "{:.1f}. A calibration that compensates other errors can produce such "
                "a number; it is kept as the controller's setting",
                set, own);
}

/// start and plan send the sled over the whole bed.
void check_reach(double chain_mm, const Machine& machine, SettingReader& settings,
                 Problems& problems) {
  const double longest_mm = longest_chain_mm(machine);
  if (longest_mm <= chain_mm) return;
  problems.add(settings.look("chainlength")->place, fmt::format("chainlength {:g}", chain_mm),
               ProblemKind::out_of_range,
               "at least {:.0f} mm to reach the lower corners of the bed; correct the "
               "chain's length or the size of the bed",
               std::ceil(longest_mm));
}

Machine machine_of(const ControllerSettings& numbers, bool has_brackets, bool over_top) {
  Machine machine;
  machine.bed = {numbers.bed_width_mm.value(), numbers.bed_height_mm.value()};
  place_motors(numbers, machine);
  machine.sprocket.pitch_mm = numbers.chain_pitch_mm.value();
  machine.sprocket.teeth = static_cast<int>(numbers.gear_teeth.value());
  machine.feed = over_top ? Feed::over_top : Feed::off_bottom;
  attach_sled(numbers, has_brackets, machine);
  machine.controller.kind = ControllerKind::maslow_classic;
  machine.controller.settings = numbers;
  machine.controller.settings.chain_over_sprocket_top = over_top;
  return machine;
}

}  // namespace

ReadMachine machine_of_settings(SettingTexts texts, Tolerances tolerances, Problems& problems) {
  SettingReader settings(std::move(texts), problems, {"Maslow Settings", "Advanced Settings"});
  if (const auto unit = other_unit_of(settings)) {
    const SettingText* width = settings.look("bedwidth");
    problems.explain(
        width->place, ProblemKind::other_unit,
        fmt::format("the lengths of this file look like {} (bedwidth = {}): multiply them "
                    "by {:g}.",
                    unit->word, width->text, unit->mm));
    problems.throw_if_any();
  }
  OldReleases old{settings, problems};
  const bool has_brackets =
      old.word("kinematicstype", {"Quadrilateral", "Triangular"}) == "Quadrilateral";
  const bool over_top = old.word("chainoversprocket", {"Top", "Bottom"}) == "Top";
  const ControllerSettings numbers = read_numbers(settings, has_brackets, old);
  if (const auto teeth = numbers.gear_teeth; teeth && *teeth != std::floor(*teeth)) {
    problems.add(settings.look("gearteeth")->place, fmt::format("{}", *teeth),
                 ProblemKind::out_of_range, "a whole number (gearteeth)");
  }
  const double more_by_encoder_turn = more_by_encoder(settings, problems);
  const auto chain_mm = settings.find("chainlength", {"mm", 100.0, 40000.0});
  problems.throw_if_any();
  ReadMachine read;
  read.machine = machine_of(numbers, has_brackets, over_top);
  state_pitch(numbers, tolerances, more_by_encoder_turn, read.machine, problems);
  read.machine.name = name_without_folders(problems.file());
  old.say();
  weigh(numbers, read.machine, problems);
  check_sag(settings, read.machine, problems);
  settings.warn_of_others("describes where the sled hangs");
  check_geometry(read.machine, problems);
  if (chain_mm && !problems.any()) check_reach(*chain_mm, read.machine, settings, problems);
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

ReadMachine parse_groundcontrol(const std::string& text, const std::string& file,
                                Tolerances tolerances) {
  Problems problems(file);
  refuse_foreign_settings(text, problems);
  SettingTexts texts = ini_texts(text, problems);
  problems.throw_if_any();
  return machine_of_settings(std::move(texts), tolerances, problems);
}

}  // namespace chaintrue::grid::files
