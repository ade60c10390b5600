// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/belt_draw.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "generator/hidden/belt_strength.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {
namespace {

constexpr const char* kSides[] = {"tl", "tr", "bl", "br"};
/// 43.975 mm of belt per turn of 22 teeth.
constexpr double kToothMm = 43.975 / 22.0;
/// 150 N stretch 2 m by 0.015 mm: negligible against the least noise, with forces that still balance to
/// 1e-4 N.
constexpr double kRigidN = 2e7;

/// Usual sizes, from least to most; those of either sign are drawn with either.
struct Card {
  const char* effect;
  bool sided;
  bool may_be_of_all;
  double least;
  double most;
  bool either_sign;
};
constexpr Card kCards[] = {{"belt_stretch", false, false, 0.002, 0.006, false},
                           {"belt_scale", true, false, 0.001, 0.004, true},
                           {"anchor_height", true, false, 15.0, 60.0, true},
                           {"anchor_moved", true, false, 2.0, 10.0, false},
                           {"tooth_skip", true, false, 1.0, 3.0, true},
                           {"drift", true, true, 0.01, 0.06, true},
                           {"belt_zero", true, true, 3.0, 25.0, true},
                           {"zero_shift", true, false, 1.0, 10.0, true},
                           {"anchor_flex", false, false, 0.5, 3.0, false}};
/// The last two are asked for by name alone: the frozen sets are drawn from the others.
constexpr std::size_t kDrawnCards = std::size(kCards) - 2;

std::vector<std::array<double, 2>> raster(const BeltFrame& frame, int columns, int rows,
                                          Dice& dice) {
  const double width = frame.anchors[3][0];
  const double height = 0.5 * (frame.anchors[0][1] + frame.anchors[1][1]);
  std::vector<std::array<double, 2>> all;
  for (int r = 0; r < rows; ++r) {
    for (int i = 0; i < columns; ++i) {
      const int c = r % 2 == 0 ? i : columns - 1 - i;
      all.push_back({width * (0.17 + 0.66 * c / (columns - 1)) + dice.uniform(-3.0, 3.0),
                     height * (0.22 + 0.56 * r / (rows - 1)) + dice.uniform(-3.0, 3.0)});
    }
  }
  return all;
}

BeltFrame drawn_frame(Dice& dice) {
  BeltFrame frame;
  const double width = dice.uniform(2400.0, 3500.0);
  const double height = dice.uniform(1800.0, 2500.0);
  const auto near = [&](double value) { return value + dice.uniform(-50.0, 50.0); };
  frame.anchors = {{{near(0.0), near(height), 100.0},
                    {near(width), near(height), 56.0},
                    {0.0, 0.0, 34.0},
                    {near(width), 0.0, 78.0}}};
  frame.stiffness_n = kRigidN;
  return frame;
}

/// Every anchor gives along its belt in proportion to the belt's tension: the pulled ones by the
/// secret's size at the frame's own pull.
void let_anchors_give(const BeltSession& session, double give_mm_per_n,
                      std::vector<FourLengths>& read) {
  for (std::size_t n = 0; n < read.size(); ++n) {
    const auto& [x, y] = session.commands[n];
    FourLengths held{};
    FourLengths pull{};
    pull.fill(session.frame.pull_n);
    for (std::size_t i = 0; i < 4; ++i) {
      const double level = level_span(session.frame.anchors[i], x, y) - session.frame.reach_mm;
      held[i] = std::hypot(level, session.frame.anchors[i][2]);
    }
    const SledAtRest rest =
        rest_on_belts(session.frame, {false, false, true, true}, held, pull, x, y - 2.0);
    for (std::size_t i = 0; i < 4; ++i) read[n][i] -= give_mm_per_n * rest.tension_n[i];
  }
}

/// Readings of all four without noise, each belt in the true frame of its visit, starting with this
/// visit; motors pull `times` as hard as in the frame.
std::vector<FourLengths> readings(const BeltFrame& frame, const BeltSecret& secret,
                                  const std::vector<std::array<double, 2>>& commands, int visit = 0,
                                  double times = 1.0) {
  BeltSession session{frame, commands};
  session.frame.pull_n *= times;
  session.pull_noise = 0.0;
  session.noise_mm = 0.0;
  if (secret.effect == "belt_stretch") session.frame.stiffness_n = frame.pull_n / secret.size;
  std::vector<FourLengths> read = read_session(session);
  if (secret.effect == "anchor_flex") let_anchors_give(session, secret.size / frame.pull_n, read);
  const auto own = [&](std::size_t i) { return secret.side == kSides[i] || secret.side == "all"; };
  if (secret.effect == "anchor_moved" || secret.effect == "anchor_height") {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!own(i)) continue;
      auto& anchor = session.frame.anchors[i];
      if (secret.effect == "anchor_height") {
        anchor[2] += secret.size;
      } else {
        anchor[0] += secret.size * std::cos(secret.direction_rad);
        anchor[1] += secret.size * std::sin(secret.direction_rad);
      }
    }
    const std::vector<FourLengths> after = read_session(session);
    for (std::size_t n = 0; n < read.size(); ++n) {
      if (visit + static_cast<int>(n) >= secret.first_visit) read[n] = after[n];
    }
  }
  for (std::size_t n = 0; n < read.size(); ++n) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (!own(i)) continue;
      if (secret.effect == "belt_scale") read[n][i] /= 1.0 + secret.size;
      if (secret.effect == "belt_zero") read[n][i] += secret.size;
      if (secret.effect == "drift") read[n][i] += secret.size * (visit + static_cast<double>(n));
      if (secret.effect == "tooth_skip" && visit + static_cast<int>(n) >= secret.first_visit)
        read[n][i] += kToothMm * secret.size;
      if (secret.effect == "zero_shift" && visit + static_cast<int>(n) >= secret.first_visit)
        read[n][i] += secret.size;
    }
  }
  return read;
}

