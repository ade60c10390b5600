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

namespace chaintrue::sealed {

/// "laws", "two", "gaussian", "matern", "stretched", "uneven", "nothing", "causes", "near_causes".
struct LawsKind {
  std::string_view word;
  std::string_view hidden;  ///< for the table
  bool is_law = false;      ///< of one variable
};
[[nodiscard]] const std::vector<LawsKind>& laws_kinds();

/// What a claimed law, written as an effect of the user's own, is worth afterwards.
struct LawInUse {
  using Says = grid::diagnosis::DeclaredAnswer::Says;
  /// Of a second session of the same machine at marks of its own, and of the session of another machine with
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
  generator::Answer answer;
  bool failed = false;
  std::vector<grid::diagnosis::Law> laws;
  bool reported = false;   ///< some law
  bool claimed = false;    ///< one at kLawClaimed
  bool leads = false;      ///< the first is right: variable and place of entry
  bool in_set = false;     ///< one of those reported is
  /// Largest distance of a place, period or size from the truth, in sigmas, of a law that leads with the
  /// right shape; empty otherwise.
  std::optional<double> worst_sigmas;
  bool cause_named = false;  ///< of sets with a listed cause
  double seconds = 0.0;
  std::string sentence;
  std::optional<LawInUse> in_use;  ///< of a claimed law that a file can say
};

/// 28, 60 and 117 points in turn.
[[nodiscard]] LawsTrial run_laws_trial(std::string_view kind, std::uint64_t seed, bool in_use = false);
[[nodiscard]] std::string line_of(std::string_view kind, const LawsTrial& trial);

}  // namespace chaintrue::sealed
