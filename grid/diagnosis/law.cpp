// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_curves.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/containers.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

struct Described {
  std::string_view name;
  std::string_view unit = "mm";
  std::optional<Side> chain{};
  std::optional<Belt> belt{};
};

/// Indexed by Coordinate.
constexpr Described kDescribed[] = {{"x"},
                                    {"y"},
                                    {"across"},
                                    {"border"},
                                    {"length_left", "mm", Side::left},
                                    {"length_right", "mm", Side::right},
                                    {"angle_left", "rad", Side::left},
                                    {"angle_right", "rad", Side::right},
                                    {"tension_left", "n", Side::left},
                                    {"tension_right", "n", Side::right},
                                    {"visit", "visit"},
                                    {"length_tl", "mm", {}, Belt::tl},
                                    {"length_tr", "mm", {}, Belt::tr},
                                    {"length_bl", "mm", {}, Belt::bl},
                                    {"length_br", "mm", {}, Belt::br},
                                    {"angle_tl", "rad", {}, Belt::tl},
                                    {"angle_tr", "rad", {}, Belt::tr},
                                    {"angle_bl", "rad", {}, Belt::bl},
                                    {"angle_br", "rad", {}, Belt::br},
                                    {"place"}};

const Described& described(Coordinate of) { return kDescribed[as_size(of)]; }

}  // namespace

std::string_view name(Coordinate of) { return described(of).name; }
std::string_view unit_of(Coordinate of) { return described(of).unit; }
std::optional<Side> chain_of(Coordinate of) { return described(of).chain; }
std::optional<Belt> belt_of(Coordinate of) { return described(of).belt; }

double value_at(const SystemPlace& place, Coordinate of, double across_rad) {
  const model::Pose& pose = place.state.reading.pose;
  if (const auto side = chain_of(of)) {
    const std::string_view unit = unit_of(of);
    return unit == "mm"    ? pose.lengths[*side]
           : unit == "rad" ? pose.chains[*side].angle_rad
                           : pose.chains[*side].tension_at_sprocket_n;
  }
  if (const auto belt = belt_of(of)) {
    const auto& values = unit_of(of) == "mm" ? place.length_mm : place.angle_rad;
    return values[as_size(*belt)];
  }
  switch (of) {
    case Coordinate::x:
      return place.mark.x_mm;
    case Coordinate::y:
      return place.mark.y_mm;
    case Coordinate::across:
      return place.mark.x_mm * std::cos(across_rad) + place.mark.y_mm * std::sin(across_rad);
    case Coordinate::border:
      return std::min(0.5 * place.bed.width_mm - std::abs(place.mark.x_mm),
                      0.5 * place.bed.height_mm - std::abs(place.mark.y_mm));
    default:
      return place.order;
  }
}

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

std::optional<Side> chain_of(Enters enters) {
  if (enters > Enters::right) return std::nullopt;
  return enters == Enters::left ? Side::left : Side::right;
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
  const auto value = [&](std::size_t k) { return law.parameters[k].value; };
  if (law.shape == LawShape::square)
    return value(0) * std::pow((v - value(1)) / (0.5 * law.span()), 2);
  const double second = law.parameters.size() > 1 ? value(1) : 0.0;
  if (!is_periodic(law.shape)) return value(0) * basis_at(law, second, 0, v);
  const auto wave = [&](double size, double phase, Index column) {
    const double at = law.span() / second;
    return size * (std::sin(phase) * basis_at(law, at, column, v) +
                   std::cos(phase) * basis_at(law, at, column + 1, v));
  };
  const double first = wave(value(0), value(2), 0);
  return law.shape == LawShape::wave ? first : first + wave(value(3), value(4), 2);
}

}  // namespace chaintrue::grid::diagnosis
