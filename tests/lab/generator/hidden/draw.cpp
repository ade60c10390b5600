// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/draw.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "generator/hidden/grid_text.hpp"
#include "generator/hidden/unlisted.hpp"

namespace chaintrue::generator {
namespace {

/// Effects that a mix draws from; zero_shift, the last, is asked for by name alone, so that the frozen
/// sets stay what they are.
constexpr std::size_t kDrawn = kCauses - 1;

/// Interval of delta, drawn log-uniformly.
struct Range {
  double from = 6.0;
  double to = 22.0;
};

TrueMachine stated_machine(const Recipe& recipe, Dice& dice) {
  TrueMachine m;
  if (!recipe.other_machines) return m;
  const double half = std::round(dice.uniform(1400.0, 1750.0));
  const double up = std::round(dice.uniform(1000.0, 1350.0));
  m.axis = {{{-half, up}, {half, up}}};
  m.over_top = dice.uniform() < 0.6;
  m.ring_radius_mm = std::round(10.0 * dice.uniform(70.0, 180.0)) / 10.0;
  m.sled_mass_kg = std::round(10.0 * dice.uniform(8.0, 15.0)) / 10.0;
  m.tilt_from_vertical_deg = std::round(dice.uniform(5.0, 20.0));
  m.chain_mass_kg_per_m = 0.001 * std::round(dice.uniform(125.0, 150.0));
  return m;
}

// The size that gives the required delta: the secant method on log delta over log size, which is
// linear for most effects.
std::optional<SizedEffect> sized(const Yardstick& yardstick, Hidden effect, double wanted) {
  const CauseCard& c = card(effect.cause);
  const double sign = effect.size < 0.0 ? -1.0 : 1.0;
  const double bound = sign > 0.0 ? c.upper : -c.lower;
  double size = std::min(c.usual, 0.5 * bound);
  double slope = effect.cause == Cause::chain_plane_offset ? 2.0 : 1.0;
  double last_log_size = 0.0, last_log_delta = 0.0;
  for (int n = 0; n < 25; ++n) {
    effect.size = sign * size;
    const Hidden one[] = {effect};
    const auto signature = yardstick.signature(one);
    if (!signature) return std::nullopt;
    const double delta = signature->norm();
    if (!(delta > 1e-9)) return std::nullopt;
    if (std::abs(delta / wanted - 1.0) < 1e-3) return SizedEffect{effect, delta, *signature};
    const double log_size = std::log(size), log_delta = std::log(delta);
    if (n > 0 && std::abs(log_size - last_log_size) > 1e-12) {
      slope = std::clamp((log_delta - last_log_delta) / (log_size - last_log_size), 0.3, 4.0);
    }
    last_log_size = log_size;
    last_log_delta = log_delta;
    const double step = std::clamp((std::log(wanted) - log_delta) / slope, -2.5, 2.5);
    // A step beyond the catalogue's bounds is limited to them once; beyond, there is no solution.
    const double next = size * std::exp(step);
    if (next > bound) {
      if (size >= bound) return std::nullopt;
      size = bound;
    } else {
      size = next;
    }
  }
  return std::nullopt;
}

// Whole links: any of the pairs with a delta in range, with equal probability.
std::optional<SizedEffect> whole_links(const Yardstick& yardstick, Hidden effect, Range range,
                                       Dice& dice) {
  std::vector<SizedEffect> fitting;
  const int last = yardstick.visits().back().number;
  const int first = effect.cause == Cause::tooth_skip ? 1 : 0;
  for (int visit = first; visit <= last; ++visit) {
    for (int links = 1; links <= 3; ++links) {
      effect.place = visit;
      effect.size = links;
      const Hidden one[] = {effect};
      auto signature = yardstick.signature(one);
      if (!signature) return std::nullopt;
      const double delta = signature->norm();
      if (delta < range.from || delta > range.to) continue;
      fitting.push_back({effect, delta, *signature});
    }
  }
  if (fitting.empty()) return std::nullopt;
  SizedEffect chosen = fitting[dice.below(fitting.size())];
  const double sign = dice.sign();
  chosen.hidden.size *= sign;
  chosen.signature *= sign;
  return chosen;
}

// Side and place are drawn again up to 30 times before the effect is dropped.
std::optional<SizedEffect> draw_effect(const Yardstick& yardstick, Cause cause, Range range,
                                       Dice& dice) {
  const CauseCard& c = card(cause);
  for (int n = 0; n < 30; ++n) {
    Hidden effect{cause, c.sides[dice.below(c.sides.size())], 0.0, 0.0};
    if (c.whole()) {
      // A single required strength: whole links only approximate it.
      const Range near = range.from == range.to ? Range{0.87 * range.from, 1.15 * range.to} : range;
      if (auto found = whole_links(yardstick, effect, near, dice)) return found;
      continue;
    }
    effect.size = c.lower < 0.0 ? dice.sign() : 1.0;
    if (c.place == Place::phase) effect.place = dice.uniform(-std::numbers::pi, std::numbers::pi);
    if (c.place == Place::visit) {
      // A tenth of the session at least on either side, or the shift is bad readings.
      const auto count = yardstick.visits().size();
      effect.place =
          yardstick.visits()[count / 10 + 1 + dice.below(count - 2 * (count / 10) - 1)].number;
    }
    if (c.place == Place::angle) {
      const auto known = yardstick.angles(effect.where == Where::left ? 0 : 1);
      const auto n_seen = static_cast<double>(known.size());
      const double from = known[static_cast<std::size_t>(0.10 * n_seen)];
      const double to = known[static_cast<std::size_t>(0.85 * n_seen)];
      effect.place = dice.uniform(from, to);
    }
    const double wanted =
        range.from == range.to ? range.from : dice.log_uniform(range.from, range.to);
    if (auto found = sized(yardstick, effect, wanted)) return found;
  }
  return std::nullopt;
}

// Effects that are not collinear, each with its own strength.
std::vector<SizedEffect> draw_effects(const Yardstick& yardstick, const Recipe& recipe,
                                      std::size_t count, Range range, Dice& dice) {
  for (int n = 0; n < 300; ++n) {
    std::vector<SizedEffect> chosen;
    while (chosen.size() < count) {
      const Cause cause =
          recipe.cause && chosen.empty() ? *recipe.cause : static_cast<Cause>(dice.below(kDrawn));
      auto next = draw_effect(yardstick, cause, range, dice);
      if (!next) break;
      const bool same = std::any_of(chosen.begin(), chosen.end(), [&](const SizedEffect& other) {
        return other.hidden.cause == next->hidden.cause ||
               std::abs(other.signature.dot(next->signature)) >= 0.85 * other.delta * next->delta;
      });
      if (same) break;
      chosen.push_back(std::move(*next));
    }
    if (chosen.size() == count) return chosen;
  }
  throw std::runtime_error("draw_effects: no effect of the catalogue fits the recipe");
}

bool same_class(const Hidden& h, const Rival& r) {
  if (h.cause == r.cause && h.where == r.where) return true;
  const auto uniform = [](Cause cause, Where where) {
    return (cause == Cause::tape_scale || cause == Cause::chain_pitch_error) &&
           where == Where::both;
  };
  // A zero that moved by whole links is a skip.
  const auto steps = [](Cause cause) {
    return cause == Cause::zero_shift || cause == Cause::tooth_skip;
  };
  if (h.where == r.where && steps(h.cause) && steps(r.cause)) return true;
  return uniform(h.cause, h.where) && uniform(r.cause, r.where);
}

bool is_separable(const Yardstick& yardstick, const SizedEffect& truth) {
  double likest = 0.0;
  for (const Rival& r : yardstick.rivals()) {
    if (!same_class(truth.hidden, r)) likest = std::max(likest, likeness(truth.signature, r));
  }
  return truth.delta >= strength_to_separate(likest);
}

// Scaled so that the part not explained by the catalogue has a delta of 10 to 20.
Disturbance draw_unlisted(const Yardstick& yardstick, double& left_over_delta, Dice& dice) {
  const auto rivals = yardstick.rivals();
  for (int n = 0; n < 200; ++n) {
    const auto shift = draw_oddity(dice);
    const auto of_size = [&](double mm) {
      return Disturbance{true, [=](const Site& site) {
                           const Vec2 own = shift(site.place);
                           return Vec2{mm * own.x, mm * own.y};
                         }};
    };
    const double left = unexplained(yardstick.signature_of(of_size(1.0)), rivals);
    if (!(left > 1e-3)) continue;
    const double size_mm = dice.log_uniform(10.0, 20.0) / left;
    // A larger size would be noticed.
    if (size_mm > 12.0) continue;
    left_over_delta = left * size_mm;
    return of_size(size_mm);
  }
  throw std::runtime_error("draw_unlisted: nothing fits");
}

std::vector<Visit> true_visits(const std::vector<PlannedVisit>& planned, Dice& dice) {
  std::vector<Visit> visits;
  for (const PlannedVisit& p : planned) {
    const double alongside = p.repeat ? 2.0 : 8.0;
    visits.push_back({{p.place.x + dice.uniform(-alongside, alongside),
                       p.place.y + dice.uniform(-alongside, alongside)},
                      static_cast<int>(visits.size())});
  }
  return visits;
}

std::vector<HiddenMachine::Note> written_down(const Recipe& recipe,
                                              const std::vector<Visit>& visits,
                                              const std::vector<Lengths>& exact,
                                              const std::vector<Hidden>& hidden, NoiseLevel noise,
                                              Dice& dice) {
  (void)dice.uniform();  // keeps the frozen sets as they are
  const auto draw = [&] { return recipe.kind == Mix::heavy ? dice.heavy_tailed() : dice.normal(); };
  std::vector<HiddenMachine::Note> notes;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const Vec2 mark = written(visits[i].place, hidden);
    HiddenMachine::Note note;
    note.number = visits[i].number;
    note.mark.x = mark.x + noise.position_mm * draw();
    note.mark.y = mark.y + noise.position_mm * draw();
    for (std::size_t c = 0; c < 2; ++c) note.lengths[c] = exact[i][c] + noise.length_mm * draw();
    notes.push_back(note);
  }
  return notes;
}

// A tenth of the points with errors of 8 to 20 mm in any direction, at most one at a mark.
void slip(std::vector<HiddenMachine::Note>& notes, Answer& answer, Dice& dice) {
  const std::size_t count = (notes.size() + 5) / 10;
  while (answer.bad_points.size() < count) {
    const std::size_t i = dice.below(notes.size());
    const auto near = [&](std::size_t k) {
      return std::hypot(notes[k].mark.x - notes[i].mark.x, notes[k].mark.y - notes[i].mark.y) <
             50.0;
    };
    if (std::any_of(answer.bad_points.begin(), answer.bad_points.end(), near)) continue;
    answer.bad_points.push_back(i);
    const double far = dice.uniform(8.0, 20.0),
                 angle = dice.uniform(-std::numbers::pi, std::numbers::pi);
    notes[i].mark.x += far * std::cos(angle);
    notes[i].mark.y += far * std::sin(angle);
  }
  std::sort(answer.bad_points.begin(), answer.bad_points.end());
}

std::size_t effects_in(Mix mix) {
  switch (mix) {
    case Mix::single:
    case Mix::bad_points_and_effect:
    case Mix::alongside:
      return 1;
    case Mix::two:
    case Mix::two_alongside:
      return 2;
    case Mix::three:
      return 3;
    default:
      return 0;
  }
}

bool has_pattern(Mix mix) {
  return mix == Mix::alongside || mix == Mix::two_alongside || mix == Mix::pattern ||
         mix == Mix::near;
}

PatternRules rules_of(const Recipe& recipe) {
  PatternRules rules{.group = recipe.patterns};
  // Together with a cause, any strength of a height of 1 to 2 mm that is detectable; alone, as
  // required.
  const bool alongside = recipe.kind == Mix::alongside || recipe.kind == Mix::two_alongside;
  if (alongside) rules.most_delta = 1e9;
  rules.near = recipe.kind == Mix::near;
  if (rules.near) rules.group = PatternGroup::broad;
  return rules;
}

Range range_of(const Recipe& recipe) {
  if (recipe.delta) return {*recipe.delta, *recipe.delta};
  if (recipe.kind == Mix::three) return {12.0, 22.0};
  if (recipe.kind == Mix::bad_points_and_effect) return {12.0, 12.0};
  return {};
}

}  // namespace

