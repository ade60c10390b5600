// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/rows.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::Effect;
using model::effects::EffectParameter;
using model::effects::EffectSide;
using model::effects::ParameterRole;
using model::effects::Station;

constexpr int kPlaces = 24;    // of a knee or a phase: neighbours stay alike to 0.99
constexpr int kMostLinks = 3;  // more than that is seen with the bare eye

model::Machine with_effect(model::Machine machine,
                           CauseId cause,
                           const std::vector<double>& values) {
  machine.effects.push_back(model::effects::applied(*cause.effect, cause.side, values));
  return machine;
}

std::vector<model::Visit> visits_of(const Session& session,
                                    const State& state,
                                    const model::Machine& machine) {
  const model::Paper paper(machine);
  std::vector<model::Visit> visits;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    visits.push_back({state.sheet.to_bed(paper.place(session.points[i].mark)),
                      session.ordered ? session.points[i].order : static_cast<int>(i)});
  }
  return visits;
}

/// Readings of the whole session: points, then the machine's own.
std::optional<Eigen::VectorXd> predicted(const Session& session,
                                         const State& state,
                                         const model::Machine& machine) {
  const auto lengths =
      model::readings(model::ReadingModel(machine), visits_of(session, state, machine));
  if (!lengths) return std::nullopt;
  Eigen::VectorXd all(session.rows());
  for (std::size_t i = 0; i < lengths->size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    all(row) = (*lengths)[i].left_mm;
    all(row + 1) = (*lengths)[i].right_mm;
  }
  for (std::size_t k = 0; k < session.readings.size(); ++k) {
    all(session.point_rows() + static_cast<Eigen::Index>(k)) =
        predicted_reading(machine, session.readings[k]);
  }
  return all;
}

Eigen::VectorXd whitened(const Session& session, const Rows& rows, const Eigen::VectorXd& mm) {
  Eigen::VectorXd result(mm.size());
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    result.segment<2>(row) = rows.points[i].whitening * mm.segment<2>(row);
  }
  for (std::size_t k = 0; k < session.readings.size(); ++k) {
    const Eigen::Index row = session.point_rows() + static_cast<Eigen::Index>(k);
    result(row) = mm(row) / session.readings[k].sigma;
  }
  return result;
}

/// What an effect that is added to a chain, or to what is written down, adds: the poses stay.
Eigen::VectorXd added(const Session& session,
                      const State& state,
                      const Rows& rows,
                      CauseId cause,
                      const std::vector<double>& values) {
  const model::Sprocket& sprocket = state.machine.sprocket;
  Eigen::VectorXd mm = Eigen::VectorXd::Zero(session.rows());
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    const model::Pose& pose = rows.points[i].reading.pose;
    for (const model::Side side : model::kSides) {
      if (!model::effects::acts_on(cause.side, side)) continue;
      const bool left = side == model::Side::left;
      const Eigen::Index row = 2 * static_cast<Eigen::Index>(i) + (left ? 0 : 1);
      if (cause.effect->misread != nullptr) {
        mm(row) = cause.effect->misread({session.points[i].order, sprocket.pitch_mm}, values);
      } else {
        const double length = left ? pose.lengths.left_mm : pose.lengths.right_mm;
        mm(row) = cause.effect
                      ->add({pose.chains[side], length, sprocket.teeth * sprocket.pitch_mm}, values)
                      .length_mm;
      }
    }
  }
  return mm;
}

const EffectParameter& size_parameter(const Effect& effect) { return effect.parameters.front(); }

const EffectParameter* place_parameter(const Effect& effect) {
  for (const EffectParameter& p : effect.parameters) {
    if (p.role == ParameterRole::place) return &p;
  }
  return nullptr;
}

/// Places where an effect may set in: visits, angles between those of the points, phases of a turn.
bool is_slip(const Effect& effect) {
  return effect.misread != nullptr && size_parameter(effect).integer &&
         effect.misread({1, 1.0}, std::vector<double>{1.0, 0.0}) == 0.0;
}

