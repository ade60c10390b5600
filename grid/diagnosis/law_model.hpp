// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One explanation, possibly with a law: the covariance of the kept rows with the settings, the
/// sizes of causes and the amplitudes of a law integrated out.
///
///   C = 1 + S + s^2 K + sum_k p_k^2 g_k g_k',   S of the settings as stated, K of a discrepancy
///   r = C^-1 (e - m)   posterior mean of the noise in rows e, after subtracting m
///
/// \code
///   LawModel model(analysis, marginalised, {3, 7}, -1);
///   const Eigen::VectorXd noise = model.noise_of(law);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

class LawModel {
 public:
  /// `regressors` of the system; `discrepancy` -1 for none. Both arguments must outlive this.
  LawModel(const Analysis& a,
           const MarginalisedSystem& marginalised,
           const RegressorSet& regressors,
           int discrepancy)
      : system_(a.system), marginalised_(marginalised), dof_(a.system.noise_dof) {
    const KeptRows& kept = marginalised.kept;
    settings_ = linear::scaled_columns(kept.of(a.system.by_setting), a.system.sigma);
    covariance_ = linear::one_plus_outer(settings_);
    if (discrepancy >= 0) {
      process_ = discrepancy_of(a.system, marginalised, discrepancy);
      discrepancy_ =
          square_of(*process_) * discrepancy_covariance(a.system, kept, process_->kernel);
      covariance_ += discrepancy_;
    }
    for (const int k : regressors) add(Eigen::VectorXd(a.system.g.col(k)));
    Eigen::VectorXd e = a.system.e;
    linear::add_product(e, -1.0, a.system.by_setting, a.system.expected_change);
    e_ = kept(e);
  }

  /// Adds a column (all rows) of unknown amplitude.
  void add(const Eigen::VectorXd& column) {
    const Eigen::VectorXd own = marginalised_.kept(column);
    // Amplitude at the usual strength.
    const double sigma =
        kUsualSignalToNoise / std::max(marginalised_.root.solve(own).norm(), 1e-12);
    linear::add_outer(covariance_, sigma * sigma, own);
    columns_.push_back(sigma * own);
    sigmas_.push_back(sigma);
  }

  /// For all kept rows, after subtracting `known` (all rows).
  [[nodiscard]] double log_density(const Eigen::VectorXd& known) const {
    const linear::Cholesky factor(covariance_);
    return NoiseDensity(dof_, e_.size())
               .log_density(factor.half_solve(e_ - marginalised_.kept(known)).squaredNorm()) -
           0.5 * factor.log_det();
  }

  /// The noise part of the kept rows and, with the discrepancy added, the machine's residual, after
  /// subtracting `known` (all rows).
  struct Left {
    Eigen::VectorXd noise;
    Eigen::VectorXd unexplained;
  };
  [[nodiscard]] Left left_of(const Eigen::VectorXd& known) const {
    Left left;
    left.noise = linear::Cholesky(covariance_).solve(e_ - marginalised_.kept(known));
    left.unexplained = left.noise;
    if (discrepancy_.size() > 0)
      linear::add_product(left.unexplained, 1.0, discrepancy_, left.noise);
    return left;
  }

