// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An observation: a vector of numbers with a covariance, and how the settings move it. Calibration
/// and diagnosis work on these, so that another way of measuring is another class here and nothing
/// else.
///
///   y         what was measured
///   f(theta)  what the machine with settings theta predicts
///   A         df/dtheta
///   C         covariance of y - f at the true theta
///
/// \code
///   const ChainReading reading({100, -200}, {1702.1, 1821.4}, {0.2, 0.3});
///   const auto line = reading.linearise(ReadingModel(machine), placement, settings);
///   if (line) residual = line->residual;   // y - f
/// \endcode
#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "model/calibration/sheet_placement.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model {

/// One sigma of a reading: of each chain's length, and of the tool's place on each axis.
struct PointNoise {
  double length_mm = 0.2;
  double position_mm = 0.3;
};

/// An observation seen from one machine: n numbers, p settings.
struct Linearisation {
  Eigen::VectorXd residual;          ///< n: y - f
  Eigen::MatrixXd setting_jacobian;  ///< n x p: A
  Eigen::MatrixXd covariance;        ///< n x n: C
};

class Observation {
 public:
  virtual ~Observation() = default;
  /// Columns of A stand in the order of `settings`.
  [[nodiscard]] virtual tl::expected<Linearisation, PoseFailure> linearise(
      const ReadingModel& model,
      const SheetPlacement& sheet,
      const std::vector<Setting>& settings) const = 0;
};

/// The two chain lengths with the tool at a mark. C = sigma_length^2 I + sigma_position^2 J J', J =
/// d(L, R)/d(mark).
class ChainReading final : public Observation {
 public:
  ChainReading(BedPoint mark, ChainLengths lengths, PointNoise noise)
      : mark_(mark), lengths_(lengths), noise_(noise) {}
  [[nodiscard]] tl::expected<Linearisation, PoseFailure> linearise(
      const ReadingModel& model,
      const SheetPlacement& sheet,
      const std::vector<Setting>& settings) const override;
  [[nodiscard]] BedPoint mark() const { return mark_; }
  [[nodiscard]] ChainLengths lengths() const { return lengths_; }

 private:
  BedPoint mark_;
  ChainLengths lengths_;
  PointNoise noise_;
};

/// A measurement of the machine itself: one setting less another. The motor spacing is right x less
/// left x, the beam's rise right y less left y.
class SettingDifference final : public Observation {
 public:
  /// \throws std::invalid_argument where one of the settings is the sheet's, or sigma is not
  /// positive.
  SettingDifference(Setting plus, Setting minus, double value_mm, double sigma_mm);
  [[nodiscard]] tl::expected<Linearisation, PoseFailure> linearise(
      const ReadingModel& model,
      const SheetPlacement& sheet,
      const std::vector<Setting>& settings) const override;

 private:
  Setting plus_;
  Setting minus_;
  double value_mm_;
  double sigma_mm_;
};

}  // namespace chaintrue::model
