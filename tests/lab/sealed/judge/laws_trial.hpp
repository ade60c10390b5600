// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The diagnosis of one session with a hidden law, a field that is no law, a listed cause or nothing:
/// which law it reports, and whether that is the hidden one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// "laws", "two", "gaussian", ... of points on two chains; "belts_laws", ... and "holes_laws", ... of these.
struct LawsKind {
  std::string_view word;
  std::string_view hidden;  ///< for the table
  bool is_law = false;      ///< of one variable
};
[[nodiscard]] const std::vector<LawsKind>& laws_kinds();

/// The later use of a claimed law, written as a declared effect.
struct LawInUse {
  using Says = grid::diagnosis::DeclaredAnswer::Says;
  /// A second session of the same machine at other marks, and the session of another machine with
  /// another law.
  std::optional<Says> second;
  std::optional<Says> foreign;
  /// The tool's true error over the measured area by the first session's map with the law offered, over
  /// that of the map without.
  std::optional<double> error_ratio;
};

struct LawsTrial {
  std::uint64_t seed = 0;
  int points = 0;
  generator::Answer answer;  ///< of points on two chains
  std::string hidden;        ///< of belts and holes, in words
  bool failed = false;
  std::vector<grid::diagnosis::Law> laws;
  bool reported = false;  ///< some law
  bool claimed = false;   ///< one at kLawClaimed
  bool leads = false;     ///< the first is right: variable and place of entry
  bool in_set = false;    ///< one of those reported is
  /// Largest distance of a place, period or size from the truth, in sigmas, of a law that leads with the
  /// right shape; empty otherwise.
  std::optional<double> worst_sigmas;
  /// Correctness of the named causes; given_law: those named given a claimed law.
  struct Names {
    bool right = false;  ///< that which is hidden is among them
    bool wrong = false;  ///< one of 90 % and more that is not hidden is
  };
  Names names, names_given_law;
  double seconds = 0.0;
  std::string sentence;
  std::optional<LawInUse> in_use;  ///< of a claimed law that a file can express
};

/// Where laws of a kind of readings depend on and enter: those of the left chain or of the belt tl, each followed by
/// the others'.
struct LawEntries {
  grid::diagnosis::Coordinate length;
  grid::diagnosis::Coordinate angle;
  grid::diagnosis::Enters reading;
};
inline constexpr LawEntries kOfChains{grid::diagnosis::Coordinate::length_left,
                                      grid::diagnosis::Coordinate::angle_left,
                                      grid::diagnosis::Enters::left};
inline constexpr LawEntries kOfBelts{grid::diagnosis::Coordinate::length_tl,
                                     grid::diagnosis::Coordinate::angle_tl,
                                     grid::diagnosis::Enters::tl};

[[nodiscard]] std::string words_of(const generator::SizedLaw& law, const LawEntries& entries);
/// Takes over the laws that were found and compares them with the hidden one, if there is one.
void judge_laws(const grid::diagnosis::Diagnosis& found,
                const generator::HiddenLaw* hidden,
                const LawEntries& entries,
                LawsTrial& trial);
/// Sets trial.seconds to the processor time of a call.
template <class Call>
auto timed(LawsTrial& trial, Call call) {
  const double start = thread_seconds();
  auto result = call();
  trial.seconds = thread_seconds() - start;
  return result;
}

/// 28, 60 and 117 points in turn.
[[nodiscard]] LawsTrial run_laws_trial(std::string_view kind,
                                       std::uint64_t seed,
                                       bool in_use = false);
[[nodiscard]] std::string line_of(std::string_view kind, const LawsTrial& trial);

}  // namespace chaintrue::sealed
