// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One explanation, possibly with a law: the covariance of the kept rows with the settings, the
/// sizes of causes and the amplitudes of a law integrated out.
///
///   C = R (1 + B B') R,   R of the settings as stated, B = R^-1 (s F, p_k g_k ...), F F' = K of a discrepancy
///   r = C^-1 (e - m)   posterior mean of the noise in rows e, after subtracting m
///
/// \code
///   LawModel model(analysis, marginalised, {3, 7}, -1);
///   const Eigen::VectorXd noise = model.noise_of(law);
/// \endcode
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/law_evidence.hpp"
#include "grid/diagnosis/leave_out.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::diagnosis {

class LawModel {
 public:
  /// `regressors` of the system; `discrepancy` -1 for none. Both arguments must outlive this.
  LawModel(const Analysis& a, const MarginalisedSystem& marginalised,
           const RegressorSet& regressors, int discrepancy)
      : system_(a.system),
        marginalised_(marginalised),
        pattern_(discrepancy_columns(a.system, marginalised, discrepancy)),
        reduced_(marginalised.root.solve(pattern_)) {
    if (discrepancy >= 0) process_ = discrepancy_of(a.system, marginalised, discrepancy);
    for (const int k : regressors) add(VectorXd(a.system.g.col(k)));
  }

  /// Adds a column (all rows) of unknown amplitude.
  void add(const VectorXd& column) {
    const VectorXd own = reduced(marginalised_, column);
    // Amplitude at the usual strength.
    sigmas_.push_back(kUsualSignalToNoise / std::max(own.norm(), 1e-12));
    columns_.push_back(sigmas_.back() * marginalised_.kept(column));
    reduced_.conservativeResize(Eigen::NoChange, reduced_.cols() + 1);
    reduced_.rightCols(1) = sigmas_.back() * own;
  }

  /// For all kept rows, after subtracting `known` (all rows).
  double log_density(const VectorXd& known) const {
    const LowRankNoise noise(reduced_);
    return density().log_density(noise.half_solve(left_by(known)).squaredNorm()) -
           0.5 * (marginalised_.log_det + noise.log_det());
  }

  /// The noise part of the kept rows and, with the discrepancy added, the machine's residual, after
  /// subtracting `known` (all rows).
  struct Left {
    VectorXd noise;
    VectorXd unexplained;
  };
  Left left_of(const VectorXd& known) const {
    Left left;
    left.noise = marginalised_.root.solve(LowRankNoise(reduced_).solve(left_by(known)));
    left.unexplained = left.noise;
    linear::add_product(left.unexplained, 1.0, pattern_,
                        linear::product(linear::transposed(pattern_), left.noise));
    return left;
  }

  /// The prediction of other rows, whitened, from all kept ones: mean, and the
  /// covariance without their noise. `columns` of these rows: the regressors', then those added.
  ///   m = X* f + K* C^-1 (e - X f),  S = K** - K* C^-1 K*'
  /// C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations 2.38 and 2.39.
  struct Expected {
    VectorXd mean;
    MatrixXd covariance;
  };
  Expected expected_of(const RegressorSystem& next, const MatrixXd& columns) const {
    const Index settings = system_.by_setting.cols();
    const Index rows = marginalised_.kept.size();
    MatrixXd here(rows, settings + columns.cols());
    MatrixXd there(next.by_setting.rows(), settings + columns.cols());
    here.leftCols(settings) =
        linear::scaled_columns(marginalised_.kept(system_.by_setting), system_.sigma);
    there.leftCols(settings) =
        linear::scaled_columns(next.by_setting.leftCols(settings), system_.sigma);
    for (Index k = 0; k < columns.cols(); ++k) {
      here.col(settings + k) = columns_[as_size(k)];
      there.col(settings + k) = sigmas_[as_size(k)] * columns.col(k);
    }
    MatrixXd across = linear::product(here, linear::transposed(there));
    MatrixXd own = linear::outer(there);
    // Holes not yet cut have their own columns, after all others.
    const Index to_come = next.by_setting.cols() - settings;
    linear::add_outer(
        own, 1.0,
        linear::scaled_columns(next.by_setting.rightCols(to_come), next.sigma.tail(to_come)));
    if (process_) {
      const double square = process_->sigma_mm * process_->sigma_mm;
      across +=
          square *
          discrepancy_covariance(next, system_, marginalised_.kept, process_->kernel).transpose();
      own += square * discrepancy_covariance(next, KeptRows::all(next), process_->kernel);
    }
    const LowRankNoise noise(reduced_);
    const MatrixXd half = noise.half_solve(marginalised_.root.solve(across));
    Expected expected;
    expected.mean = linear::product(next.by_setting.leftCols(settings), system_.expected_change);
    linear::add_product(expected.mean, 1.0, linear::transposed(half),
                        noise.half_solve(marginalised_.e));
    linear::add_gram(own, -1.0, half);
    expected.covariance = without_negligible(own);
    return expected;
  }

  /// The kept rows without some of them, from one factorisation.
  class Downdated {
   public:
    explicit Downdated(const LawModel& model)
        : dof_(model.system_.noise_dof),
          rows_(model.marginalised_.root, LowRankNoise(model.reduced_), model.marginalised_.e) {}
    struct Without {
      double log_density = 0.0;  ///< of the other rows
      VectorXd left;  ///< of those left out: the difference from the prediction by the others
    };
    /// By their positions.
    [[nodiscard]] Without without(const Rows& rows) const {
      const LeaveOut::Kept kept = rows_.without(rows);
      const NoiseDensity density(dof_, rows_.rows() - std::ssize(rows));
      return {density.log_density(std::max(kept.inner(0, 0), 0.0)) - 0.5 * kept.log_det,
              kept.missed()};
    }

   private:
    double dof_;
    LeaveOut rows_;
  };

 private:
  NoiseDensity density() const { return {system_.noise_dof, marginalised_.kept.size()}; }
  /// R^-1 (e - known)
  VectorXd left_by(const VectorXd& known) const {
    return marginalised_.e - reduced(marginalised_, known);
  }

  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  std::optional<Discrepancy> process_;
  MatrixXd pattern_;               ///< s F in the kept rows; no columns without a discrepancy
  MatrixXd reduced_;               ///< B
  std::vector<VectorXd> columns_;  ///< kept rows, scaled to one sigma each
  std::vector<double> sigmas_;
};

/// An explanation with the amplitudes of a law at one place; null for the likeliest without a law.
inline LawModel model_with(const Analysis& a, const LawEvidence& evidence, const WeighedLaw* law) {
  LawModel model(a, a.comparison.marginalised_systems[evidence.marginalised],
                 evidence.sets[law != nullptr ? law->set : evidence.without_set],
                 law != nullptr ? law->discrepancy : evidence.without_discrepancy);
  if (law == nullptr) return model;
  const MatrixXd columns = law_columns(a.system, evidence.curves[law->curve], {law->at});
  for (Index k = 0; k < columns.cols(); ++k) model.add(VectorXd(columns.col(k)));
  return model;
}

}  // namespace chaintrue::grid::diagnosis