std::vector<double> places(const Session& session, const Rows& rows, CauseId cause) {
  const EffectParameter& place = *place_parameter(*cause.effect);
  std::vector<double> result;
  if (place.integer) {
    // A skip before the first visit is a zero; a miscount may be at any visit.
    for (std::size_t i = is_slip(*cause.effect) ? 0 : 1; i < session.points.size(); ++i) {
      result.push_back(session.points[i].order);
    }
    return result;
  }
  if (place.upper - place.lower >= 2.0 * std::numbers::pi) {
    for (int k = 0; k < kPlaces; ++k) result.push_back(2.0 * std::numbers::pi * k / kPlaces);
    return result;
  }
  std::vector<double> angles;
  for (const PointState& point : rows.points) {
    const auto side = cause.side == EffectSide::left ? model::Side::left : model::Side::right;
    angles.push_back(point.reading.pose.chains[side].angle_rad);
  }
  std::sort(angles.begin(), angles.end());
  const auto last = static_cast<double>(angles.size() - 1);
  for (int k = 0; k < kPlaces; ++k) {
    const double at = last * k / kPlaces;
    const auto below = static_cast<std::size_t>(at);
    result.push_back(angles[below] + (at - std::floor(at)) * (angles[below + 1] - angles[below]));
  }
  return result;
}

/// The coefficient's power: how the signature grows from half the size to the whole one.
double power_of(const Eigen::VectorXd& whole, const Eigen::VectorXd& half) {
  const double ratio = whole.norm() / std::max(half.norm(), 1e-300);
  return std::max(1.0, std::round(std::log2(ratio)));
}

constexpr double kNearby = 0.95;  // of a size: far enough for differences, near enough for a slope

/// The same about a size that was found. A signature that hardly grows any more leaves its size
/// open; one that shrinks again has no power.
double power_about(const Eigen::VectorXd& whole, const Eigen::VectorXd& nearby) {
  const double ratio = whole.dot(nearby) / whole.squaredNorm();
  return std::clamp(std::log(std::max(ratio, 1e-3)) / std::log(kNearby), 0.2, 4.0);
}

/// Goes on through zero as a straight line, where an odd effect changes its sign.
bool is_odd(const Direction& direction) { return direction.power < 1.5; }

void limit(Direction& direction) {
  const EffectParameter& size = size_parameter(*direction.cause.effect);
  const double at = direction.values.front();
  const auto coefficient = [&](double bound) {
    const double ratio = bound / at;
    return ratio < 0.0 ? -std::pow(-ratio, direction.power) : std::pow(ratio, direction.power);
  };
  const double a = coefficient(size.lower);
  const double b = coefficient(size.upper);
  direction.lowest = std::min(a, b);
  direction.highest = std::max(a, b);
}

struct Column {
  Direction direction;
  Eigen::VectorXd g;
};

class Builder {
 public:
  Builder(const Session& session, const State& state, const Rows& rows)
      : session_(session), state_(state), rows_(rows) {}

  void add(CauseId cause, const std::vector<Refinement>& refinements) {
    std::vector<double> values = model::effects::nominal_values(*cause.effect);
    refined_ = false;
    for (const Refinement& r : refinements) {
      if (!(r.cause == cause)) continue;
      values.front() = r.values.front();
      refined_ = true;
    }
    if (size_parameter(*cause.effect).integer) {
      add_links(cause, values);
    } else if (place_parameter(*cause.effect) == nullptr) {
      add_one(cause, values, std::log(share_of_side(cause)));
    } else {
      const std::vector<double> where = places(session_, rows_, cause);
      const double share = std::log(share_of_side(cause) / static_cast<double>(where.size()));
      for (const double place : where) {
        values.back() = place;
        add_one(cause, values, share);
      }
      for (const Refinement& r : refinements) {
        if (r.cause == cause) add_one(cause, r.values, share);
      }
    }
  }

  [[nodiscard]] std::vector<Column>& columns() { return columns_; }

 private:
  [[nodiscard]] static double share_of_side(CauseId cause) {
    return 1.0 / static_cast<double>(cause.effect->sides.size());
  }

