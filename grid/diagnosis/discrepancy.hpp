// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The model discrepancy: a repeatable pattern over the bed that no cause explains, as a Gaussian
/// process (M. Kennedy and A. O'Hagan, J. R. Stat. Soc. B 63 (2001), 425).
///
/// Most disturbances act on one thing: one chain, one axis of the sheet, the sled's height, the
/// tension. So a field is a smooth scalar function of one thing (the place, x, y, one chain's
/// length, angle or tension) and enters the two chains, or the tool's two coordinates, at a fixed
/// ratio; fields that enter both freely are tried as well.
///
///   cov(r_i, r_j) = s^2 / F sum_f k_f(t_i, t_j) T_i D_f T_j'
///   k(t, u) = exp(-|t - u|^2 / (2 length^2)),  t what the field is a function of
///   T  identity where it enters the chains, J = d(L, R)/d(mark) where it moves the tool
///   D  d d' with d = (cos, sin) of the direction of entry, or the identity where it has none; of
///      the border d = (1, 1), and either component has its own t and weight
///
/// In mechanisms other than two chains each length is disturbed separately, equal in
/// variance: T and D are identities over its lengths.
///
///   F  fields of the kernel; of several lengths where something displaced has a trend as well
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "grid/diagnosis/kept_rows.hpp"
#include "grid/diagnosis/law.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

enum class FieldEntry {
  chains,
  tool,
  lengths,  ///< each length of the mechanism by a separate function, of place or visit
};

struct DiscrepancyField {
  /// For the border: a drop over it moves the tool outwards, by one function of the distance from
  /// the side for x and from the top or bottom for y.
  Coordinate of = Coordinate::place;
  double length = 0.0;  ///< in the unit of its variable
  FieldEntry entry = FieldEntry::chains;
  std::optional<double> direction_rad{};  ///< of entry: of (left, right), or of (x, y)
  double across_rad = 0.0;                ///< from x, of Coordinate::across
  /// For FieldEntry::lengths the one length that it disturbs; absent: each of them.
  std::optional<Index> alone{};
  bool operator==(const DiscrepancyField&) const = default;
};

struct DiscrepancyKernel {
  std::vector<DiscrepancyField> fields;  ///< equal in variance
  double prior = 0.0;                    ///< share among all kernels
  /// Whether its fields disturb each length of the mechanism separately.
  bool of_lengths() const { return !fields.empty() && fields.front().entry == FieldEntry::lengths; }
};

/// The discrepancies that are tried with a mechanism: each kernel at each strength, numbered
/// kernel * strengths + strength.
struct DiscrepancyFamily {
  std::vector<DiscrepancyKernel> kernels;  ///< priors sum to one
  /// Expected length of a discrepancy in the rows after projection on the settings, in units of
  /// noise.
  std::span<const double> strengths;

  int count() const { return as_int(kernels.size() * strengths.size()); }
  std::size_t kernel_of(int discrepancy) const { return as_size(discrepancy) / strengths.size(); }
  double strength_of(int discrepancy) const {
    return strengths[as_size(discrepancy) % strengths.size()];
  }
  /// Its kernel's share, and of its strengths what a half-Cauchy of scale 10 has, so that a huge
  /// discrepancy is rarer than one that just shows (A. Gelman, Bayesian Analysis 1 (2006), 515,
  /// section 4.3).
  double log_share_of(int discrepancy) const;
};
/// For any other mechanism: a smooth function of the place for each of its lengths, and, where the
/// visits' order is known, one that changes with these as well.
const DiscrepancyFamily& length_discrepancies(bool ordered);
/// For four lengths those, and smooth functions of the place that disturb one length alone, as
/// alternatives to a law of one length. Half of the prior is theirs; the first kernels are those of
/// length_discrepancies().
const DiscrepancyFamily& length_discrepancies_of_laws(bool ordered);

struct Discrepancy {
  DiscrepancyKernel kernel;
  double sigma_mm = 0.0;  ///< s
};

/// F with F F' the covariance of all whitened rows for s = 1, up to rounding: n x r. A smooth field over
/// a bed has few degrees of freedom. Rows that see no place stay 0.
MatrixXd discrepancy_factor(const RegressorSystem& system, const DiscrepancyKernel& kernel);

/// Covariance of a discrepancy in all rows of another system, and with the kept ones of its own.
struct DiscrepancyElsewhere {
  MatrixXd own;
  MatrixXd across;
};
DiscrepancyElsewhere discrepancy_at(const RegressorSystem& there, const Discrepancy& process,
                                    const RegressorSystem& system, const KeptRows& kept);

/// F with F F' ~= a covariance, n x r, what is left of its diagonal below this share of the largest.
MatrixXd low_rank(const MatrixXd& covariance, double share);

/// A field's effect on all rows through each component of its entry, n x r each, what is left of the
/// field's unit variance at any place below `least`.
std::vector<MatrixXd> field_factor(const RegressorSystem& system, const DiscrepancyField& field,
                                   double least);
/// The combinations of components through which a field enters: its direction, or each component
/// by itself.
std::vector<VectorXd> entries_of(const DiscrepancyField& field, std::size_t components);

}  // namespace chaintrue::grid::diagnosis
