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
using effects::ChainAddition;

// Steps of the five-point difference
//   f'(0) = (8 (f(h) - f(-h)) - (f(2h) - f(-2h))) / (12 h)                                   (1)
// At 4 mm its truncation, h^4 f^(5) / 30, is below 1e-9 of the derivative of an angle that varies
// over the 600 mm or more between sled and sprocket; rounding adds 1e-13.
constexpr double kStepMm = 4.0;
constexpr std::array<double, 4> kStencil = {-2.0, -1.0, 1.0, 2.0};
constexpr std::array<double, 4> kWeights = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};

// The numbers of a chain, besides its length, that effects depend on.
struct StateNumbers {
  double angle_rad = 0.0;
  double free_mm = 0.0;
  double tension_n = 0.0;
  double horizontal_n = 0.0;
};

void add_weighted(PerSide<StateNumbers>& sum, const Pose& pose, double weight) {
  for (const Side side : kSides) {
    const ChainState& chain = pose.chains[side];
    sum[side].angle_rad += weight * chain.angle_rad;
    sum[side].free_mm += weight * chain.free_length_mm;
    sum[side].tension_n += weight * chain.tension_at_sprocket_n;
    sum[side].horizontal_n += weight * chain.horizontal_n;
  }
}

bool is_motor_setting(Setting setting) { return setting <= Setting::motor_right_y_mm; }

double& motor_coordinate(EquilibriumParameters& parameters, Setting setting) {
  switch (setting) {
    case Setting::motor_left_x_mm:
      return parameters.motors.left.x_mm;
    case Setting::motor_left_y_mm:
      return parameters.motors.left.y_mm;
    case Setting::motor_right_x_mm:
      return parameters.motors.right.x_mm;
    default:
      return parameters.motors.right.y_mm;
  }
}

Parameter parameter_of(Setting setting) {
  switch (setting) {
    case Setting::motor_left_x_mm:
      return Parameter::motor_left_x_mm;
    case Setting::motor_left_y_mm:
      return Parameter::motor_left_y_mm;
    case Setting::motor_right_x_mm:
      return Parameter::motor_right_x_mm;
    default:
      return Parameter::motor_right_y_mm;
  }
}

void require_sound(const Machine& machine) {
  const std::vector<MachineProblem> problems = problems_of(machine);
  if (problems.empty()) return;
  const MachineProblem& first = problems.front();
  throw std::invalid_argument(
      fmt::format("{}: found {}, expected {}", first.parameter, first.value, first.expected));
}

double sign_of_change(double change, double last) {
  if (change > 0.0) return 1.0;
  if (change < 0.0) return -1.0;
  return last;
}

// The first effect of the catalogue that depends on the direction of travel: the effects before it
// make the length whose change gives the direction.
std::size_t place_of_direction() {
  const auto table = effects::catalogue();
  const auto found = std::find_if(table.begin(), table.end(), [](const effects::Effect* e) {
    return e->add_by_direction != nullptr;
  });
  return static_cast<std::size_t>(found - table.begin());
}

double length(const Pose& pose, Side side) { return pose.lengths[side]; }

void accumulate(ChainAddition& sum, const ChainAddition& part) {
  sum.length_mm += part.length_mm;
  sum.per_angle_mm_per_rad += part.per_angle_mm_per_rad;
  sum.per_free_length += part.per_free_length;
  sum.per_length += part.per_length;
  sum.per_tension_mm_per_n += part.per_tension_mm_per_n;
  sum.per_horizontal_mm_per_n += part.per_horizontal_mm_per_n;
  sum.per_x += part.per_x;
  sum.per_y += part.per_y;
}

