// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/workshop_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "grid/containers.hpp"
#include "model/effects/effect.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct Unit {
  std::string_view parameter;
  double factor;
  std::string_view words;  ///< {} the number
  /// For a negative value, {} its absolute value; empty if `words` show the sign.
  std::string_view negative{};
  std::string_view one{};  ///< for 1 and -1, if a noun is counted
  bool is_whole = false;
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// The words of one effect for its parameter.
struct UnitOfEffect {
  std::string_view effect;
  Unit unit;
};

constexpr UnitOfEffect kUnitsOfEffects[] = {
    {"sled_width", {"offset_mm", 1.0, "{} mm wider", "{} mm narrower"}},
    {"sled_height", {"offset_mm", 1.0, "{} mm higher", "{} mm lower"}},
    {"sled_cg", {"offset_mm", 1.0, "{} mm lower", "{} mm higher"}},
    {"belt_stretch", {"elongation", 100.0, "{} % longer when pulled", "{} % shorter when pulled"}},
    {"belt_scale", {"scale", 100.0, "{} % more belt per turn", "{} % less belt per turn"}},
    {"belt_zero", {"offset_mm", 1.0, "{} mm too much read", "{} mm too little read"}},
    {"anchor_height", {"offset_mm", 1.0, "{} mm higher", "{} mm lower"}},
    {"pen_off_centre", {"offset_mm", 1.0, "{} mm to the right", "{} mm to the left"}},
    {"servo_arm", {"offset_mm", 1.0, "{} mm to the right", "{} mm to the left"}},
    {"gondola_width", {"offset_mm", 1.0, "{} mm wider", "{} mm narrower"}},
    {"standoff", {"offset_mm", 1.0, "{} mm farther from the wall", "{} mm closer to the wall"}},
    {"gondola_mass", {"relative", 100.0, "{} % heavier", "{} % lighter"}},
    {"cord_weight", {"more_g_per_m", 1.0, "{} g per metre heavier", "{} g per metre lighter"}},
    {"pen_friction", {"force_n", 1.0, "{} N"}},
    {"spool_layers", {"growth_mm_per_m2", 1.0, "growth {} mm per square metre"}},
};

/// The words of every other effect for its parameter.
constexpr Unit kUnits[] = {
    {"scale", 100.0, "{} %"},
    {"elongation", 100.0, "links {} % longer", "links {} % shorter"},
    {"angle_rad", 1000.0, "{} mm per metre"},
    {"relative_weight", 100.0, "{} % heavier", "{} % lighter"},
    {"compliance_per_n", 1e6, "{} millionths per newton"},
    {"flexibility_mm_per_n", 1.0, "{} mm per newton"},
    {"force_n", 1.0, "{} N to the right", "{} N to the left"},
    {"offset_mm", 1.0, "radius {} mm larger", "radius {} mm smaller"},
    {"slope_mm_per_rad", 1.0 / kDegrees, "{} mm per degree"},
    {"knee_rad", kDegrees, "sets in at {} degrees below the horizontal",
     "sets in at {} degrees above the horizontal"},
    {"phase_rad", kDegrees, "phase {} degrees"},
    {"rate_mm_per_visit", 1.0, "{} mm per visit"},
    {"links", 1.0, "{} links", "", "{} link", true},
    {"teeth", 1.0, "{} teeth", "", "{} tooth", true},
    {"shift_mm", 1.0, "{} mm too much read", "{} mm too little read"},
    {"first_visit", 1.0, "from visit {} on", "", "", true},
    {"visit", 1.0, "at visit {}", "", "", true},
    {"amplitude_mm", 1.0, "{} mm"},
    {"half_width_mm", 1.0, "{} mm to either side"},
    {"distance_mm", 1.0, "{} mm"},
    {"give_mm", 1.0, "{} mm when pulled"},
    {"direction_rad", kDegrees, "{} degrees from x towards y"},
};

/// Null for a parameter without words. The meaning of a declared effect's parameter is known only to its
/// author.
const Unit* unit_for(const Effect& effect, std::string_view parameter) {
  if (effect.law != nullptr) return nullptr;
  const auto* own = find_where(kUnitsOfEffects, [&](const UnitOfEffect& one) {
    return one.effect == effect.id && one.unit.parameter == parameter;
  });
  return own != nullptr ? &own->unit : find_where(kUnits, having(&Unit::parameter, parameter));
}

/// Rounded to two digits.
double two_digits(double value) {
  if (value == 0.0) return 0.0;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1.0);
  return step * std::round(value / step);
}

}  // namespace

std::string with_sigma(double value, double sigma, int most_digits) {
  if (!(sigma > 0.0)) return fmt::format("{:g}", two_digits(value));
  const int digits =
      std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, most_digits);
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, sigma, digits);
}

NameAndUnit parameter_words(std::string_view parameter) {
  std::size_t at = std::string_view::npos;
  for (const std::string_view unit : {"_mm", "_rad"}) at = std::min(at, parameter.find(unit));
  NameAndUnit words{std::string(parameter.substr(0, at)),
                    at == std::string_view::npos ? "" : std::string(parameter.substr(at + 1))};
  for (std::string* text : {&words.name, &words.unit})
    std::replace(text->begin(), text->end(), '_', ' ');
  return words;
}

