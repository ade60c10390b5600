// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A set of holes as one observation: n tape readings with their covariance, and how the settings
/// move them. Calibration and diagnosis take it as they take chain readings.
///
///   l_i   chain lengths that the controller paid out for hole i
///   q_i   where the machine puts the tool with them: f(q_i) = l_i
///   m_i   q_i on the sheet
///   d_k   |m_a - m_b|, or m_a's distance from an edge                                      (1)
///   V     tape^2 I + hole^2 B B' + size^2 w w' + hook^2 1 1', B = dd/dm                    (2)
///
/// Holes share their own error with every distance that ends there, readings of one session that of
/// the hook, so V is not diagonal. The frame
/// of the sheet matters to edges alone: distances between holes do not move with it.
///
/// An effect of the catalogue is scored by secants: linearise with the machine that has it, and
/// compare residuals; the covariance hardly changes.
///
/// \code
///   const auto distances = HoleDistances::of(set);          // set.machine has the controller
///   const auto line = distances->linearise(ReadingModel(machine), {}, settings);
///   if (line) whiten(line->residual, line->covariance);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/holes/measured_holes.hpp"
#include "model/calibration/observation.hpp"
#include "model/effects/effect.hpp"

namespace chaintrue::grid {

/// (1) at given places, with its derivative.
struct DistanceGeometry {
  Eigen::VectorXd predicted_mm;  ///< n
  Eigen::MatrixXd by_mark;       ///< n x 2 N, x and y of each hole
  Eigen::MatrixXd by_size;       ///< n x 2, by what the sheet is wider and higher than said
};
[[nodiscard]] DistanceGeometry distance_geometry(const MeasuredHoles& set,
                                                 const std::vector<model::BedPoint>& marks);

/// (2) in its parts: the tape's alone (a diagonal), the holes', that of the sheet's size and that
/// of the hook.
struct DistanceNoise {
  Eigen::VectorXd tape_mm2;
  Eigen::MatrixXd holes_mm2;
  Eigen::MatrixXd size_mm2;
  Eigen::MatrixXd hook_mm2;
};
[[nodiscard]] DistanceNoise distance_noise(const MeasuredHoles& set,
                                           const DistanceGeometry& geometry);

/// Of the effects of the paper the one that a tape can have: a scale of its own.
[[nodiscard]] bool is_of_tape(const model::effects::Effect& effect,
                              model::effects::EffectSide side);
/// Read over true length, where the machine's effects say that the tape is long or short.
[[nodiscard]] double tape_factor(const model::Machine& machine);

/// A hole where a machine puts it.
struct HolePlace {
  model::PointReading reading;
  model::BedPoint mark;     ///< on the sheet
  Eigen::Matrix2d by_mark;  ///< d(L, R)/d(mark)
};

struct HoleFailure {
  std::size_t hole = 0;
  model::PoseFailure reason = model::PoseFailure::not_converged;
};

/// Immutable, thread safe.
class HoleDistances final : public model::Observation {
 public:
  /// Fails in words where a command is out of the controller's reach.
  /// \throws std::invalid_argument for a set without a machine.
  [[nodiscard]] static tl::expected<HoleDistances, std::string> of(MeasuredHoles set);

  /// Where the machine puts each hole with what was paid out for it.
  [[nodiscard]] tl::expected<std::vector<HolePlace>, HoleFailure> places(
      const model::ReadingModel& model, const model::SheetPlacement& sheet) const;
  /// How a setting moves the hole's mark.
  [[nodiscard]] static Eigen::Vector2d mark_by_setting(const model::ReadingModel& model,
                                                       const model::SheetPlacement& sheet,
                                                       const HolePlace& place,
                                                       model::Setting setting);
  /// The readings less the hook, in the order of set().distances.
  [[nodiscard]] tl::expected<model::Linearisation, model::PoseFailure> linearise(
      const model::ReadingModel& model,
      const model::SheetPlacement& sheet,
      const std::vector<model::Setting>& settings) const override;
  [[nodiscard]] const MeasuredHoles& set() const { return set_; }
  /// What the controller paid out, hole by hole.
  [[nodiscard]] const std::vector<model::ChainLengths>& lengths() const { return lengths_; }
  [[nodiscard]] const Eigen::VectorXd& measured_mm() const { return measured_mm_; }

 private:
  explicit HoleDistances(MeasuredHoles set) : set_(std::move(set)) {}
  MeasuredHoles set_;
  std::vector<model::ChainLengths> lengths_;
  Eigen::VectorXd measured_mm_;
};

}  // namespace chaintrue::grid
