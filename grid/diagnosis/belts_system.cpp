// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/secants.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;
using model::effects::EffectSide;

namespace {

/// Nothing is stated of the anchors: a metre is as good as nothing.
constexpr double kAnchorSigmaMm = 1000.0;
/// How well one sigma of a belt's reading is known before any is read: hardly.
constexpr double kNoiseDof = 2.0;
/// Visits at which something may set in, spread over the session: neighbours of 24 stay alike to 0.97,
/// and the best is looked for between its neighbours afterwards.
constexpr std::size_t kVisits = 24;
/// Ways that an anchor may slip: the nearest is at most a sixteenth of a turn off, 0.92 alike.
constexpr int kWays = 8;
/// On either side of a step, or nobody can tell it from bad readings.
constexpr std::size_t kLeastAfter = 2;

/// Whole teeth that a belt may jump by, with their shares: one is the rule, a turn of the encoder is
/// what a lost magnet makes.
struct Teeth {
  double teeth;
  double share;
};
constexpr Teeth kTeeth[] = {{1.0, 0.25},
                            {-1.0, 0.25},
                            {2.0, 0.1},
                            {-2.0, 0.1},
                            {3.0, 0.05},
                            {-3.0, 0.05},
                            {22.0, 0.1},
                            {-22.0, 0.1}};

/// How often a cause acts, against the others. Belts that are pulled stretch: the four frames whose
/// owners published more than a start all do, and with this share it is as likely as that nothing is
/// wrong. What sets in during a session is rare,
/// and an anchor that slips by just a tooth along its belt is rarer than a belt that skips.
double share_of(const CauseId& cause) {
  const std::string_view id = cause.effect->id;
  if (id == "belt_stretch") return 40.0;
  if (id == "tooth_skip" || id == "zero_shift") return 0.3;
  return id == "anchor_moved" ? 0.01 : 1.0;
}

/// The visits in order, without the first few and the last few.
std::vector<int> visits_to_set_in(const MeasuredBelts& belts) {
  std::vector<int> orders;
  for (const BeltPoint& point : belts.points) {
    if (point.order) orders.push_back(*point.order);
  }
  std::sort(orders.begin(), orders.end());
  if (orders.size() <= 2 * kLeastAfter) return {};
  return {orders.begin() + kLeastAfter, orders.end() - (kLeastAfter - 1)};
}

std::vector<int> thinned(const std::vector<int>& visits) {
  if (visits.size() <= kVisits) return visits;
  std::vector<int> few;
  for (std::size_t i = 0; i < kVisits; ++i) few.push_back(visits[i * visits.size() / kVisits]);
  return few;
}

/// Those between the neighbours of one among the thinned.
std::vector<int> about(const std::vector<int>& visits, int visit) {
  const auto half = static_cast<std::ptrdiff_t>(visits.size() / kVisits + 1);
  const auto at = std::lower_bound(visits.begin(), visits.end(), visit) - visits.begin();
  const auto last = static_cast<std::ptrdiff_t>(visits.size());
  return {visits.begin() + std::clamp<std::ptrdiff_t>(at - half, 0, last),
          visits.begin() + std::clamp<std::ptrdiff_t>(at + half + 1, 0, last)};
}

class Columns {
 public:
  Columns(const MeasuredBelts& belts, const BeltsState& state, BeltsSystem& system)
      : belts_(belts), state_(state), system_(system), visits_(visits_to_set_in(belts)) {}

