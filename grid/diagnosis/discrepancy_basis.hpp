// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The model discrepancy with some columns, for many kernels and strengths at once. A smooth
/// field over a bed has few degrees of freedom, so its covariance is B B' with few columns.
///
/// Notation
///   F      field over the places, low rank: k ~= F F', what is left of its diagonal below 1e-4
///   B      R^-1 W T F of a marginalised system, N x r; a direction of entry mixes two of these. Of a
///          kernel of lengths the factor of R^-1 K R^-1 itself, what is left below 1e-4 of its largest
///   E      residual and columns of the marginalised system
///   Q J Q' B'B, J tridiagonal: with that a strength costs no more than its columns
///
///   a'(I + s^2 B B')^-1 b = a'b - (Q'B'a)' (1 / s^2 + J)^-1 (Q'B'b)
///   det(I + s^2 B B')     = det(1 + s^2 J)
///
/// (Woodbury and Sylvester: G. Golub and C. Van Loan, Matrix Computations (2013), sections 2.1.4
/// and 2.1.5, and 8.3.1 for the tridiagonal form.)
#pragma once

#include <memory>
#include <vector>

#include "grid/diagnosis/evidence.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

class DiscrepancyBasis {
 public:
  /// For these kernels (numbers in the system's family). Notes their traces in the marginalised
  /// system. Both references must outlive this.
  DiscrepancyBasis(const RegressorSystem& system, MarginalisedSystem& marginalised,
                   const Indices& kernels);
  ~DiscrepancyBasis();

  /// Inner products of the residual and of some columns with what turns a kernel tridiagonal.
  class GivenKernel {
   public:
    /// Inner products of the residual with itself and with each column, and each column's square.
    struct Diagonal {
      double ee = 0.0;
      double log_det = 0.0;  ///< of V and of the discrepancy
      VectorXd ge;           ///< a column each
      VectorXd gg;
    };
    Diagonal diagonal(double strength) const;
    /// All inner products of some of the columns (regressors, ascending).
    NormalEquations equations(double strength, RegressorSet columns) const;

   private:
    friend class DiscrepancyBasis;
    /// H with (1 + s^2 B B')^-1 = 1 - B Q H' H Q' B' of a strength: two diagonals.
    struct Half {
      ArrayXd on;            ///< r
      ArrayXd above;         ///< r, each column's entry in the row before; the first is 0
      double log_det = 0.0;  ///< |1 + s^2 B'B|
    };
    Half half(double strength) const;
    /// Replaces rows E'BQ by E'BQH'.
    static void apply(const Half& half, MatrixXd& lines);
    const NormalEquations* plain_ = nullptr;  ///< without a discrepancy
    double trace_ = 0.0;
    ArrayXd on_;           ///< r, J's diagonal
    ArrayXd subdiagonal_;  ///< r - 1, the one next to it
    MatrixXd rotated_;     ///< E'BQ, (1 + columns) x r
  };
  /// Prepares `given` of this kernel for many sets of columns, at the cost of as many columns as the kernel has.
  void prepare(std::size_t kernel);
  /// Prepares these columns for `given` for all kernels at once, after which several threads may
  /// call it.
  void relate(const NormalEquations& plain);
  /// Frees what `given` and `relate` keep of columns.
  void forget();
  /// `plain`: normal equations of the columns without a discrepancy; kept by reference.
  GivenKernel given(std::size_t kernel, const NormalEquations& plain);

 private:
  class Fields;
  struct Kernel;
  const MarginalisedSystem& marginalised_;
  std::unique_ptr<Fields> fields_;
  std::vector<Kernel> kernels_;
};

}  // namespace chaintrue::grid::diagnosis
