// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A way of measuring, as the linearised system needs it: what a machine would give to be read, how
/// that moves with the settings and with the chains, and which causes it can never show. One object
/// a way; both are stateless and thread safe. Private to grid/diagnosis.
///
///   points     chain lengths read with the tool at a mark
///   distances  a tape between holes, which lie where the lengths paid out put the tool:
///              f(m_i) = l_i. With c added to the chains there, dm = -J^-1 c, dd = (dd/dm) dm
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <tl/expected.hpp>

#include "grid/diagnosis/linearised_system.hpp"

namespace chaintrue::grid::diagnosis {

class Observed {
 public:
  virtual ~Observed() = default;
  /// What such a machine would give to be read, mm; empty where it cannot get there.
  [[nodiscard]] virtual std::optional<Eigen::VectorXd> predicted(
      const Session& session, const State& state, const model::Machine& machine) const = 0;
  [[nodiscard]] virtual Eigen::VectorXd measured(const Session& session) const = 0;
  /// Sets points, units, sigmas and, in mm, the observed rows of by_setting.
  [[nodiscard]] virtual tl::expected<void, model::VisitFailure> linearise(
      const Session& session,
      const State& state,
      const Steps& steps,
      LinearisedSystem& system) const = 0;
  /// From mm to units of noise, the observed rows.
  virtual void whiten(const LinearisedSystem& system, Eigen::VectorXd& mm) const = 0;
  /// Why nothing of the kind can show this cause; empty where it can.
  [[nodiscard]] virtual std::string untestable(const Session& session, CauseId cause) const = 0;
};

/// The whitened column of an effect that is added to a chain, or to what is written down: the poses
/// stay.
[[nodiscard]] Eigen::VectorXd added(const Session& session,
                                    const State& state,
                                    const LinearisedSystem& system,
                                    CauseId cause,
                                    const std::vector<double>& values);

[[nodiscard]] const Observed& observed_of(const Session& session);

[[nodiscard]] const Observed& observed_points();
[[nodiscard]] const Observed& observed_distances();

}  // namespace chaintrue::grid::diagnosis
