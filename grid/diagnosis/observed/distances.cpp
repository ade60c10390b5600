// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/observed/observed.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::Station;

std::vector<model::BedPoint> marks_of(const std::vector<observation::PlaceState>& places) {
  std::vector<model::BedPoint> marks;
  for (const observation::PlaceState& place : places) marks.push_back(place.mark);
  return marks;
}

class Distances final : public Observed {
 public:
  [[nodiscard]] std::optional<Eigen::VectorXd> predicted(
      const Session& session, const State& state, const model::Machine& machine) const override {
    const auto places = session.distances->placed({model::ReadingModel(machine), state.sheet});
    if (!places) return std::nullopt;
    return Eigen::VectorXd(
        observation::tape_factor(machine) *
        observation::distance_geometry(session.distances->set(), marks_of(*places)).predicted_mm);
  }

  [[nodiscard]] Eigen::VectorXd measured(const Session& session) const override {
    return session.distances->measured();
  }

  [[nodiscard]] tl::expected<void, model::VisitFailure> linearise(
      const Session& session,
      const State& state,
      const Steps& steps,
      LinearisedSystem& system) const override {
    const MeasuredHoles& set = session.distances->set();
    const model::ReadingModel model(state.machine);
    const auto places = session.distances->placed({model, state.sheet});
    if (!places) {
      return tl::unexpected(model::VisitFailure{places.error().place, places.error().reason});
    }
    const observation::DistanceGeometry geometry = observation::distance_geometry(set, marks_of(*places));
    const Eigen::MatrixXd by_mark = observation::tape_factor(state.machine) * geometry.by_mark;
    const auto settings = static_cast<Eigen::Index>(session.settings.size());
    const Eigen::Index count = session.observed_rows();
    for (std::size_t i = 0; i < places->size(); ++i) {
      const auto at = 2 * static_cast<Eigen::Index>(i);
      for (Eigen::Index k = 0; k < settings; ++k) {
        system.by_setting.col(k).head(count) +=
            by_mark.middleCols<2>(at) *
            observation::TapeDistances::mark_by_setting(
                {model, state.sheet}, (*places)[i], session.settings[static_cast<std::size_t>(k)]);
      }
      system.points.push_back(
          {(*places)[i].reading, (*places)[i].by_mark, Eigen::Matrix2d::Identity()});
    }
    const Eigen::MatrixXd by_hook = hook_columns(session);
    system.by_setting.block(0, settings, count, 2) = observation::tape_factor(state.machine) * geometry.by_size;
    system.by_setting.block(0, settings + 2, count, by_hook.cols()) = by_hook;
    system.by_setting.block(0, settings + 2 + by_hook.cols(), count, by_mark.cols()) = by_mark;
    set_sigmas(set, steps, system);
    for (Eigen::Index k = 0; k < count; ++k) system.units.push_back(unit_of(system, by_mark, k));
    return {};
  }

  void whiten(const LinearisedSystem& system, Eigen::VectorXd& mm) const override {
    const Eigen::Index count = system.row_sigma_mm.size();
    mm.head(count) = mm.head(count).cwiseQuotient(system.row_sigma_mm).eval();
  }

  [[nodiscard]] std::string untestable(const Session& /*session*/, CauseId cause) const override {
    if (cause.effect->needs == model::effects::DataNeed::order) {
      return "the order in which the holes were cut is not in the file, and no chain was read";
    }
    if (cause.effect->station == Station::paper && !observation::is_of_tape(*cause.effect, cause.side)) {
      return "a tape has one scale whichever way it is held, and no axes: print or set out marks "
             "and read the chains there";
    }
    return "";
  }

 private:
  /// A distance by the hook of its session.
  static Eigen::MatrixXd hook_columns(const Session& session) {
    const std::vector<HoleDistance>& distances = session.distances->set().distances;
    const auto& known = session.tape_sessions;
    Eigen::MatrixXd columns =
        Eigen::MatrixXd::Zero(session.observed_rows(), static_cast<Eigen::Index>(known.size()));
    for (std::size_t k = 0; k < distances.size(); ++k) {
      const auto at = std::find(known.begin(), known.end(), distances[k].session);
      if (at != known.end()) columns(static_cast<Eigen::Index>(k), at - known.begin()) = 1.0;
    }
    return columns;
  }

  static void set_sigmas(const MeasuredHoles& set, const Steps& steps, LinearisedSystem& system) {
    const auto count = static_cast<Eigen::Index>(set.distances.size());
    system.row_sigma_mm.resize(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      system.row_sigma_mm(k) = sigma_of(set, set.distances[static_cast<std::size_t>(k)]);
    }
    if (!steps.whiten) {
      system.row_sigma_mm.setConstant(
          std::sqrt(system.row_sigma_mm.squaredNorm() / static_cast<double>(count)));
    }
  }

  static Unit unit_of(const LinearisedSystem& system,
                      const Eigen::MatrixXd& by_mark,
                      Eigen::Index row) {
    Unit unit;
    for (std::size_t i = 0; i < system.points.size(); ++i) {
      const Eigen::RowVector2d own = by_mark.block<1, 2>(row, 2 * static_cast<Eigen::Index>(i));
      if (own.isZero(0.0)) continue;
      SeenPlace seen{i, Eigen::Matrix2d::Zero()};
      seen.by_chain.row(0) = -own * system.points[i].by_mark.inverse() / system.row_sigma_mm(row);
      unit.push_back(seen);
    }
    return unit;
  }
};

}  // namespace

const Observed& observed_distances() {
  static const Distances distances;
  return distances;
}

}  // namespace chaintrue::grid::diagnosis
