// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A frame at the bottom of its least squares, readings seen from fits without them, and which of
/// them are set aside. Private to grid/belts.
///
/// Of a reading with residual r, weight w and row x (frame and place), h = w x C x':
///
///   off = r / (1 - h)                    read less what all others make of it               (1)
///   t   = r / (s_out sqrt(1 - h)),       s_out^2 = (s^2 n - r^2 / (1 - h)) / (n - 1)        (2)
///
/// with n checks and spread s. Of one that is set aside off = r, and s^2 (1 + h) is its variance.
#pragma once

#include <optional>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/frame_solver.hpp"

namespace chaintrue::grid::belts {

struct AnchorFit {
  FrameState state;
  Counting counting;
  double spread_mm = 0.0;
  Eigen::Index checks = 0;
  /// At the bottom, with right anchors right of the left ones and upper above lower ones.
  bool is_sound = false;
};

/// From the likeliest start that leads to a sound frame, every reading counting; where none does the
/// one that fits best, and empty where no start leads anywhere.
[[nodiscard]] std::optional<AnchorFit> settle(const MeasuredBelts& belts);
/// The same without the readings that do not fit.
[[nodiscard]] std::optional<AnchorFit> settle_robustly(const MeasuredBelts& belts);
/// From a state near by, with what counts given.
[[nodiscard]] std::optional<AnchorFit> settle_from(const MeasuredBelts& belts,
                                                   FrameState state,
                                                   Counting counting);

/// What is known about a settled frame: its equations and covariances.
class FitDiagnostics {
 public:
  /// `belts` outlives this.
  FitDiagnostics(const MeasuredBelts& belts, const AnchorFit& frame);

  [[nodiscard]] const AnchorAdjustment& solver() const { return solver_; }
  [[nodiscard]] const FrameEquations& equations() const { return equations_; }
  [[nodiscard]] const AnchorAdjustment::Reduced& reduced() const { return reduced_; }
  /// Of the frame's unknowns. Not finite, or with a negative diagonal, where they are not determined.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  [[nodiscard]] Eigen::Matrix2d place_covariance_mm2(std::size_t point) const;
  /// w x C: how the frame's unknowns answer to a reading.
  [[nodiscard]] Eigen::VectorXd influence(std::size_t point, model::Belt belt) const;
  [[nodiscard]] BeltResidual residual(std::size_t point, model::Belt belt) const;
  /// The anchors without any reading of a point, to first order.
  [[nodiscard]] AnchorVector anchors_without(std::size_t point) const;

 private:
  AnchorFit frame_;
  AnchorAdjustment solver_;
  FrameEquations equations_;
  AnchorAdjustment::Reduced reduced_;
  Eigen::MatrixXd covariance_;
};

}  // namespace chaintrue::grid::belts
