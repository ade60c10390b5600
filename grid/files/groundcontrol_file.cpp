// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/groundcontrol_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "grid/files/groundcontrol_settings.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/other_unit.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/catalogue.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Brackets;
using model::ControllerSettings;
using model::Feed;
using model::Machine;
using model::Ring;

constexpr double kDegreeRad = std::numbers::pi / 180.0;
const std::vector<std::string> kSections = {"Maslow Settings", "Advanced Settings"};

enum class Need { always, ring, brackets, never };

/// A number of the ini file. `setting` is the controller's member for it, if there is one.
struct NumberKey {
  const char* key;
  Range range;
  Need need;
  std::optional<double> ControllerSettings::*setting;
};

// The ranges of model::problems_of and of the catalogue of effects, applied here too so that
// messages name the ini file's lines.
constexpr NumberKey kNumberKeys[] = {
    {"bedwidth", {"mm", 200, 20000}, Need::always, &ControllerSettings::bed_width_mm},
    {"bedheight", {"mm", 200, 20000}, Need::always, &ControllerSettings::bed_height_mm},
    {"motorspacingx", {"mm", 300, 40000}, Need::always, &ControllerSettings::motor_spacing_mm},
    {"motoroffsety", {"mm", 1, 10000}, Need::always, &ControllerSettings::motor_offset_y_mm},
    {"chainpitch", {"mm", 1, 50}, Need::always, &ControllerSettings::chain_pitch_mm},
    {"gearteeth", {"teeth", 3, 100}, Need::always, &ControllerSettings::gear_teeth},
    {"rotationradius", {"mm", 20, 1000}, Need::ring, &ControllerSettings::rotation_radius_mm},
    {"sledwidth", {"mm", 20, 2000}, Need::brackets, nullptr},
    {"sledheight", {"mm", 0, 2000}, Need::brackets, nullptr},
    {"sledcg", {"mm", 0, 2000}, Need::brackets, nullptr},
    {"topbeamtilt", {"degrees", -20, 20}, Need::never, &ControllerSettings::top_beam_tilt_deg},
    {"chainsagcorrection",
     {"1e-12 / mm^2", -1000, 1000},
     Need::never,
     &ControllerSettings::chain_sag_correction},
    {"leftchaintolerance",
     {"percent", -5, 5},
     Need::never,
     &ControllerSettings::left_chain_tolerance_percent},
    {"rightchaintolerance",
     {"percent", -5, 5},
     Need::never,
     &ControllerSettings::right_chain_tolerance_percent},
    {"sledweight", {"N", 1, 2000}, Need::never, &ControllerSettings::sled_weight_n},
    {"chainelongationfactor",
     {"1/N", 0, 1e-3},
     Need::never,
     &ControllerSettings::chain_elongation_per_n},
};

/// Reads settings one by one and collects problems.
class IniReader {
 public:
  IniReader(const IniTable& table, Problems& problems) : table_(table), problems_(problems) {}

  std::optional<double> number(const NumberKey& key, bool is_needed) {
    const IniEntry* entry = find(key.key, is_needed, key.range.expected());
    if (entry == nullptr) return std::nullopt;
    return checked_number(entry->text, entry->place, key.key, key.range, problems_);
  }

  std::optional<std::string> word(const std::string& key, const std::vector<std::string>& words) {
    const std::string expected = fmt::format("{} ({})", fmt::join(words, " or "), key);
    const IniEntry* entry = find(key, true, expected);
    if (entry == nullptr) return std::nullopt;
    if (std::find(words.begin(), words.end(), entry->text) != words.end()) return entry->text;
    problems_.add(entry->place, entry->text.empty() ? "nothing" : entry->text, expected);
    return std::nullopt;
  }

  [[nodiscard]] std::string place_of_key(const std::string& key) const {
    const IniEntry* entry = table_.find(kSections, key);
    return entry != nullptr ? entry->place : std::string();
  }

 private:
  const IniEntry* find(const std::string& key, bool is_needed, const std::string& expected) {
    const IniEntry* entry = table_.find(kSections, key);
    if (entry == nullptr && is_needed) {
      problems_.add(key, "", fmt::format("{}, in [{}]", expected, fmt::join(kSections, "] or [")));
    }
    return entry;
  }

