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
#include "grid/diagnosis/observations.hpp"

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

/// Errors of the tool in mm with some causes, without a surface and with one.
struct ErrorsWith {
  std::vector<Eigen::Vector2d> machine, and_surface;
};
/// For every choice of causes.
struct Errors {
  ErrorsWith calibrated;    ///< none
  ErrorsWith extended;      ///< those that the fold itself names
  ErrorsWith fixed_naming;  ///< those that all units name, their sizes fitted without the fold
};

/// Held-out units of one fold.
struct Fold {
  std::vector<std::size_t> units;
  Errors errors;
  std::vector<CauseId> named;
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

/// Units held out together, and what they are.
struct HeldOutBlocks {
  std::vector<std::vector<std::size_t>> units;  ///< empty where there are too few units
  bool of_the_bed = false;                      ///< or each hole with all distances that end there
};

/// What is held out tells of the tool where chains were read at marks enough, else of distances.
[[nodiscard]] HeldOutBlocks held_out_blocks(const ObservationSet& session);

}  // namespace chaintrue::grid::diagnosis
