// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Right names over false ones as the threshold on a score varies.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "planted/judge/baselines.hpp"

namespace chaintrue::planted {

/// Causes that no points separate have one name: links long on both sides and a tape long along both
/// axes; a skip and a zero that moved.
[[nodiscard]] bool same_class(std::string_view one, std::string_view other);

/// A name that a method gives in one set.
struct ScoredName {
  double score = 0.0;
  bool right = false;  ///< otherwise false
};
/// What one method says of many sets.
struct Method {
  std::string name;
  double usual = 0.0;  ///< threshold in common use
  int sets = 0;
  int hidden = 0;  ///< causes in all sets
  std::vector<ScoredName> names{};

  /// Of one set. Each hidden cause is named once at most, by its likeliest name. `no_matter`: names that count
  /// neither way.
  void add(const Scores& scores,
           const std::vector<std::string>& hidden_here,
           const std::vector<std::string>& no_matter = {});
};

struct CurvePoint {
  int right = 0;
  int wrong = 0;
};
/// With all names of this score and more.
[[nodiscard]] CurvePoint at_threshold(const Method& method, double threshold);
/// The most right names at a threshold with at most so many false ones.
[[nodiscard]] CurvePoint at_most_wrong(const Method& method, int wrong);

/// As Markdown: right names, in % of the hidden ones, with so many false ones in 100 sets; and what the
/// usual threshold gives.
[[nodiscard]] std::string curves_table(const std::vector<Method>& methods);

/// Methods on the same sets.
struct CurveGroup {
  std::string title;
  std::vector<Method> methods;
};
/// As SVG, a panel a group: right names, in % of the hidden ones, over false ones in 100 sets, up to 50; a dot where
/// the usual threshold stands.
[[nodiscard]] std::string curves_svg(const std::vector<CurveGroup>& groups);

}  // namespace chaintrue::planted
