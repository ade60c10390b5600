// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/discrepancy_basis.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "grid/parallel.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The largest residual of the field's unit variance at any place. A hundredth of its sigma, which
/// is seldom beyond a millimetre.
constexpr double kLeftOfField = 1e-4;

/// The inner products of one field: the rows of its first component, then those of its second.
struct Products {
  DiscrepancyField field;  ///< without its direction
  MatrixXd rows;           ///< 2 r x N, R^-1 times its effect on the kept rows, transposed
  MatrixXd gram;           ///< 2 r x 2 r
  /// With the residual and the columns of some normal equations, 2 r x (1 + columns).
  std::map<const NormalEquations*, MatrixXd> with;
};

/// A share of a kernel's basis: c times a field's first component plus s times its second.
struct Block {
  Products* products = nullptr;
  double c = 0.0;
  double s = 0.0;

  Index rank() const { return products->rows.rows() / 2; }
  MatrixXd mixed(const MatrixXd& by_component) const {
    return c * by_component.topRows(rank()) + s * by_component.bottomRows(rank());
  }
};

}  // namespace

/// Fields that several kernels share.
class DiscrepancyBasis::Fields {
 public:
  Fields(const RegressorSystem& system, const MarginalisedSystem& marginalised)
      : system_(system), marginalised_(marginalised) {}

  Products& of(const DiscrepancyKernel& kernel) {
    const MatrixXd factor = reduced(marginalised_, discrepancy_factor(system_, kernel));
    const MatrixXd first = low_rank(linear::outer(factor), kLeftOfField);
    return add(kernel.fields.front(), first, MatrixXd::Zero(first.rows(), first.cols()));
  }
  Products& of(DiscrepancyField field) {
    field.direction_rad.reset();
    auto* known = find_where(all_, having(&Products::field, field));
    if (known != nullptr) return *known;
    const std::vector<MatrixXd> parts = field_factor(system_, field, kLeftOfField);
    return add(field, reduced(marginalised_, parts[0]), reduced(marginalised_, parts[1]));
  }
  /// Inner products of a block with the residual and these columns.
  MatrixXd with(const Block& block, const NormalEquations& plain) {
    const auto [known, is_new] = block.products->with.try_emplace(&plain);
    if (is_new) known->second = linear::product(block.products->rows, plain.rows);
    return block.mixed(known->second);
  }

  /// Computes the inner products of all fields with these columns, so that `with` changes nothing.
  void relate_all(const NormalEquations& plain) {
    for (Products& own : all_) own.with.try_emplace(&plain);
    for_each_index(all_.size(), [&](std::size_t k) {
      all_[k].with.at(&plain) = linear::product(all_[k].rows, plain.rows);
    });
  }

  void forget() {
    for (Products& own : all_) own.with.clear();
  }

 private:
  Products& add(const DiscrepancyField& field, const MatrixXd& first, const MatrixXd& second) {
    Products& p = all_.emplace_back();
    p.field = field;
    p.rows.resize(2 * first.cols(), first.rows());
    p.rows << first.transpose(), second.transpose();
    p.gram = linear::outer(p.rows);
    return p;
  }

  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  std::deque<Products> all_;  ///< blocks point into it
};

namespace {

/// B'B
MatrixXd gram_of(const std::vector<Block>& blocks) {
  Index rank = 0;
  for (const Block& block : blocks) rank += block.rank();
  MatrixXd all(rank, rank);
  Index row = 0;
  for (const Block& a : blocks) {
    Index column = 0;
    for (const Block& b : blocks) {
      const MatrixXd both = a.products == b.products
                                ? a.products->gram
                                : linear::product(a.products->rows,
                                                  linear::transposed(b.products->rows));
      const MatrixXd part = b.mixed(a.mixed(both).transpose());
      all.block(column, row, part.rows(), part.cols()) = part;
      column += part.rows();
    }
    row += a.rank();
  }
  return all;
}

}  // namespace

