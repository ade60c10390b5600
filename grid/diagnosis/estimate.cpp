// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/estimate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

/// Linear unknowns with a prior each.
struct Unknowns {
  Eigen::MatrixXd design;
  Eigen::VectorXd mean;
  Eigen::VectorXd sigma;
};

struct Solution {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

Solution solve(const Unknowns& unknowns,
               const Eigen::VectorXd& data,
               const Eigen::LLT<Eigen::MatrixXd>* noise) {
  Eigen::MatrixXd design = unknowns.design;
  Eigen::VectorXd y = data;
  if (noise != nullptr) {
    noise->matrixL().solveInPlace(design);
    noise->matrixL().solveInPlace(y);
  }
  // Scaled by the priors the normal equations are well conditioned: I + S A'A S.
  const Eigen::MatrixXd scaled = design * unknowns.sigma.asDiagonal();
  Eigen::MatrixXd normal = scaled.transpose() * scaled;
  normal.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(normal);
  const Eigen::VectorXd x = llt.solve(scaled.transpose() * (y - design * unknowns.mean));
  const Eigen::MatrixXd inverse =
      llt.solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols()));
  return {unknowns.mean + unknowns.sigma.cwiseProduct(x),
          unknowns.sigma.asDiagonal() * inverse * unknowns.sigma.asDiagonal()};
}

}  // namespace

Estimate estimate(const Session& session,
                  const LinearisedSystem& system,
                  const MarginalisedSystem& marginalised,
                  const std::vector<int>& regressors,
                  int discrepancy) {
  Estimate result;
  result.regressors = regressors;
  const auto settings = system.setting.size();
  result.coefficient = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(regressors.size()));
  result.coefficient_sigma = result.coefficient;
  Eigen::VectorXd data = system.e;
  for (std::size_t k = 0; k < regressors.size(); ++k) {
    if (system.regressors[static_cast<std::size_t>(regressors[k])].fixed) {
      result.coefficient(static_cast<Eigen::Index>(k)) = 1.0;
      data -= system.g.col(regressors[k]);
    } else {
      result.free.push_back(k);
    }
  }
  Eigen::LLT<Eigen::MatrixXd> noise;
  Discrepancy process;
  if (discrepancy >= 0) {
    process = discrepancy_of(marginalised, discrepancy);
    Eigen::MatrixXd c = process.sigma_mm * process.sigma_mm *
                        discrepancy_covariance(session, system, marginalised.kept, process.kernel);
    c.diagonal().array() += 1.0;
    noise.compute(c);
  }
  Solution solution;
  // A coefficient that leaves its bounds is fixed there and the rest solved again.
  while (true) {
    const auto free = static_cast<Eigen::Index>(result.free.size());
    Unknowns unknowns{
        Eigen::MatrixXd(static_cast<Eigen::Index>(marginalised.kept.size()), settings + free),
        Eigen::VectorXd::Zero(settings + free),
        Eigen::VectorXd(settings + free)};
    unknowns.design.leftCols(settings) = system.by_setting(marginalised.kept, Eigen::all);
    unknowns.mean.head(settings) = system.expected_change;
    unknowns.sigma.head(settings) = system.sigma;
    for (Eigen::Index k = 0; k < free; ++k) {
      const int column = regressors[result.free[static_cast<std::size_t>(k)]];
      unknowns.design.col(settings + k) = system.g(marginalised.kept, column);
      unknowns.sigma(settings + k) =
          kWideSignalToNoise / std::max(marginalised.g.col(column).norm(), 1e-12);
    }
    solution = solve(unknowns, data(marginalised.kept), discrepancy >= 0 ? &noise : nullptr);
    std::size_t outside = result.free.size();
    for (std::size_t k = 0; k < result.free.size(); ++k) {
      const Regressor& d = system.regressors[static_cast<std::size_t>(regressors[result.free[k]])];
      const double value = solution.value(settings + static_cast<Eigen::Index>(k));
      if (value < d.lowest || value > d.highest) outside = k;
    }
    if (outside == result.free.size()) break;
    const auto at = static_cast<Eigen::Index>(result.free[outside]);
    const Regressor& d =
        system.regressors[static_cast<std::size_t>(regressors[result.free[outside]])];
    result.coefficient(at) = std::clamp(
        solution.value(settings + static_cast<Eigen::Index>(outside)), d.lowest, d.highest);
    data -= system.g.col(regressors[result.free[outside]]) * result.coefficient(at);
    result.free.erase(result.free.begin() + static_cast<std::ptrdiff_t>(outside));
  }
  result.setting_change = solution.value.head(settings);
  Eigen::VectorXd left = data - system.by_setting * result.setting_change;
  for (std::size_t k = 0; k < result.free.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(result.free[k]);
    const Eigen::Index column = settings + static_cast<Eigen::Index>(k);
    result.coefficient(at) = solution.value(column);
    left -= system.g.col(regressors[result.free[k]]) * result.coefficient(at);
  }
  result.left = left;
  result.left_beside_discrepancy = left;
  const Eigen::VectorXd kept = left(marginalised.kept);
  double quadratic = kept.squaredNorm();
  if (discrepancy >= 0) {
    result.discrepancy = process;
    result.discrepancy_weights = noise.solve(kept);
    quadratic = kept.dot(result.discrepancy_weights);
    result.left_beside_discrepancy -= discrepancy_in_rows(session, system, marginalised, result);
  }
  const Eigen::VectorXd off =
      (result.setting_change - system.expected_change).cwiseQuotient(system.sigma);
  const NoiseDensity density(session.noise_dof,
                             static_cast<Eigen::Index>(marginalised.kept.size()));
  result.noise_square = density.noise_square(quadratic + off.squaredNorm());
  result.covariance = solution.covariance * result.noise_square;
  result.setting_covariance = result.covariance.topLeftCorner(settings, settings);
  for (std::size_t k = 0; k < result.free.size(); ++k) {
    const Eigen::Index column = settings + static_cast<Eigen::Index>(k);
    result.coefficient_sigma(static_cast<Eigen::Index>(result.free[k])) =
        std::sqrt(result.covariance(column, column));
  }
  for (std::size_t k = 0; k < regressors.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const bool is_fixed = system.regressors[static_cast<std::size_t>(regressors[k])].fixed;
    if (is_fixed || result.coefficient_sigma(at) > 0.0) continue;
    const double length = std::max(marginalised.g.col(regressors[k]).norm(), 1e-12);
    result.coefficient_sigma(at) = std::sqrt(result.noise_square) / length;
  }
  return result;
}

