// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kDegreesOfRadian = 180.0 / std::numbers::pi;

std::string number_words(const ParameterEstimate& own, double factor) {
  constexpr int kMostDigits = 4;
  return own.sigma > 0.0 ? with_sigma(factor * own.value, factor * own.sigma, kMostDigits)
                         : fmt::format("{:.3g}", factor * own.value);
}

/// How a number with a variable's unit is written, and a slope over it.
struct VariableUnit {
  std::string_view unit;  ///< unit_of()
  double factor;
  std::string_view words;
  double slope_factor;
  std::string_view slope_words;
};
constexpr VariableUnit kVariableUnits[] = {
    {"mm", 1.0, "mm", 1000.0, "mm a metre"},
    {"rad", kDegreesOfRadian, "degrees", 1.0 / kDegreesOfRadian, "mm a degree"},
    {"n", 1.0, "N", 1.0, "mm a newton"},
    {"visit", 1.0, "visits", 1.0, "mm a visit"}};

/// Indexed by Enters.
constexpr std::string_view kEntrances[] = {"in the left chain",
                                           "in the right chain",
                                           "in both chains equally",
                                           "in both chains, with opposite signs",
                                           "which moves the tool along x",
                                           "which moves the tool along y",
                                           "",
                                           "which moves the tool in that direction",
                                           "which moves the tool outwards",
                                           "in the top left belt",
                                           "in the top right belt",
                                           "in the bottom left belt",
                                           "in the bottom right belt"};

/// Whether the law's place or period is this value, within two sigmas or `least`.
bool is_near(const Law& law, double value, double least) {
  const ParameterEstimate& own = law.parameters[1];
  return std::abs(own.value - value) < std::max(2.0 * own.sigma, least);
}

/// Whether its period may be a turn of something, if its variable is a chain's or belt's.
bool is_wave_of_length(const Law& law) { return is_periodic(law.shape) && unit_of(law.of) == "mm"; }

}  // namespace

std::string variable_in_words(const Law& law) {
  constexpr std::string_view kVariables[] = {
      "x{anchor}",
      "y{anchor}",
      "the distance{anchor} in the direction {direction:.0f} degrees from x towards y",
      "the distance from the border",
      "the left chain's length",
      "the right chain's length",
      "the left chain's angle below the horizontal",
      "the right chain's angle below the horizontal",
      "the tension in the left chain",
      "the tension in the right chain",
      "the number of the visit",
      "the top left belt's length",
      "the top right belt's length",
      "the bottom left belt's length",
      "the bottom right belt's length",
      "the top left belt's angle against the horizontal",
      "the top right belt's angle against the horizontal",
      "the bottom left belt's angle against the horizontal",
      "the bottom right belt's angle against the horizontal"};  // by Coordinate
  return fmt::format(fmt::runtime(kVariables[as_size(law.of)]),
                     fmt::arg("anchor", belt_of(law.enters) ? " from the bottom left anchor" : ""),
                     fmt::arg("direction", law.direction_deg));
}

std::string average_in_words(const Law& law, Observations of) {
  const std::string_view what = of == Observations::distances ? "changes a distance"
                                : of == Observations::belts   ? "changes that belt's length"
                                                              : "moves the tool";
  return fmt::format("{} by {:.2f} mm", what, law.rms_mm);
}

