// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws as columns of a marginalised system, next to those of causes.
///
///   LawSystem system(analysis, number, sets);
///   system.take(system.columns(curve, points));       // columns 0, 1, ... of laws
///   const NormalEquations equations = system.equations(discrepancy);
///   const double w = system.log_weight(equations, {set, discrepancy}, {0});
#pragma once

#include <compare>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/discrepancy_basis.hpp"
#include "grid/diagnosis/law_curves.hpp"

namespace chaintrue::grid::diagnosis {

/// Causes that act, by their number among the sets, and a discrepancy or none.
struct LawContext {
  std::size_t set = 0;
  int discrepancy = -1;
  friend bool operator==(const LawContext&, const LawContext&) = default;
  friend auto operator<=>(const LawContext&, const LawContext&) = default;
};

/// Amplitudes of a law in a context.
struct LawAmplitudes {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

class LawSystem {
 public:
  /// `number` of one of the comparison's marginalised systems; `sets` of the system's regressors. The
  /// analysis must outlive this.
  LawSystem(const Analysis& analysis,
            std::size_t number,
            const std::vector<std::vector<int>>& sets);
  LawSystem(const LawSystem&) = delete;
  LawSystem& operator=(const LawSystem&) = delete;

  /// A curve's columns at these grid points, in the kept rows after projection on the settings.
  [[nodiscard]] Eigen::MatrixXd columns(const LawCurve& curve, const std::vector<double>& at) const;
  /// Replaces the columns of laws.
  void take(const Eigen::MatrixXd& laws);

  /// For the causes and the laws taken last.
  [[nodiscard]] NormalEquations equations(int discrepancy);
  /// Log prior and evidence of a context with some of the laws' columns; without the laws' prior.
  [[nodiscard]] double log_weight(const NormalEquations& equations,
                                  const LawContext& context,
                                  const std::vector<Eigen::Index>& laws) const;
  [[nodiscard]] LawAmplitudes amplitudes(const NormalEquations& equations,
                                         const LawContext& context,
                                         const std::vector<Eigen::Index>& laws) const;

  [[nodiscard]] const DiscrepancyFamily& family() const { return *own_.discrepancies; }
  [[nodiscard]] std::size_t sets() const { return sets_.size(); }
  [[nodiscard]] Eigen::Index rows() const { return marginalised_.kept.size(); }

 private:
  /// Columns in a context: of its causes and of some laws.
  [[nodiscard]] std::vector<Eigen::Index> all_columns(const LawContext& context,
                                                      const std::vector<Eigen::Index>& laws) const;
  struct Priors {
    double alone = 0.0;
    double given = 0.0;  ///< with a discrepancy
  };
  const RegressorSystem& from_;
  MarginalisedSystem marginalised_;
  NoiseDensity noise_;
  LawColumns columns_;
  RegressorSystem own_;
  Eigen::MatrixXd causes_;
  std::vector<Regressor> cause_regressors_;
  std::vector<std::vector<Eigen::Index>> sets_;
  std::vector<Priors> log_prior_;
  std::optional<DiscrepancyBasis> basis_;
  std::deque<NormalEquations> plains_;  ///< the basis refers to them
  const NormalEquations* plain_ = nullptr;
  std::map<std::size_t, DiscrepancyBasis::GivenKernel> given_;
};

}  // namespace chaintrue::grid::diagnosis