  /// The prediction of other rows, whitened, from all kept ones: mean, and the
  /// covariance without their noise. `columns` of these rows: the regressors', then those added.
  ///   m = X* f + K* C^-1 (e - X f),  S = K** - K* C^-1 K*'
  /// C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations 2.38 and 2.39.
  struct Expected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };
  [[nodiscard]] Expected expected_of(const RegressorSystem& next,
                                     const Eigen::MatrixXd& columns) const {
    const Eigen::Index settings = settings_.cols();
    Eigen::MatrixXd here(settings_.rows(), settings + columns.cols());
    Eigen::MatrixXd there(next.by_setting.rows(), settings + columns.cols());
    here.leftCols(settings) = settings_;
    there.leftCols(settings) =
        linear::scaled_columns(next.by_setting.leftCols(settings), system_.sigma);
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
      here.col(settings + k) = columns_[as_size(k)];
      there.col(settings + k) = sigmas_[as_size(k)] * columns.col(k);
    }
    Eigen::MatrixXd across = linear::product(there, linear::transposed(here));
    Eigen::MatrixXd own = linear::outer(there);
    // Holes not yet cut have their own columns, after all others.
    const Eigen::Index to_come = next.by_setting.cols() - settings;
    linear::add_outer(
        own,
        1.0,
        linear::scaled_columns(next.by_setting.rightCols(to_come), next.sigma.tail(to_come)));
    if (process_) {
      across += square_of(*process_) *
                discrepancy_covariance(next, system_, marginalised_.kept, process_->kernel);
      own += square_of(*process_) *
             discrepancy_covariance(next, next, KeptRows::all(next), process_->kernel);
    }
    const linear::Cholesky factor(covariance_);
    Expected expected;
    expected.mean = linear::product(next.by_setting.leftCols(settings), system_.expected_change);
    linear::add_product(expected.mean, 1.0, across, factor.solve(e_));
    linear::add_gram(own, -1.0, factor.half_solve(across.transpose()));
    expected.covariance = without_negligible(own);
    return expected;
  }

  /// The kept rows without some of them, from one factorisation. With P = C^-1, O the rows left out and K the others:
  ///   e_K' C_KK^-1 e_K = e'P e - (P e)_O' P_OO^-1 (P e)_O,   |C_KK| = |C| |P_OO|
  ///   e_O - C_OK C_KK^-1 e_K = P_OO^-1 (P e)_O
  /// As in downdating.hpp.
  class Downdated {
   public:
    explicit Downdated(const LawModel& model) : dof_(model.dof_) {
      const linear::Cholesky factor(model.covariance_);
      precision_ = factor.inverse();
      weighed_ = linear::product(precision_, model.e_);
      quadratic_ = model.e_.dot(weighed_);
      log_det_ = factor.log_det();
    }
    struct Without {
      double log_density = 0.0;  ///< of the other rows
      Eigen::VectorXd
          left;  ///< of those left out: the difference from the prediction by the others
    };
    /// By their positions.
    [[nodiscard]] Without without(const Rows& rows) const {
      const linear::Cholesky block(precision_(rows, rows));
      const Eigen::VectorXd weighed = weighed_(rows);
      Without result{0.0, block.solve(weighed)};
      const double quadratic = quadratic_ - weighed.dot(result.left);
      result.log_density = NoiseDensity(dof_, weighed_.size() - weighed.size())
                               .log_density(std::max(quadratic, 0.0)) -
                           0.5 * (log_det_ + block.log_det());
      return result;
    }

   private:
    double dof_;
    Eigen::MatrixXd precision_;
    Eigen::VectorXd weighed_;  ///< P e
    double quadratic_;
    double log_det_;
  };

 private:
  static double square_of(const Discrepancy& process) {
    return process.sigma_mm * process.sigma_mm;
  }

  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  double dof_;
  std::optional<Discrepancy> process_;
  Eigen::MatrixXd settings_;              ///< kept rows, scaled to one sigma each
  std::vector<Eigen::VectorXd> columns_;  ///< the same
  std::vector<double> sigmas_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd discrepancy_;  ///< s^2 K; empty without one
  Eigen::VectorXd e_;
};

/// An explanation with the amplitudes of a law at one place; null for the likeliest without a law.
[[nodiscard]] inline LawModel model_with(const Analysis& a,
                                         const LawEvidence& evidence,
                                         const WeighedLaw* law) {
  LawModel model(a,
                 a.comparison.marginalised_systems[evidence.marginalised],
                 evidence.sets[law != nullptr ? law->set : evidence.without_set],
                 law != nullptr ? law->discrepancy : evidence.without_discrepancy);
  if (law == nullptr) return model;
  const Eigen::MatrixXd columns = law_columns(a.system, evidence.curves[law->curve], {law->at});
  for (Eigen::Index k = 0; k < columns.cols(); ++k) model.add(Eigen::VectorXd(columns.col(k)));
  return model;
}

}  // namespace chaintrue::grid::diagnosis