  const IniTable& table_;
  Problems& problems_;
};

/// The numbers of the file by key.
using SettingValues = std::map<std::string, std::optional<double>>;

/// The unit of a file in which the router is too small for mm.
std::optional<OtherUnit> other_unit_of(const IniTable& table) {
  const auto value_of = [&](const char* key) {
    const IniEntry* entry = table.find(kSections, key);
    return entry != nullptr ? number_of(entry->text) : std::nullopt;
  };
  // A bed is at least 200 mm high; motors lie half a metre beyond the widest in centimetres.
  constexpr double kShortest = 10.0;
  const std::pair<const char*, double> most[] = {
      {"bedwidth", kWidestOfOtherUnit}, {"bedheight", 200.0}, {"motorspacingx", 500.0}};
  for (const auto& [key, longest] : most) {
    const auto value = value_of(key);
    if (!value || *value < kShortest || *value > longest) return std::nullopt;
  }
  return other_unit(*value_of("bedwidth"));
}

void place_motors(const SettingValues& numbers, Machine& machine) {
  const double half_spacing = 0.5 * numbers.at("motorspacingx").value();
  const double y = 0.5 * machine.bed.height_mm + numbers.at("motoroffsety").value();
  const double tilt = numbers.at("topbeamtilt").value_or(0.0) * kDegreeRad;
  // (1)
  machine.motors.left = {-half_spacing * std::cos(tilt), y - half_spacing * std::sin(tilt)};
  machine.motors.right = {half_spacing * std::cos(tilt), y + half_spacing * std::sin(tilt)};
}

void attach_sled(const SettingValues& numbers, bool has_brackets, Machine& machine) {
  if (has_brackets) {
    machine.attachment = Brackets{numbers.at("sledwidth").value(),
                                  numbers.at("sledheight").value(),
                                  numbers.at("sledcg").value()};
  } else {
    machine.attachment = Ring{numbers.at("rotationradius").value()};
  }
}

/// A tolerance other than 0 is the pitch that the owner measured for this chain.
void state_pitch(const SettingValues& numbers, Machine& machine, Problems& problems) {
  std::vector<std::string> links;
  for (const auto& [key, side] :
       {std::pair("leftchaintolerance", "left"), std::pair("rightchaintolerance", "right")}) {
    const double percent = numbers.at(key).value_or(0.0);
    if (percent == 0.0) continue;
    machine.effects.push_back({"chain_pitch_error", side, {{"elongation", percent / 100.0}}});
    links.push_back(fmt::format(
        "{:g} % {} ({})", std::abs(percent), percent > 0.0 ? "longer" : "shorter", side));
  }
  if (links.empty()) return;
  const model::effects::Effect* effect = model::effects::find_effect("chain_pitch_error");
  problems.warn("",
                fmt::format("chain tolerance: links {} than new, each number good to {:g} % (/effects)",
                            fmt::join(links, " and "),
                            100.0 * effect->parameters.front().prior_sigma));
}

/// Sled, chain and frame: from the file if stated, otherwise the default machine's, with a warning.
void weigh(const SettingValues& numbers, Machine& machine, Problems& problems) {
  const auto assume = [&problems](std::string what) {
    problems.warn("", fmt::format("the settings do not say {}", std::move(what)));
  };
  if (const auto weight_n = numbers.at("sledweight")) {
    machine.sled.mass_kg = *weight_n / kGroundcontrolGravity_m_per_s2;
  } else {
    assume(
        fmt::format("what the sled weighs; assumed {} kg (/sled/mass_kg)", machine.sled.mass_kg));
  }
  if (const auto compliance = numbers.at("chainelongationfactor")) {
    machine.chain.compliance_per_n = *compliance;
  } else {
    // The default elongation of MaslowCNC/Firmware (setting $45).
    machine.chain.compliance_per_n = 5.1685e-6;
    assume(fmt::format("how far the chain stretches; assumed {} per N (/chain/compliance_per_n)",
                       machine.chain.compliance_per_n));
  }
  assume(fmt::format("what the chain weighs; assumed {} kg/m (/chain/mass_kg_per_m)",
                     machine.chain.mass_kg_per_m));
  assume(
      fmt::format("how far the frame leans; assumed {} degrees from the vertical "
                  "(/frame/tilt_from_vertical_deg)",
                  machine.frame.tilt_from_vertical_deg));
  assume(
      fmt::format("how well it was taped; assumed are motor positions to {} mm, chain zeros to {} "
                  "mm and the ring's "
                  "radius to {} mm, 1 sigma (/uncertainty)",
                  machine.uncertainty.motor_position_mm,
                  machine.uncertainty.chain_zero_mm,
                  machine.uncertainty.ring_radius_mm));
}

