// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A V-plotter as a Mechanism: the equilibrium of plotter_statics.hpp with the settings of its
/// controller as parameters and the effects of plotter_effects.cpp. Positions are the pen's, in
/// the frame of plotter_machine.hpp; lengths are left, right, as the controller counts them:
///
///   K = (L + what effects add) (1 + scale / 1000) + zero                                    (1)
///
/// Derivatives are exact.
///
/// \code
///   const auto mechanism = make_plotter_mechanism(mural(1500.0));
///   const auto at = mechanism->predict({120.0, -700.0}, {});
/// \endcode
#pragma once

#include <array>
#include <memory>

#include "model/effects/effect_table.hpp"
#include "model/mechanism.hpp"
#include "model/plotter/plotter_machine.hpp"
#include "model/plotter/plotter_statics.hpp"

namespace chaintrue::model {

class PlotterMechanism final : public MechanismBase {
 public:
  /// \throws std::invalid_argument for a machine with problems, with the first of them.
  explicit PlotterMechanism(const PlotterMachine& machine);

  /// The drawing area.
  MechanismExtent extent() const override;
  /// Fails with a PlotterReason's name.
  [[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position, const MechanismVisit& visit,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate_by_first(
      ChainLengths lengths) const override;

  /// The machine with the values of the parameters.
  const PlotterMachine& machine() const { return machine_; }

 private:
  PlotterMechanism(PlotterMachine machine, std::vector<MechanismParameter> parameters,
                   std::vector<AppliedEffect> applied);
  std::shared_ptr<const Mechanism> rebuild(const Eigen::VectorXd& values,
                                           std::vector<AppliedEffect> applied) const override;
  bool has(effects::Part part) const override;
  /// The point where straight cords of these lengths end.
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> straight_place(
      ChainLengths lengths) const;

  PlotterMachine machine_;
  plotter::Statics statics_;
  std::vector<effects::ActingEffect> acting_;
};

std::shared_ptr<const PlotterMechanism> make_plotter_mechanism(const PlotterMachine& machine);

/// The parameters' places in values().
enum PlotterParameter : Eigen::Index {
  kPinSpacing,
  kPinRise,
  kZeroLeft,
  kZeroRight,
  kScaleLeft,
  kScaleRight,
  kPlotterParameters
};

}  // namespace chaintrue::model
