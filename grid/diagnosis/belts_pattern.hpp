// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A pattern in four belts' lengths that nobody listed: what is left of each belt's lengths changes
/// smoothly from place to place. Private to grid/diagnosis.
///
///   cov(f_b(p), f_c(q)) = s^2 exp(-|p - q|^2 / (2 l^2))  for b = c, else 0                  (1)
///
/// f_b is added to the readings of belt b; a place's two checks see Q' f. Each length l is tried at
/// some strengths, s such that the pattern is expected to be so many sigmas long in the checks once
/// the anchors have taken their share. Rows that are whitened by V = I + (1) are a system like any
/// other, with the pattern integrated out.
///
/// A pattern is numbered length by length and strength by strength (CandidateModel::discrepancy).
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

inline constexpr std::size_t kPatternKernels = 5;
inline constexpr std::size_t kPatternStrengths = 4;

/// A check of a place, as a pattern sees it.
struct PatternRow {
  model::FramePoint at;
  std::optional<int> order;
  Eigen::Vector4d check;  ///< Q' of each belt, over one sigma
};
/// Of the analysis' kept rows.
[[nodiscard]] std::vector<PatternRow> pattern_rows(const BeltsAnalysis& analysis,
                                                   const std::vector<Eigen::Index>& kept);
/// (1) between rows for s = 1 mm, in units of noise.
[[nodiscard]] Eigen::MatrixXd pattern_covariance(const std::vector<PatternRow>& rows,
                                                 const std::vector<PatternRow>& columns,
                                                 std::size_t kernel);
[[nodiscard]] inline std::size_t pattern_kernel_of(int pattern) {
  return static_cast<std::size_t>(pattern) / kPatternStrengths;
}
/// s^2 of a pattern with that covariance of the kept rows, `root` that of their anchors.
[[nodiscard]] double pattern_square(const Eigen::MatrixXd& covariance,
                                    const CovarianceRoot& root,
                                    int pattern);
/// Logarithm of its share of all patterns beforehand.
[[nodiscard]] double log_share_of_pattern(int pattern);

/// V = L L' of a pattern in the kept rows.
struct PatternNoise {
  Eigen::LLT<Eigen::MatrixXd> root;
  double log_det = 0.0;
};
[[nodiscard]] PatternNoise beside_pattern(const Eigen::MatrixXd& covariance,
                                          const CovarianceRoot& root,
                                          int pattern);

/// With the pattern of the decision integrated out of system and comparison from here on: sizes,
/// sigmas and what is said of other causes are then beside it. Nothing where the decision has none.
void integrate_pattern(BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