std::string_view word(Mix mix) {
  for (const auto& [value, name] : kMixes) {
    if (value == mix) return name;
  }
  return "";
}

std::optional<Mix> mix_of(std::string_view text) {
  for (const auto& [value, name] : kMixes) {
    if (name == text) return value;
  }
  return std::nullopt;
}

TrueMachine with_settings_off(TrueMachine m, double factor, Dice& dice) {
  for (Vec2& axis : m.axis) {
    axis.x += 1.5 * factor * dice.normal();
    axis.y += 1.5 * factor * dice.normal();
  }
  for (double& zero : m.chain_zero_mm) zero += 0.5 * factor * dice.normal();
  return m;
}

std::optional<SizedEffect> draw_sized_effect(const Yardstick& yardstick, Cause cause,
                                             double least_delta, double most_delta, Dice& dice) {
  return draw_effect(yardstick, cause, {least_delta, most_delta}, dice);
}

SealedSet draw_set(const Recipe& recipe, std::uint64_t seed) {
  Dice machine_dice(seed, "machine"), order_dice(seed, "order"), place_dice(seed, "places");
  Dice effect_dice(seed, "effects"), noise_dice(seed, "noise"), slip_dice(seed, "slips");
  const TrueMachine stated = stated_machine(recipe, machine_dice);
  const TrueMachine truth = with_settings_off(stated, recipe.settings_off, machine_dice);

  Answer answer;
  const auto drawn_order = static_cast<Order>(order_dice.below(kOrders));
  answer.order = recipe.order.value_or(drawn_order);
  const Layout layout = layout_of(recipe.points);
  const auto visits = true_visits(
      recipe.list_of_start ? list_of_start() : plan_visits(layout, answer.order, order_dice),
      place_dice);

  const NoiseLevel noise = recipe.noise;
  const auto yardstick = Yardstick::make(truth, visits, noise, {});
  if (!yardstick) throw std::runtime_error("draw_set: the machine cannot reach its own bed");
  std::vector<Signature> signatures;
  if (!recipe.exactly.empty()) {
    answer.hidden = recipe.exactly;
    for (const Hidden& h : recipe.exactly) {
      const Hidden one[] = {h};
      const auto signature = yardstick->signature(one);
      if (!signature) throw std::runtime_error("draw_set: the machine cannot take an effect");
      answer.delta.push_back(signature->norm());
    }
  } else if (const std::size_t count = effects_in(recipe.kind); count > 0) {
    const auto effects = draw_effects(*yardstick, recipe, count, range_of(recipe), effect_dice);
    for (const SizedEffect& s : effects) {
      answer.hidden.push_back(s.hidden);
      answer.delta.push_back(s.delta);
      signatures.push_back(s.signature);
    }
    answer.separable = is_separable(*yardstick, effects.front());
  }
  HiddenMachine machine(stated, truth, answer.hidden);
  if (recipe.kind == Mix::unlisted)
    machine.suffers(draw_unlisted(*yardstick, answer.left_over_delta, effect_dice));
  if (has_pattern(recipe.kind)) {
    Dice pattern_dice(seed, "pattern");
    answer.pattern = draw_pattern(*yardstick, rules_of(recipe), signatures, pattern_dice);
    machine.suffers(answer.pattern->disturbance);
  }

  if (recipe.law) {
    Dice law_dice(seed, "law");
    answer.law = draw_law(*yardstick, *recipe.law, law_dice);
    machine.suffers(disturbance_of(answer.law->law));
  }

  machine.went_to(visits);
  const auto exact = machine.exact(visits);
  if (!exact) throw std::runtime_error("draw_set: the hidden machine cannot reach a mark");
  auto notes = written_down(recipe, visits, *exact, answer.hidden, noise, noise_dice);
  const bool slips = recipe.kind == Mix::bad_points || recipe.kind == Mix::bad_points_and_effect;
  if (slips) slip(notes, answer, slip_dice);

  WrittenGrid grid;
  grid.stated = stated;
  const double ratio = recipe.kind == Mix::wrong_noise ? noise_dice.log_uniform(0.7, 1.5) : 1.0;
  grid.stated_noise = {noise.length_mm * ratio, noise.position_mm * ratio};
  grid.notes = std::move(notes);
  std::string text = grid_text(grid);
  return {std::move(text), std::move(answer), std::move(machine), noise, std::move(grid.notes)};
}

std::string other_session(const SealedSet& set, int columns, int rows, std::uint64_t seed) {
  Dice place_dice(seed, "other places"), noise_dice(seed, "other noise");
  std::vector<Vec2> marks;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      marks.push_back({-1200.0 + 2400.0 * (i + place_dice.uniform()) / columns,
                       -600.0 + 1200.0 * (j + place_dice.uniform()) / rows});
    }
  }
  place_dice.shuffle(marks);
  const auto count = marks.size();
  for (std::size_t k = 0; k < 6; ++k) marks.push_back(marks[k * count / 6]);
  std::vector<Visit> visits;
  for (const Vec2& mark : marks) visits.push_back({mark, static_cast<int>(visits.size())});
  const auto exact = set.machine.exact(visits);
  if (!exact) throw std::runtime_error("other_session: the hidden machine cannot reach a mark");
  WrittenGrid grid;
  grid.stated = set.machine.stated();
  grid.stated_noise = set.noise;
  grid.notes = written_down({}, visits, *exact, set.answer.hidden, set.noise, noise_dice);
  return grid_text(grid);
}

}  // namespace chaintrue::generator
