// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All readings of one machine about one state, in units of noise: the linear system shared by
/// estimates, checks and diagnoses.
///
/// Notation as in observation.hpp; W = diag(W_u) whitens unit by unit (unit_whitening.hpp):
///
///   W (y - f) = W A (theta - theta_0) + W B b + sum_i W D_i c_i + e,   e ~ N(0, I)          (1)
///
/// Columns of A and B as observation_set.hpp has them, the zeros of other sessions among those of A; whitened rows have no unit, chains and marks
/// are in mm, settings and nuisances in their own units.
///
/// \code
///   const auto system = linearise(set, from);
///   if (system) rows = system->by_setting;                       // W (A, B)
/// \endcode
#pragma once

#include <cstddef>
#include <tl/expected.hpp>
#include <vector>

#include "grid/estimation/observation_set.hpp"
#include "grid/estimation/unit_whitening.hpp"
#include "interp/eigen.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::estimation {

/// The point of linearisation of an observation: the view, and its settings there minus the stated
/// ones (the machine's, then its sheet's).
struct ObservedFrom {
  observation::View view;
  VectorXd settings;
};

/// How f is computed.
enum class Prediction {
  place_by_place,  ///< each place independently
  visit_by_visit,  ///< with the machine's memory between visits
};

/// Rows that are good or bad together.
struct SystemUnit {
  std::size_t observation = 0;
  std::size_t unit = 0;  ///< into the observation's
  Index first_row = 0;
  Index rows = 1;
  MatrixXd whitening = MatrixXd::Identity(1, 1);  ///< W_u
  bool reads_chains = false;                      ///< the rows are the chains at its only place
  /// W_u D_i, `place` into the system's places.
  std::vector<observation::PlaceColumns> places{};
  /// The effect of a millimetre of each reading on the whitened rows; empty: the unit is an outlier
  /// as a whole.
  MatrixXd by_reading{};

  /// From the readings' units to those of noise, and back: the rows of this unit, at most two.
  Vector2d whitened(const VectorXd& all) const;
  Vector2d unwhitened(const VectorXd& all) const;
  auto segment(const VectorXd& all) const { return all.segment(first_row, rows); }
  /// One sigma of a unit of one reading.
  double sigma() const { return 1.0 / whitening(0, 0); }
};

/// A place at the state.
struct SystemPlace {
  std::size_t observation = 0;
  std::size_t place = 0;  ///< into the observation's
  observation::ChainPlaceState state;
  MarkPoint mark;  ///< as written, or as commanded
  int order = 0;
  bool ordered = false;  ///< lengths were read here, at this visit
  Bed bed;               ///< of the machine at rest here
  /// For a mechanism other than two chains: each length as read, and its angle at its anchor
  /// against the horizontal, 0 to pi / 2. Otherwise empty.
  std::vector<double> length_mm{};
  std::vector<double> angle_rad{};
};

/// (1), n rows.
struct LinearisedSystem {
  VectorXd e;                       ///< W (y - f)
  VectorXd response;                ///< W (y - f + A (theta_0 - stated))
  MatrixXd by_setting;              ///< W (A, B), n x q, columns as the observation set has them
  Index nuisances = 0;              ///< the last of these q columns
  std::vector<SystemUnit> units;    ///< numbered as in the observation set
  std::vector<SystemUnit> certain;  ///< rows of readings that cannot be outliers
  std::vector<int> unit_of_row;     ///< n; -1: a row of those
  std::vector<SystemPlace> places{};
};

/// A place where the machine cannot hold the tool.
struct PlaceOfObservation {
  std::size_t observation = 0;
  std::size_t place = 0;
};
using UnreachablePlace = Failure<model::MechanismReason, PlaceOfObservation>;

/// Precondition: `from` has one entry for each observation.
[[nodiscard]] tl::expected<LinearisedSystem, UnreachablePlace> linearise(
    const ObservationSet& set, const std::vector<ObservedFrom>& from,
    Prediction prediction = Prediction::place_by_place);

/// All n rows, from the readings' units to those of noise.
VectorXd whitened(const LinearisedSystem& system, VectorXd all);

/// The nuisances' columns.
inline auto nuisance_columns(const LinearisedSystem& system) {
  return system.by_setting.rightCols(system.nuisances);
}

}  // namespace chaintrue::grid::estimation
