// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A frame between its belts and the tape: what the distances of all sets are about one state, their
/// covariance, and the minimum of (1) of belts_and_holes.hpp. Private to grid/belts.
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/belt_holes.hpp"
#include "grid/belts/settled_frame.hpp"

namespace chaintrue::grid::belts {

/// Added to the variance of a rejected distance, mm^2: as of a tape read to ten metres, so that it
/// weighs nothing.
inline constexpr double kRejectedMm2 = 1e8;

/// Size and reach of the displacement, and what the noise is more than was stated.
struct TapedNoise {
  double factor = 1.0;
  double size_mm = 0.0;  ///< 0: no displacement
  double reach_mm = 1.0;
};

/// The distances of all sets, one below the other.
struct TapedRows {
  Eigen::VectorXd residual_mm;
  Eigen::MatrixXd by_frame;             ///< n x 6
  Eigen::MatrixXd by_mark;              ///< n x 2 N
  Eigen::MatrixXd by_size;              ///< n x 2, of each set's own sheet
  Eigen::MatrixXd by_sheet;             ///< n x 3, the same
  std::vector<model::MarkPoint> marks;  ///< of all holes, from where the first set's commands count
};

class TapedFrame {
 public:
  /// `belts` and `sets` outlive this. `alone` is the frame that the belts settled on by themselves,
  /// of no points the stated one.
  TapedFrame(const MeasuredBelts& belts, const std::vector<BeltHoles>& sets, AnchorFit alone);

  [[nodiscard]] std::optional<TapedRows> rows(const FrameState& state) const;
  /// C about these rows; those set aside are known to nothing.
  [[nodiscard]] Eigen::MatrixXd covariance(const TapedRows& rows,
                                           const TapedNoise& noise,
                                           const std::vector<bool>& counting) const;
  /// S_b: of the frame by everything but the holes.
  [[nodiscard]] Eigen::MatrixXd covariance_without_holes(const FrameState& state) const;
  /// r_b.
  [[nodiscard]] Eigen::VectorXd about_the_belts(const TapedRows& rows,
                                                const FrameState& state) const;
  /// The minimum nearest to `state`, with C as it is; empty where it does not settle.
  [[nodiscard]] std::optional<FrameState> settled(FrameState state,
                                                  const Eigen::MatrixXd& covariance) const;
  [[nodiscard]] const AnchorFit& alone() const { return alone_; }

 private:
  struct Normal {
    double cost = 0.0;
    Eigen::MatrixXd matrix;
    Eigen::VectorXd gradient;
    std::optional<AnchorAdjustment::Reduced> belts;
  };
  /// Of everything but the holes.
  [[nodiscard]] Normal of_the_belts(const FrameState& state) const;
  [[nodiscard]] std::optional<Normal> normal(const FrameState& state,
                                             const Eigen::MatrixXd& inverse) const;
  [[nodiscard]] FrameState stepped(const FrameState& state,
                                   const Normal& normal,
                                   const Eigen::VectorXd& step) const;

  const MeasuredBelts& belts_;
  const std::vector<BeltHoles>& sets_;
  AnchorFit alone_;
  std::optional<AnchorAdjustment> solver_;  ///< none without points
  Eigen::Index unknowns_ = kFrameUnknowns;
};

}  // namespace chaintrue::grid::belts
