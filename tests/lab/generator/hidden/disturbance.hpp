// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What disturbs a machine and is in no catalogue: a function of the place, of the chains' angles and of
/// their lengths, that moves the tool or adds to the readings.
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "generator/hidden/effects.hpp"

namespace chaintrue::generator {

/// The tool's position, and the chains' or belts' angles and lengths there.
struct Site {
  Vec2 place;
  std::array<double, 4> angle_rad{};
  std::array<double, 4> length_mm{};
};

std::vector<Site> sites_of(std::span<const Visit> visits, const std::vector<Rest>& at_rest);

/// One number at each site.
using Field = std::function<double(const Site&)>;

struct Disturbance {
  bool moves_tool = false;
  /// The tool's shift off its mark; else what is added to the left chain (x) and to the right one (y).
  std::function<Vec2(const Site&)> at;
};

}  // namespace chaintrue::generator
