// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace chaintrue::generator {
namespace {

double largest_cosine(const Signature& own, std::span<const Signature> others) {
  double most = 0.0;
  for (const Signature& other : others) {
    most = std::max(most, std::abs(own.dot(other)) / (own.norm() * other.norm()));
  }
  return most;
}

}  // namespace

Field draw_family(PatternGroup group, Dice& dice) {
  if (group == PatternGroup::other) return draw_other_family(dice);
  const bool is_dent = dice.sign() > 0.0;
  const Vec2 centre{dice.uniform(-1000.0, 1000.0), dice.uniform(-450.0, 450.0)};
  const double direction = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const double phase = dice.uniform(-std::numbers::pi, std::numbers::pi);
  const auto drawn = [&](double narrowest, double widest, double shortest, double longest) {
    return is_dent ? dice.uniform(narrowest, widest) : dice.uniform(shortest, longest);
  };
  const double extent = group == PatternGroup::short_scale ? drawn(90.0, 150.0, 250.0, 450.0)
                        : group == PatternGroup::broad     ? drawn(400.0, 900.0, 1200.0, 3000.0)
                                                           : drawn(180.0, 320.0, 500.0, 900.0);
  return [=](const Site& site) {
    const Vec2 from{site.place.x - centre.x, site.place.y - centre.y};
    if (is_dent) return std::exp(-0.5 * (from.x * from.x + from.y * from.y) / (extent * extent));
    const double along = std::cos(direction) * from.x + std::sin(direction) * from.y;
    return std::sin(2.0 * std::numbers::pi * along / extent + phase);
  };
}

std::vector<Site> sites_of(std::span<const Visit> visits, const std::vector<Rest>& at_rest) {
  std::vector<Site> sites;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    Site& site = sites.emplace_back(Site{visits[i].place, {}, {}});
    for (std::size_t c = 0; c < 2; ++c) {
      site.angle_rad[c] = at_rest[i].chain[c].angle_rad;
      site.length_mm[c] = at_rest[i].chain[c].length_mm;
    }
  }
  return sites;
}

SizedPattern draw_pattern(const Yardstick& yardstick, const PatternRules& rules,
                          std::span<const Signature> alongside, Dice& dice) {
  const auto rivals = rules.near ? yardstick.rivals() : std::vector<Rival>{};
  for (int n = 0; n < 20000; ++n) {
    const Field field = draw_family(rules.group, dice);
    const double entry = dice.uniform(-std::numbers::pi, std::numbers::pi);
    const double height = dice.uniform(1.0, 2.0);
    const Disturbance disturbance{false, [=](const Site& site) {
                                    const double own = height * field(site);
                                    return Vec2{own * std::cos(entry), own * std::sin(entry)};
                                  }};
    const Signature own = yardstick.signature_of(disturbance);
    const double delta = own.norm();
    if (!(delta >= rules.least_delta && delta <= rules.most_delta)) continue;
    double rho = largest_cosine(own, alongside);
    for (const Rival& r : rivals) rho = std::max(rho, likeness(own, r));
    if (rules.near ? rho < 0.9 || rho > 0.98 : rho >= 0.5) continue;
    return {disturbance, delta, rho};
  }
  throw std::runtime_error("draw_pattern: nothing fits");
}

}  // namespace chaintrue::generator
