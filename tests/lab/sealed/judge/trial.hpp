// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The trial of one sealed set: the grid's text is read like a user's file and diagnosed, and only
/// then compared with the truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"

namespace chaintrue::sealed {

struct TrialOptions {
  generator::Recipe recipe;
  bool improvement = false;  ///< held-out errors, reported and true
  bool follow_up = false;    ///< measures what the diagnosis proposes, if it leaves a set of causes
};

/// A cause as reported by the diagnosis.
struct NamedCause {
  std::string id;  ///< effect:side
  double probability = 0.0;
  std::vector<std::string> same_as;
};

/// Errors of the tool on a fresh session without noise [mm, rms].
struct TrueErrors {
  double calibrated = 0.0;
  double extended = 0.0;       ///< with the diagnosis's machine
  double oracle = 0.0;         ///< given the cause
  double reported_drop = 0.0;  ///< of the mean square, as reported by the diagnosis
  double reported_share = 0.0;
};

struct Trial {
  std::uint64_t seed = 0;
  int points = 0;
  generator::Answer answer;
  std::vector<std::string> hidden;  ///< effect:side
  bool failed = false;
  grid::diagnosis::Verdict verdict = grid::diagnosis::Verdict::nothing_found;
  std::vector<NamedCause> causes;
  std::vector<grid::diagnosis::Hypothesis> hypotheses;
  double unknown_probability = 0.0;  ///< of a pattern, alone or together with causes
  double family_wise_p = 1.0;
  std::vector<std::size_t> bad_points;
  double seconds = 0.0;
  std::optional<TrueErrors> errors;
  std::optional<bool> follow_up;  ///< a single right name after it
};

[[nodiscard]] Trial run_trial(const TrialOptions& options, std::uint64_t seed);

/// Processor time of this thread, so that other work on the machine does not count.
[[nodiscard]] double thread_seconds();
/// A diagnosis without stability, held-out errors and next measurements.
[[nodiscard]] grid::diagnosis::DiagnosisOptions verdict_alone();

/// In the order of the diagnosis.
[[nodiscard]] std::vector<NamedCause> named_causes(const grid::diagnosis::Diagnosis& found);
/// Copies the results of a diagnosis into a trial.
void take_over(const grid::diagnosis::Diagnosis& found, Trial& trial);

/// The cause or a member of its class.
[[nodiscard]] bool means(const NamedCause& named, const std::string& id);
/// Any of named, named_set, several_causes.
[[nodiscard]] bool names_something(const Trial& trial);
/// A pattern is reported: its probability is above one half.
[[nodiscard]] bool tells_pattern(const Trial& trial);
/// Named alone or together with others, not as one of a set of alternatives.
[[nodiscard]] bool names_outright(const Trial& trial);
/// Something is named, or a set of alternatives is given, without the hidden cause; or one of
/// several names is not hidden.
[[nodiscard]] bool names_wrongly(const Trial& trial);
/// The hidden cause is the first.
[[nodiscard]] bool leads_right(const Trial& trial);
/// The hidden cause is among `causes`.
[[nodiscard]] bool in_set(const Trial& trial);
/// Every hidden cause is among `causes`.
[[nodiscard]] bool all_named(const Trial& trial);
/// Every bad point is among the rejected ones.
[[nodiscard]] bool all_bad_found(const Trial& trial);
/// effect:side, `-` for no side.
[[nodiscard]] std::string id_of(const generator::Hidden& hidden);
[[nodiscard]] std::string id_of(const grid::diagnosis::CauseId& cause);

}  // namespace chaintrue::sealed
