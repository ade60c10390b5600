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

double field(const Pattern& pattern, const PatternSite& site) {
  const Vec2 from{site.place.x - pattern.centre.x, site.place.y - pattern.centre.y};
  switch (pattern.family) {
    case PatternFamily::dent:
      return std::exp(-0.5 * (from.x * from.x + from.y * from.y) /
                      (pattern.extent_mm * pattern.extent_mm));
    case PatternFamily::wave: {
      const double along =
          std::cos(pattern.direction_rad) * from.x + std::sin(pattern.direction_rad) * from.y;
      return std::sin(2.0 * std::numbers::pi * along / pattern.extent_mm + pattern.phase_rad);
    }
    default:
      return other_field(pattern, site);
  }
}

Pattern draw_family(PatternGroup group, Dice& dice) {
  if (group == PatternGroup::other) return draw_other_family(dice);
  Pattern p;
  const auto extent = [&](double narrowest, double widest, double shortest, double longest) {
    return p.family == PatternFamily::dent ? dice.uniform(narrowest, widest)
                                           : dice.uniform(shortest, longest);
  };
  p.family = dice.sign() > 0.0 ? PatternFamily::dent : PatternFamily::wave;
  p.centre = {dice.uniform(-1000.0, 1000.0), dice.uniform(-450.0, 450.0)};
  p.direction_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  p.phase_rad = dice.uniform(-std::numbers::pi, std::numbers::pi);
  p.extent_mm = group == PatternGroup::short_scale ? extent(90.0, 150.0, 250.0, 450.0)
                : group == PatternGroup::broad     ? extent(400.0, 900.0, 1200.0, 3000.0)
                                                   : extent(180.0, 320.0, 500.0, 900.0);
  return p;
}

std::vector<PatternSite> sites_of(std::span<const Visit> visits, const std::vector<Rest>& at_rest) {
  std::vector<PatternSite> sites;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    PatternSite& site = sites.emplace_back(PatternSite{visits[i].place, {}, {}});
    for (std::size_t c = 0; c < 2; ++c) {
      site.angle_rad[c] = at_rest[i].chain[c].angle_rad;
      site.length_mm[c] = at_rest[i].chain[c].length_mm;
    }
  }
  return sites;
}

std::vector<Lengths> extra_lengths(const Pattern& pattern,
                                   std::span<const Visit> visits,
                                   const std::vector<Rest>& at_rest) {
  std::vector<Lengths> extra;
  for (const PatternSite& site : sites_of(visits, at_rest)) {
    const double height = pattern.height_mm * field(pattern, site);
    extra.push_back({height * pattern.entry[0], height * pattern.entry[1]});
  }
  return extra;
}

SizedPattern draw_pattern(const Yardstick& yardstick,
                          const PatternRules& rules,
                          std::span<const Signature> alongside,
                          Dice& dice) {
  const auto rivals = rules.near ? yardstick.rivals() : std::vector<Rival>{};
  for (int n = 0; n < 20000; ++n) {
    Pattern p = draw_family(rules.group, dice);
    const double entry = dice.uniform(-std::numbers::pi, std::numbers::pi);
    p.entry = {std::cos(entry), std::sin(entry)};
    p.height_mm = dice.uniform(1.0, 2.0);
    const auto extra = extra_lengths(p, yardstick.visits(), yardstick.at_rest());
    const Signature own = yardstick.signature_of_lengths(extra);
    const double delta = own.norm();
    if (!(delta >= rules.least_delta && delta <= rules.most_delta)) continue;
    double rho = largest_cosine(own, alongside);
    for (const Rival& r : rivals) rho = std::max(rho, likeness(own, r));
    if (rules.near ? rho < 0.9 || rho > 0.98 : rho >= 0.5) continue;
    return {p, delta, rho};
  }
  throw std::runtime_error("draw_pattern: nothing fits");
}

}  // namespace chaintrue::generator
