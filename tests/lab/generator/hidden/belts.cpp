// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/belts.hpp"

#include <cmath>
#include <stdexcept>

#include "generator/hidden/random.hpp"

namespace chaintrue::generator {
namespace {

/// A belt from its anchor to a sled at (x, y).
struct Spring {
  double span = 0.0;   ///< level, to the tool
  double level = 0.0;  ///< level part of the belt
  double slant = 0.0;  ///< the belt
  double ux = 0.0;     ///< level way to the anchor
  double uy = 0.0;
};

Spring spring_to(const BeltFrame& frame, std::size_t i, double x, double y) {
  const auto& a = frame.anchors[i];
  Spring s;
  s.span = std::hypot(a[0] - x, a[1] - y);
  s.level = s.span - frame.reach_mm;
  s.slant = std::hypot(s.level, a[2]);
  s.ux = (a[0] - x) / s.span;
  s.uy = (a[1] - y) / s.span;
  return s;
}

struct Force {
  double x = 0.0;
  double y = 0.0;
};

double tension(const BeltFrame& frame, double slant, double unstretched) {
  return frame.stiffness_n * std::max(0.0, slant / unstretched - 1.0);
}

Force force_at(const BeltFrame& frame, const std::array<bool, 4>& is_pulled,
               const FourLengths& held_mm, const FourLengths& pulls_n, double x, double y) {
  Force force{0.0, -frame.weight_n};
  for (std::size_t i = 0; i < 4; ++i) {
    const Spring s = spring_to(frame, i, x, y);
    const double pull = is_pulled[i] ? pulls_n[i] : tension(frame, s.slant, held_mm[i]);
    force.x += pull * s.level / s.slant * s.ux;
    force.y += pull * s.level / s.slant * s.uy;
  }
  return force;
}

}  // namespace

SledAtRest rest_on_belts(const BeltFrame& frame, const std::array<bool, 4>& is_pulled,
                         const FourLengths& held_mm, const FourLengths& pulls_n, double near_x_mm,
                         double near_y_mm) {
  SledAtRest rest{near_x_mm, near_y_mm, {}, {}, 0.0};
  const auto force = [&](double x, double y) {
    return force_at(frame, is_pulled, held_mm, pulls_n, x, y);
  };
  for (int turn = 0; turn < 200; ++turn) {
    const Force now = force(rest.x_mm, rest.y_mm);
    rest.left_over_n = std::hypot(now.x, now.y);
    if (rest.left_over_n < 1e-7) break;
    // Newton with differences; a step is at most 5 mm, because belts go slack suddenly.
    constexpr double h = 1e-4;
    const Force right = force(rest.x_mm + h, rest.y_mm);
    const Force up = force(rest.x_mm, rest.y_mm + h);
    const double a = (right.x - now.x) / h;
    const double b = (up.x - now.x) / h;
    const double c = (right.y - now.y) / h;
    const double d = (up.y - now.y) / h;
    const double determinant = a * d - b * c;
    double dx = now.x;
    double dy = now.y;
    if (determinant != 0.0) {
      dx = -(d * now.x - b * now.y) / determinant;
      dy = -(a * now.y - c * now.x) / determinant;
    }
    const double size = std::hypot(dx, dy);
    const double share = size > 5.0 ? 5.0 / size : 1.0;
    rest.x_mm += share * dx;
    rest.y_mm += share * dy;
  }
  if (rest.left_over_n > 1e-4)
    throw std::runtime_error("a sled on four belts does not come to rest");
  for (std::size_t i = 0; i < 4; ++i) {
    const Spring s = spring_to(frame, i, rest.x_mm, rest.y_mm);
    rest.tension_n[i] = is_pulled[i] ? pulls_n[i] : tension(frame, s.slant, held_mm[i]);
    rest.length_mm[i] =
        is_pulled[i] ? s.slant / (1.0 + pulls_n[i] / frame.stiffness_n) : held_mm[i];
  }
  return rest;
}

std::vector<FourLengths> read_session(const BeltSession& session) {
  Dice pulls(session.seed, "belt pulls");
  Dice noise(session.seed, "belt readings");
  std::vector<FourLengths> readings;
  for (const auto& [x, y] : session.commands) {
    FourLengths held{};
    FourLengths pull{};
    for (std::size_t i = 0; i < 4; ++i) {
      held[i] = spring_to(session.frame, i, x, y).slant;
      pull[i] = session.frame.pull_n * (1.0 + session.pull_noise * pulls.normal());
    }
    const SledAtRest rest =
        rest_on_belts(session.frame, {false, false, true, true}, held, pull, x, y - 2.0);
    FourLengths read = rest.length_mm;
    for (double& length : read) length += session.noise_mm * noise.normal();
    readings.push_back(read);
  }
  return readings;
}

}  // namespace chaintrue::generator
