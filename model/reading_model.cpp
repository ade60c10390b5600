// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/reading_model.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

using effects::ActingEffect;
using effects::acts_on;

// Steps of the five-point difference
//   f'(0) = (8 (f(h) - f(-h)) - (f(2h) - f(-2h))) / (12 h)                                   (1)
// At 4 mm its truncation, h^4 f^(5) / 30, is below 1e-9 of the derivative of an angle that varies
// over the 600 mm or more between sled and sprocket; rounding adds 1e-13.
constexpr double kStepMm = 4.0;
constexpr std::array<double, 4> kStencil = {-2.0, -1.0, 1.0, 2.0};
constexpr std::array<double, 4> kWeights = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};

// What a chain's length may depend on, or the slopes of that, in the order of LengthVariable.
using StateNumbers = Eigen::Matrix<double, effects::kLengthVariables, 1>;

void add_weighted(PerSide<StateNumbers>& sum, const Pose& pose, double weight) {
  for (const Side side : kSides) {
    const ChainState& chain = pose.chains[side];
    sum[side][effects::kAngle] += weight * chain.angle_rad;
    sum[side][effects::kFree] += weight * chain.free_length_mm;
    sum[side][effects::kTension] += weight * chain.tension_at_sprocket_n;
    sum[side][effects::kHorizontal] += weight * chain.horizontal_n;
  }
}

// The slopes of a pose have to be known for these.
bool depends_on_state(const effects::Number& added) {
  return added.d[effects::kAngle] != 0.0 || added.d[effects::kFree] != 0.0 ||
         added.d[effects::kTension] != 0.0 || added.d[effects::kHorizontal] != 0.0;
}

bool is_motor_setting(Setting setting) { return setting <= Setting::motor_right_y_mm; }

/// In the order of the settings.
struct MotorSetting {
  Side side;
  double MotorPosition::*axis;
  Parameter parameter;
};
constexpr std::array kMotorSettings = {
    MotorSetting{Side::left, &MotorPosition::x_mm, Parameter::motor_left_x_mm},
    MotorSetting{Side::left, &MotorPosition::y_mm, Parameter::motor_left_y_mm},
    MotorSetting{Side::right, &MotorPosition::x_mm, Parameter::motor_right_x_mm},
    MotorSetting{Side::right, &MotorPosition::y_mm, Parameter::motor_right_y_mm}};

const MotorSetting& motor_of(Setting setting) {
  return kMotorSettings.at(static_cast<std::size_t>(setting));
}

double sign_of_change(double change, double last) {
  if (change > 0.0) return 1.0;
  if (change < 0.0) return -1.0;
  return last;
}

// f'(0) by (1); with a smaller step where a neighbour has no pose. `pose_at(t)` is the pose t mm
// away.
template <class PoseAt>
tl::expected<PerSide<StateNumbers>, PoseFailure> state_slope(const PoseAt& pose_at) {
  PoseFailure reason = PoseReason::not_converged;
  for (const double step_mm : {kStepMm, kStepMm / 16.0, kStepMm / 256.0}) {
    PerSide<StateNumbers> slope{StateNumbers::Zero(), StateNumbers::Zero()};
    bool complete = true;
    for (std::size_t i = 0; i < kStencil.size() && complete; ++i) {
      const PoseResult neighbour = pose_at(kStencil[i] * step_mm);
      complete = neighbour.has_value();
      if (complete) {
        add_weighted(slope, *neighbour, kWeights[i] / step_mm);
      } else {
        reason = neighbour.error();
      }
    }
    if (complete) return slope;
  }
  return tl::unexpected(reason);
}

}  // namespace

struct ReadingModel::State {
  Machine machine;
  Model model = Model::elastic;
  EquilibriumParameters parameters;
  std::unique_ptr<const Kinematics> kinematics;
  std::vector<ActingEffect> acting;
  /// Sum of the elongations of a chain.
  PerSide<double> elongation;

  /// What effects add to a chain, without those of the visit.
  [[nodiscard]] effects::Number added(const Pose& pose, Side side) const;
  [[nodiscard]] PerSide<effects::Number> added(const Pose& pose) const {
    return {added(pose, Side::left), added(pose, Side::right)};
  }
  /// What a visit adds to the reading of a chain.
  [[nodiscard]] double added_at_visit(Side side, int order, double direction) const;
  /// The reading of a chain paid out to this length.
  [[nodiscard]] double counted(double length_mm, Side side) const {
    return length_mm / (1.0 + elongation[side]) + machine.chain_zero[side];
  }
  /// d(reading)/d(anything) from the slopes of the pose's lengths, of its chains' states and of the
  /// tool's position.
  [[nodiscard]] Eigen::Vector2d through_effects(const PerSide<effects::Number>& added,
                                                const Eigen::Vector2d& length_slope,
                                                PerSide<StateNumbers> slope,
                                                const Eigen::Vector2d& position_slope) const;
  [[nodiscard]] PoseResult pose_near(BedPoint point, Setting setting, double change_mm) const;
};

