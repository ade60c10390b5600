// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "grid/diagnosis/observed/observed.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

std::vector<model::Visit> visits_of(const Session& session,
                                    const State& state,
                                    const model::Machine& machine) {
  const model::MarkFrame mark_frame(machine);
  std::vector<model::Visit> visits;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    visits.push_back({state.sheet.to_bed(mark_frame.place(session.points[i].mark)),
                      session.ordered ? session.points[i].order : static_cast<int>(i)});
  }
  return visits;
}

/// One whitening for all, of the mean variance of a row.
void whiten_alike(const Eigen::Matrix2d& summed, LinearisedSystem& system) {
  const double mean = 0.5 * summed.trace() / static_cast<double>(system.points.size());
  for (PointState& point : system.points) {
    point.whitening = Eigen::Matrix2d::Identity() / std::sqrt(mean);
  }
}

class Points final : public Observed {
 public:
  [[nodiscard]] std::optional<Eigen::VectorXd> predicted(
      const Session& session, const State& state, const model::Machine& machine) const override {
    const auto lengths =
        model::readings(model::ReadingModel(machine), visits_of(session, state, machine));
    if (!lengths) return std::nullopt;
    Eigen::VectorXd all(session.observed_rows());
    for (std::size_t i = 0; i < lengths->size(); ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      all(row) = (*lengths)[i].left_mm;
      all(row + 1) = (*lengths)[i].right_mm;
    }
    return all;
  }

  [[nodiscard]] Eigen::VectorXd measured(const Session& session) const override {
    Eigen::VectorXd all(session.observed_rows());
    for (std::size_t i = 0; i < session.points.size(); ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      all(row) = session.points[i].lengths.left_mm;
      all(row + 1) = session.points[i].lengths.right_mm;
    }
    return all;
  }

  [[nodiscard]] tl::expected<void, model::VisitFailure> linearise(
      const Session& session,
      const State& state,
      const Steps& steps,
      LinearisedSystem& system) const override {
    const model::ReadingModel model(state.machine);
    const model::MarkFrame mark_frame(state.machine);
    Eigen::Matrix2d summed = Eigen::Matrix2d::Zero();
    for (std::size_t i = 0; i < session.points.size(); ++i) {
      const model::BedPoint place = mark_frame.place(session.points[i].mark);
      const auto reading = model.at(state.sheet.to_bed(place));
      if (!reading) return tl::unexpected(model::VisitFailure{i, reading.error()});
      PointState seen{*reading, reading->position_jacobian * state.sheet.rotation(), {}};
      const Eigen::Matrix2d covariance =
          std::pow(session.noise.length_mm, 2) * Eigen::Matrix2d::Identity() +
          std::pow(session.noise.position_mm, 2) * seen.by_mark * seen.by_mark.transpose();
      summed += covariance;
      seen.whitening = Eigen::Matrix2d(covariance.llt().matrixL()).inverse();
      const Eigen::Matrix<double, 2, 3> by_sheet =
          reading->position_jacobian * state.sheet.sensitivity(place);
      const auto row = 2 * static_cast<Eigen::Index>(i);
      constexpr auto kOfMachine = static_cast<Eigen::Index>(model::kMachineSettings.size());
      for (Eigen::Index k = 0; k < system.setting.size(); ++k) {
        system.by_setting.block<2, 1>(row, k) =
            k < kOfMachine
                ? model.sensitivity(*reading, session.settings[static_cast<std::size_t>(k)])
                : Eigen::Vector2d(by_sheet.col(k - kOfMachine));
      }
      system.points.push_back(std::move(seen));
    }
    if (!steps.whiten) whiten_alike(summed, system);
    for (std::size_t i = 0; i < system.points.size(); ++i) {
      system.units.push_back({{i, system.points[i].whitening}});
    }
    return {};
  }

  void whiten(const LinearisedSystem& system, Eigen::VectorXd& mm) const override {
    for (std::size_t i = 0; i < system.points.size(); ++i) {
      auto pair = mm.segment<2>(2 * static_cast<Eigen::Index>(i));
      pair = (system.points[i].whitening * pair).eval();
    }
  }

  [[nodiscard]] std::string untestable(const Session& session, CauseId cause) const override {
    const bool needs_order = cause.effect->needs == model::effects::DataNeed::order;
    return needs_order && !session.ordered
               ? "the order in which the points were visited is not known"
               : "";
  }
};

}  // namespace

const Observed& observed_points() {
  static const Points points;
  return points;
}

const Observed& observed_of(const Session& session) {
  return session.distances ? observed_distances() : observed_points();
}

}  // namespace chaintrue::grid::diagnosis