std::string in_words(const Law& law) {
  constexpr std::string_view kSentences[] = {
      "{slope} {per} in proportion to {variable}, {entrance}",
      "a parabola over {variable} about {at} {unit}, {size} mm high half a bed away, {entrance}",
      "a step of {size} mm at {variable} = {at} {unit}, {entrance}",
      "{slope} {per} {side} {variable} = {at} {unit}, {entrance}",
      "{size} mm at {variable} = {end}, falling to a third within {at} {unit}, {entrance}",
      "a wave of {size} mm over {variable} with period {at} {unit}, {entrance}",
      "a wave of {size} mm over {variable} with period {at} {unit} and its second harmonic of "
      "{second} mm, {entrance}"};
  const VariableUnit& unit =
      *find_where(kVariableUnits, having(&VariableUnit::unit, unit_of(law.of)));
  const auto words_of = [&](std::size_t k, double factor) {
    return k < law.parameters.size() ? number_words(law.parameters[k], factor) : "";
  };
  return fmt::format(fmt::runtime(kSentences[as_size(law.shape)]),
                     fmt::arg("size", words_of(0, 1.0)), fmt::arg("second", words_of(3, 1.0)),
                     fmt::arg("slope", words_of(0, unit.slope_factor / law.span())),
                     fmt::arg("per", unit.slope_words), fmt::arg("at", words_of(1, unit.factor)),
                     fmt::arg("unit", unit.words),
                     fmt::arg("side", law.towards > 0 ? "beyond" : "below"),
                     fmt::arg("end", law.towards > 0 ? "largest" : "least"),
                     fmt::arg("variable", variable_in_words(law)),
                     fmt::arg("entrance", kEntrances[as_size(law.enters)]));
}

std::string given_law_words(const Diagnosis& d) {
  std::vector<std::string> named, gone;
  double sum = 0.0;
  for (const CauseGivenLaw& own : d.unexplained->causes_given_law) {
    std::string cause = sized(own.cause, own.parameters);
    for (const CauseId& same : own.same_as) cause += " or " + sized(same, {});
    if (own.parameters.empty()) {
      gone.push_back(fmt::format("{}: {} instead of {}", cause, percent(own.probability),
                                 percent(own.without_law)));
    } else {
      named.push_back(fmt::format("{}: {}", cause, percent(own.probability)));
      sum += own.probability;
    }
  }
  std::string text;
  // For causes that act together each is more likely than not; of an open set only one acts.
  if (!named.empty()) {
    text += fmt::format(" Given this law, they also name {}.",
                        fmt::join(named, sum > 1.0 ? ", and " : ", or "));
  }
  if (!gone.empty())
    text += fmt::format(" Named only without this law: {}.", fmt::join(gone, "; "));
  return text;
}

std::vector<std::string> hints_of(const Law& law, const BeltMachine& machine) {
  const double turn = machine.belt_turn_mm;
  // Tolerance of a belt's pitch: one per cent.
  if (!is_wave_of_length(law) || !belt_of(law.of) || !is_near(law, turn, 0.01 * turn)) return {};
  return {fmt::format(
      "Its period is near one turn of the motor ({:.3f} mm of belt): is its pulley or its magnet "
      "eccentric?",
      turn)};
}

std::vector<std::string> hints_of(const Law& law, const Machine& machine) {
  std::vector<std::string> hints;
  const double pitch = machine.sprocket.pitch_mm;
  const double turn = machine.sprocket.teeth * pitch;
  // Tolerance of a period: one per cent of a turn or a link.
  const struct {
    double period_mm, least_mm;
    std::string_view hint;
  } periods[] = {
      {turn, 0.01 * turn, "one turn of the sprocket ({:.1f} mm): is it eccentric?"},
      {0.5 * turn, 0.005 * turn, "half a turn of the sprocket ({:.1f} mm): is it out of round?"},
      {pitch, 0.01 * pitch,
       "one link and one tooth ({:.2f} mm): does the chain ride on the teeth?"}};
  if (is_wave_of_length(law) && chain_of(law.of)) {
    const auto* own = find_where(
        periods, [&](const auto& one) { return is_near(law, one.period_mm, one.least_mm); });
    if (own != nullptr) {
      hints.push_back("Its period is near " + fmt::format(fmt::runtime(own->hint), own->period_mm));
    }
  }
  constexpr double kNearMm = 30.0;  // a hand's breadth to either side is the same place
  if (law.of == Coordinate::x && (law.shape == LawShape::step || law.shape == LawShape::kink)) {
    if (is_near(law, 0.0, kNearMm))
      hints.emplace_back("Its place is near the middle of the beam: is something joined there?");
    for (const Side side : kSides) {
      if (is_near(law, machine.motors[side].x_mm, kNearMm))
        hints.push_back(
            fmt::format("Its place is near the {} motor.", side == Side::left ? "left" : "right"));
    }
  }
  if (unit_of(law.of) == "n")
    hints.emplace_back("It follows a chain's tension: something yields under load.");
  return hints;
}

