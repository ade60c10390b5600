// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The trial of one sealed set: the grid's text is read like a user's file and diagnosed, and only
/// then compared with the truth.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

struct TrialOptions {
  generator::Recipe recipe{};
  bool improvement = false;  ///< held-out errors, reported and true
  bool follow_up = false;    ///< measures what the diagnosis proposes, if it leaves a set of causes
  /// Facts and numbers besides those of the table of rates, and names with their probabilities.
  bool more = false;
};

/// A class of causes as the diagnosis reports it.
struct Claim {
  std::vector<std::string> members;  ///< effect:side; the one that gives the class its name first
  double probability = 0.0;

  bool means(std::string_view id) const;
  bool operator==(const Claim&) const = default;
};

/// chain_pitch_error:both~tape_scale:both=0.1204, and without the probability.
std::string word_of(const Claim& claim);
std::string name_of(const Claim& claim);
/// \throws std::invalid_argument with the word if it is not one.
Claim parse_claim(const std::string& word);

/// What a diagnosis says, and what is hidden.
struct Trial {
  std::vector<std::string> hidden;  ///< effect:side
  grid::diagnosis::Verdict verdict = grid::diagnosis::Verdict::nothing_found;
  std::vector<Claim> causes;
  double unknown_probability = 0.0;  ///< of a pattern, alone or together with causes
  std::vector<std::size_t> bad_points;
  std::vector<std::size_t> hidden_bad_points;

  explicit Trial(const grid::diagnosis::Diagnosis& found);

  bool is_hidden(const Claim& claim) const;
  bool is_named(const std::string& id) const;
  /// Any of named, named_set, several_causes.
  bool names_something() const;
  /// Named alone or together with others, not as one of a set of alternatives.
  bool names_outright() const;
  /// Something is named, or a set of alternatives is given, without the hidden cause; or one of
  /// several names is not hidden.
  bool names_wrongly() const;
};

/// Verdict, names and facts.
[[nodiscard]] Outcome outcome_of(const std::string& kind, std::uint64_t seed, const Trial& trial);

/// Failed if the diagnosis fails.
[[nodiscard]] Outcome run_trial(const std::string& kind, const TrialOptions& options,
                                std::uint64_t seed);

/// A diagnosis without stability, held-out errors and next measurements.
grid::diagnosis::DiagnosisOptions verdict_alone();

/// In the order of the diagnosis.
std::vector<Claim> named_causes(const grid::diagnosis::Diagnosis& found);

/// effect:side, `-` for no side.
std::string id_of(std::string_view effect, std::string_view side);
std::string id_of(const generator::Hidden& hidden);
std::string id_of(const grid::diagnosis::CauseId& cause);

}  // namespace chaintrue::sealed