std::vector<FourLengths> less(std::vector<FourLengths> read,
                              const std::vector<FourLengths>& plain) {
  for (std::size_t n = 0; n < read.size(); ++n) {
    for (std::size_t i = 0; i < 4; ++i) read[n][i] -= plain[n][i];
  }
  return read;
}

/// The projected signature of each cause of the catalogue at its usual size, as spaces;
/// causes that set in do so at every visit.
std::vector<Rival> rivals_of(const BeltFrame& frame,
                             const std::vector<std::array<double, 2>>& commands,
                             const std::vector<FourLengths>& plain,
                             const AnchorProjection& projection) {
  std::vector<Rival> rivals;
  const auto add = [&](const std::vector<FourLengths>& change) {
    const Eigen::VectorXd left = projection.left_of(change);
    if (left.norm() > 1e-6) rivals.push_back({.basis = left.normalized()});
  };
  for (const Card& card : kCards) {
    const std::string effect = card.effect;
    if (effect == "tooth_skip" || effect == "anchor_moved" || effect == "zero_shift") continue;
    std::vector<std::string> sides = {""};
    if (card.sided) sides = {"tl", "tr", "bl", "br"};
    if (card.may_be_of_all) sides.emplace_back("all");
    for (const std::string& side : sides) {
      BeltSecret secret;
      secret.effect = effect;
      secret.side = side;
      secret.size = std::sqrt(card.least * card.most);
      add(less(readings(frame, secret, commands), plain));
    }
  }
  // A belt that is longer, and an anchor that is elsewhere, from a visit on.
  for (std::size_t first = 1; first < commands.size(); ++first) {
    for (std::size_t belt = 0; belt < 4; ++belt) {
      std::vector<FourLengths> longer(commands.size(), FourLengths{});
      std::vector<FourLengths> right(commands.size(), FourLengths{});
      std::vector<FourLengths> up(commands.size(), FourLengths{});
      for (std::size_t n = first; n < commands.size(); ++n) {
        const auto& anchor = frame.anchors[belt];
        const auto& [x, y] = commands[n];
        const double level = level_span(anchor, x, y);
        longer[n][belt] = 1.0;
        right[n][belt] = (anchor[0] - x) / level;
        up[n][belt] = (anchor[1] - y) / level;
      }
      add(longer);
      add(right);
      add(up);
    }
  }
  return rivals;
}

/// Adds a law to the readings, and chooses the noise that gives it its strength: in units of this, beyond what
/// anchors and any one cause explain. \throws std::runtime_error if 500 draws find no noise of 0.1 to 1 mm.
void add_law(const BeltRecipe& recipe, const std::vector<std::array<double, 2>>& commands,
             Dice& dice, BeltDraw& draw) {
  constexpr int kDraws = 500;
  const std::vector<FourLengths> plain = readings(draw.frame, BeltSecret{}, commands);
  const AnchorProjection projection(draw.frame, commands);
  const std::vector<Rival> rivals = rivals_of(draw.frame, commands, plain, projection);
  for (int n = 0; n < kDraws; ++n) {
    HiddenLaw law = drawn_belt_law(*recipe.law, commands, dice);
    const std::size_t belt = law.component;
    std::vector<FourLengths> added(commands.size(), FourLengths{});
    for (std::size_t k = 0; k < commands.size(); ++k)
      added[k][belt] = law_value(law, site_of(draw.frame, belt, commands[k], plain[k][belt]));
    const double own = unexplained(projection.left_of(added), rivals);
    if (!(own > 1e-3)) continue;
    const double strength = drawn_law_strength(dice);
    const double size = dice.log_uniform(0.5, 6.0) * (is_slope(law.family) ? 4.0 : 1.0);
    draw.noise_mm = size * own / strength;
    if (draw.noise_mm < 0.1 || draw.noise_mm > 1.0) continue;
    law.size_mm = size * dice.sign();
    for (std::size_t k = 0; k < commands.size(); ++k)
      draw.lengths_mm[k][belt] += law.size_mm * added[k][belt];
    draw.secret.law = SizedLaw{std::move(law), strength};
    return;
  }
  throw std::runtime_error("draw_belts: no law fits");
}