std::string in_workshop_units(const CauseId& cause, const ParameterEstimate& estimate) {
  const Unit* unit = unit_for(*cause.effect, estimate.parameter);
  if (unit == nullptr)
    return fmt::format("{} = {}", estimate.parameter, with_sigma(estimate.value, estimate.sigma));
  const bool reversed = estimate.value < 0.0 && !unit->negative.empty();
  const double value = reversed ? -estimate.value : estimate.value;
  const bool is_one = !unit->one.empty() && std::abs(value) == 1.0;
  return fmt::format(fmt::runtime(reversed ? unit->negative
                                  : is_one ? unit->one
                                           : unit->words),
                     unit->is_whole
                         ? fmt::format("{:g}", value)
                         : with_sigma(unit->factor * value, unit->factor * estimate.sigma));
}

std::string sizes_in_words(const CauseId& cause, const std::vector<ParameterEstimate>& parameters) {
  std::string text;
  for (const ParameterEstimate& estimate : parameters) {
    if (!text.empty()) text += ", ";
    text += in_workshop_units(cause, estimate);
  }
  return text;
}

std::string sized(const CauseId& cause, const std::vector<ParameterEstimate>& parameters) {
  const std::string name = fmt::format("{}{}", cause.effect->cause, side_words(cause));
  return parameters.empty() ? name
                            : fmt::format("{} ({})", name, sizes_in_words(cause, parameters));
}

std::string off_in_words(double residual_mm) {
  return fmt::format("{:.1f} mm too {}", std::abs(residual_mm),
                     residual_mm > 0.0 ? "long" : "short");
}

std::string coordinate_words(std::string_view coordinate) {
  constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"angle_left", "the angle of the left chain"},
      {"angle_right", "the angle of the right chain"},
      {"length_left", "the length of the left chain"},
      {"length_right", "the length of the right chain"},
      {"tension_left", "the tension in the left chain"},
      {"tension_right", "the tension in the right chain"},
      {"order", "the order of the visits"},
      {"x", "the position from left to right"},
      {"y", "the height on the sheet"},
  };
  const auto* own = find_where(kWords, [&](const auto& one) { return one.first == coordinate; });
  return std::string(own != nullptr ? own->second : coordinate);
}

std::string side_words(const CauseId& cause) {
  if (cause.side == EffectSide::both && cause.effect->station == Station::paper)
    return " along both axes";
  // by EffectSide
  return std::string(
      word_of(cause.side, {"", " on the left", " on the right", " equally on both sides",
                           " along x", " along y", " at the top left", " at the top right",
                           " at the bottom left", " at the bottom right", ", all four equally"}));
}

std::string joined(const std::vector<std::string>& parts, std::string_view last,
                   std::string_view between) {
  std::string text;
  for (const auto i : each_index(parts)) {
    if (i > 0) text += i + 1 == parts.size() ? fmt::format(" {} ", last) : std::string(between);
    text += parts[i];
  }
  return text;
}

std::vector<std::string> remedies(const std::vector<Cause>& causes) {
  std::vector<std::string> lines;
  std::vector<std::string_view> said;
  for (const Cause& cause : causes) {
    const std::string_view remedy = cause.cause.effect->remedy;
    if (contains(said, remedy)) continue;
    said.push_back(remedy);
    std::vector<std::string> sides;
    for (const Cause& other : causes) {
      const std::string side = side_words(other.cause);
      if (other.cause.effect->remedy == remedy && !side.empty()) sides.push_back(side.substr(1));
    }
    lines.push_back(sides.size() > 1 ? fmt::format("{}: {}", remedy, joined(sides, "and"))
                                     : std::string(remedy));
  }
  return lines;
}

std::string reading_words(ReadingOf what, std::string_view side) {
  switch (what) {
    case ReadingOf::motor_spacing:
      return "the distance between the motors' axes, with a tape";
    case ReadingOf::beam_rise:
      return "the height of the right motor above the left, with a level";
    case ReadingOf::ring_radius:
      return "from the bit to the end of a chain";
    case ReadingOf::sled_mass:
      return "the sled's weight, on a scale";
    case ReadingOf::chain_mass:
      return "the weight of a metre of chain";
    case ReadingOf::link_pitch:
      return fmt::format("the length of 100 links of the {} chain, pulled taut", side);
    case ReadingOf::tape_error:
      break;
  }
  return fmt::format(
      "the error of the tape or the printed sheet per metre{}: hold a good tape against two metres "
      "of "
      "it",
      side == "x" || side == "y" ? fmt::format(" along {}", side) : "");
}

std::string percent(double probability) {
  const double in_percent = 100.0 * probability;
  if (in_percent > 99.9) return "above 99.9 %";
  if (in_percent < 0.1) return "below 0.1 %";
  return in_percent > 99.0 || in_percent < 1.0 ? fmt::format("{:.1f} %", in_percent)
                                               : fmt::format("{:.0f} %", in_percent);
}

}  // namespace chaintrue::grid::diagnosis
