// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Folds of what a name gains: the naming and every fit repeated without some units, and what each way of
/// modelling then leaves at them.
///
/// \code
///   const HeldOutFolds folds(analysis);
///   const Fold fold = folds.without(block);   // fold.errors.extended: mm at the units of the block
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/downdating.hpp"

namespace chaintrue::grid::diagnosis {

/// The models without some units, positions in the session, and what is decided on by them: with the gate for all
/// units, and the classes of these.
struct DecidedWithout {
  Downdating::Without models;
  Decision decision;
};
[[nodiscard]] DecidedWithout decided_without(const Analysis& analysis,
                                             const Downdating& downdating,
                                             const std::vector<std::size_t>& units);

/// Errors of the tool in mm, for every way of modelling.
struct Errors {
  std::vector<Eigen::Vector2d> calibrated, surface_only;
  /// With the causes that the fold itself names.
  std::vector<Eigen::Vector2d> extended, extended_and_surface;
  /// With the causes that all units name, their sizes fitted without the fold.
  std::vector<Eigen::Vector2d> fixed_naming, fixed_naming_and_surface;
};

/// Held-out units of one fold.
struct Fold {
  std::vector<std::size_t> units;
  Errors errors;
  std::vector<CauseClass> named;
};

class HeldOutFolds {
 public:
  /// Keeps the analysis by reference.
  explicit HeldOutFolds(const Analysis& analysis);

  /// \param units  of the analysis' session, to be left out of everything. The gate and the decision are those for all
  /// units; the models are those that the whole comparison holds, weighed without these units (downdating.hpp). Units
  /// that are outliers or slips of the whole session are not among the fold's.
  [[nodiscard]] Fold without(const std::vector<std::size_t>& units) const;

 private:
  const Analysis& analysis_;
  Downdating downdating_;
};

}  // namespace chaintrue::grid::diagnosis
