// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One explanation, possibly with a law: the covariance of the kept rows with the settings, the
/// sizes of causes and the amplitudes of a law integrated out.
///
///   C = R (1 + B B') R,   R of the settings as stated, B = R^-1 (s F, p_k g_k ...), F F' = K of a discrepancy
///   r = C^-1 (e - m)   posterior mean of the noise in rows e, after subtracting m
///
/// \code
///   const LawModel model(analysis, marginalised, {{3, 7}, -1});
///   const Eigen::VectorXd noise = model.left_of(law).noise;
/// \endcode
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "grid/diagnosis/covariance_root.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"
#include "grid/diagnosis/laws.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

class LawModel {
 public:
  /// `law`: columns of a law, all rows. The analysis and the system must outlive this.
  LawModel(const Analysis& a, const MarginalisedSystem& marginalised, const ActsBesides& besides,
           const std::optional<MatrixXd>& law = {})
      : system_(a.system),
        marginalised_(marginalised),
        pattern_(
            marginalised.kept(discrepancy_columns(a.system, marginalised, besides.discrepancy))),
        columns_(a.system.g.dense(besides.causes)) {
    if (besides.discrepancy >= 0)
      process_ = discrepancy_of(a.system, marginalised, besides.discrepancy);
    if (law) {
      columns_.conservativeResize(Eigen::NoChange, columns_.cols() + law->cols());
      columns_.rightCols(law->cols()) = *law;
    }
    columns_ = marginalised.kept(columns_);
    const MatrixXd own = marginalised.root.solve(columns_);
    // These are amplitudes at the usual strength.
    sigmas_ = kUsualSignalToNoise / own.colwise().norm().transpose().array().max(1e-12);
    columns_ = linear::scaled_columns(columns_, sigmas_);
    reduced_.resize(own.rows(), pattern_.cols() + own.cols());
    reduced_ << marginalised.root.solve(pattern_), linear::scaled_columns(own, sigmas_);
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
    linear::add_product(left.unexplained, 1.0, pattern_, linear::inner(pattern_, left.noise));
    return left;
  }

  /// The prediction of other rows, whitened, from all kept ones: mean, and the
  /// covariance without their noise. `columns` of these rows: the regressors', then the law's.
  ///   m = X* f + K* C^-1 (e - X f),  S = K** - K* C^-1 K*'
  /// C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations 2.38 and 2.39.
  Alternative expected_of(const RegressorSystem& next, const MatrixXd& columns) const {
    const Index settings = system_.by_setting.cols();
    MatrixXd here(columns_.rows(), settings + columns.cols());
    here << linear::scaled_columns(marginalised_.kept(system_.by_setting), system_.sigma), columns_;
    MatrixXd there(next.by_setting.rows(), here.cols());
    there << linear::scaled_columns(next.by_setting.leftCols(settings), system_.sigma),
        linear::scaled_columns(columns, sigmas_);
    MatrixXd across = linear::product(here, linear::transposed(there));
    MatrixXd own = linear::outer(there);
    // Holes not yet cut have their own columns, after all others.
    const Index to_come = next.by_setting.cols() - settings;
    linear::add_outer(
        own, 1.0,
        linear::scaled_columns(next.by_setting.rightCols(to_come), next.sigma.tail(to_come)));
    if (process_) {
      const auto [of_next, of_both] = discrepancy_at(next, *process_, system_, marginalised_.kept);
      across += of_both.transpose();
      own += of_next;
    }
    const LowRankNoise noise(reduced_);
    const MatrixXd half = noise.half_solve(marginalised_.root.solve(across));
    Alternative expected;
    expected.mean = linear::product(next.by_setting.leftCols(settings), system_.expected_change);
    linear::add_product(expected.mean, 1.0, linear::transposed(half),
                        noise.half_solve(marginalised_.e));
    linear::add_gram(own, -1.0, half);
    expected.covariance = without_negligible(own);
    return expected;
  }

