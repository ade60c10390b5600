// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_declaration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::ActsOn;
using model::effects::Declaration;
using model::effects::DeclaredParameter;
using model::effects::EffectSide;
using model::effects::ParameterRole;

std::string variable_of(const Law& law, const model::Bed& bed) {
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
  const double direction = law.direction_deg * std::numbers::pi / 180.0;
  return fmt::format(fmt::runtime(kVariables[static_cast<std::size_t>(law.of)]),
                     fmt::arg("cos", std::cos(direction)), fmt::arg("sin", std::sin(direction)),
                     fmt::arg("right", 0.5 * bed.width_mm), fmt::arg("top", 0.5 * bed.height_mm));
}

/// The chain whose value is the law's variable.
bool is_of_other_chain(const Law& law) {
  const auto chain = chain_of(law.of);
  return chain && law.enters != (*chain == model::Side::left ? Enters::left : Enters::right);
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
          .prior_sigma = std::max(law.parameters[1].sigma, 0.01 * (law.to - law.from))};
}

/// The parameters size_mm and, if there is one, the place.
std::string formula_of(const Law& law, const model::Bed& bed) {
  const std::string v = variable_of(law, bed);
  const double span = law.to - law.from;
  const std::string over_span = with_unit(law, span);
  const std::string place = fmt::format("place_{}", unit_of(law.of));
  switch (law.shape) {
    case LawShape::linear:
      return fmt::format("size_mm * ({} - {:.6g}) / {}", v, 0.5 * (law.from + law.to), over_span);
    case LawShape::square:
      return fmt::format("size_mm * (({} - {:.6g}) / {})^2", v, law.parameters[1].value,
                         with_unit(law, 0.5 * span));
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
  const std::string turn = fmt::format("2 * pi * ({} - {:.6g}) / {}", v, 0.5 * (law.from + law.to),
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
    case Enters::along: {
      const double direction = law.direction_deg * std::numbers::pi / 180.0;
      return fmt::format("({:.6f} * side * cos(phi) - {:.6f} * sin(phi)) * ", std::cos(direction),
                         std::sin(direction));
    }
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

tl::expected<Declaration, std::string> declaration_of(const Law& law, const model::Bed& bed) {
  if (const std::string why = refusal_of(law); !why.empty()) {
    return tl::unexpected(
        fmt::format("The law found ({}) cannot be written to a file: {}.", in_words(law), why));
  }
  Declaration own;
  own.id = fmt::format("{}_of_{}", name(law.shape), name(law.of));
  own.acts_on = law.of == Coordinate::visit ? ActsOn::reading : ActsOn::chain;
  own.sides = {law.enters == Enters::left    ? EffectSide::left
               : law.enters == Enters::right ? EffectSide::right
                                             : EffectSide::both};
  own.parameters = {size_of(law)};
  const bool has_place =
      law.shape == LawShape::step || law.shape == LawShape::kink || is_periodic(law.shape);
  if (has_place) own.parameters.push_back(place_of(law));
  own.adds_mm = entrance_of(law) + formula_of(law, bed);
  own.cause = fmt::format("a cause without a name, {}", form_in_words(law));
  own.signature = in_words(law);
  own.remedy = "find what has this place or period, and give it a name here";
  own.not_modelled = "deviations from this form";
  own.typical = fmt::format("{:.2g} mm", std::abs(law.parameters.front().value));
  own.source = fmt::format("a diagnosis: probability {}", percent(law.probability));
  return own;
}

tl::expected<Declaration, std::string> declaration_of(const std::vector<Law>& laws,
                                                      const model::Bed& bed) {
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
