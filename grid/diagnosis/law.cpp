// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct DescribedShape {
  std::string_view name;
  std::string_view second;  ///< of its parameters, without the unit
  std::size_t parameters;
};

/// Indexed by LawShape.
constexpr DescribedShape kShapes[] = {{"linear", "", 1},           {"square", "place", 2},
                                      {"step", "place", 2},        {"kink", "place", 2},
                                      {"exponential", "scale", 2}, {"wave", "period", 3},
                                      {"harmonics", "period", 5}};

const DescribedShape& described_shape(LawShape shape) { return kShapes[as_size(shape)]; }

}  // namespace

std::optional<Belt> belt_of(Enters enters) {
  if (enters < Enters::tl) return std::nullopt;
  return static_cast<Belt>(as_int(enters) - as_int(Enters::tl));
}

std::string_view name(LawShape shape) { return described_shape(shape).name; }

bool is_periodic(LawShape shape) { return shape >= LawShape::wave; }

std::vector<std::string> parameter_names(LawShape shape, Coordinate of) {
  const DescribedShape& own = described_shape(shape);
  std::vector<std::string> names = {"size_mm", fmt::format("{}_{}", own.second, unit_of(of)),
                                    "phase_rad", "second_size_mm", "second_phase_rad"};
  names.resize(own.parameters);
  return names;
}

double value_of(const Law& law, double v) {
  if (law.parameters.size() != described_shape(law.shape).parameters) {
    throw precondition("a law of shape {} with {} parameters", name(law.shape),
                       law.parameters.size());
  }
  const double size = law.parameters.front().value;
  const double second = law.parameters.size() > 1 ? law.parameters[1].value : 0.0;
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
