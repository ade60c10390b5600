// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A is bordered block-diagonal: a block for each penalty, and a border of the shared columns.
///
/// Notation beyond reml.hpp, for one block with Gram matrix G and penalty S:
///   c        balances the traces of G and S
///   T        T' (G + c S) T = I and T' c S T = diag(w), hence T' G T = diag(1 - w)            (1)
///   a        diagonal of A in the block: (1 - w) / sigma2 + (lambda / c) w
///   C        T' times the Gram matrix of the block with the p shared columns
///   U        diag(1 / a) C / sigma2
///   H        Schur complement on the shared columns:
///            G_pp / sigma2 + S0 - sum C' diag(1 / a) C / sigma2^2
/// A^-1 is diag(1 / a) + U H^-1 U' within the blocks, -U H^-1 off them, H^-1 in the corner. (2)
///
/// With little noise that difference cancels. Where the rows are known and one penalty is the
/// identity (F the n x m part of X that it touches, Z the rest, F F' = Q diag(e) Q'):
///   D        diag(1 / (sigma2 + e / lambda)): Q D Q' is the inverse of sigma2 I + F F' / lambda
///   H        = S0 + Z' Q D Q' Z, all its terms positive                                       (3)
/// the shared coefficients are s = H^-1 (S0 s0 + Z' Q D Q' y), and with r = y - Z s the others are
/// F' Q D Q' r / lambda, the deviance r' Q D Q' r + (s - s0)' S0 (s - s0).                     (4)
///
/// Internal to interp.

#include <memory>
#include <optional>
#include <vector>

#include "interp/reml_structure.hpp"

namespace chaintrue::interp::reml {

/// The columns of one penalty.
struct Block {
  Eigen::Index first_column;   ///< in the problem
  Eigen::Index first_working;  ///< in working coordinates
  Eigen::MatrixXd basis;       ///< T
  Eigen::VectorXd weight;      ///< w
  double balance;              ///< c
  double log_basis;            ///< log |T|
  Eigen::MatrixXd coupling;    ///< C
};

/// The p columns that no penalty touches.
struct Shared {
  std::vector<Eigen::Index> columns;
  Eigen::MatrixXd gram;
  Eigen::MatrixXd prior;
  Eigen::VectorXd mean;
};

/// The rows turned by Q.
struct TurnedRows {
  Eigen::VectorXd eigenvalues;  ///< e
  Eigen::MatrixXd shared;       ///< Q' Z
  Eigen::VectorXd response;     ///< Q' y
  Eigen::MatrixXd to_block;     ///< T^-1 F' Q
};

/// A at one lambda and sigma2; keeps references to the first three. Null where A is not positive
/// definite to rounding.
[[nodiscard]] std::unique_ptr<Factor> make_bordered_factor(const std::vector<Block>& blocks,
                                                           const Shared& shared,
                                                           const std::optional<TurnedRows>& rows,
                                                           const Eigen::VectorXd& lambda,
                                                           double sigma2);

}  // namespace chaintrue::interp::reml