namespace {

using model::effects::ActsOn;
using model::effects::Declaration;
using model::effects::DeclaredParameter;

std::string variable_of(const Law& law, const Bed& bed) {
  constexpr std::string_view kVariables[] = {"x",
                                             "y",
                                             "({cos:.6f} * x + {sin:.6f} * y)",
                                             "min({right} - abs(x), {top} - abs(y))",
                                             "L0",
                                             "L0",
                                             "phi",
                                             "phi",
                                             "T",
                                             "T",
                                             "n"};  // by Coordinate, of chains
  return fmt::format(fmt::runtime(kVariables[as_size(law.of)]),
                     fmt::arg("cos", std::cos(law.direction_rad())),
                     fmt::arg("sin", std::sin(law.direction_rad())),
                     fmt::arg("right", 0.5 * bed.width_mm), fmt::arg("top", 0.5 * bed.height_mm));
}

/// The chain whose value is the law's variable.
bool is_of_other_chain(const Law& law) {
  return chain_of(law.of) && chain_of(law.of) != chain_of(law.enters);
}

/// A number with the variable's unit.
std::string with_unit(const Law& law, double value) {
  const std::string_view unit = unit_of(law.of);
  if (unit == "mm") return fmt::format("({:.6g} * mm)", value);
  if (unit == "n") return fmt::format("({:.6g} * N)", value);
  return fmt::format("{:.6g}", value);
}

DeclaredParameter size_of(const Law& law) {
  const double value = law.parameters.front().value;
  // Range for another session: five times as large, or of the other sign.
  const double bound = std::max(1.0, 5.0 * std::abs(value));
  return {.name = "size_mm",
          .symbol = "a",
          .meaning = "how large it is",
          .null = 0.0,
          .nominal = value,
          // The phase of a wave has its sign.
          .lower = is_periodic(law.shape) ? 0.0 : -bound,
          .upper = bound,
          .prior_sigma = std::max(std::abs(value), 0.05)};
}

DeclaredParameter place_of(const Law& law) {
  if (is_periodic(law.shape)) {
    return {.name = "phase_rad",
            .symbol = "p",
            .meaning = "phase of the wave in the middle of its range",
            .role = ParameterRole::place,
            .nominal = law.parameters[2].value,
            .lower = -6.3,
            .upper = 6.3,
            .prior_sigma = std::numbers::pi};
  }
  return {.name = law.parameters[1].parameter,
          .symbol = "p",
          .meaning = "where it sets in",
          .role = ParameterRole::place,
          .nominal = std::clamp(law.parameters[1].value, law.from, law.to),
          .lower = law.from,
          .upper = law.to,
          .prior_sigma = std::max(law.parameters[1].sigma, 0.01 * law.span())};
}

/// The parameters size_mm and, if there is one, the place.
std::string formula_of(const Law& law, const Bed& bed) {
  const std::string v = variable_of(law, bed);
  const std::string over_span = with_unit(law, law.span());
  const std::string place = fmt::format("place_{}", unit_of(law.of));
  switch (law.shape) {
    case LawShape::linear:
      return fmt::format("size_mm * ({} - {:.6g}) / {}", v, law.middle(), over_span);
    case LawShape::square:
      return fmt::format("size_mm * (({} - {:.6g}) / {})^2", v, law.parameters[1].value,
                         with_unit(law, 0.5 * law.span()));
    case LawShape::step:
      return fmt::format("size_mm * step({} - {})", v, place);
    case LawShape::kink:
      return law.towards > 0 ? fmt::format("size_mm * ramp({} - {}) / {}", v, place, over_span)
                             : fmt::format("size_mm * ramp({} - {}) / {}", place, v, over_span);
    case LawShape::exponential: {
      const std::string scale = with_unit(law, law.parameters[1].value);
      return law.towards > 0 ? fmt::format("size_mm * exp(({} - {:.6g}) / {})", v, law.to, scale)
                             : fmt::format("size_mm * exp(({:.6g} - {}) / {})", law.from, v, scale);
    }
    case LawShape::wave:
    case LawShape::harmonics:
      break;
  }
  const std::string turn = fmt::format("2 * pi * ({} - {:.6g}) / {}", v, law.middle(),
                                       with_unit(law, law.parameters[1].value));
  if (law.shape == LawShape::wave) return fmt::format("size_mm * sin({} + phase_rad)", turn);
  // The shape of one period is kept: the harmonic scales and shifts with the wave.
  const double ratio = law.parameters[3].value / law.parameters[0].value;
  const double behind = std::remainder(law.parameters[4].value - 2.0 * law.parameters[2].value,
                                       2.0 * std::numbers::pi);
  return fmt::format(
      "size_mm * (sin({} + phase_rad) + {:.6g} * sin(2 * ({} + phase_rad) + {:.6f}))", turn, ratio,
      turn, behind);
}

/// A factor: what a millimetre of the law adds to either chain; empty if it enters the chain
/// directly.
std::string entrance_of(const Law& law) {
  switch (law.enters) {
    case Enters::x:
      return "side * cos(phi) * ";
    case Enters::y:
      return "-sin(phi) * ";
    case Enters::along:
      return fmt::format("({:.6f} * side * cos(phi) - {:.6f} * sin(phi)) * ",
                         std::cos(law.direction_rad()), std::sin(law.direction_rad()));
    default:
      return "";
  }
}

std::string refusal_of(const Law& law) {
  if (belt_of(law.enters)) return "a declared cause acts on chains, but this law acts on a belt";
  if (is_of_other_chain(law)) {
    const bool moves = law.enters == Enters::x || law.enters == Enters::y;
    return fmt::format("a chain's formula uses only that chain, but this law {}",
                       moves ? "moves the tool" : "acts elsewhere");
  }
  if (law.enters == Enters::outwards) {
    return "a law that moves the tool outwards moves it along x by one distance and along y by "
           "another, which no formula of a chain can express";
  }
  return "";
}

}  // namespace

