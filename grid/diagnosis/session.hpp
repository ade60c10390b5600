// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measured grid as a diagnosis sees it: points in an order that does not depend on the file's,
/// their lengths, the noise, the settings with what is stated of them, and the readings of the
/// machine itself.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "model/calibration/observation.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::diagnosis {

struct SessionPoint {
  std::size_t index = 0;  ///< into the grid's points
  model::BedPoint mark;
  model::ChainLengths lengths;
  int order = 0;
};

struct Session {
  model::Machine stated;
  std::vector<SessionPoint> points;  ///< by visit, or by place where nobody noted the visits
  bool ordered = false;
  model::PointNoise noise;
  double noise_dof = 15.0;
  bool noise_from_repeats = false;
  std::vector<model::Setting> settings;
  Eigen::VectorXd stated_value;  ///< of the settings
  Eigen::VectorXd stated_sigma;
  std::vector<ExtraReading> readings;  ///< those that a machine predicts

  [[nodiscard]] Eigen::Index point_rows() const {
    return 2 * static_cast<Eigen::Index>(points.size());
  }
  [[nodiscard]] Eigen::Index rows() const {
    return point_rows() + static_cast<Eigen::Index>(readings.size());
  }
};

/// Fewer points leave nothing to judge a cause by once the settings have taken their share.
inline constexpr std::size_t kFewestPoints = 8;

[[nodiscard]] tl::expected<Session, DiagnosisFailure> make_session(const MeasuredGrid& grid);

/// The session without its readings and with these points alone.
[[nodiscard]] Session with_points(const Session& session, std::vector<SessionPoint> points);

/// A machine with its settings somewhere, and where the sheet lies.
struct State {
  model::Machine machine;
  model::SheetPlacement sheet;
};
[[nodiscard]] State stated_state(const Session& session);
[[nodiscard]] Eigen::VectorXd setting_values(const Session& session, const State& state);
[[nodiscard]] State with_settings(const Session& session,
                                  State state,
                                  const Eigen::VectorXd& values);

/// What the machine says of itself where a person would measure it: motor_spacing_mm, link_pitch_mm
/// with its effects, ...
[[nodiscard]] double predicted_reading(const model::Machine& machine, const ExtraReading& reading);

}  // namespace chaintrue::grid::diagnosis
