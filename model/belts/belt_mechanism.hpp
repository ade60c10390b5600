// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Four belts as a Mechanism: belt_readings.hpp with the anchors' coordinates as parameters and the
/// belts' effects. Positions are in the anchors' frame; lengths are tl, tr, bl, br.
///
/// Without effects a printed length depends on the position less its own anchor, so that
///
///   d(length)/d(anchor) = -d(length)/d(place)                                               (1)
///
/// Effects of tension depend on all anchors.
///
/// Without effects a printed length equals that of belt_kinematics.hpp to rounding, 1e-12 mm.
#pragma once

#include <memory>
#include <optional>

#include "model/belts/belt_readings.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::model {

/// Prior of the logarithm of the scale, which is the last parameter if present: a taped distance is
/// exp(log_scale) times the modelled one. Belt lengths alone do not determine it.
struct BeltScaleKnowledge {
  std::optional<double> sigma;  ///< about 0; may be empty
};

class BeltMechanism final : public MechanismBase {
 public:
  /// `anchor_sigma_mm` is the standard deviation of the stated anchors; if it is absent, or the
  /// anchors are not known, they have no prior. \throws std::invalid_argument for a machine with
  /// problems. Without `scale` the scale is 1 and no parameter.
  explicit BeltMechanism(const BeltMachine& machine,
                         std::optional<double> anchor_sigma_mm = std::nullopt,
                         std::optional<BeltScaleKnowledge> scale = std::nullopt);

  /// Points inside the anchors' rectangle that are farther from its edges than arm and extension
  /// are long.
  MechanismExtent extent() const override;
  /// Fails with anchors_not_known, or with a failure of belt_kinematics.hpp.
  [[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position, const MechanismVisit& visit,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override;
  [[nodiscard]] tl::expected<ChainLengths, MechanismFailure> first_lengths(
      const ToolPosition& position) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate_by_first(
      ChainLengths lengths) const override;
  /// The zero of one belt or of all has shifted; an anchor has moved. Coordinates that define the
  /// frame cannot move: such a movement appears in the others.
  std::vector<MechanismChange> possible_changes() const override;

  /// The anchors, in the order of the lengths.
  std::vector<FixedPoint> fixed_points() const override;
  FrameScale frame_scale() const override;

  /// The machine with the values of the parameters.
  const BeltMachine& machine() const { return machine_; }

 private:
  BeltMechanism(BeltMachine machine, std::vector<MechanismParameter> parameters,
                Eigen::VectorXd values, std::vector<AppliedEffect> applied);
  std::shared_ptr<const Mechanism> rebuild(const Eigen::VectorXd& values,
                                           std::vector<AppliedEffect> applied) const override;
  [[nodiscard]] tl::expected<belts::AnchorNumber, BeltFailure> print(const belts::BeltVisit& visit,
                                                                     FramePoint place) const;

  BeltMachine machine_;
  std::vector<effects::ActingEffect> acting_;
};

/// One sigma of a belt's zero after a jump: a turn of the encoder is 44 mm, a tooth 2 mm.
inline constexpr double kBeltZeroShiftMm = 5.0;
/// One sigma of how far an anchor that came loose has moved, in x and in y.
inline constexpr double kAnchorShiftMm = 5.0;

std::shared_ptr<const BeltMechanism> make_belt_mechanism(
    const BeltMachine& machine, std::optional<double> anchor_sigma_mm = std::nullopt,
    std::optional<BeltScaleKnowledge> scale = std::nullopt);

}  // namespace chaintrue::model
