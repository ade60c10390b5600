// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The building blocks of tables of effects: sets of sides, parameters, and the laws that all
/// mechanisms share.
///
/// \code
///   .parameters = {whole(size("links", "k", "whole links too many", 1.0, -20.0, 20.0)), first_visit()},
///   .add = teeth_skipped,
/// \endcode
#pragma once

#include <string_view>

#include "model/effects/effect.hpp"

namespace chaintrue::model::effects {

inline constexpr EffectSide kOneChain[] = {EffectSide::left, EffectSide::right};
inline constexpr EffectSide kAnyChain[] = {EffectSide::left, EffectSide::right, EffectSide::both};
inline constexpr EffectSide kPaperAxes[] = {EffectSide::x, EffectSide::y, EffectSide::both};
inline constexpr EffectSide kOneBelt[] = {EffectSide::tl, EffectSide::tr, EffectSide::bl,
                                          EffectSide::br};
inline constexpr EffectSide kOneBeltOrAll[] = {EffectSide::tl, EffectSide::tr, EffectSide::bl,
                                               EffectSide::br, EffectSide::all};

/// A size that vanishes at 0. Its usual spread is its usual size unless stated.
constexpr EffectParameter size(std::string_view name, std::string_view symbol,
                               std::string_view meaning, double usual, double lower, double upper,
                               double prior_sigma = 0.0) {
  if (prior_sigma == 0.0) prior_sigma = usual < 0.0 ? -usual : usual;
  return {.name = name,
          .symbol = symbol,
          .meaning = meaning,
          .nominal = usual,
          .lower = lower,
          .upper = upper,
          .prior_sigma = prior_sigma};
}
constexpr EffectParameter place(std::string_view name, std::string_view symbol,
                                std::string_view meaning, double nominal, double lower,
                                double upper, double prior_sigma) {
  EffectParameter parameter = size(name, symbol, meaning, nominal, lower, upper, prior_sigma);
  parameter.role = ParameterRole::place;
  parameter.null = nominal;
  return parameter;
}
constexpr EffectParameter whole(EffectParameter parameter) {
  parameter.integer = true;
  return parameter;
}
constexpr EffectParameter mirrored(EffectParameter parameter) {
  parameter.mirror_sign = -1.0;
  return parameter;
}

/// The number of a visit; ten is a placeholder.
constexpr EffectParameter visit(std::string_view name, std::string_view meaning) {
  return whole(place(name, "m", meaning, 10.0, 0.0, 1e6, 10.0));
}
constexpr EffectParameter first_visit(
    std::string_view meaning = "number of the first visit at which it acts") {
  return visit("first_visit", meaning);
}

/// p k for n >= m: values k, m; p a tooth.
inline Number teeth_skipped(const LengthState& length, Values values) {
  return length.order >= values[1] ? length.tooth_mm * values[0] : 0.0;
}
/// z for n >= m: values z, m.
inline Number zero_shifted(const LengthState& length, Values values) {
  return length.order >= values[1] ? values[0] : 0.0;
}
/// d n.
inline Number drifted(const LengthState& length, Values values) { return values[0] * length.order; }

}  // namespace chaintrue::model::effects
