// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two chain lengths with the tool at a mark, read off the chains or paid out by the controller
/// for a command (then the mark is where the tool really went). A point is a unit of two rows.
///
///   y_i = f(sheet(m_i)),   C_i = sigma_length^2 I + sigma_position^2 J J',   J = d(L, R)/d(mark)   (1)
#pragma once

#include "grid/observation/observation.hpp"

namespace chaintrue::grid::observation {

/// One sigma of a reading: of each chain's length, and of the tool's place on each axis.
struct PointNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
};

class ChainLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by mark and lengths.
  ChainLengthReadings(std::vector<Place> places,
                      bool ordered,
                      PointNoise noise,
                      double noise_dof,
                      std::optional<SheetPrior> sheet);
  /// The same in the order of `places`.
  [[nodiscard]] static ChainLengthReadings in_given_order(std::vector<Place> places,
                                                          bool ordered,
                                                          PointNoise noise,
                                                          double noise_dof,
                                                          std::optional<SheetPrior> sheet);

  [[nodiscard]] const Kind& kind() const override { return chain_lengths; }
  [[nodiscard]] Eigen::Index rows() const override { return measured_.size(); }
  [[nodiscard]] const std::vector<Place>& places() const override { return places_; }
  [[nodiscard]] const std::vector<Unit>& units() const override { return units_; }
  [[nodiscard]] const Eigen::VectorXd& measured() const override { return measured_; }
  [[nodiscard]] const Eigen::VectorXd& nuisance_sigma() const override { return nuisance_sigma_; }
  [[nodiscard]] const std::optional<SheetPrior>& sheet() const override { return sheet_; }
  [[nodiscard]] bool ordered() const override { return ordered_; }
  [[nodiscard]] double noise_dof() const override { return noise_dof_; }
  [[nodiscard]] bool may_slip() const override { return true; }
  [[nodiscard]] tl::expected<Eigen::VectorXd, Unreachable> predicted(
      const View& view) const override;
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const std::vector<model::Setting>& settings) const override;
  [[nodiscard]] std::string untestable(const model::effects::Effect& effect,
                                       model::effects::EffectSide side) const override;
  [[nodiscard]] std::string name_of(std::size_t unit) const override;

  [[nodiscard]] const PointNoise& noise() const { return noise_; }

 private:
  struct GivenOrder {};
  ChainLengthReadings(GivenOrder,
                      std::vector<Place> places,
                      bool ordered,
                      PointNoise noise,
                      double noise_dof,
                      std::optional<SheetPrior> sheet);

  std::vector<Place> places_;
  std::vector<Unit> units_;
  Eigen::VectorXd measured_;
  Eigen::VectorXd nuisance_sigma_;
  bool ordered_;
  PointNoise noise_;
  double noise_dof_;
  std::optional<SheetPrior> sheet_;
};

}  // namespace chaintrue::grid::observation
