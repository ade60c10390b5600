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
#include "grid/containers.hpp"
#include "grid/estimation/observation_set.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {

/// Columns of a surface for each chain: polynomials and the penalised basis.
struct SurfaceColumns {
  Eigen::Index polynomials = 0;
  Eigen::Index penalised = 0;
};

class Unknowns {
 public:
  Unknowns(const ObservationSet& set, SurfaceColumns surface)
      : stated_(set.mechanism), surface_(surface), of_set_(as_size(set.stated_value.size())) {
    const bool frame_is_laid = !set.parts.empty() && set.parts.front().sheet.has_value();
    settings_ = parameters() + (frame_is_laid ? kSheet : 0);
    total_ = settings_ + scales() + 2 * (surface.polynomials + surface.penalised);
    for (std::size_t i = 0; i < set.parts.size(); ++i) {
      sheet_.push_back(-1);
      if (set.parts[i].sheet) {
        sheet_.back() = i == 0 ? parameters() : total_;
        if (i > 0) total_ += kSheet;
      }
      const auto zeros = as_index(set.parts[i].zero_columns.size());
      zeros_.push_back(zeros > 0 ? total_ : -1);
      total_ += zeros;
      nuisance_.push_back(total_);
      total_ += set.parts[i].observation->nuisance_sigma().size();
    }
    sigma_ = Eigen::VectorXd::Zero(total_);
    for (std::size_t i = 0; i < set.parts.size(); ++i) {
      const ObservationPart& part = set.parts[i];
      const std::vector<Eigen::Index> own = columns_of(i);
      const std::vector<Eigen::Index> there = set.columns_of(part);
      for (std::size_t k = 0; k < own.size(); ++k) {
        of_set_[as_size(there[k])] = own[k];
        sigma_[own[k]] = set.stated_sigma[there[k]];
      }
      for (std::size_t z = 0; z < part.zero_columns.size(); ++z) {
        const Eigen::Index column = zeros_[i] + as_index(z);
        of_set_[as_size(part.zero_columns[z])] = column;
        sigma_[column] = set.stated_sigma[part.zero_columns[z]];
      }
      for (std::size_t q = 0; q < part.nuisance_columns.size(); ++q) {
        of_set_[as_size(part.nuisance_columns[q])] = nuisance_[i] + as_index(q);
      }
    }
  }

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
  [[nodiscard]] std::vector<Eigen::Index> columns_of(std::size_t observation) const {
    std::vector<Eigen::Index> columns;
    for (Eigen::Index i = 0; i < parameters(); ++i) columns.push_back(i);
    for (Eigen::Index i = 0; sheet_[observation] >= 0 && i < kSheet; ++i)
      columns.push_back(sheet_[observation] + i);
    return columns;
  }

  /// Index of each column of the observation set among the unknowns.
  [[nodiscard]] const std::vector<Eigen::Index>& of_set() const { return of_set_; }

  /// Stated parameters minus the values that they deviate from.
  [[nodiscard]] Eigen::VectorXd stated_deviations() const {
    Eigen::VectorXd deviations = Eigen::VectorXd::Zero(parameters());
    for (Eigen::Index i = 0; i < parameters(); ++i) {
      const auto& stated = stated_->parameters()[as_size(i)].stated;
      if (stated) deviations[i] = *stated - stated_->values()[i];
    }
    return deviations;
  }

  /// The mechanism and the sheets for a vector of all unknowns.
  [[nodiscard]] std::shared_ptr<const model::Mechanism> mechanism_at(
      const Eigen::VectorXd& unknowns) const {
    return stated_->with_values(stated_->values() + unknowns.head(parameters()));
  }

  [[nodiscard]] model::SheetPlacement sheet_at(const Eigen::VectorXd& unknowns,
                                               std::size_t observation) const {
    const Eigen::Index first = sheet_[observation];
    if (first < 0) return {};
    return {unknowns[first], unknowns[first + 1], unknowns[first + 2]};
  }

 private:
  static constexpr auto kSheet = std::ssize(model::kSheetSettings);

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
