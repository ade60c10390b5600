// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From a machine with its effects to the lengths that a person would read off it: machine -> chain
/// -> reading, and the frame in which the marks are written.
///
///   reading = (L0 + chain effects) / (1 + e) + chain_zero + reading effects                 (1)
///
/// L0 from the equilibrium with every machine effect on; chain effects in the catalogue's order on
/// that state; e the sum of the elongations of chain_pitch_error. ReadingModel answers the
/// repeatable part of a reading: what it would be without drift, skips and hysteresis, which depend
/// on the visit and not on the place. readings() answers whole sessions with all of it.
///
/// Points are true positions of the tool; MarkFrame turns them into what is written beside the
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

#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// What a grid can calibrate before anything is named (shared words with the file formats).
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
  /// d(left, right)/d(x, y). Exact for the equilibrium and for effects of the length; where an
  /// effect looks at a chain's angle or free length, the derivative of those is a five-point
  /// difference, good to 1e-9 of its size. At the knee of angular_kink it is the one-sided
  /// derivative above the knee.
  Eigen::Matrix2d position_jacobian = Eigen::Matrix2d::Zero();
};

/// Const and thread safe.
class ReadingModel {
 public:
  /// \throws std::invalid_argument for a machine with problems (problems_of) or with effects that
  /// cannot act (effects::problems_of_effects).
  explicit ReadingModel(const Machine& machine, Model model = Model::elastic);

  [[nodiscard]] tl::expected<PointReading, PoseFailure> at(BedPoint point) const;
  /// d(left, right)/d(setting) for the motor positions and chain zeros, as accurate as the
  /// position_jacobian. \throws std::invalid_argument for the sheet's settings: they move the
  /// point, not the machine.
  [[nodiscard]] Eigen::Vector2d sensitivity(const PointReading& reading, Setting setting) const;
  /// Where the tool is when these lengths are read, searched from `start` (Newton on at(), 1e-9
  /// mm).
  [[nodiscard]] tl::expected<PointReading, PoseFailure> find(ChainLengths lengths,
                                                             BedPoint start) const;
  /// What a visit adds to the reading of each chain wherever the tool is: drift, skips and, by the
  /// `direction` in which each chain reached its length (+1 paid out, -1 taken in), hysteresis.
  [[nodiscard]] ChainLengths added_at_visit(int order, const PerSide<double>& direction) const;
  [[nodiscard]] const Machine& machine() const;
  [[nodiscard]] Model model() const;

 private:
  friend class Session;
  struct State;
  std::shared_ptr<const State> state_;
};

/// A visit of the tool: where it truly is, and the visit's number.
struct Visit {
  BedPoint position;
  int order = 0;
};

struct VisitFailure {
  std::size_t index = 0;  ///< into the visits
  PoseFailure reason = PoseFailure::not_converged;
};

/// What is read at each visit, in the order of `visits`; they are gone through by rising `order`.
/// Hysteresis follows the sign of the change of a chain's length since the visit before, taken
/// before hysteresis and pitch error; no change keeps the sign, the first visit counts as paid out
/// (+1). `told` hears after each visit how many are done.
/// \throws std::invalid_argument where two visits bear the same number.
[[nodiscard]] tl::expected<std::vector<ChainLengths>, VisitFailure> readings(
    const ReadingModel& model,
    std::span<const Visit> visits,
    const std::function<void(std::size_t read)>& told = {});

/// The frame in which the marks are written: the paper effects of a machine, in the catalogue's
/// order. They are linear.
class MarkFrame {
 public:
  /// \throws std::invalid_argument as ReadingModel.
  explicit MarkFrame(const Machine& machine);
  /// What is written beside a mark that truly is at `place`.
  [[nodiscard]] MarkPoint written(MarkPoint place) const;
  /// Where the mark truly is that bears these numbers.
  [[nodiscard]] MarkPoint place(MarkPoint written) const;

 private:
  Eigen::Matrix2d written_per_place_;
};

}  // namespace chaintrue::model