effects::Number ReadingModel::State::added(const Pose& pose, Side side) const {
  const effects::LengthState chain = effects::chain_at_rest(pose, side, machine.sprocket);
  effects::Number sum;
  for (const ActingEffect& one : acting) {
    if (one.effect->add != nullptr && !depends_on_visit(*one.effect) && acts_on(one.side, side))
      sum = sum + one.effect->add(chain, one.values);
  }
  return sum;
}

double ReadingModel::State::added_at_visit(Side side, int order, double direction) const {
  const effects::LengthState chain{
      .tooth_mm = machine.sprocket.pitch_mm, .direction = direction, .order = order};
  double sum = 0.0;
  for (const ActingEffect& one : acting) {
    if (!depends_on_visit(*one.effect) || !acts_on(one.side, side)) continue;
    const double added_mm = one.effect->add(chain, one.values).value;
    sum += one.effect->by_direction ? added_mm / (1.0 + elongation[side]) : added_mm;
  }
  return sum;
}

Eigen::Vector2d ReadingModel::State::through_effects(const PerSide<effects::Number>& added,
                                                     const Eigen::Vector2d& length_slope,
                                                     PerSide<StateNumbers> slope,
                                                     const Eigen::Vector2d& position_slope) const {
  Eigen::Vector2d result;
  for (const Side side : kSides) {
    const Eigen::Index row = side == Side::left ? 0 : 1;
    slope[side][effects::kLength] = length_slope[row];
    slope[side].tail<2>() = position_slope;
    const StateNumbers by = Eigen::Map<const StateNumbers>(added[side].d.data());
    result[row] = (length_slope[row] + by.dot(slope[side])) / (1.0 + elongation[side]);
  }
  return result;
}

PoseResult ReadingModel::State::pose_near(BedPoint point,
                                            Setting setting,
                                            double change_mm) const {
  EquilibriumParameters changed = parameters;
  const MotorSetting& motor = motor_of(setting);
  changed.motors[motor.side].*motor.axis += change_mm;
  return make_kinematics(changed, model)->inverse(point);
}

ReadingModel::ReadingModel(const Machine& machine, Model model) {
  require_none(problems_of(machine));
  auto state = std::make_shared<State>();
  state->machine = machine;
  state->model = model;
  state->acting = effects::acting_effects(machine);
  state->parameters = equilibrium_parameters(machine);
  for (const ActingEffect& one : state->acting) {
    if (one.effect->alter != nullptr) one.effect->alter(state->parameters, one.values);
    if (one.effect->elongation == nullptr) continue;
    for (const Side side : kSides) {
      if (acts_on(one.side, side)) state->elongation[side] += one.effect->elongation(one.values);
    }
  }
  state->kinematics = make_kinematics(state->parameters, model);
  state_ = std::move(state);
}

const Machine& ReadingModel::machine() const { return state_->machine; }

Model ReadingModel::model() const { return state_->model; }

tl::expected<PointReading, PoseFailure> ReadingModel::at(BedPoint point) const {
  const State& state = *state_;
  const PoseResult pose = state.kinematics->inverse(point);
  if (!pose) return tl::unexpected(pose.error());
  PointReading reading;
  reading.pose = *pose;
  const PerSide<effects::Number> added = state.added(*pose);
  for (const Side side : kSides)
    reading.lengths[side] = state.counted(pose->lengths[side] + added[side].value, side);
  const Eigen::Matrix2d lengths_by_point = state.kinematics->jacobian(*pose);
  for (const Eigen::Index axis : {0, 1}) {
    PerSide<StateNumbers> slope{StateNumbers::Zero(), StateNumbers::Zero()};
    if (depends_on_state(added.left) || depends_on_state(added.right)) {
      const auto found = state_slope([&](double mm) {
        return state.kinematics->inverse(axis == 0 ? BedPoint{point.x_mm + mm, point.y_mm}
                                                   : BedPoint{point.x_mm, point.y_mm + mm});
      });
      if (!found) return tl::unexpected(found.error());
      slope = *found;
    }
    reading.position_jacobian.col(axis) = state.through_effects(
        added, lengths_by_point.col(axis), slope, Eigen::Vector2d::Unit(axis));
  }
  return reading;
}

Eigen::Vector2d ReadingModel::sensitivity(const PointReading& reading, Setting setting) const {
  const State& state = *state_;
  if (setting == Setting::chain_zero_left_mm) return {1.0, 0.0};
  if (setting == Setting::chain_zero_right_mm) return {0.0, 1.0};
  if (!is_motor_setting(setting)) {
    throw std::invalid_argument(
        "sensitivity: the sheet's settings move the point, not the machine");
  }
  const PerSide<effects::Number> added = state.added(reading.pose);
  PerSide<StateNumbers> slope{StateNumbers::Zero(), StateNumbers::Zero()};
  if (depends_on_state(added.left) || depends_on_state(added.right)) {
    const auto found = state_slope(
        [&](double mm) { return state.pose_near(reading.pose.position, setting, mm); });
    // A pose exists here but not at its neighbours within 16 um: at the very edge only the length's
    // own slope is used.
    if (found) slope = *found;
  }
  return state.through_effects(added,
                               state.kinematics->sensitivity(reading.pose, motor_of(setting).parameter),
                               slope,
                               Eigen::Vector2d::Zero());
}

