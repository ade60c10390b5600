// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors and places from belt lengths: one weighted least-squares problem whose places are
/// eliminated. Private to grid/belts.
///
/// Notation
///   a    the frame: x and y of tl, x and y of tr, x of br; then, with distances, the logarithm of
///        the scale and the places at which a tape ends
///   p_k  place k, two unknowns
///   r    read less predicted, mm
///   J_a, J_p  d(predicted)/d(a), d(predicted)/d(p_k)
///   w    1 / sigma^2 of a belt's reading, or 0 where it is set aside
///
///   V_k = J_p' w J_p,   U_k = J_a' w J_p
///   S   = J_a' w J_a - sum_k U_k V_k^-1 U_k'                                                (1)
///   S da = J_a' w r - sum_k U_k V_k^-1 J_p' w r                                             (2)
///   dp_k = V_k^-1 (J_p' w r - U_k' da)                                                      (3)
///   cov a = S^-1,   cov p_k = V_k^-1 + V_k^-1 U_k' S^-1 U_k V_k^-1                          (4)
///
/// The scale s is that of everything that belts see against the tape: a taped distance is (1 + s)
/// times what anchors and places make of it. Belts alone say nothing of s, and nothing is said of it
/// without a distance.
///
/// A place at which fewer than two readings count tells nothing and is left out.
///
/// Source: B. Triggs et al., Bundle Adjustment - A Modern Synthesis (2000), section 6, for (1) to
/// (3); K. Madsen, H. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems (2004),
/// section 3.2, for the damping.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "grid/belts/first_frames.hpp"

namespace chaintrue::grid::belts {

/// The equations about a state.
struct FrameEquations {
  double cost = 0.0;  ///< r' w r of everything that counts; infinite where a belt cannot be
  double belts_square_mm2 = 0.0;      ///< sum of r^2 of the belts' readings that count
  Eigen::VectorXd residual;           ///< 4 N, mm; of all readings, those set aside too
  Eigen::MatrixX2d by_place;          ///< 4 N x 2, d(predicted)/d(place)
  Eigen::VectorXd distance_residual;  ///< in sigmas
  Eigen::MatrixXd distance_by_frame;  ///< in sigmas, a column for each unknown of the frame
};

class AnchorAdjustment {
 public:
  /// `belts` outlives this. \throws std::logic_error where `counting` is not of its points, or a
  /// hole stands beside anchors that are not known.
  AnchorAdjustment(const MeasuredBelts& belts, Counting counting, double sigma_mm);

  /// From this state to the nearest minimum. False where it does not settle.
  [[nodiscard]] bool solve(FrameState& state) const;
  [[nodiscard]] FrameEquations equations(const FrameState& state) const;

  /// Of the frame's unknowns: 5, with distances the scale, and the taped places.
  [[nodiscard]] Eigen::Index unknowns() const { return unknowns_; }
  [[nodiscard]] bool fits_scale() const { return !belts_.distances.empty(); }
  [[nodiscard]] double sigma_mm() const { return sigma_mm_; }
  [[nodiscard]] const Counting& counting() const { return counting_; }
  [[nodiscard]] bool counts(std::size_t point, model::Belt belt) const {
    return is_placed_[point] && counting_[point][belt];
  }
  /// At least two of its readings count.
  [[nodiscard]] bool is_placed(std::size_t point) const { return is_placed_[point]; }
  /// A tape ends there: its place is among the frame's unknowns.
  [[nodiscard]] bool is_taped(std::size_t point) const { return place_column_[point] >= 0; }
  /// Where the two unknowns of a taped place stand in the frame's.
  [[nodiscard]] Eigen::Index place_column(std::size_t point) const { return place_column_[point]; }
  /// Readings and distances that count, less unknowns.
  [[nodiscard]] Eigen::Index degrees_of_freedom() const;
  /// The same of the belts' readings alone, as if the distances were not there.
  [[nodiscard]] Eigen::Index belt_degrees_of_freedom() const;

  /// What (1) to (4) need of a point, about one state.
  struct Eliminated {
    Eigen::Matrix2d inverse = Eigen::Matrix2d::Zero();   ///< V^-1
    Eigen::MatrixX2d cross;                              ///< U
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< J_p' w r
  };
  struct Reduced {
    Eigen::MatrixXd normal;          ///< S
    Eigen::VectorXd gradient;        ///< right side of (2)
    std::vector<Eliminated> points;  ///< empty blocks where a place is taped or left out
  };
  /// `damping` is added to the diagonals, as a share of them.
  [[nodiscard]] Reduced reduce(const FrameEquations& at, double damping) const;
  /// A reading's row of J_a, places that are taped included.
  [[nodiscard]] Eigen::VectorXd frame_row(const FrameEquations& at,
                                          std::size_t point,
                                          model::Belt belt) const;
  /// V, U and J_p' w r of a point, whatever counts at others.
  [[nodiscard]] Eliminated eliminated(const FrameEquations& at,
                                      std::size_t point,
                                      double damping) const;

 private:
  void add_belts(const FrameState& state, FrameEquations& equations) const;
  void add_distances(const FrameState& state, FrameEquations& equations) const;
  [[nodiscard]] FrameState stepped(const FrameState& state,
                                   const Reduced& reduced,
                                   const Eigen::VectorXd& step) const;

  const MeasuredBelts& belts_;
  Counting counting_;
  double sigma_mm_;
  Eigen::Index unknowns_ = kAnchorUnknowns;
  std::vector<Eigen::Index> place_column_;  ///< into the frame's unknowns; -1: eliminated
  std::vector<bool> is_placed_;
};

}  // namespace chaintrue::grid::belts
