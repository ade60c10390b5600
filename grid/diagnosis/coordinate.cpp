// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/coordinate.hpp"

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/regressor_system.hpp"

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

}  // namespace chaintrue::grid::diagnosis