Eigen::Vector2d discrepancy_at(const Session& session,
                               const LinearisedSystem& system,
                               const MarginalisedSystem& marginalised,
                               const Estimate& estimate,
                               const DiscrepancyPlace& place) {
  Eigen::Vector2d mm = Eigen::Vector2d::Zero();
  const Eigen::Index size = system.unit_rows;
  for (Eigen::Index a = 0; a + size <= estimate.discrepancy_weights.size(); a += size) {
    const Eigen::Index row = marginalised.kept[static_cast<std::size_t>(a)];
    if (row >= session.observed_rows()) break;
    const auto weights = estimate.discrepancy_weights.segment(a, size);
    for (const SeenPlace& seen : system.units[static_cast<std::size_t>(row / size)]) {
      mm +=
          discrepancy_block(
              estimate.discrepancy.kernel, place, discrepancy_place(session, system, seen.place)) *
          seen.by_chain.topRows(size).transpose() * weights;
    }
  }
  return estimate.discrepancy.sigma_mm * estimate.discrepancy.sigma_mm * mm;
}

Eigen::VectorXd discrepancy_in_rows(const Session& session,
                                    const LinearisedSystem& system,
                                    const MarginalisedSystem& marginalised,
                                    const Estimate& estimate) {
  std::vector<Eigen::Vector2d> chains;
  for (std::size_t i = 0; i < system.points.size(); ++i) {
    chains.push_back(discrepancy_at(
        session, system, marginalised, estimate, discrepancy_place(session, system, i)));
  }
  Eigen::VectorXd all = Eigen::VectorXd::Zero(session.rows());
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    for (const SeenPlace& seen : system.units[u]) {
      all.segment(system.unit_rows * static_cast<Eigen::Index>(u), system.unit_rows) +=
          (seen.by_chain * chains[seen.place]).head(system.unit_rows);
    }
  }
  return all;
}

Eigen::VectorXd left_of_machine(const LinearisedSystem& system,
                                const Estimate& estimate,
                                const Eigen::VectorXd& left) {
  if (system.nuisances == 0) return left;
  return left + nuisance_columns(system) * estimate.setting_change.tail(system.nuisances);
}

std::vector<Eigen::Vector2d> chain_residuals(const LinearisedSystem& system,
                                             const Eigen::VectorXd& whitened) {
  std::vector<Eigen::Vector2d> result;
  for (std::size_t i = 0; i < system.points.size(); ++i) {
    result.emplace_back(system.points[i].whitening.inverse() *
                        whitened.segment<2>(2 * static_cast<Eigen::Index>(i)));
  }
  return result;
}

Eigen::Vector2d error_of_unit(const LinearisedSystem& system,
                              const Eigen::VectorXd& whitened,
                              std::size_t unit) {
  const auto at = static_cast<Eigen::Index>(unit);
  if (system.unit_rows == 1) return {whitened(at) * system.row_sigma_mm(at), 0.0};
  const PointState& state = system.points[unit];
  const Eigen::Vector2d chain = state.whitening.inverse() * whitened.segment<2>(2 * at);
  return tool_shift(state, chain);
}

double noise_of_unit_mm2(const Session& session, const LinearisedSystem& system, std::size_t unit) {
  const auto at = static_cast<Eigen::Index>(unit);
  if (system.unit_rows == 1) {
    const Eigen::RowVectorXd nuisance =
        nuisance_columns(system).row(at) * system.sigma.tail(system.nuisances).asDiagonal();
    return std::pow(system.row_sigma_mm(at), 2) * (1.0 + nuisance.squaredNorm());
  }
  const Eigen::Matrix2d inverse = system.points[unit].by_mark.inverse();
  return 2.0 * std::pow(session.noise.position_mm, 2) +
         (inverse * inverse.transpose()).trace() * std::pow(session.noise.length_mm, 2);
}

Eigen::Vector2d tool_shift(const PointState& point, const Eigen::Vector2d& chain_mm) {
  return point.by_mark.inverse() * chain_mm;
}

}  // namespace chaintrue::grid::diagnosis
