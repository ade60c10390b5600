// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/observed/observed.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// What an effect adds to the chains at a point, or to what is written down there.
Eigen::Vector2d added_at(const Session& session,
                         const State& state,
                         const LinearisedSystem& system,
                         std::size_t i,
                         CauseId cause,
                         const std::vector<double>& values) {
  const model::Sprocket& sprocket = state.machine.sprocket;
  const model::Pose& pose = system.points[i].reading.pose;
  Eigen::Vector2d mm = Eigen::Vector2d::Zero();
  for (const model::Side side : model::kSides) {
    if (!model::effects::acts_on(cause.side, side)) continue;
    const bool left = side == model::Side::left;
    if (cause.effect->misread != nullptr) {
      mm(left ? 0 : 1) =
          cause.effect->misread({session.points[i].order, sprocket.pitch_mm}, values);
    } else {
      const double length = left ? pose.lengths.left_mm : pose.lengths.right_mm;
      mm(left ? 0 : 1) =
          cause.effect->add({pose.chains[side], length, sprocket.teeth * sprocket.pitch_mm}, values)
              .length_mm;
    }
  }
  return mm;
}

}  // namespace

Eigen::VectorXd added(const Session& session,
                      const State& state,
                      const LinearisedSystem& system,
                      CauseId cause,
                      const std::vector<double>& values) {
  std::vector<Eigen::Vector2d> mm;
  for (std::size_t i = 0; i < system.points.size(); ++i) {
    mm.push_back(added_at(session, state, system, i, cause, values));
  }
  Eigen::VectorXd column = Eigen::VectorXd::Zero(session.rows());
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    const Eigen::Index row = system.unit_rows * static_cast<Eigen::Index>(u);
    for (const SeenPlace& seen : system.units[u]) {
      column.segment(row, system.unit_rows) +=
          (seen.by_chain * mm[seen.place]).head(system.unit_rows);
    }
  }
  return column;
}

}  // namespace chaintrue::grid::diagnosis
