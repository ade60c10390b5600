// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Eigen's decompositions of dense matrices, instantiated once for all sources: the precompiled
/// headers declare them, and the object that belongs to those headers (precompiled.cmake) defines
/// them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

#define CHAINTRUE_EIGEN_INSTANCES(define)                                       \
  define class Eigen::LLT<Eigen::MatrixXd>;                                     \
  define class Eigen::LDLT<Eigen::MatrixXd>;                                    \
  define class Eigen::PartialPivLU<Eigen::MatrixXd>;                            \
  define class Eigen::HouseholderQR<Eigen::MatrixXd>;                           \
  define class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;                     \
  define class Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd, 1>; \
  define struct Eigen::internal::gebp_kernel<                                   \
      double, double, Eigen::Index,                                             \
      Eigen::internal::blas_data_mapper<double, Eigen::Index, 0, 0, 1>,         \
      Eigen::internal::gebp_traits<double, double>::mr,                         \
      Eigen::internal::gebp_traits<double, double>::nr, false, false>;

CHAINTRUE_EIGEN_INSTANCES(extern template)
