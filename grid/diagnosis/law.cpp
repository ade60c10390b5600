// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/precondition.hpp"

namespace chaintrue::grid::diagnosis {

std::optional<model::Belt> belt_of(Enters enters) {
  if (enters < Enters::tl) return std::nullopt;
  return static_cast<model::Belt>(static_cast<int>(enters) - static_cast<int>(Enters::tl));
}

std::string_view name(LawShape shape) {
  constexpr std::string_view kNames[] = {"linear",      "square", "step",     "kink",
                                         "exponential", "wave",   "harmonics"};
  return kNames[static_cast<std::size_t>(shape)];
}

bool is_periodic(LawShape shape) { return shape == LawShape::wave || shape == LawShape::harmonics; }

std::size_t parameter_count(LawShape shape) {
  constexpr std::size_t kCounts[] = {1, 2, 2, 2, 2, 3, 5};  // by LawShape
  return kCounts[static_cast<std::size_t>(shape)];
}

double value_of(const Law& law, double v) {
  const std::size_t count = parameter_count(law.shape);
  if (law.parameters.size() != count) {
    throw precondition("a law of shape {} with {} parameters", name(law.shape),
                       law.parameters.size());
  }
  const double size = law.parameters.front().value;
  const double second = count > 1 ? law.parameters[1].value : 0.0;
  const double span = law.to - law.from;
  const double middle = 0.5 * (law.from + law.to);
  switch (law.shape) {
    case LawShape::linear:
      return size * (v - middle) / span;
    case LawShape::square:
      return size * std::pow((v - second) / (0.5 * span), 2);
    case LawShape::step:
      return v >= second ? size : 0.0;
    case LawShape::kink:
      return size * std::max(0.0, law.towards * (v - second)) / span;
    case LawShape::exponential:
      return size * std::exp(-(law.towards > 0 ? law.to - v : v - law.from) / second);
    case LawShape::wave:
    case LawShape::harmonics:
      break;
  }
  const double turn = 2.0 * std::numbers::pi * (v - middle) / second;
  const double first = size * std::sin(turn + law.parameters[2].value);
  if (law.shape == LawShape::wave) return first;
  return first + law.parameters[3].value * std::sin(2.0 * turn + law.parameters[4].value);
}

}  // namespace chaintrue::grid::diagnosis
