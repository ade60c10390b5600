// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy_basis.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/parallel.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The largest residual of the field's unit variance at any place. A hundredth of its sigma, which
/// is seldom beyond a millimetre.
constexpr double kLeftOfField = 1e-4;

}  // namespace

DiscrepancyBasis::DiscrepancyBasis(const RegressorSystem& system, MarginalisedSystem& marginalised,
                                   const Indices& kernels)
    : kernels_(system.discrepancies->kernels.size()) {
  marginalised.discrepancy_trace.resize(kernels_.size(), 0.0);
  // Several kernels share a field, in other directions.
  std::map<DiscrepancyField, std::vector<MatrixXd>> factors;
  const auto factor_of = [&](DiscrepancyField field) {
    field.direction_rad.reset();
    const auto [own, is_new] = factors.try_emplace(field);
    if (is_new) {
      for (const MatrixXd& part : field_factor(system, field, kLeftOfField))
        own->second.push_back(reduced(marginalised, part));
    }
    return own->second;
  };
  for (const std::size_t number : kernels) {
    const DiscrepancyKernel& kernel = system.discrepancies->kernels[number];
    const MatrixXd b =
        kernel.of_lengths()
            ? low_rank(linear::outer(reduced(marginalised, discrepancy_factor(system, kernel))),
                       kLeftOfField)
            : kernel_factor(kernel, marginalised.e.size(), factor_of);
    kernels_[number].rows = b.transpose();
  }
  for_each_index(kernels.size(), [&](std::size_t k) {
    Kernel& own = kernels_[kernels[k]];
    MatrixXd gram = linear::outer(own.rows);
    own.trace = marginalised.discrepancy_trace[kernels[k]] = gram.trace();
    if (own.trace > 0.0) {
      own.tridiagonal = linear::Tridiagonal(std::move(gram));
      own.tridiagonal.rotate_in_place(own.rows);
    } else {
      own.rows.resize(0, own.rows.cols());
    }
  });
}

DiscrepancyBasis::GivenKernel::GivenKernel(const NormalEquations& plain, const Kernel& kernel)
    : plain_(&plain),
      kernel_(&kernel),
      rotated_(linear::product(kernel.rows, plain.rows).transpose()) {}

DiscrepancyBasis::GivenKernel::Half DiscrepancyBasis::GivenKernel::half(double strength) const {
  // J + 1 / s^2 = L D L', L with ones on its diagonal and one entry next to each
  const double shift = kernel_->trace / (strength * strength);
  const Index r = rotated_.cols();
  Half result{ArrayXd(r), ArrayXd::Zero(r), 0.0};
  double d = 0.0;
  for (const Index k : each_below(r)) {
    const double own = kernel_->tridiagonal.diagonal()(k) + shift;
    const double before = k > 0 ? kernel_->tridiagonal.subdiagonal()(k - 1) : 0.0;
    if (k > 0) result.above(k) = before / std::sqrt(d);
    // J is positive up to rounding
    d = std::max(k > 0 ? own - before * before / d : own, shift);
    result.on(k) = 1.0 / std::sqrt(d);
    result.log_det += std::log(d / shift);
  }
  return result;
}

void DiscrepancyBasis::GivenKernel::apply(const Half& half, MatrixXd& lines) {
  for (const Index k : each_below(lines.cols())) {
    if (k > 0) lines.col(k) -= half.above(k) * lines.col(k - 1);
    lines.col(k) *= half.on(k);
  }
}

DiscrepancyBasis::GivenKernel::Diagonal DiscrepancyBasis::GivenKernel::diagonal(
    double strength) const {
  const Half own = half(strength);
  MatrixXd lines = rotated_;
  apply(own, lines);
  const VectorXd e = lines.row(0);
  const auto g = lines.bottomRows(lines.rows() - 1);
  Diagonal result;
  result.ee = plain_->ee - e.squaredNorm();
  result.ge = plain_->ge;
  linear::add_product(result.ge, -1.0, g, e);
  result.gg = plain_->gg.diagonal() - g.rowwise().squaredNorm();
  result.log_det = plain_->log_det + own.log_det;
  return result;
}

NormalEquations DiscrepancyBasis::GivenKernel::equations(double strength,
                                                         RegressorSet columns) const {
  const ColumnSet at = plain_->positions(columns);
  Rows line = {0};
  for (const Index column : at) line.push_back(column + 1);
  const Half own = half(strength);
  MatrixXd lines = rotated_(line, Eigen::all);
  apply(own, lines);
  const VectorXd e = lines.row(0);
  const auto g = lines.bottomRows(lines.rows() - 1);
  NormalEquations result;
  result.columns = std::move(columns);
  result.ee = plain_->ee - e.squaredNorm();
  result.ge = plain_->ge(at);
  linear::add_product(result.ge, -1.0, g, e);
  result.gg = plain_->gg(at, at);
  linear::add_outer(result.gg, -1.0, g);
  result.prior_square = plain_->prior_square(at);
  result.log_det = plain_->log_det + own.log_det;
  return result;
}

}  // namespace chaintrue::grid::diagnosis
