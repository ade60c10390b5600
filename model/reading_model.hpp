// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two chains as a Mechanism: from a machine with its effects to the lengths read off it (machine ->
/// chain -> reading), with the settings as parameters; and the frame of the marks. Positions are in
/// the bed's frame; lengths are left, right.
///
///   reading = (L0 + chain effects) / (1 + e) + chain_zero + reading effects                 (1)
///
/// L0 from the equilibrium with every machine effect on; chain effects in the catalogue's order on
/// that state; e the sum of the elongations of chain_pitch_error. at() gives the repeatable part of a
/// reading: without drift, skips and hysteresis, which depend on the visit and not on the position.
/// predict() is for one visit, readings() for whole sessions, with all effects.
///
/// Points are true positions of the tool; MarkFrame turns them into the coordinates written at the
/// marks.
///
/// \code
///   Machine machine;
///   machine.effects = {{"chain_pitch_error", "left", {{"elongation", 0.0012}}}};
///   const ReadingModel model(machine);
///   if (const auto reading = model.at({100.0, -200.0})) use(reading->lengths.left_mm);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "model/effects/effect_table.hpp"
#include "model/kinematics.hpp"
#include "model/machine.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::model {

/// Settings that can be calibrated without named effects (the identifiers of the file formats).
enum class Setting {
  motor_left_x_mm,
  motor_left_y_mm,
  motor_right_x_mm,
  motor_right_y_mm,
  chain_zero_left_mm,
  chain_zero_right_mm,
  sheet_x_mm,
  sheet_y_mm,
  sheet_rotation_rad,
};

struct PointReading {
  Pose pose;
  ChainLengths lengths;
  /// d(left, right)/d(x, y), exact. At the knee of angular_kink it is the one-sided derivative above
  /// the knee.
  Eigen::Matrix2d position_jacobian = Eigen::Matrix2d::Zero();
};

/// The frame of the marks: the paper effects of a machine, in the catalogue's order. They are
/// linear.
class MarkFrame {
 public:
  /// \throws std::invalid_argument for effects that cannot act.
  explicit MarkFrame(const Machine& machine);
  /// The written coordinates of a mark whose true position is `place`.
  MarkPoint written(MarkPoint place) const;
  /// The true position of the mark with these written coordinates.
  MarkPoint place(MarkPoint written) const;

 private:
  Eigen::Matrix2d written_per_place_;
};

/// Const and thread safe.
class ReadingModel final : public MechanismBase {
 public:
  /// \throws std::invalid_argument for a machine with problems (problems_of) or with effects that
  /// cannot act (effects::problems_of_effects).
  explicit ReadingModel(const Machine& machine, Model model = Model::elastic);

  [[nodiscard]] tl::expected<PointReading, PoseFailure> at(BedPoint point) const;
  /// d(left, right)/d(setting) for the motor positions and chain zeros, as accurate as the
  /// position_jacobian. \throws std::invalid_argument for the sheet's settings: they move the
  /// point, not the machine.
  Eigen::Vector2d sensitivity(const PointReading& reading, Setting setting) const;
  /// The tool's position when these lengths are read, searched from `start` (Newton on at(), 1e-9
  /// mm).
  [[nodiscard]] tl::expected<PointReading, PoseFailure> find(ChainLengths lengths,
                                                             BedPoint start) const;
  /// The machine with its values and effects.
  const Machine& machine() const { return machine_; }

  MechanismExtent extent() const override;
  /// Values of effects are not left out.
  [[nodiscard]] std::vector<MachineProblem> problems_of_effects(
      const std::vector<AppliedEffect>& applied) const override;
  [[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position, const MechanismVisit& visit,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override;
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override;
  ToolPosition place_of_mark(const ToolPosition& written) const override;
  std::vector<MechanismChange> possible_changes() const override;

 private:
  friend class Session;
  ReadingModel(const Machine& machine, Model model, std::vector<MechanismParameter> parameters);
  std::shared_ptr<const Mechanism> rebuild(const Eigen::VectorXd& values,
                                           std::vector<AppliedEffect> applied) const override;
  /// What effects add to a chain, without those of the visit.
  effects::Number added(const Pose& pose, Side side) const;
  /// What a visit adds to the reading of a chain, independent of the tool's position: drift, skips
  /// and hysteresis, the latter by the `direction` in which the chain reached its length (+1 paid
  /// out, -1 taken in).
  double added_at_visit(Side side, int order, double direction) const;
  Eigen::Vector2d added_at(const MechanismVisit& visit) const;
  /// The reading of a chain paid out to this length.
  double counted(double length_mm, Side side) const {
    return length_mm / (1.0 + elongation_[side]) + machine_.chain_zero[side];
  }

  Machine machine_;
  Model model_;
  MarkFrame frame_;
  std::vector<effects::ActingEffect> acting_;
  std::shared_ptr<const Kinematics> kinematics_;
  PerSide<double> elongation_;  ///< sum of the elongations of a chain
};

std::shared_ptr<const ReadingModel> make_chain_mechanism(const Machine& machine);

/// A visit of the tool: its true position and its number.
struct Visit {
  BedPoint position;
  int order = 0;
};

/// Its place is an index into the visits.
using VisitFailure = Failure<PoseReason, std::size_t>;

/// The readings at each visit, in the order of `visits`; visits are processed by increasing
/// `order`. Hysteresis follows the sign of the change of a chain's length since the visit before,
/// taken before hysteresis and pitch error; no change keeps the sign, the first visit counts as
/// paid out (+1). `on_progress` is called after each visit with the number done. \throws
/// std::invalid_argument if two visits have the same number.
[[nodiscard]] tl::expected<std::vector<ChainLengths>, VisitFailure> readings(
    const ReadingModel& model, std::span<const Visit> visits,
    const std::function<void(std::size_t read)>& on_progress = {});

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::ReadingModel;
using model::Setting;
}  // namespace chaintrue