  /// The kept rows, after subtracting `known` (all rows), without some of them, from one factorisation.
  class Downdated {
   public:
    explicit Downdated(const LawModel& model)
        : Downdated(model, VectorXd::Zero(model.system_.e.size())) {}
    Downdated(const LawModel& model, const VectorXd& known)
        : dof_(model.system_.noise_dof),
          rows_(model.marginalised_.root, LowRankNoise(model.reduced_), model.left_by(known)) {}
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
  /// R^-1 (e - known)
  VectorXd left_by(const VectorXd& known) const {
    return marginalised_.e - reduced(marginalised_, known);
  }

  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  std::optional<Discrepancy> process_;
  MatrixXd pattern_;  ///< s F in the kept rows; no columns without a discrepancy
  MatrixXd columns_;  ///< kept rows of the regressors and the law, scaled to one sigma each
  VectorXd sigmas_;   ///< of these
  MatrixXd reduced_;  ///< B
};

/// The system in which a law was weighed.
inline const MarginalisedSystem& marginalised_system(const Analysis& a, const WeighedLaw& law) {
  return a.comparison.marginalised_systems[law.marginalised];
}
/// The likeliest explanation with the amplitudes of a law at one place, and without a law.
inline LawModel model_with(const Analysis& a, const WeighedLaw& law) {
  return {a, marginalised_system(a, law), law.with, law.columns(a.system)};
}
inline LawModel model_without(const Analysis& a, const WeighedLaw& law) {
  return {a, marginalised_system(a, law), law.without};
}

// Partial residuals of a law: at each point the law plus the unexplained residual, in the
// coordinate that it enters.
//
//   z_i = law(v_i) + c_i'r_i / c_i'c_i
//   c   rows of the point for one millimetre of the law,  r  noise (law_model.hpp)
//
// If the law is right, points scatter about the curve as the readings do.

// The error of predicting left-out readings with a law, compared with the settings, the
// causes and the best smooth pattern without one.
//
//   e_i^ = C_ik C_kk^-1 e_k,   C as in law_model.hpp, k the rows that are kept, i those left out
//
// Inside: every fourth of the places, four times, so that neighbours stay. Outside: the quarters
// of the bed on one side of a line (bed_parts.hpp), left out whole. Every distance that ends at
// such a place is left out: others would determine its hole. Sizes are estimated anew each time,
// and the place or period is chosen anew among the leading values of its grid; shape and entry
// stay.
//
// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equation 2.25.

/// The points of one curve, the heaviest first.
using LawPoints = std::vector<const WeighedLaw*>;

/// For the law at one of the points of its curve; absent if no parts of the bed can be left out.
std::optional<LawHeldOut> held_out_with(const Analysis& analysis, const WeighedLaw& law,
                                        const LawPoints& of_curve);

/// The probability of a law averaged over parts of the bed, as that of causes given a pattern is
/// (bed_parts.hpp): a real pattern follows no law exactly, and a slightly wrong likelihood gives
/// large odds from a few marks. A true law holds without any quarter of the bed.
///
///   odds_k = odds (f r_k - r),   r = log p(e | law, S, D) - log p(e | S0, D0)
///
/// r_k without quarter k, f the share of rows that it counts for; S, D and S0, D0 the best contexts with the
/// law and without one. The result is the mean of the probabilities, and no more than that of all readings.
/// (J. Huggins and J. Miller, Bayesian Analysis 18 (2023) 79.)

/// `probability` is that of all readings; it is returned if there are no such parts.
double averaged_over_parts(const Analysis& analysis, const WeighedLaw& law, double probability);

/// For the points that are kept whole, in the order of the files; `law` with the parameters of `weighed`.
std::vector<LawResidual> residuals_about(const Analysis& analysis, const WeighedLaw& weighed,
                                         const Law& law);

}  // namespace chaintrue::grid::diagnosis