BeltSecret drawn_secret(const BeltRecipe& recipe, int visits, Dice& dice) {
  BeltSecret secret;
  if (recipe.nothing) return secret;
  const Card* card = &kCards[dice.below(kDrawnCards)];
  for (const Card& one : kCards) {
    if (recipe.effect == one.effect) card = &one;
  }
  secret.effect = card->effect;
  secret.size = dice.log_uniform(card->least, card->most) * (card->either_sign ? dice.sign() : 1.0);
  if (secret.effect == "tooth_skip") secret.size = std::round(secret.size);
  if (card->sided) secret.side = kSides[dice.below(4)];
  if (card->may_be_of_all && dice.uniform() < 0.3) secret.side = "all";
  secret.direction_rad = dice.uniform(-3.14, 3.14);
  const bool sets_in = secret.effect == "tooth_skip" || secret.effect == "anchor_moved" ||
                       secret.effect == "zero_shift";
  if (sets_in) secret.first_visit = static_cast<int>(visits * dice.uniform(0.15, 0.85));
  return secret;
}

}  // namespace

BeltDraw draw_belts(const BeltRecipe& recipe, std::uint64_t seed) {
  Dice dice(seed, "belt draw");
  BeltDraw draw;
  draw.frame = drawn_frame(dice);
  constexpr std::array<std::array<int, 2>, 3> kRasters = {{{6, 5}, {8, 7}, {10, 9}}};
  const auto& [columns, rows] = kRasters[dice.below(kRasters.size())];
  const auto commands = raster(draw.frame, columns, rows, dice);
  draw.secret = drawn_secret(recipe, columns * rows, dice);
  draw.lengths_mm = readings(draw.frame, draw.secret, commands);
  draw.noise_mm = dice.uniform(0.2, 1.0);
  if (!recipe.nothing) {
    std::vector<FourLengths> change = readings(draw.frame, BeltSecret{}, commands);
    for (std::size_t n = 0; n < change.size(); ++n) {
      for (std::size_t i = 0; i < 4; ++i) change[n][i] = draw.lengths_mm[n][i] - change[n][i];
    }
    draw.secret.strength = dice.log_uniform(recipe.least_strength, recipe.most_strength);
    draw.noise_mm =
        AnchorProjection(draw.frame, commands).left_of(change).norm() / draw.secret.strength;
  }
  if (recipe.law) {
    Dice own(seed, "belt law");
    add_law(recipe, commands, own, draw);
  }
  draw.pulls.assign(draw.lengths_mm.size(), recipe.pulls.front());
  for (std::size_t pass = 1; pass < recipe.pulls.size(); ++pass) {
    const double times = recipe.pulls[pass] / recipe.pulls.front();
    for (const FourLengths& read : readings(draw.frame, draw.secret, commands,
                                            static_cast<int>(draw.lengths_mm.size()), times)) {
      draw.lengths_mm.push_back(read);
      draw.pulls.push_back(recipe.pulls[pass]);
    }
  }
  Dice noise(seed, "belt noise");
  for (FourLengths& read : draw.lengths_mm) {
    for (double& length : read) length += draw.noise_mm * noise.normal();
  }
  for (int k = 0; k < recipe.bad_readings; ++k) {
    const auto point = static_cast<int>(draw.lengths_mm.size()) * k / recipe.bad_readings +
                       static_cast<int>(dice.below(3));
    const auto belt = dice.below(4);
    // Far beyond the noise: errors that a user would want to know of.
    draw.lengths_mm[static_cast<std::size_t>(point)][belt] +=
        dice.sign() * draw.noise_mm * dice.log_uniform(15.0, 100.0);
    draw.secret.bad.push_back({point, static_cast<int>(belt)});
  }
  return draw;
}

}  // namespace chaintrue::generator
