// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Diagnostics of a fit of anchors: covariances, residuals, left-out readings and places. Private
/// to grid/belts and what reads its fits.
///
/// Notation, of a block of places that are found together (belt_lengths.hpp)
///   a       anchors, with a tape the logarithm of the scale                       p
///   p_b     positions of the block
///   r, w    read minus predicted, and 1 / sigma^2 (0 if not counted)
///   J, A    d(predicted)/d(p_b), d(predicted)/d(a)
///   V = J' w J,   G = V^-1 J' w A
///
///   cov a = (sum_b A' w A - A' w J G)^-1,   cov p_b = V^-1 + G cov(a) G'                     (1)
///
/// For a reading with rows j of J and x of X = A - J G,  h = w (j V^-1 j' + x cov(a) x'):
///
///   deleted = r / (1 - h)                read less what all others make of it               (2)
///   t       = r / (s_out sqrt(1 - h)),   s_out^2 = (s^2 n - r^2 / (1 - h)) / (n - 1)        (3)
///
/// with n checks and spread s. Of one that is rejected deleted = r, and s^2 (1 + h) is its variance.
///
/// Source: B. Triggs et al., Bundle Adjustment - A Modern Synthesis (2000), section 6, for (1).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/containers.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::belts {

/// All readings about a state, 4 N rows; 0 for a belt that cannot reach.
struct ReadingLines {
  VectorXd residual_mm;       ///< read less predicted
  Eigen::MatrixX2d by_place;  ///< d(predicted)/d(place)
};
ReadingLines reading_lines(const MeasuredBelts& belts, const FrameState& state);

/// Includes the residuals of the distances.
struct FitResiduals : ReadingLines {
  std::vector<double> distance_residual_mm;  ///< taped less predicted
};

class FitDiagnostics {
 public:
  FitDiagnostics(const MeasuredBelts& belts, const AnchorFit& frame);

  /// Residuals at places with too few readings, about the fitted place.
  const FitResiduals& equations() const { return equations_; }
  double sigma_mm() const { return frame_.residual_sigma_mm; }
  const AnchorFit& frame() const { return frame_; }
  /// For a. Not finite, or with a negative diagonal, if it is not determined.
  const MatrixXd& covariance() const { return covariance_; }
  /// cov(a)^-1.
  const MatrixXd& precision() const { return precision_; }
  bool has_scale() const { return covariance_.cols() > kAnchorUnknowns; }
  bool counts(std::size_t point, Belt belt) const {
    return is_placed(point) && frame_.counting[point][belt];
  }

  /// At least two of its readings count.
  bool is_placed(std::size_t point) const { return slots_[point].has_value(); }
  /// A tape ends there.
  bool is_taped(std::size_t point) const {
    return slots_[point] && blocks_[slots_[point]->block].is_taped;
  }

  Matrix2d place_covariance_mm2(std::size_t point) const;

  /// w cov(a) x': the response of a to a reading.
  VectorXd influence(std::size_t point, Belt belt) const;

  BeltResidual residual(std::size_t point, Belt belt) const;

  /// A distance as predicted by the fit, and its sigma.
  struct Expected {
    double mm = 0.0;
    double variance_mm2 = 0.0;
    double with_scale = 0.0;  ///< covariance with the scale's logarithm, if there is one
  };
  /// Empty if too few readings determine one of its ends.
  std::optional<Expected> expected(const MeasuredBelts& belts, const BeltDistance& distance) const;

  /// The anchors without the readings of a point that no tape ends at, to first order.
  AnchorVector anchors_without(std::size_t point) const;

 private:
  struct Block {
    observation::BlockLine line;
    MatrixXd inverse;     ///< V^-1
    MatrixXd by_unknown;  ///< G
    MatrixXd left;        ///< X
    bool is_taped = false;
    /// X' w A, and the gradient X' w r.
    MatrixXd precision() const {
      const MatrixXd weighed = line.weight.asDiagonal() * line.by_parameter;
      return linear::inner(left, weighed);
    }
    VectorXd gradient() const {
      return left.transpose() * line.weight.cwiseProduct(line.residual_mm);
    }
  };
  /// Index of a point in its block.
  struct Slot {
    std::size_t block = 0;
    Index place = 0;
    Index row(Belt belt) const { return 4 * place + as_index(belt); }
  };

  AnchorFit frame_;
  std::shared_ptr<const Mechanism> mechanism_;
  std::vector<Block> blocks_;
  std::vector<std::optional<Slot>> slots_;
  FitResiduals equations_;
  MatrixXd precision_;
  MatrixXd covariance_;
};

// Assembles a BeltsFit from anchors, places and their covariances, with the error of predicting
// the lower belts from the upper two at left-out places. Private to grid/belts and what reads its
// fits.

/// `covariance` as below; `residuals_mm` of the distances.
BeltScale scale_of(const FrameState& state, const MatrixXd& covariance,
                   std::vector<double> residuals_mm = {});

/// Everything except the predictions of each half of the places by the other. `belts` and `view`
/// use the same readings; `covariance` is that of the anchors, mm^2, with a tape of the scale's
/// logarithm too.
BeltsFit fit_report(const MeasuredBelts& belts, const FitDiagnostics& view,
                    const MatrixXd& covariance);

/// A fit with what counts given, and the readings as its anchors explain them.
struct Refitted {
  AnchorFit frame;
  MeasuredBelts belts;
};
using Refit = std::function<std::optional<Refitted>(const AnchorFit& from)>;
/// Every second place, in the order of the visits, by the others, and those by these. Empty if a
/// half has fewer than kFewestBeltPoints, or has no fit.
std::optional<BeltPrediction> predict_by_halves(const MeasuredBelts& belts, const AnchorFit& frame,
                                                const Refit& refit);

}  // namespace chaintrue::grid::belts

namespace chaintrue::grid {
using belts::FitDiagnostics;
}  // namespace chaintrue::grid