struct DiscrepancyBasis::Kernel {
  std::vector<Block> blocks;
  linear::Tridiagonal tridiagonal;
  MatrixXd turned;  ///< Q'B', r x N, if prepared
};

DiscrepancyBasis::DiscrepancyBasis(const RegressorSystem& system, MarginalisedSystem& marginalised,
                                   const Indices& kernels)
    : marginalised_(marginalised),
      fields_(std::make_unique<Fields>(system, marginalised)),
      kernels_(system.discrepancies->kernels.size()) {
  marginalised.discrepancy_trace.resize(kernels_.size(), 0.0);
  for (const std::size_t number : kernels) {
    const DiscrepancyKernel& kernel = system.discrepancies->kernels[number];
    Kernel& own = kernels_[number];
    if (kernel.of_lengths()) own.blocks.push_back({&fields_->of(kernel), 1.0, 0.0});
    const double share = 1.0 / std::sqrt(as_double(kernel.fields.size()));
    for (const DiscrepancyField& field : kernel.fields) {
      if (kernel.of_lengths()) break;
      Products* const products = &fields_->of(field);
      for (const VectorXd& entry : entries_of(field, 2))
        own.blocks.push_back({products, share * entry[0], share * entry[1]});
    }
  }
  for_each_index(kernels.size(), [&](std::size_t k) {
    MatrixXd all = gram_of(kernels_[kernels[k]].blocks);
    marginalised.discrepancy_trace[kernels[k]] = all.trace();
    kernels_[kernels[k]].tridiagonal = linear::Tridiagonal(std::move(all));
  });
}

DiscrepancyBasis::~DiscrepancyBasis() = default;

void DiscrepancyBasis::prepare(std::size_t number) {
  Kernel& own = kernels_.at(number);
  own.turned.resize(own.tridiagonal.diagonal().size(), marginalised_.e.size());
  Index row = 0;
  for (const Block& block : own.blocks) {
    own.turned.middleRows(row, block.rank()) = block.mixed(block.products->rows);
    row += block.rank();
  }
  own.tridiagonal.rotate_in_place(own.turned);
}

void DiscrepancyBasis::relate(const NormalEquations& plain) { fields_->relate_all(plain); }
void DiscrepancyBasis::forget() { fields_->forget(); }

DiscrepancyBasis::GivenKernel DiscrepancyBasis::given(std::size_t kernel,
                                                      const NormalEquations& plain) {
  const Kernel& own = kernels_.at(kernel);
  GivenKernel result;
  result.plain_ = &plain;
  result.trace_ = marginalised_.discrepancy_trace.at(kernel);
  const auto lines = std::ssize(plain.columns) + 1;
  if (own.blocks.empty() || !(result.trace_ > 0.0)) {
    result.rotated_.resize(lines, 0);
    return result;
  }
  result.on_ = own.tridiagonal.diagonal();
  result.subdiagonal_ = own.tridiagonal.subdiagonal();
  MatrixXd with(result.on_.size(), lines);
  if (own.turned.size() > 0) {
    with = linear::product(own.turned, plain.rows);
  } else {
    Index row = 0;
    for (const Block& block : own.blocks) {
      const MatrixXd part = fields_->with(block, plain);
      with.middleRows(row, part.rows()) = part;
      row += part.rows();
    }
    own.tridiagonal.rotate_in_place(with);
  }
  result.rotated_ = with.transpose();
  return result;
}

DiscrepancyBasis::GivenKernel::Half DiscrepancyBasis::GivenKernel::half(double strength) const {
  // J + 1 / s^2 = L D L', L with ones on its diagonal and one entry next to each
  const double shift = trace_ / (strength * strength);
  const Index r = on_.size();
  Half result{ArrayXd(r), ArrayXd::Zero(r), 0.0};
  double d = 0.0;
  for (const Index k : each_below(r)) {
    const double own = on_(k) + shift;
    const double before = k > 0 ? subdiagonal_(k - 1) : 0.0;
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
