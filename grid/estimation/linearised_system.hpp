// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All readings of one machine about one state, brought to units of noise: the one linear system
/// that an estimate, a check and a diagnosis stand on.
///
/// Notation as in observation.hpp; W = diag(W_u) whitens unit by unit:
///
///   W (y - f) = W A (theta - theta_0) + W B b + sum_i W D_i c_i + e,   e ~ N(0, I)          (1)
///
/// \code
///   const auto system = linearise(observations, views);
///   if (system) rows = system->by_setting;                       // W A
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/observation.hpp"

namespace chaintrue::grid::estimation {

/// One observation as it is seen: the view, and its own settings there less what was stated (the
/// machine's, then its sheet's).
struct ObservedFrom {
  observation::View view;
  Eigen::VectorXd settings;
};

struct SystemUnit {
  std::size_t observation = 0;
  std::size_t unit = 0;  ///< into the observation's
  Eigen::Index first_row = 0;
  Eigen::Index rows = 1;
  Eigen::MatrixXd whitening;  ///< W_u
  /// W_u D_i, `place` into the system's places.
  std::vector<observation::PlaceColumns> places;
};

struct SystemPlace {
  std::size_t observation = 0;
  std::size_t place = 0;  ///< into the observation's
  observation::PlaceState state;
};

/// (1), n rows.
struct LinearisedSystem {
  Eigen::VectorXd residual;  ///< W (y - f)
  Eigen::VectorXd response;  ///< W (y - f + A (theta_0 - stated))
  /// W A: the machine's settings, then the sheet of each observation that has one.
  Eigen::MatrixXd by_setting;
  Eigen::MatrixXd by_nuisance;  ///< W B of all observations, side by side
  std::vector<SystemUnit> units;
  std::vector<SystemPlace> places;
};

/// A place where the machine cannot hold the tool.
struct UnreachablePlace {
  std::size_t observation = 0;
  observation::Unreachable place;
};

/// `from` has one entry for each observation.
[[nodiscard]] tl::expected<LinearisedSystem, UnreachablePlace> linearise(
    const observation::Observations& observations, const std::vector<ObservedFrom>& from);

/// W with W C W' = I, lower triangular.
[[nodiscard]] Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& covariance);
/// W^-1.
[[nodiscard]] Eigen::MatrixXd unwhitening_of(const Eigen::MatrixXd& whitening);

}  // namespace chaintrue::grid::estimation
