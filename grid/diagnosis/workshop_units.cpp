// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/workshop_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "grid/containers.hpp"
#include "model/belts/belt_effects.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct Unit {
  std::string_view parameter;
  double factor;
  std::string_view words;  ///< {} the number
  /// For a negative value, {} its absolute value; empty if `words` show the sign.
  std::string_view negative{};
  std::string_view one{};  ///< for 1 and -1, if a noun is counted
};

constexpr double kDegrees = 180.0 / std::numbers::pi;

constexpr std::array kUnits = {
    Unit{"scale", 100.0, "{} %"},
    Unit{"elongation", 100.0, "links {} % longer", "links {} % shorter"},
    Unit{"angle_rad", 1000.0, "{} mm per metre"},
    Unit{"relative_weight", 100.0, "{} % heavier", "{} % lighter"},
    Unit{"compliance_per_n", 1e6, "{} millionths per newton"},
    Unit{"flexibility_mm_per_n", 1.0, "{} mm per newton"},
    Unit{"force_n", 1.0, "{} N to the right", "{} N to the left"},
    Unit{"offset_mm", 1.0, "radius {} mm larger", "radius {} mm smaller"},
    Unit{"slope_mm_per_rad", 1.0 / kDegrees, "{} mm per degree"},
    Unit{"knee_rad",
         kDegrees,
         "sets in at {} degrees below the horizontal",
         "sets in at {} degrees above the horizontal"},
    Unit{"phase_rad", kDegrees, "phase {} degrees"},
    Unit{"rate_mm_per_visit", 1.0, "{} mm per visit"},
    Unit{"links", 1.0, "{} links", "", "{} link"},
    Unit{"shift_mm", 1.0, "{} mm too much read", "{} mm too little read"},
    Unit{"first_visit", 1.0, "from visit {} on"},
    Unit{"visit", 1.0, "at visit {}"},
    Unit{"amplitude_mm", 1.0, "{} mm"},
    Unit{"half_width_mm", 1.0, "{} mm to either side"},
    Unit{"distance_mm", 1.0, "{} mm"},
};

/// Parameters with their own words; `effect` empty: any effect.
struct UnitOfEffect {
  std::string_view effect;
  Unit unit;
};

constexpr std::array kSledUnits = {
    UnitOfEffect{"sled_width", {"offset_mm", 1.0, "{} mm wider", "{} mm narrower"}},
    UnitOfEffect{"sled_height", {"offset_mm", 1.0, "{} mm higher", "{} mm lower"}},
    UnitOfEffect{"sled_cg", {"offset_mm", 1.0, "{} mm lower", "{} mm higher"}},
};

constexpr std::array kBeltUnits = {
    UnitOfEffect{"belt_stretch",
             {"elongation", 100.0, "{} % longer when pulled", "{} % shorter when pulled"}},
    UnitOfEffect{"belt_scale", {"scale", 100.0, "{} % more belt per turn", "{} % less belt per turn"}},
    UnitOfEffect{"belt_zero", {"offset_mm", 1.0, "{} mm too much read", "{} mm too little read"}},
    UnitOfEffect{"anchor_height", {"offset_mm", 1.0, "{} mm higher", "{} mm lower"}},
    UnitOfEffect{"", {"give_mm", 1.0, "{} mm when pulled"}},
    UnitOfEffect{"", {"teeth", 1.0, "{} teeth", "", "{} tooth"}},
    UnitOfEffect{"", {"direction_rad", kDegrees, "{} degrees from x towards y"}},
};

constexpr std::array kCordUnits = {
    UnitOfEffect{"pen_off_centre",
                 {"offset_mm", 1.0, "{} mm to the right", "{} mm to the left"}},
    UnitOfEffect{"servo_arm", {"offset_mm", 1.0, "{} mm to the right", "{} mm to the left"}},
    UnitOfEffect{"gondola_width", {"offset_mm", 1.0, "{} mm wider", "{} mm narrower"}},
    UnitOfEffect{"standoff",
                 {"offset_mm", 1.0, "{} mm farther from the wall", "{} mm closer to the wall"}},
    UnitOfEffect{"gondola_mass", {"relative", 100.0, "{} % heavier", "{} % lighter"}},
    UnitOfEffect{"cord_weight",
                 {"more_g_per_m", 1.0, "{} g per metre heavier", "{} g per metre lighter"}},
    UnitOfEffect{"pen_friction", {"force_n", 1.0, "{} N"}},
    UnitOfEffect{"spool_layers", {"growth_mm_per_m2", 1.0, "growth {} mm per square metre"}},
    UnitOfEffect{"", {"teeth", 1.0, "{} teeth", "", "{} tooth"}},
};

/// Rounded to two digits.
double two_digits(double value) {
  if (value == 0.0) return 0.0;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1.0);
  return step * std::round(value / step);
}

/// Rounded to the sigma's first two digits; a value without a sigma to its own first two digits.
std::string with_sigma(double value, double sigma) {
  if (!(sigma > 0.0)) return fmt::format("{:g}", two_digits(value));
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 6);
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, sigma, digits);
}

}  // namespace

