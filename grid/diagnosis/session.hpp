// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was measured as a diagnosis sees it, in an order that does not depend on the file's: places
/// with chain lengths, the noise, the settings with what is stated of them, and the readings of the
/// machine itself.
///
/// Readings come in units of rows that are good or bad together. A point of a grid is a unit of
/// two, the chain lengths read there. Of holes the lengths were paid out, not read: each distance
/// between them is a unit of one, and what keeps a hole from where its lengths put it stands beside
/// the settings as a nuisance with a sigma.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/tape_distances.hpp"
#include "model/calibration/observation.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::diagnosis {

/// A point, or a hole: where it was commanded and what was paid out.
struct SessionPoint {
  std::size_t index = 0;  ///< into the grid's points, or the holes
  model::BedPoint mark;
  model::ChainLengths lengths;
  int order = 0;
};

struct Session {
  model::Machine stated;
  std::vector<SessionPoint> points;  ///< by visit, or by place where nobody noted the visits
  bool ordered = false;
  /// Between the holes at `points`; none: the chains were read at each.
  std::shared_ptr<const observation::TapeDistances> distances;
  std::vector<std::size_t> distance_index;  ///< into the set's, in the order of the rows
  /// Sessions of the tape whose hooks are known with a doubt; each is a nuisance.
  std::vector<std::size_t> tape_sessions;
  model::PointNoise noise;  ///< of points
  double noise_dof = 15.0;
  bool noise_from_repeats = false;
  std::vector<model::Setting> settings;
  Eigen::VectorXd stated_value;  ///< of the settings, then of the nuisances
  Eigen::VectorXd stated_sigma;
  std::vector<ExtraReading> readings;  ///< those that a machine predicts

  [[nodiscard]] std::size_t units() const {
    return distances ? distances->set().distances.size() : points.size();
  }
  [[nodiscard]] Eigen::Index unit_rows() const { return distances ? 1 : 2; }
  [[nodiscard]] Eigen::Index observed_rows() const {
    return unit_rows() * static_cast<Eigen::Index>(units());
  }
  [[nodiscard]] Eigen::Index rows() const {
    return observed_rows() + static_cast<Eigen::Index>(readings.size());
  }
  [[nodiscard]] Eigen::Index nuisances() const {
    return stated_value.size() - static_cast<Eigen::Index>(settings.size());
  }
  /// Whether the readings know of it at all: of distances, of the sheet's place where its edges
  /// were measured.
  [[nodiscard]] bool knows(model::Setting setting) const;
  /// With fewer units left, none is set aside.
  [[nodiscard]] std::size_t fewest_units() const;
};

/// Fewer points leave nothing to judge a cause by once the settings have taken their share.
inline constexpr std::size_t kFewestPoints = 8;
/// Distances tell four of the six settings; two more for a cause, two to doubt it by.
inline constexpr std::size_t kFewestDistances = 8;
/// Of which so many must stay when outliers are set aside.
inline constexpr std::size_t kFewestGoodDistances = 6;

[[nodiscard]] tl::expected<Session, DiagnosisFailure> make_session(const MeasuredGrid& grid);
[[nodiscard]] tl::expected<Session, DiagnosisFailure> make_session(const MeasuredHoles& set);

/// The session without its readings and with these points alone.
[[nodiscard]] Session with_points(const Session& session, std::vector<SessionPoint> points);
/// The same machine with other holes and distances: those that it has first and in their order.
/// Empty where a hole is out of the controller's reach.
[[nodiscard]] std::optional<Session> with_holes(const Session& session, MeasuredHoles set);

/// A machine with its settings somewhere, and where the sheet lies.
struct State {
  model::Machine machine;
  model::SheetPlacement sheet;
};
[[nodiscard]] State stated_state(const Session& session);
/// Nuisances are nothing in every state.
[[nodiscard]] Eigen::VectorXd setting_values(const Session& session, const State& state);
[[nodiscard]] State with_settings(const Session& session,
                                  State state,
                                  const Eigen::VectorXd& values);

/// What the machine says of itself where a person would measure it: motor_spacing_mm, link_pitch_mm
/// with its effects, ...
[[nodiscard]] double predicted_reading(const model::Machine& machine, const ExtraReading& reading);

}  // namespace chaintrue::grid::diagnosis