  void add(const CauseId& cause) {
    const auto& parameters = cause.effect->parameters;
    std::vector<double> values;
    for (const auto& parameter : parameters) values.push_back(parameter.nominal);
    const BeltCause* found = nullptr;
    for (const BeltCause& own : state_.causes) {
      if (own.cause == cause) found = &own;
    }
    if (found != nullptr) values = found->values;
    const double side = share_of(cause) / static_cast<double>(cause.effect->sides.size());
    if (parameters.size() == 1) return add_one({cause, values}, found != nullptr, side);
    std::vector<int> visits = thinned(visits_);
    if (found != nullptr) {
      const std::vector<int> near = about(visits_, static_cast<int>(values.back()));
      visits.insert(visits.end(), near.begin(), near.end());
      std::sort(visits.begin(), visits.end());
      visits.erase(std::unique(visits.begin(), visits.end()), visits.end());
    }
    const double share = side / static_cast<double>(visits.size());
    for (const int visit : visits) {
      values.back() = visit;
      if (parameters.front().integer) {
        for (const Teeth& own : kTeeth) {
          values.front() = own.teeth;
          add_one({cause, values}, false, share * own.share);
        }
      } else if (parameters.size() > 2) {
        add_ways({cause, values}, found, share);
      } else {
        add_one({cause, values}, found != nullptr, share);
      }
    }
  }

  void finish() {
    const auto count = static_cast<Eigen::Index>(columns_.size());
    system_.by_cause_mm.resize(4 * static_cast<Eigen::Index>(belts_.points.size()), count);
    for (Eigen::Index k = 0; k < count; ++k)
      system_.by_cause_mm.col(k) = columns_[static_cast<std::size_t>(k)];
  }

 private:
  void add_ways(BeltCause own, const BeltCause* found, double share) {
    if (found != nullptr) {
      own.values[1] = found->values[1];
      add_one(own, true, share / (kWays + 1));
    }
    for (int way = 0; way < kWays; ++way) {
      own.values[1] = std::remainder(2.0 * std::numbers::pi * way / kWays, 2.0 * std::numbers::pi);
      add_one(own, false, share / kWays);
    }
  }

  void add_one(const BeltCause& own, bool refined, double share) {
    Eigen::VectorXd column = added_by(belts_, {own}, state_.frame.state);
    if (!(column.norm() > 0.0)) return;
    Regressor regressor;
    regressor.cause = own.cause;
    regressor.values = own.values;
    regressor.log_prior = std::log(share);
    regressor.refined = refined;
    if (own.cause.effect->parameters.front().integer) {
      regressor.fixed = true;
      regressor.lowest = regressor.highest = 1.0;
    } else {
      BeltCause smaller = own;
      smaller.values.front() *= refined ? kNearby : 0.5;
      const Eigen::VectorXd other = added_by(belts_, {smaller}, state_.frame.state);
      regressor.power = refined ? power_about(column, other) : power_of(column, other);
      limit(regressor);
    }
    system_.system.regressors.push_back(std::move(regressor));
    columns_.push_back(std::move(column));
  }

  const MeasuredBelts& belts_;
  const BeltsState& state_;
  BeltsSystem& system_;
  std::vector<int> visits_;
  std::vector<Eigen::VectorXd> columns_;
};

}  // namespace

BeltsCandidates candidates(const MeasuredBelts& belts) {
  BeltsCandidates result;
  const bool ordered = !visits_to_set_in(belts).empty();
  std::array<bool, 2> is_pulled_anywhere{};
  for (const BeltPoint& point : belts.points) {
    for (const Belt belt : kBelts) is_pulled_anywhere[is_pulled(point, belt) ? 1 : 0] = true;
  }
  for (const model::belts::BeltEffect* effect : model::belts::belt_effects()) {
    for (const EffectSide side : effect->sides) {
      const CauseId cause{&model::belts::described(*effect), side};
      if (effect == &model::belts::anchor_moved && side == EffectSide::all) {
        result.not_testable.emplace_back(
            cause,
            "a frame that stands elsewhere as a whole, with the places in it, changes no length: "
            "measure a hole that the machine cut from two edges of the sheet");
      } else if (effect == &model::belts::belt_scale && side == EffectSide::all) {
        result.not_testable.emplace_back(
            cause,
            belts.distances.empty()
                ? "lengths that are all too long by the same share make a larger frame and "
                  "contradict nothing: tape one long distance, between two anchors or two holes "
                  "that the machine cut, and give it as distances"
                : "no belt tells it; the taped distances do: see the scale");
      } else if (effect->needs == model::effects::DataNeed::order && !ordered) {
        result.not_testable.emplace_back(
            cause, "the file does not say in which order the places were measured: give order");
      } else if ((effect == &model::belts::belt_stretch || effect == &model::belts::anchor_flex) &&
                 !(is_pulled_anywhere[0] && is_pulled_anywhere[1])) {
        result.not_testable.emplace_back(
            cause, "no belt is pulled beside others that hold: say which are, with pulled");
      } else {
        result.testable.push_back(cause);
      }
    }
  }
  return result;
}

