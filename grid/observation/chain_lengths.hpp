// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two chain lengths with the tool at a mark, read off the chains or paid out by the controller
/// for a command (then the mark is where the tool really went). A point is a unit of two rows.
///
///   y_i = f(sheet(m_i)),   C_i = sigma_length^2 I + sigma_position^2 J J'                   (1)
///
///   m_i  a mark
///   J    d(L, R)/d(mark)
#pragma once

#include "grid/observation/observation.hpp"
#include "interp/eigen.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::observation {

/// One sigma of a reading: of each chain's length, and of the tool's place on each axis.
struct PointNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
};

/// C_i of (1).
Matrix2d covariance_of(const PointNoise& noise, const Matrix2d& by_mark);

class ChainLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by mark and lengths.
  ChainLengthReadings(std::vector<Place> places, bool ordered, PointNoise noise, double noise_dof,
                      std::optional<SheetPrior> sheet);
  /// As above, in the order of `places`.
  static ChainLengthReadings in_given_order(std::vector<Place> places, bool ordered,
                                            PointNoise noise, double noise_dof,
                                            std::optional<SheetPrior> sheet);

  const Kind& kind() const override { return chain_lengths; }
  [[nodiscard]] tl::expected<VectorXd, Unreachable> predicted(const View& view) const override;

  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;

  std::string name_of(std::size_t unit) const override;

  const PointNoise& noise() const { return noise_; }

 private:
  void take(std::vector<Place> places);

  PointNoise noise_;
};

}  // namespace chaintrue::grid::observation