  void add_one(CauseId cause, const std::vector<double>& values, double log_prior) {
    auto g = signature(session_, state_, rows_, cause, values);
    if (!g || !(g->norm() > 0.0)) return;
    std::vector<double> smaller = values;
    smaller.front() *= refined_ ? kNearby : 0.5;
    const auto half = signature(session_, state_, rows_, cause, smaller);
    if (!half) return;
    Direction direction;
    direction.cause = cause;
    direction.values = values;
    direction.power = refined_ ? power_about(*g, *half) : power_of(*g, *half);
    direction.log_prior = log_prior;
    direction.refined = refined_;
    limit(direction);
    columns_.push_back({std::move(direction), std::move(*g)});
  }

  void add_links(CauseId cause, std::vector<double> values) {
    const std::vector<double> where = places(session_, rows_, cause);
    for (const double place : where) {
      values.back() = place;
      for (int links = -kMostLinks; links <= kMostLinks; ++links) {
        if (links == 0) continue;
        values.front() = links;
        auto g = signature(session_, state_, rows_, cause, values);
        if (!g || !(g->norm() > 0.0)) continue;
        Direction direction;
        direction.cause = cause;
        direction.values = values;
        direction.fixed = true;
        direction.slip = is_slip(*cause.effect);
        direction.lowest = direction.highest = 1.0;
        direction.visits = static_cast<double>(where.size());
        columns_.push_back({std::move(direction), std::move(*g)});
      }
    }
  }

  const Session& session_;
  const State& state_;
  const Rows& rows_;
  std::vector<Column> columns_;
  bool refined_ = false;
};

}  // namespace

Candidates candidates(const Session& session) {
  Candidates result;
  for (const Effect* effect : model::effects::catalogue()) {
    for (const EffectSide side : effect->sides) {
      const CauseId cause{effect, side};
      model::Machine machine =
          with_effect(session.stated, cause, model::effects::nominal_values(*effect));
      const auto problems = model::effects::problems_of_effects(machine);
      if (effect->needs == model::effects::DataNeed::order && !session.ordered) {
        result.not_testable.push_back(
            {cause, "the order in which the points were visited is not known"});
      } else if (!problems.empty()) {
        result.not_testable.push_back({cause, problems.front().expected});
      } else {
        result.testable.push_back(cause);
      }
    }
  }
  return result;
}

tl::expected<Rows, model::VisitFailure> base_rows(const Session& session,
                                                  const State& state,
                                                  const Steps& steps) {
  const model::ReadingModel model(state.machine);
  const model::Paper paper(state.machine);
  Rows rows;
  rows.setting = setting_values(session, state);
  rows.expected_change = session.stated_value - rows.setting;
  rows.sigma = session.stated_sigma;
  rows.by_setting = Eigen::MatrixXd::Zero(session.rows(), rows.setting.size());
  const auto all = predicted(session, state, state.machine);
  Eigen::Matrix2d summed = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    const SessionPoint& point = session.points[i];
    const model::BedPoint place = paper.place(point.mark);
    const auto reading = model.at(state.sheet.to_bed(place));
    if (!reading || !all) {
      return tl::unexpected(
          model::VisitFailure{i, reading ? model::PoseFailure::not_converged : reading.error()});
    }
    PointState seen{*reading, {}, reading->position_jacobian * state.sheet.rotation(), {}};
    const auto row = 2 * static_cast<Eigen::Index>(i);
    seen.residual_mm =
        Eigen::Vector2d(point.lengths.left_mm, point.lengths.right_mm) - all->segment<2>(row);
    const Eigen::Matrix2d covariance =
        std::pow(session.noise.length_mm, 2) * Eigen::Matrix2d::Identity() +
        std::pow(session.noise.position_mm, 2) * seen.by_mark * seen.by_mark.transpose();
    summed += covariance;
    seen.whitening = Eigen::Matrix2d(covariance.llt().matrixL()).inverse();
    const Eigen::Matrix<double, 2, 3> by_sheet =
        reading->position_jacobian * state.sheet.sensitivity(place);
    for (Eigen::Index k = 0; k < rows.setting.size(); ++k) {
      const auto machine_settings = static_cast<Eigen::Index>(model::kMachineSettings.size());
      rows.by_setting.block<2, 1>(row, k) =
          k < machine_settings
              ? model.sensitivity(*reading, session.settings[static_cast<std::size_t>(k)])
              : Eigen::Vector2d(by_sheet.col(k - machine_settings));
    }
    rows.points.push_back(std::move(seen));
  }
  if (!steps.whiten) {
    const double mean = 0.5 * summed.trace() / static_cast<double>(session.points.size());
    for (PointState& point : rows.points) {
      point.whitening = Eigen::Matrix2d::Identity() / std::sqrt(mean);
    }
  }
  Eigen::VectorXd measured(session.rows());
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    measured(row) = session.points[i].lengths.left_mm;
    measured(row + 1) = session.points[i].lengths.right_mm;
  }
  for (std::size_t k = 0; k < session.readings.size(); ++k) {
    const Eigen::Index row = session.point_rows() + static_cast<Eigen::Index>(k);
    measured(row) = session.readings[k].value;
    for (Eigen::Index s = 0; s < rows.setting.size(); ++s) {
      Eigen::VectorXd moved = rows.setting;
      moved(s) += 1.0;  // these readings are linear in the settings
      rows.by_setting(row, s) =
          predicted_reading(with_settings(session, state, moved).machine, session.readings[k]) -
          (*all)(row);
    }
  }
  rows.e = whitened(session, rows, measured - *all);
  for (Eigen::Index k = 0; k < rows.setting.size(); ++k) {
    rows.by_setting.col(k) = whitened(session, rows, rows.by_setting.col(k));
  }
  return rows;
}

