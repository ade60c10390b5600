// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sealed sets: from a seed and a mix to the grid file that a user would have, and the answer separately.
///
/// The mix of the published figures: the classic machine; regular grids of 28, 60, 117, 200 or 465 marks
/// plus six repeats; 0.2 mm noise of length and 0.3 mm of position, stated with 12 degrees of freedom;
/// motors off by 1.5 mm and zeros by 0.5 mm (one sigma; stated 3 and 1); rows, columns, serpentines and
/// random orders; an effect, then its side, then its place drawn uniformly, then the strength delta
/// log-uniform in 6 .. 22 and the size with that strength. Sizes outside the catalogue's bounds are drawn
/// again. Whole links use one of the pairs (links, visit) with a delta in range.
///
/// \code
///   const SealedSet set = draw_set({.kind = Mix::single, .points = 28}, seed);
///   set.grid_text;                 // chaintrue_grid
///   set.answer.hidden.front();     // used afterwards
/// \endcode
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/law.hpp"
#include "generator/hidden/pattern.hpp"
#include "generator/hidden/session.hpp"
#include "generator/hidden/strength.hpp"

namespace chaintrue::generator {

enum class Mix {
  single,
  nothing,
  heavy,        ///< nothing hidden, noise with heavy tails
  wrong_noise,  ///< nothing hidden, stated noise 0.7 to 1.5 times the true one
  two,
  three,
  unlisted,
  bad_points,             ///< 10 % of the marks miswritten, nothing hidden
  bad_points_and_effect,  ///< the same with an effect of delta 12
  alongside,              ///< as single, with a pattern that is not collinear with it
  two_alongside,          ///< as two, with a pattern
  pattern,                ///< a pattern alone, delta 6 to 30
  near,                   ///< a pattern alone that is collinear with an effect of the catalogue
};
inline constexpr std::pair<Mix, std::string_view> kMixes[] = {
    {Mix::single, "single"},
    {Mix::nothing, "nothing"},
    {Mix::heavy, "heavy"},
    {Mix::wrong_noise, "wrong_noise"},
    {Mix::two, "two"},
    {Mix::three, "three"},
    {Mix::unlisted, "unlisted"},
    {Mix::bad_points, "bad_points"},
    {Mix::bad_points_and_effect, "bad_points_and_effect"},
    {Mix::alongside, "beside"},
    {Mix::two_alongside, "two_beside"},
    {Mix::pattern, "pattern"},
    {Mix::near, "near"},
};
std::string_view word(Mix mix);
std::optional<Mix> mix_of(std::string_view word);

struct Recipe {
  Mix kind = Mix::single;
  int points = 28;
  /// Instead of 6 .. 22.
  std::optional<double> delta;
  /// Draws another geometry, feed, tilt and weight as well.
  bool other_machines = false;
  /// This cause instead of a drawn one; its strength is still drawn.
  std::optional<Cause> cause;
  std::optional<Order> order;
  /// The list of `chaintrue start` in place of `points` and the order.
  bool list_of_start = false;
  /// Exactly these instead of any drawn effects.
  std::vector<Hidden> exactly;
  /// Factor on the usual errors of the settings.
  double settings_off = 1.0;
  /// The true noise; stated correctly unless the mix differs.
  NoiseLevel noise;
  /// For the mixes with a pattern.
  PatternGroup patterns = PatternGroup::smooth;
  /// A law or a field as well.
  std::optional<LawFamily> law;
};

/// The truth of a set.
struct Answer {
  std::vector<Hidden> hidden;
  std::vector<double> delta;  ///< of each on its own
  /// The first's delta is sufficient to separate it from any other effect outside its class.
  bool separable = false;
  double left_over_delta = 0.0;  ///< of an unlisted disturbance, the part that no effect explains
  std::optional<SizedPattern> pattern;
  std::optional<SizedLaw> law;
  std::vector<std::size_t> bad_points;
  Order order = Order::rows;
};

/// The machine of a set: it can be measured again. Not thread safe.
class HiddenMachine {
 public:
  HiddenMachine(TrueMachine stated, TrueMachine truth, std::vector<Hidden> hidden);

  struct Note {
    Vec2 mark;
    Lengths lengths{};
    int number = 0;
  };
  /// Visits a mark (written with the same tape as the others) and reads the chains.
  std::optional<Note> measure(Vec2 mark, NoiseLevel noise, Dice& dice);
  /// A reading of the machine itself, with its sigma; empty for an unknown name.
  struct Reading {
    double value = 0.0;
    double sigma = 0.0;
  };
  std::optional<Reading> read(std::string_view what, std::string_view side, Dice& dice) const;

  /// The session so far: true positions in order of visit.
  const std::vector<Visit>& visits() const { return visits_; }
  void went_to(std::vector<Visit> visits) { visits_ = std::move(visits); }
  const TrueMachine& stated() const { return stated_; }
  const TrueMachine& truth() const { return truth_; }
  const std::vector<Hidden>& hidden() const { return hidden_; }
  void suffers(std::optional<Disturbance> what) { disturbance_ = std::move(what); }
  const std::optional<Disturbance>& disturbance() const { return disturbance_; }
  /// Noise-free readings of a whole session, the disturbance included.
  std::optional<std::vector<Lengths>> exact(std::span<const Visit> visits) const;

 private:
  TrueMachine stated_;
  TrueMachine truth_;  ///< settings off, effects not yet applied
  std::vector<Hidden> hidden_;
  std::optional<Disturbance> disturbance_;
  std::vector<Visit> visits_;
};

struct SealedSet {
  std::string grid_text;
  Answer answer;
  HiddenMachine machine;
  NoiseLevel noise;
  /// The numbers of the text before rounding to 0.0001 mm.
  std::vector<HiddenMachine::Note> notes;
};

/// Motors off by 1.5 mm and zeros by 0.5 mm, one sigma, times a factor.
[[nodiscard]] TrueMachine with_settings_off(TrueMachine machine, double factor, Dice& dice);

/// An effect with its strength in the data.
struct SizedEffect {
  Hidden hidden;
  double delta = 0.0;
  Signature signature;
};
/// Side, place and size of a cause for a session, its strength log-uniform between the two; empty if no
/// size within its bounds has such a strength.
std::optional<SizedEffect> draw_sized_effect(const Yardstick& yardstick, Cause cause,
                                             double least_delta, double most_delta, Dice& dice);

/// Same recipe and seed, same bytes. \throws std::runtime_error if no effect fits the recipe.
SealedSet draw_set(const Recipe& recipe, std::uint64_t seed);

/// The same points in another session: as many visits in the same order, each up to `shift_mm`
/// from its old position; for measuring held-out errors. Visits that cannot be made keep their
/// position.
std::vector<Visit> fresh_session(const HiddenMachine& machine, double shift_mm, Dice& dice);
/// Positions over the rectangle of the marks, one at random in each cell of a grid.
std::vector<Visit> area_session(const HiddenMachine& machine, Dice& dice);

/// The text of another session of the same machine at other marks, `columns` by `rows` of them, one
/// at random in each cell, in random order and with six second visits. \throws std::runtime_error if a
/// mark cannot be reached.
std::string other_session(const SealedSet& set, int columns, int rows, std::uint64_t seed);

}  // namespace chaintrue::generator
