// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From the comparison's probabilities to a verdict: which causes are present, which cannot be distinguished,
/// and when to abstain.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

/// Causes that these data cannot separate, however strong. The first names the class: a cause in
/// the machine precedes one on the paper. A cause that acts in whole numbers and one that acts by
/// any amount form one class if the fitted amount is such a number; the likelier is first.
using CauseClass = std::vector<CauseId>;
std::vector<CauseClass> classes_of(const RegressorSystem& system,
                                   const ModelComparison& comparison);

/// The regressor of each visible cause that the data are nearest to.
std::vector<std::pair<CauseId, int>> best_regressors(const RegressorSystem& system,
                                                     const MarginalisedSystem& marginalised);

struct ClassProbability {
  std::size_t index = 0;  ///< into the classes
  double probability = 0.0;
};

struct Decision {
  Verdict verdict = Verdict::nothing_found;
  std::vector<CauseClass> classes;
  /// Probability of being present, alone or with others; most probable first.
  std::vector<ClassProbability> marginal;
  double nothing = 0.0;
  double noise = 0.0;
  double outliers = 0.0;
  double discrepancy_alone = 0.0;
  double caused = 0.0;       ///< one cause or more
  double discrepancy = 0.0;  ///< with a model discrepancy, with causes or alone
  /// The causes of the verdict (indices into classes): the one named, the set, or those that act
  /// together.
  Indices listed;
  /// The model: one regressor per cause, the discrepancy or -1, the marginalised system.
  RegressorSet regressors;
  int best_discrepancy = -1;
  bool discrepancy_left = false;
  std::size_t marginalised = 0;

  /// The cause that names each listed class.
  std::vector<CauseId> leaders() const;
  /// The class of a cause; the number of classes if it has none.
  std::size_t class_of(const CauseId& cause) const;
  /// Probability of a class; 0 if there is no such class.
  double probability_of(std::size_t index) const;
};

/// `detected`: the strongest effect exceeds what noise produces (family-wise). Only the rejected
/// points of the comparison's marginalised systems are used.
Decision decide(const RegressorSystem& system, const ModelComparison& comparison,
                const Flags& excluded, bool detected, std::vector<CauseClass> classes);

/// Names no cause: what remains is an unexplained pattern or nothing. Probabilities are kept.
void withdraw_names(const ModelComparison& comparison, Decision& decision);

}  // namespace chaintrue::grid::diagnosis
