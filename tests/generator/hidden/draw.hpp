// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sealed sets: from a seed and a mix to the grid file that a person would have, and the answer in
/// an envelope of its own.
///
/// The mix that figures are stated for: the classic machine; regular grids of 28, 60, 117, 200 or 465 marks
/// plus six repeats; 0.2 mm noise of length and 0.3 mm of position, stated with 12 degrees of
/// freedom; motors off by 1.5 mm and zeros by 0.5 mm (one sigma; stated 3 and 1); rows, columns,
/// serpentines and random orders alike; an effect, then its side, then its place drawn evenly, then
/// the strength delta log-uniform in 6 .. 22 and the size searched that has it. Sizes outside the
/// catalogue's bounds are drawn again. Whole links take one of the (links, visit) whose delta is in
/// range.
///
/// \code
///   const SealedSet set = draw_set({.kind = Mix::single, .points = 28}, seed);
///   set.grid_text;                 // chaintrue_grid
///   set.answer.hidden.front();     // opened afterwards
/// \endcode
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/pattern.hpp"
#include "generator/hidden/session.hpp"
#include "generator/hidden/strength.hpp"
#include "generator/hidden/unlisted.hpp"

namespace chaintrue::generator {

enum class Mix {
  single,
  nothing,
  heavy,         ///< nothing hidden, noise with heavy tails
  wrong_noise,   ///< nothing hidden, stated noise 0.7 to 1.5 times the true one
  uneven_noise,  ///< nothing hidden, noise up to three times larger in one part of the bed
  two,
  three,
  unlisted,
  bad_points,             ///< 10 % of the marks miswritten, nothing hidden
  bad_points_and_effect,  ///< the same with an effect of delta 12
  no_order,               ///< as single, without visiting numbers
  rounded,                ///< as single, read to 0.5 mm
  beside,                 ///< as single, and a pattern that is not much like it
  two_beside,             ///< as two, and a pattern
  pattern,                ///< a pattern alone, delta 6 to 30
  near,                   ///< a pattern alone that looks like an effect of the catalogue
};
[[nodiscard]] std::string_view word(Mix mix);
[[nodiscard]] std::optional<Mix> mix_of(std::string_view word);

struct Recipe {
  Mix kind = Mix::single;
  int points = 28;
  /// In place of 6 .. 22.
  std::optional<double> delta;
  /// Draws another geometry, feed, tilt and weight as well.
  bool other_machines = false;
  Extent extent = Extent::whole;
  /// This one in place of a draw; its strength is still drawn.
  std::optional<Cause> cause;
  std::optional<Order> order;
  /// These as they are, in place of any draw of effects.
  std::vector<Hidden> exactly;
  /// As stated, in place of the classic one.
  std::optional<TrueMachine> machine;
  /// Times the usual errors of the settings.
  double settings_off = 1.0;
  /// The true noise; stated as it is, unless the mix or noise_ratio say otherwise.
  NoiseLevel noise;
  /// Stated over true.
  std::optional<double> noise_ratio;
  /// Of the mixes with a pattern.
  PatternGroup patterns = PatternGroup::smooth;
};

/// What is in the envelope.
struct Answer {
  std::vector<Hidden> hidden;
  std::vector<double> delta;  ///< of each on its own
  /// Largest |cosine| of the first with any other effect, its class left aside, and which.
  double nearest_rho = 0.0;
  Cause nearest = Cause::tape_scale;
  Where nearest_where = Where::nowhere;
  bool separable = false;  ///< delta is enough for that rival
  std::optional<Unlisted> unlisted;
  double left_over_delta = 0.0;  ///< of the unlisted, what no effect of the catalogue explains
  double whole_delta = 0.0;
  std::optional<SizedPattern> pattern;
  std::vector<std::size_t> bad_points;
  Order order = Order::rows;
  double noise_ratio = 1.0;  ///< stated over true
};

/// The machine behind a set: it can be measured again. Not thread safe.
class HiddenMachine {
 public:
  HiddenMachine(TrueMachine stated, TrueMachine truth, std::vector<Hidden> hidden);

  struct Note {
    Vec2 mark;
    Lengths lengths{};
    int number = 0;
  };
  /// Goes to a mark (by the tape that wrote the others) and reads the chains.
  [[nodiscard]] std::optional<Note> measure(Vec2 mark, NoiseLevel noise, Dice& dice);
  /// A reading of the machine itself, with its sigma; nothing for an unknown word.
  struct Reading {
    double value = 0.0;
    double sigma = 0.0;
  };
  [[nodiscard]] std::optional<Reading> read(std::string_view what,
                                            std::string_view side,
                                            Dice& dice) const;

  /// The session so far: true places in order of visit.
  [[nodiscard]] const std::vector<Visit>& visits() const { return visits_; }
  void went_to(std::vector<Visit> visits) { visits_ = std::move(visits); }
  [[nodiscard]] const TrueMachine& stated() const { return stated_; }
  [[nodiscard]] const TrueMachine& truth() const { return truth_; }
  [[nodiscard]] const std::vector<Hidden>& hidden() const { return hidden_; }
  void suffers(Unlisted what) { unlisted_ = what; }
  void suffers(const Pattern& what) { pattern_ = what; }
  /// Noise-free readings of a whole session, what no catalogue lists included.
  [[nodiscard]] std::optional<std::vector<Lengths>> exact(std::span<const Visit> visits) const;

 private:
  TrueMachine stated_;
  TrueMachine truth_;  ///< settings off, effects not yet applied
  std::vector<Hidden> hidden_;
  std::optional<Unlisted> unlisted_;
  std::optional<Pattern> pattern_;
  std::vector<Visit> visits_;
};

struct SealedSet {
  std::string grid_text;
  Answer answer;
  HiddenMachine machine;
  NoiseLevel noise;
  /// The numbers of the text, before they were rounded to 0.0001 mm.
  std::vector<HiddenMachine::Note> notes;
};

/// Same recipe and seed, same bytes. \throws std::runtime_error where no effect fits the recipe.
[[nodiscard]] SealedSet draw_set(const Recipe& recipe, std::uint64_t seed);

/// Same points in another session: as many visits of the same order, each beside the old place by
/// up to `beside_mm`; what held-out errors are measured on. Visits that cannot be made are left
/// where they were.
[[nodiscard]] std::vector<Visit> fresh_session(const HiddenMachine& machine,
                                               double beside_mm,
                                               Dice& dice);
/// Places over the rectangle that the marks span, one at random in each cell of a grid.
[[nodiscard]] std::vector<Visit> area_session(const HiddenMachine& machine, Dice& dice);

}  // namespace chaintrue::generator