SettingValues read_numbers(IniReader& reader, std::optional<bool> has_brackets) {
  SettingValues numbers;
  for (const NumberKey& key : kNumberKeys) {
    const bool is_of_this_sled =
        key.need == Need::ring ? has_brackets == false : has_brackets == true;
    const bool is_of_a_sled = key.need == Need::ring || key.need == Need::brackets;
    const bool is_needed = key.need == Need::always || (is_of_a_sled && is_of_this_sled);
    // Every file contains the settings of the other kind of sled, which have no meaning.
    if (is_of_a_sled && !is_of_this_sled) continue;
    numbers[key.key] = reader.number(key, is_needed);
  }
  return numbers;
}

Machine machine_of(const SettingValues& numbers, bool has_brackets, bool over_top) {
  Machine machine;
  machine.bed = {numbers.at("bedwidth").value(), numbers.at("bedheight").value()};
  place_motors(numbers, machine);
  machine.sprocket.pitch_mm = numbers.at("chainpitch").value();
  machine.sprocket.teeth = static_cast<int>(numbers.at("gearteeth").value());
  machine.feed = over_top ? Feed::over_top : Feed::off_bottom;
  attach_sled(numbers, has_brackets, machine);
  machine.controller.kind = model::ControllerKind::maslow_classic;
  for (const NumberKey& key : kNumberKeys) {
    const auto value = numbers.find(key.key);
    if (key.setting != nullptr && value != numbers.end())
      machine.controller.settings.*key.setting = value->second;
  }
  machine.controller.settings.chain_over_sprocket_top = over_top;
  return machine;
}

}  // namespace

ReadMachine machine_of_settings(const IniTable& table, Tolerances tolerances, Problems& problems) {
  IniReader reader(table, problems);
  if (const auto unit = other_unit_of(table)) {
    problems.explain(reader.place_of_key("bedwidth"),
                     ProblemKind::other_unit,
                     fmt::format("the lengths of this file look like {} (bedwidth = {}): multiply them "
                                 "by {:g}.",
                                 unit->word,
                                 table.find(kSections, "bedwidth")->text,
                                 unit->mm));
    problems.throw_if_any();
  }
  const auto kinematics = reader.word("kinematicstype", {"Triangular", "Quadrilateral"});
  const auto feed = reader.word("chainoversprocket", {"Top", "Bottom"});
  const auto has_brackets =
      kinematics ? std::optional(*kinematics == "Quadrilateral") : std::nullopt;
  const SettingValues numbers = read_numbers(reader, has_brackets);
  if (const auto teeth = numbers.at("gearteeth"); teeth && *teeth != std::floor(*teeth)) {
    problems.add(
        reader.place_of_key("gearteeth"), fmt::format("{}", *teeth), "a whole number (gearteeth)");
  }
  problems.throw_if_any();
  ReadMachine read;
  read.machine = machine_of(numbers, *has_brackets, *feed == "Top");
  if (tolerances == Tolerances::are_pitch) state_pitch(numbers, read.machine, problems);
  read.machine.name = std::filesystem::path(problems.file()).filename().string();
  weigh(numbers, read.machine, problems);
  for (const model::MachineProblem& problem : model::problems_of(read.machine)) {
    problems.add(
        fmt::format("the machine's {}", problem.parameter), problem.value, problem.expected);
  }
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

ReadMachine parse_groundcontrol(const std::string& text,
                                const std::string& file,
                                Tolerances tolerances) {
  Problems problems(file);
  const IniTable table(text, problems);
  problems.throw_if_any();
  return machine_of_settings(table, tolerances, problems);
}

ReadMachine read_groundcontrol(const std::filesystem::path& path, Tolerances tolerances) {
  return parse_groundcontrol(read_whole_file(path), name_in_messages(path), tolerances);
}

}  // namespace chaintrue::grid::files
