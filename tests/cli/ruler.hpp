// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings of a test drawing that a hidden plotter drew.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "generator/hidden/plotter.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::testing_support {

/// Where the pen comes to rest for a command in the frame of the pins.
using PenOf = std::function<generator::PenAtRest(double x_mm, double y_mm)>;

/// The drawing with every null filled in, to a tenth of a millimetre.
inline nlohmann::ordered_json ruled(nlohmann::ordered_json drawing, const PenOf& pen,
                                    double noise_mm, std::uint64_t seed) {
  generator::Dice dice(seed, "ruler");
  const auto at = [&](const std::string& name) {
    for (const auto& cross : drawing.at("crosses")) {
      if (cross.at("name") == name) return pen(cross.at("x_mm"), cross.at("y_mm"));
    }
    throw std::logic_error("no cross " + name);
  };
  for (auto& measure : drawing.at("measures")) {
    const auto a = at(measure.at("from")), b = at(measure.at("to"));
    const double length = std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm);
    double true_mm = length;
    if (measure.at("kind") == "bow") {
      const auto m = at(measure.at("middle"));
      true_mm =
          ((b.x_mm - a.x_mm) * (m.y_mm - a.y_mm) - (b.y_mm - a.y_mm) * (m.x_mm - a.x_mm)) / length;
    }
    measure["value_mm"] = std::round(10.0 * (true_mm + noise_mm * dice.normal())) / 10.0;
  }
  return drawing;
}

}  // namespace chaintrue::testing_support
