// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two chains as a Mechanism: ReadingModel (reading_model.hpp) with its settings as parameters and
/// the catalogue's effects. Positions are in the bed's frame; lengths are left, right.
///
/// Derivatives are ReadingModel's: exact for the equilibrium, to 1e-9 of their size where an effect
/// depends on a chain's angle or free length.
#pragma once

#include <memory>

#include "model/mechanism.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model {

class ChainMechanism final : public MechanismBase {
 public:
  /// \throws std::invalid_argument as ReadingModel.
  explicit ChainMechanism(const Machine& machine, Model model = Model::elastic);
  explicit ChainMechanism(ReadingModel readings);

  [[nodiscard]] std::string_view kind() const override { return "chains"; }
  [[nodiscard]] std::span<const std::string_view> lengths() const override;
  [[nodiscard]] MechanismExtent extent() const override;
  /// Values of effects are not left out.
  [[nodiscard]] std::vector<MachineProblem> problems_of_effects(
      const std::vector<AppliedEffect>& applied) const override;
  [[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position,
      const MechanismVisit& visit,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override;
  [[nodiscard]] ToolPosition place_of_mark(const ToolPosition& written) const override;
  [[nodiscard]] std::vector<MechanismChange> possible_changes() const override;

  /// The machine with its values and effects.
  [[nodiscard]] const Machine& machine() const { return readings_.machine(); }
  [[nodiscard]] const ReadingModel& readings() const { return readings_; }

 private:
  ChainMechanism(ReadingModel readings, std::vector<MechanismParameter> parameters);
  [[nodiscard]] std::shared_ptr<const Mechanism> made_anew(
      const Eigen::VectorXd& values, std::vector<AppliedEffect> applied) const override;

  ReadingModel readings_;
  MarkFrame frame_;
};

[[nodiscard]] std::shared_ptr<const ChainMechanism> make_chain_mechanism(const Machine& machine);

/// One sigma of a zero shift: re-hanging a chain shifts it by up to 3 mm.
inline constexpr double kZeroShiftSigmaMm = 2.0;
/// One sigma of pitch growth: 0.05 % is a year's wear.
inline constexpr double kPitchGrowthSigma = 5e-4;
inline constexpr double kMotorShiftSigmaMm = 5.0;

/// Possible changes of two chains if only their links are known: zeros, skipped teeth, worn links.
[[nodiscard]] std::vector<MechanismChange> changes_of_chains(double pitch_mm);

}  // namespace chaintrue::model