// f'(0) by (1); with a smaller step where a neighbour has no pose. `pose_at(t)` is the pose t mm
// away.
template <class PoseAt>
tl::expected<PerSide<StateNumbers>, PoseFailure> state_slope(const PoseAt& pose_at) {
  PoseFailure reason = PoseReason::not_converged;
  for (const double step_mm : {kStepMm, kStepMm / 16.0, kStepMm / 256.0}) {
    PerSide<StateNumbers> slope;
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
  double turn_mm = 0.0;
  /// Sum of the elongations of a chain.
  PerSide<double> elongation;
  /// An effect depends on the chain's angle or free length.
  bool looks_at_state = false;

  enum class Part { before_direction, after_direction, whole };
  [[nodiscard]] ChainAddition additions(const Pose& pose, Side side, Part part) const;
  [[nodiscard]] double zero(Side side) const { return machine.chain_zero[side]; }
  /// The reading of a chain paid out to this length, with all effects.
  [[nodiscard]] double counted(double length_mm, Side side) const {
    return length_mm / (1.0 + elongation[side]) + zero(side);
  }
  /// d(reading)/d(anything) from the slopes of the pose's lengths, of its chains' states and of the
  /// tool's position.
  [[nodiscard]] Eigen::Vector2d through_effects(const Pose& pose,
                                                const Eigen::Vector2d& length_slope,
                                                const PerSide<StateNumbers>& slope,
                                                const Eigen::Vector2d& position_slope) const;
  [[nodiscard]] PoseResult pose_near(BedPoint point, Setting setting, double change_mm) const;
};

ChainAddition ReadingModel::State::additions(const Pose& pose, Side side, Part part) const {
  static const std::size_t direction = place_of_direction();
  const effects::ChainAtRest chain =
      effects::chain_at_rest(pose, side, turn_mm, machine.sprocket.pitch_mm);
  ChainAddition sum;
  for (const ActingEffect& one : acting) {
    if (one.effect->add == nullptr || !acts_on(one.side, side)) continue;
    // What is declared is there before the direction shows.
    const bool before =
        one.effect->law != nullptr || effects::place_in_catalogue(*one.effect) < direction;
    if (part == Part::whole || before == (part == Part::before_direction)) {
      accumulate(sum, one.effect->add(chain, one.values));
    }
  }
  return sum;
}

Eigen::Vector2d ReadingModel::State::through_effects(const Pose& pose,
                                                     const Eigen::Vector2d& length_slope,
                                                     const PerSide<StateNumbers>& slope,
                                                     const Eigen::Vector2d& position_slope) const {
  Eigen::Vector2d result;
  for (const Side side : kSides) {
    const Eigen::Index row = side == Side::left ? 0 : 1;
    const ChainAddition added = additions(pose, side, Part::whole);
    result[row] = (length_slope[row] * (1.0 + added.per_length) +
                   added.per_angle_mm_per_rad * slope[side].angle_rad +
                   added.per_free_length * slope[side].free_mm +
                   added.per_tension_mm_per_n * slope[side].tension_n +
                   added.per_horizontal_mm_per_n * slope[side].horizontal_n +
                   added.per_x * position_slope[0] + added.per_y * position_slope[1]) /
                  (1.0 + elongation[side]);
  }
  return result;
}

PoseResult ReadingModel::State::pose_near(BedPoint point,
                                            Setting setting,
                                            double change_mm) const {
  EquilibriumParameters changed = parameters;
  motor_coordinate(changed, setting) += change_mm;
  return make_kinematics(changed, model)->inverse(point);
}

ReadingModel::ReadingModel(const Machine& machine, Model model) {
  require_sound(machine);
  auto state = std::make_shared<State>();
  state->machine = machine;
  state->model = model;
  state->acting = effects::acting_effects(machine);
  state->turn_mm = machine.sprocket.teeth * machine.sprocket.pitch_mm;
  state->parameters = equilibrium_parameters(machine);
  for (const ActingEffect& one : state->acting) {
    if (one.effect->alter != nullptr) one.effect->alter(state->parameters, one.values);
    state->looks_at_state = state->looks_at_state || one.effect->add != nullptr;
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
  for (const Side side : kSides) {
    const double paid_out =
        length(*pose, side) + state.additions(*pose, side, State::Part::whole).length_mm;
    reading.lengths[side] = state.counted(paid_out, side);
  }
  const Eigen::Matrix2d lengths_by_point = state.kinematics->jacobian(*pose);
  for (const Eigen::Index axis : {0, 1}) {
    PerSide<StateNumbers> slope;
    if (state.looks_at_state) {
      const auto found = state_slope([&](double mm) {
        return state.kinematics->inverse(axis == 0 ? BedPoint{point.x_mm + mm, point.y_mm}
                                                   : BedPoint{point.x_mm, point.y_mm + mm});
      });
      if (!found) return tl::unexpected(found.error());
      slope = *found;
    }
    reading.position_jacobian.col(axis) = state.through_effects(
        *pose, lengths_by_point.col(axis), slope, Eigen::Vector2d::Unit(axis));
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
  PerSide<StateNumbers> slope;
  if (state.looks_at_state) {
    const auto found = state_slope(
        [&](double mm) { return state.pose_near(reading.pose.position, setting, mm); });
    // A pose exists here but not at its neighbours within 16 um: at the very edge only the length's
    // own slope is used.
    if (found) slope = *found;
  }
  return state.through_effects(reading.pose,
                               state.kinematics->sensitivity(reading.pose, parameter_of(setting)),
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
    // A step out of reach is shortened.
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
  ChainLengths added;
  for (const Side side : kSides) {
    for (const ActingEffect& one : state_->acting) {
      if (!acts_on(one.side, side)) continue;
      if (one.effect->add_by_direction != nullptr) {
        added[side] += one.effect->add_by_direction(direction[side], one.values) /
                       (1.0 + state_->elongation[side]);
      }
      if (one.effect->misread != nullptr)
        added[side] += one.effect->misread({order, state_->machine.sprocket.pitch_mm}, one.values);
    }
  }
  return added;
}

/// The state of a session: the direction in which each chain last moved.
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
    using Part = ReadingModel::State::Part;
    const double before =
        length(pose, side) + state_.additions(pose, side, Part::before_direction).length_mm;
    if (last_length_mm_[side]) {
      direction_[side] = sign_of_change(before - *last_length_mm_[side], direction_[side]);
    }
    last_length_mm_[side] = before;
    double paid_out = before;
    for (const ActingEffect& one : state_.acting) {
      if (one.effect->add_by_direction == nullptr || !acts_on(one.side, side)) continue;
      paid_out += one.effect->add_by_direction(direction_[side], one.values);
    }
    paid_out += state_.additions(pose, side, Part::after_direction).length_mm;
    double reading = state_.counted(paid_out, side);
    for (const ActingEffect& one : state_.acting) {
      if (one.effect->misread == nullptr || !acts_on(one.side, side)) continue;
      reading += one.effect->misread({order, state_.machine.sprocket.pitch_mm}, one.values);
    }
    return reading;
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
