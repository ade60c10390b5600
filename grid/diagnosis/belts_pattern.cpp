// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_pattern.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// A pattern over the places, and half of it over the visits where it changes with these as well.
struct Kernel {
  double length_mm;
  double visits;  ///< 0: it does not
};
/// From twice the usual distance of two places to a quarter of a frame; over the visits of a row.
constexpr std::array<Kernel, kPatternKernels> kKernels = {Kernel{150.0, 0.0},
                                                          Kernel{300.0, 0.0},
                                                          Kernel{600.0, 0.0},
                                                          Kernel{300.0, 6.0},
                                                          Kernel{600.0, 6.0}};
/// In sigmas: from what is hardly seen to what real frames leave, four times over.
constexpr std::array<double, kPatternStrengths> kStrengths = {6.0, 12.0, 24.0, 48.0};
double bell(double away, double length) {
  const double in_lengths = away / length;
  // Beyond six lengths there is nothing: e^-18.
  return std::abs(in_lengths) < 6.0 ? std::exp(-0.5 * in_lengths * in_lengths) : 0.0;
}

/// Of what is added to a belt at two places.
double alike(const PatternRow& p, const PatternRow& q, const Kernel& kernel) {
  const double by_place =
      bell(std::hypot(p.at.x_mm - q.at.x_mm, p.at.y_mm - q.at.y_mm), kernel.length_mm);
  if (kernel.visits == 0.0 || !p.order || !q.order) return by_place;
  return 0.5 * (by_place + bell(*p.order - *q.order, kernel.visits));
}

double strength_of_pattern(int pattern) {
  return kStrengths.at(static_cast<std::size_t>(pattern) % kPatternStrengths);
}

}  // namespace

double log_share_of_pattern(int pattern) {
  // A half-Cauchy density in steps of equal ratio (discrepancy.hpp).
  const auto weight = [](double s) { return s / (1.0 + std::pow(s / kDiscrepancyScale, 2)); };
  double all = 0.0;
  for (const double s : kStrengths) all += weight(s);
  return std::log(weight(strength_of_pattern(pattern)) / all / kKernels.size());
}

std::vector<PatternRow> pattern_rows(const BeltsAnalysis& a,
                                     const std::vector<Eigen::Index>& kept) {
  std::vector<PatternRow> rows;
  for (const Eigen::Index row : kept) {
    const auto point = static_cast<std::size_t>(row / 2);
    rows.push_back({a.state.frame.state.places[point],
                    a.belts.points[point].order,
                    a.linear.checks[point].col(row % 2) / a.sigma_mm});
  }
  return rows;
}

Eigen::MatrixXd pattern_covariance(const std::vector<PatternRow>& rows,
                                   const std::vector<PatternRow>& columns,
                                   std::size_t kernel) {
  const Kernel& own = kKernels.at(kernel);
  Eigen::MatrixXd covariance(static_cast<Eigen::Index>(rows.size()),
                             static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          rows[i].check.dot(columns[j].check) * alike(rows[i], columns[j], own);
    }
  }
  return covariance;
}

double pattern_square(const Eigen::MatrixXd& covariance, const CovarianceRoot& root, int pattern) {
  // What is left of it once the anchors have taken their share.
  const double trace = root.solve(root.solve(covariance).transpose()).trace();
  return std::pow(strength_of_pattern(pattern), 2) / std::max(trace, 1e-300);
}

PatternNoise beside_pattern(const Eigen::MatrixXd& covariance,
                            const CovarianceRoot& root,
                            int pattern) {
  Eigen::MatrixXd v = covariance * pattern_square(covariance, root, pattern);
  v.diagonal().array() += 1.0;
  PatternNoise noise{Eigen::LLT<Eigen::MatrixXd>(v), 0.0};
  noise.log_det = 2.0 * Eigen::MatrixXd(noise.root.matrixL()).diagonal().array().log().sum();
  return noise;
}

void integrate_pattern(BeltsAnalysis& a) {
  Analysis& own = a.analysis;
  Decision& decision = own.decision;
  if (!decision.discrepancy_left || decision.best_discrepancy < 0) return;
  MarginalisedSystem& space = own.comparison.marginalised_systems[decision.marginalised];
  const std::size_t kernel = pattern_kernel_of(decision.best_discrepancy);
  a.pattern_length_mm = kKernels.at(kernel).length_mm;
  const std::vector<PatternRow> rows = pattern_rows(a, space.kept);
  const PatternNoise pattern =
      beside_pattern(pattern_covariance(rows, rows, kernel), space.root, decision.best_discrepancy);
  RegressorSystem& system = own.system;
  const auto whiten = [&](auto&& columns) {
    Eigen::MatrixXd kept = columns(space.kept, Eigen::all);
    pattern.root.matrixL().solveInPlace(kept);
    columns(space.kept, Eigen::all) = kept;
  };
  Eigen::MatrixXd e = system.e;
  whiten(e);
  system.e = e;
  whiten(system.by_setting);
  Eigen::MatrixXd g = system.g.dense();
  whiten(g);
  system.g = RegressorColumns(std::move(g));
  space = marginalise(system, space.outliers, own.options.steps);
  own.estimate = estimate(system, space, decision.regressors, -1);
  const Eigen::VectorXd beside = own.estimate.left(space.kept);
  // Of what anchors and causes leave the pattern takes (V - I) V^-1; L^-1 of it is at hand.
  const Eigen::VectorXd all = pattern.root.matrixL() * beside;
  const Eigen::VectorXd taken = all - pattern.root.matrixU().solve(beside);
  a.pattern_rms_mm =
      a.sigma_mm * std::sqrt(taken.squaredNorm() / static_cast<double>(taken.size()));
  a.pattern_share = std::min(1.0, taken.squaredNorm() / std::max(all.squaredNorm(), 1e-300));
  decision.discrepancy_left = false;
  decision.best_discrepancy = -1;
}

}  // namespace chaintrue::grid::diagnosis