namespace {

std::string worded(const Unit& unit, const ParameterEstimate& estimate) {
  const bool whole = unit.parameter == "links" || unit.parameter == "teeth" ||
                     (unit.parameter.ends_with("visit") && !unit.parameter.starts_with("rate"));
  const bool reversed = estimate.value < 0.0 && !unit.negative.empty();
  const double value = reversed ? -estimate.value : estimate.value;
  const std::string number = whole ? fmt::format("{:g}", value)
                                   : with_sigma(unit.factor * value, unit.factor * estimate.sigma);
  const bool is_one = !unit.one.empty() && std::abs(value) == 1.0;
  return fmt::format(fmt::runtime(reversed ? unit.negative
                                  : is_one ? unit.one
                                           : unit.words),
                     number);
}

}  // namespace

NameAndUnit parameter_words(std::string_view parameter) {
  std::size_t at = std::string_view::npos;
  for (const std::string_view unit : {"_mm", "_rad"}) at = std::min(at, parameter.find(unit));
  NameAndUnit words{std::string(parameter.substr(0, at)),
                    at == std::string_view::npos ? "" : std::string(parameter.substr(at + 1))};
  for (std::string* text : {&words.name, &words.unit})
    std::replace(text->begin(), text->end(), '_', ' ');
  return words;
}

std::string in_workshop_units(const ParameterEstimate& estimate) {
  for (const Unit& unit : kUnits) {
    if (unit.parameter == estimate.parameter) return worded(unit, estimate);
  }
  return fmt::format("{} = {}", estimate.parameter, with_sigma(estimate.value, estimate.sigma));
}

std::string in_workshop_units(const CauseId& cause, const ParameterEstimate& estimate) {
  // The meaning of a declared effect's parameter is known only to its author.
  if (cause.effect->law != nullptr)
    return fmt::format("{} = {}", estimate.parameter, with_sigma(estimate.value, estimate.sigma));
  std::span<const UnitOfEffect> of_mechanism = kSledUnits;
  if (contains(model::belts::belt_effects(), cause.effect)) of_mechanism = kBeltUnits;
  if (contains(model::plotter::plotter_effects(), cause.effect)) of_mechanism = kCordUnits;
  for (const UnitOfEffect& own : of_mechanism) {
    const bool fits = own.effect.empty() || own.effect == cause.effect->id;
    if (fits && own.unit.parameter == estimate.parameter) return worded(own.unit, estimate);
  }
  return in_workshop_units(estimate);
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
  return fmt::format(
      "{:.1f} mm too {}", std::abs(residual_mm), residual_mm > 0.0 ? "long" : "short");
}

std::string coordinate_words(std::string_view coordinate) {
  struct Words {
    std::string_view name;
    std::string_view words;
  };
  constexpr std::array kWords = {
      Words{"angle_left", "the angle of the left chain"},
      Words{"angle_right", "the angle of the right chain"},
      Words{"length_left", "the length of the left chain"},
      Words{"length_right", "the length of the right chain"},
      Words{"tension_left", "the tension in the left chain"},
      Words{"tension_right", "the tension in the right chain"},
      Words{"order", "the order of the visits"},
      Words{"x", "the position from left to right"},
      Words{"y", "the height on the sheet"},
  };
  for (const Words& w : kWords) {
    if (w.name == coordinate) return std::string(w.words);
  }
  return std::string(coordinate);
}

std::string side_words(const CauseId& cause) {
  using model::effects::EffectSide;
  switch (cause.side) {
    case EffectSide::left:
      return " on the left";
    case EffectSide::right:
      return " on the right";
    case EffectSide::both:
      return cause.effect->station == model::effects::Station::paper ? " along both axes"
                                                                     : " equally on both sides";
    case EffectSide::x:
      return " along x";
    case EffectSide::y:
      return " along y";
    case EffectSide::tl:
      return " at the top left";
    case EffectSide::tr:
      return " at the top right";
    case EffectSide::bl:
      return " at the bottom left";
    case EffectSide::br:
      return " at the bottom right";
    case EffectSide::all:
      return ", all four equally";
    case EffectSide::none:
      break;
  }
  return "";
}

std::string joined(const std::vector<std::string>& parts,
                   std::string_view last,
                   std::string_view between) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
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
  if (what == ReadingOf::motor_spacing) return "the distance between the motors' axes, with a tape";
  if (what == ReadingOf::beam_rise)
    return "the height of the right motor above the left, with a level";
  if (what == ReadingOf::ring_radius) return "from the bit to the end of a chain";
  if (what == ReadingOf::sled_mass) return "the sled's weight, on a scale";
  if (what == ReadingOf::chain_mass) return "the weight of a metre of chain";
  if (what == ReadingOf::tape_error) {
    return fmt::format(
        "the error of the tape or the printed sheet per metre{}: hold a good tape "
        "against "
        "two metres of it",
        side == "x" || side == "y" ? fmt::format(" along {}", side) : "");
  }
  return fmt::format("the length of 100 links of the {} chain, pulled taut", side);
}

std::string percent(double probability) {
  const double in_percent = 100.0 * probability;
  if (in_percent > 99.9) return "above 99.9 %";
  if (in_percent < 0.1) return "below 0.1 %";
  return in_percent > 99.0 || in_percent < 1.0 ? fmt::format("{:.1f} %", in_percent)
                                               : fmt::format("{:.0f} %", in_percent);
}

}  // namespace chaintrue::grid::diagnosis