tl::expected<Declaration, std::string> declaration_of(const Law& law, const Bed& bed) {
  if (const std::string why = refusal_of(law); !why.empty()) {
    return tl::unexpected(
        fmt::format("The law found ({}) cannot be written to a file: {}.", in_words(law), why));
  }
  Declaration own;
  own.id = fmt::format("{}_of_{}", name(law.shape), name(law.of));
  own.acts_on = law.of == Coordinate::visit ? ActsOn::reading : ActsOn::chain;
  const auto chain = chain_of(law.enters);
  own.sides = {!chain                 ? EffectSide::both
               : *chain == Side::left ? EffectSide::left
                                      : EffectSide::right};
  own.parameters = {size_of(law)};
  const bool has_place =
      law.shape == LawShape::step || law.shape == LawShape::kink || is_periodic(law.shape);
  if (has_place) own.parameters.push_back(place_of(law));
  own.adds_mm = entrance_of(law) + formula_of(law, bed);
  own.cause =
      fmt::format("a cause without a name, {} over {}",
                  word_of(law.shape, {"a slope", "a bow", "a step", "a kink", "an exponential",
                                      "a wave", "a wave with its second harmonic"}),
                  variable_in_words(law));
  own.signature = in_words(law);
  own.remedy = "find what has this place or period, and give it a name here";
  own.not_modelled = "deviations from this form";
  own.typical = fmt::format("{:.2g} mm", std::abs(law.parameters.front().value));
  own.source = fmt::format("a diagnosis: probability {}", percent(law.probability));
  return own;
}

tl::expected<Declaration, std::string> declaration_of(const std::vector<Law>& laws,
                                                      const Bed& bed) {
  if (laws.empty()) {
    return tl::unexpected(
        std::string("No law is written: for these readings no law is more likely than none."));
  }
  const Law& first = laws.front();
  if (first.probability < kLawClaimed) {
    return tl::unexpected(
        fmt::format("No law is written: the likeliest, {}, has a probability of {}, and {} is "
                    "needed. Measure more points.",
                    in_words(first), percent(first.probability), percent(kLawClaimed)));
  }
  return declaration_of(first, bed);
}

}  // namespace chaintrue::grid::diagnosis