tl::expected<PointReading, PoseFailure> ReadingModel::find(ChainLengths lengths,
                                                           BedPoint start) const {
  constexpr int kMaxSteps = 40;
  constexpr double kMaxStrideMm = 300.0;
  constexpr double kConvergedMm = 1e-9;
  BedPoint point = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    auto reading = at(point);
    if (!reading) return reading;
    const Eigen::Vector2d missing{lengths.left_mm - reading->lengths.left_mm,
                                  lengths.right_mm - reading->lengths.right_mm};
    Eigen::Vector2d move = reading->position_jacobian.inverse() * missing;
    if (!move.allFinite()) break;
    if (move.norm() > kMaxStrideMm) move *= kMaxStrideMm / move.norm();
    // Shorten a step that leaves the domain.
    while (move.norm() >= kConvergedMm &&
           !state_->kinematics->inverse({point.x_mm + move[0], point.y_mm + move[1]})) {
      move *= 0.5;
    }
    point = {point.x_mm + move[0], point.y_mm + move[1]};
    if (move.norm() < kConvergedMm && missing.norm() < 100.0 * kConvergedMm) return at(point);
  }
  return tl::unexpected(PoseReason::not_converged);
}

ChainLengths ReadingModel::added_at_visit(int order, const PerSide<double>& direction) const {
  return {state_->added_at_visit(Side::left, order, direction.left),
          state_->added_at_visit(Side::right, order, direction.right)};
}

/// The direction in which each chain last moved.
class Session {
 public:
  explicit Session(const ReadingModel& model) : state_(*model.state_) {}

  tl::expected<ChainLengths, PoseFailure> read(const Visit& visit) {
    const PoseResult pose = state_.kinematics->inverse(visit.position);
    if (!pose) return tl::unexpected(pose.error());
    return ChainLengths{chain(*pose, Side::left, visit.order),
                        chain(*pose, Side::right, visit.order)};
  }

 private:
  double chain(const Pose& pose, Side side, int order) {
    const double before = pose.lengths[side] + state_.added(pose, side).value;
    if (last_length_mm_[side]) {
      direction_[side] = sign_of_change(before - *last_length_mm_[side], direction_[side]);
    }
    last_length_mm_[side] = before;
    return state_.counted(before, side) + state_.added_at_visit(side, order, direction_[side]);
  }

  const ReadingModel::State& state_;
  PerSide<double> direction_{1.0, 1.0};
  PerSide<std::optional<double>> last_length_mm_;
};

tl::expected<std::vector<ChainLengths>, VisitFailure> readings(
    const ReadingModel& model,
    std::span<const Visit> visits,
    const std::function<void(std::size_t read)>& on_progress) {
  std::vector<std::size_t> sequence(visits.size());
  std::iota(sequence.begin(), sequence.end(), std::size_t{0});
  std::sort(sequence.begin(), sequence.end(), [&](std::size_t a, std::size_t b) {
    return visits[a].order < visits[b].order;
  });
  Session session(model);
  std::vector<ChainLengths> result(visits.size());
  for (std::size_t k = 0; k < sequence.size(); ++k) {
    const std::size_t i = sequence[k];
    if (k > 0 && visits[i].order == visits[sequence[k - 1]].order) {
      throw std::invalid_argument(
          fmt::format("readings: two visits bear the number {}", visits[i].order));
    }
    const auto lengths = session.read(visits[i]);
    if (!lengths) return tl::unexpected(lengths.error().at(i));
    result[i] = *lengths;
    if (on_progress) on_progress(k + 1);
  }
  return result;
}

MarkFrame::MarkFrame(const Machine& machine) {
  const std::vector<ActingEffect> acting = effects::acting_effects(machine);
  const auto write = [&](MarkPoint point) {
    for (const ActingEffect& one : acting) {
      if (one.effect->write != nullptr) point = one.effect->write(point, one.side, one.values);
    }
    return Eigen::Vector2d{point.x_mm, point.y_mm};
  };
  written_per_place_.col(0) = write({1.0, 0.0});
  written_per_place_.col(1) = write({0.0, 1.0});
}

MarkPoint MarkFrame::written(MarkPoint place) const {
  const Eigen::Vector2d w = written_per_place_ * Eigen::Vector2d{place.x_mm, place.y_mm};
  return {w[0], w[1]};
}

MarkPoint MarkFrame::place(MarkPoint written) const {
  const Eigen::Vector2d p =
      written_per_place_.inverse() * Eigen::Vector2d{written.x_mm, written.y_mm};
  return {p[0], p[1]};
}

}  // namespace chaintrue::model
