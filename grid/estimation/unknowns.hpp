// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The unknowns of a joint estimate, in this order:
///
///   settings      parameters of the mechanism; of the first observation's sheet (3), where it has one
///   scales        of either chain; none of a mechanism of more lengths
///   polynomials   of either chain's surface, as the places observe it (observed_subspace.hpp)
///   penalised     the same
///   the rest      of each observation: its sheet and its zeros if it has its own, its
///                 nuisances
///
/// What comes before the rest is what a map is made of. Settings of the machine and placements of
/// sheets are deviations from what was stated.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "grid/chain_rows.hpp"
#include "grid/estimation/observation_set.hpp"

namespace chaintrue::grid::estimation {

/// Columns of a surface for each chain: polynomials and the penalised basis.
struct SurfaceColumns {
  Eigen::Index polynomials = 0;
  Eigen::Index penalised = 0;
};

class Unknowns {
 public:
  Unknowns(const ObservationSet& set, SurfaceColumns surface);

  /// Number of the mechanism's parameters: the first unknowns.
  [[nodiscard]] Eigen::Index parameters() const { return stated_->values().size(); }
  /// Number of settings: parameters, and those of the first sheet.
  [[nodiscard]] Eigen::Index settings() const { return settings_; }
  /// Two, or none: a surface corrects the lengths of two chains.
  [[nodiscard]] Eigen::Index scales() const { return stated_->lengths().size() == 2 ? 2 : 0; }
  [[nodiscard]] Eigen::Index scale(model::Side side) const { return settings_ + row_of(side); }
  [[nodiscard]] Eigen::Index polynomial(model::Side side) const {
    return settings_ + 2 + row_of(side) * surface_.polynomials;
  }
  [[nodiscard]] Eigen::Index first_penalised_of(model::Side side) const {
    return settings_ + 2 + 2 * surface_.polynomials + row_of(side) * surface_.penalised;
  }
  [[nodiscard]] const SurfaceColumns& surface() const { return surface_; }
  /// Where the columns of an observation's sheet begin; -1: it has none.
  [[nodiscard]] Eigen::Index sheet(std::size_t observation) const { return sheet_[observation]; }
  /// Where the columns of its own zeros begin, two; -1: it has none.
  [[nodiscard]] Eigen::Index zeros(std::size_t observation) const { return zeros_[observation]; }
  /// Where the columns of its nuisances begin.
  [[nodiscard]] Eigen::Index nuisance(std::size_t observation) const {
    return nuisance_[observation];
  }
  [[nodiscard]] Eigen::Index total() const { return total_; }

  /// Prior sigma of a setting's, sheet's or zero's column, infinite without a prior; 0 for the
  /// others.
  [[nodiscard]] double sigma(Eigen::Index column) const { return sigma_[column]; }
  /// Columns of an observation's own settings: the machine's, then its sheet's.
  [[nodiscard]] std::vector<Eigen::Index> columns_of(std::size_t observation) const;
  /// Index of each column of the observation set among the unknowns.
  [[nodiscard]] const std::vector<Eigen::Index>& of_set() const { return of_set_; }

  /// Stated parameters minus the values that they deviate from.
  [[nodiscard]] Eigen::VectorXd stated_deviations() const;

  /// The mechanism and the sheets for a vector of all unknowns.
  [[nodiscard]] std::shared_ptr<const model::Mechanism> mechanism_at(
      const Eigen::VectorXd& unknowns) const;
  [[nodiscard]] model::SheetPlacement sheet_at(const Eigen::VectorXd& unknowns,
                                               std::size_t observation) const;

 private:
  std::shared_ptr<const model::Mechanism> stated_;
  SurfaceColumns surface_;
  Eigen::Index settings_ = 0;
  std::vector<Eigen::Index> sheet_;
  std::vector<Eigen::Index> zeros_;
  std::vector<Eigen::Index> nuisance_;
  std::vector<Eigen::Index> of_set_;
  Eigen::Index total_ = 0;
  Eigen::VectorXd sigma_;
};

}  // namespace chaintrue::grid::estimation