Eigen::MatrixXd checked(const std::vector<Eigen::Matrix<double, 4, 2>>& checks,
                        const Eigen::MatrixXd& readings) {
  Eigen::MatrixXd rows(readings.rows() / 2, readings.cols());
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    rows.middleRows<2>(2 * at).noalias() = checks[k].transpose() * readings.middleRows<4>(4 * at);
  }
  return rows;
}

BeltsSystem system_of(const MeasuredBelts& belts,
                      const BeltsState& state,
                      const std::vector<CauseId>& causes,
                      double sigma_mm) {
  BeltsSystem result;
  const std::size_t count = belts.points.size();
  const belts::AnchorAdjustment solver(belts, state.frame.counting, sigma_mm);
  const belts::FrameEquations at = solver.equations(state.frame.state);
  result.residual_mm = at.residual;
  result.by_anchor.resize(at.residual.size(), belts::kAnchorUnknowns);
  for (std::size_t k = 0; k < count; ++k) {
    for (const Belt belt : kBelts) {
      result.by_anchor.row(belts::row_of(k, belt)) =
          solver.frame_row(at, k, belt).head<belts::kAnchorUnknowns>();
    }
    result.checks.emplace_back(checks_of(at, k, {true, true, true, true}));
  }
  Columns columns(belts, state, result);
  for (const CauseId& cause : causes) columns.add(cause);
  columns.finish();
  RegressorSystem& system = result.system;
  system.setting = Eigen::VectorXd::Zero(belts::kAnchorUnknowns);
  system.expected_change = system.setting;
  system.sigma = Eigen::VectorXd::Constant(belts::kAnchorUnknowns, kAnchorSigmaMm);
  system.noise_dof = kNoiseDof;
  system.fewest_units = 2 * kFewestBeltPoints;
  for (std::size_t u = 0; u < 2 * count; ++u) {
    SystemUnit unit;
    unit.first_row = static_cast<Eigen::Index>(u);
    unit.whitening = estimation::UnitWhitening::projected(Eigen::MatrixXd::Identity(1, 1), sigma_mm);
    system.units.push_back(std::move(unit));
    system.unit_of_row.push_back(static_cast<int>(u));
  }
  turn_to(Suspects(count), sigma_mm, result);
  return result;
}

void turn_to(const Suspects& suspects, double sigma_mm, BeltsSystem& result) {
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    if (!suspects[k]) continue;
    Eigen::Matrix<double, 4, 2>& q = result.checks[k];
    Eigen::Vector2d along = q.row(static_cast<Eigen::Index>(*suspects[k])).transpose();
    along.normalize();
    Eigen::Matrix2d turn;
    turn << along, Eigen::Vector2d(-along.y(), along.x());
    q = (q * turn).eval();
  }
  RegressorSystem& system = result.system;
  system.e = checked(result.checks, result.residual_mm) / sigma_mm;
  system.by_setting = checked(result.checks, result.by_anchor) / sigma_mm;
  system.g = Eigen::MatrixXd(checked(result.checks, result.by_cause_mm) / sigma_mm);
}

}  // namespace chaintrue::grid::diagnosis