std::optional<Eigen::VectorXd> signature(const Session& session,
                                         const State& state,
                                         const Rows& rows,
                                         CauseId cause,
                                         const std::vector<double>& values) {
  if (cause.effect->add != nullptr || cause.effect->misread != nullptr) {
    return whitened(session, rows, added(session, state, rows, cause, values));
  }
  const model::Machine machine = with_effect(state.machine, cause, values);
  if (!model::effects::problems_of_effects(machine).empty()) return std::nullopt;
  const auto with = predicted(session, state, machine);
  const auto without = predicted(session, state, state.machine);
  if (!with || !without) return std::nullopt;
  return whitened(session, rows, *with - *without);
}

void add_directions(const Session& session,
                    const State& state,
                    const std::vector<CauseId>& causes,
                    const std::vector<Refinement>& refinements,
                    Rows& rows) {
  Builder builder(session, state, rows);
  for (const CauseId& cause : causes) builder.add(cause, refinements);
  const auto count = static_cast<Eigen::Index>(builder.columns().size());
  rows.g.resize(session.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    Column& column = builder.columns()[static_cast<std::size_t>(k)];
    rows.g.col(k) = column.g;
    rows.directions.push_back(std::move(column.direction));
  }
}

bool renew_directions(const Session& session,
                      const State& state,
                      const std::vector<Direction>& directions,
                      Rows& rows) {
  rows.directions = directions;
  rows.g.resize(session.rows(), static_cast<Eigen::Index>(directions.size()));
  for (std::size_t k = 0; k < directions.size(); ++k) {
    Direction& d = rows.directions[k];
    const auto g = signature(session, state, rows, d.cause, d.values);
    if (!g || !(g->norm() > 0.0)) return false;
    rows.g.col(static_cast<Eigen::Index>(k)) = *g;
    if (d.fixed) continue;
    std::vector<double> nearby = d.values;
    nearby.front() *= kNearby;
    const auto there = signature(session, state, rows, d.cause, nearby);
    if (!there) return false;
    d.power = power_about(*g, *there);
    d.refined = true;
    limit(d);
  }
  return true;
}

double size_at(const Direction& direction, double coefficient) {
  const double at = direction.values.front();
  if (direction.fixed) return at;
  if (coefficient <= 0.0) return is_odd(direction) ? at * coefficient : 0.0;
  return at * std::pow(coefficient, 1.0 / direction.power);
}

double size_slope(const Direction& direction, double coefficient) {
  if (direction.fixed) return 0.0;
  const double at = direction.values.front();
  if (coefficient <= 0.0 && is_odd(direction)) return at;
  const double c = std::max(coefficient, 1e-6);
  return at / direction.power * std::pow(c, 1.0 / direction.power - 1.0);
}

}  // namespace chaintrue::grid::diagnosis
