// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/reading_model.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "model/calibration/setting.hpp"
#include "model/chains/chain_changes.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

using effects::ActingEffect;
using effects::acts_on;

constexpr std::array<std::string_view, 2> kChainLengths = {"left", "right"};

double sign_of_change(double change, double last) {
  if (change > 0.0) return 1.0;
  if (change < 0.0) return -1.0;
  return last;
}

/// What is added to a chain at this place, with the derivatives of all that it depends on.
template <int N>
Dual<N> with_derivatives(const effects::Number& added, const ChainNumbers<N>& chain,
                         const Dual<N>& x_mm, const Dual<N>& y_mm) {
  // In the order of LengthVariable.
  const std::array<Dual<N>, effects::kLengthVariables> by = {chain.angle_rad,
                                                             chain.free_length_mm,
                                                             chain.length_mm,
                                                             chain.tension_at_sprocket_n,
                                                             chain.horizontal_n,
                                                             x_mm,
                                                             y_mm};
  Dual<N> result = added.value;
  for (std::size_t k = 0; k < by.size(); ++k) {
    for (std::size_t i = 0; i < N; ++i) result.d[i] += added.d[k] * by[k].d[i];
  }
  return result;
}

std::vector<MechanismParameter> stated_parameters(const Machine& machine) {
  std::vector<MechanismParameter> parameters;
  for (const Setting setting : kMachineSettings) {
    parameters.push_back(
        {name(setting), "mm", stated_value(machine, setting), stated_sigma(machine, setting),
         setting == Setting::chain_zero_left_mm || setting == Setting::chain_zero_right_mm});
  }
  return parameters;
}

Eigen::VectorXd values_of(const Machine& machine) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(kMachineSettings.size()));
  Eigen::Index i = 0;
  for (const Setting setting : kMachineSettings) values[i++] = stated_value(machine, setting);
  return values;
}

const Machine& sound(const Machine& machine) {
  require_none(problems_of(machine));
  return machine;
}

}  // namespace

std::shared_ptr<const ReadingModel> make_chain_mechanism(const Machine& machine) {
  return std::make_shared<const ReadingModel>(machine);
}

ReadingModel::ReadingModel(const Machine& machine, Model model)
    : ReadingModel(sound(machine), model, stated_parameters(machine)) {}

ReadingModel::ReadingModel(const Machine& machine, Model model,
                           std::vector<MechanismParameter> parameters)
    : MechanismBase("chains", kChainLengths, effects::effects_of(machine), std::move(parameters),
                    values_of(machine), machine.effects),
      machine_(sound(machine)),
      model_(model),
      frame_(machine),
      acting_(effects::acting_effects(machine)) {
  EquilibriumParameters equilibrium = equilibrium_parameters(machine);
  for (const ActingEffect& one : acting_) {
    if (one.effect->alter != nullptr) one.effect->alter(equilibrium, one.values);
    if (one.effect->elongation == nullptr) continue;
    for (const Side side : kSides) {
      if (acts_on(one.side, side)) elongation_[side] += one.effect->elongation(one.values);
    }
  }
  kinematics_ = make_kinematics(equilibrium, model);
}

std::shared_ptr<const Mechanism> ReadingModel::rebuild(const Eigen::VectorXd& values,
                                                       std::vector<AppliedEffect> applied) const {
  Machine changed = machine_;
  changed.effects = std::move(applied);
  Eigen::Index i = 0;
  for (const Setting setting : kMachineSettings)
    changed = with_setting(std::move(changed), setting, values[i++]);
  return std::shared_ptr<const Mechanism>(new ReadingModel(changed, model_, stated()));
}

MechanismExtent ReadingModel::extent() const {
  const Bed& bed = machine_.bed;
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

std::vector<MachineProblem> ReadingModel::problems_of_effects(
    const std::vector<AppliedEffect>& applied) const {
  Machine changed = machine_;
  changed.effects.insert(changed.effects.end(), applied.begin(), applied.end());
  return effects::problems_of_effects(changed);
}

effects::Number ReadingModel::added(const Pose& pose, Side side) const {
  const effects::LengthState chain = effects::chain_at_rest(pose, side, machine_.sprocket);
  effects::Number sum;
  for (const ActingEffect& one : acting_) {
    if (one.effect->add != nullptr && !depends_on_visit(*one.effect) && acts_on(one.side, side))
      sum = sum + one.effect->add(chain, one.values);
  }
  return sum;
}

double ReadingModel::added_at_visit(Side side, int order, double direction) const {
  const effects::LengthState chain{
      .tooth_mm = machine_.sprocket.pitch_mm, .direction = direction, .order = order};
  double sum = 0.0;
  for (const ActingEffect& one : acting_) {
    if (!depends_on_visit(*one.effect) || !acts_on(one.side, side)) continue;
    const double added_mm = one.effect->add(chain, one.values).value;
    sum += one.effect->by_direction ? added_mm / (1.0 + elongation_[side]) : added_mm;
  }
  return sum;
}

Eigen::Vector2d ReadingModel::added_at(const MechanismVisit& visit) const {
  const auto direction = [&](std::size_t chain) {
    return visit.direction.empty() ? 1.0 : visit.direction.at(chain);
  };
  return {added_at_visit(Side::left, visit.order, direction(0)),
          added_at_visit(Side::right, visit.order, direction(1))};
}

tl::expected<PointReading, PoseFailure> ReadingModel::at(BedPoint point) const {
  const PoseResult pose = kinematics_->inverse(point);
  if (!pose) return tl::unexpected(pose.error());
  PointReading reading;
  reading.pose = *pose;
  const PerSide<ChainNumbers<2>> chains = kinematics_->by_place(*pose);
  const auto x = Dual<2>::variable(point.x_mm, 0), y = Dual<2>::variable(point.y_mm, 1);
  for (const Side side : kSides) {
    const effects::Number added = this->added(*pose, side);
    reading.lengths[side] = counted(pose->lengths[side] + added.value, side);
    const Dual<2> slope = (chains[side].length_mm + with_derivatives(added, chains[side], x, y)) /
                          (1.0 + elongation_[side]);
    reading.position_jacobian.row(side == Side::left ? 0 : 1) << slope.d[0], slope.d[1];
  }
  return reading;
}

Eigen::Vector2d ReadingModel::sensitivity(const PointReading& reading, Setting setting) const {
  if (setting == Setting::chain_zero_left_mm) return {1.0, 0.0};
  if (setting == Setting::chain_zero_right_mm) return {0.0, 1.0};
  if (setting > Setting::motor_right_y_mm) {
    throw std::invalid_argument(
        "sensitivity: the sheet's settings move the point, not the machine");
  }
  // Both enumerations begin with the motors' coordinates.
  const PerSide<ChainNumbers<1>> chains =
      kinematics_->by_parameter(reading.pose, static_cast<Parameter>(setting));
  const auto slope = [&](Side side) {
    const Dual<1> length = chains[side].length_mm +
                           with_derivatives<1>(added(reading.pose, side), chains[side], 0.0, 0.0);
    return length.d[0] / (1.0 + elongation_[side]);
  };
  return {slope(Side::left), slope(Side::right)};
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
           !kinematics_->inverse({point.x_mm + move[0], point.y_mm + move[1]})) {
      move *= 0.5;
    }
    point = {point.x_mm + move[0], point.y_mm + move[1]};
    if (move.norm() < kConvergedMm && missing.norm() < 100.0 * kConvergedMm) return at(point);
  }
  return tl::unexpected(PoseReason::not_converged);
}

tl::expected<LengthsPrediction, MechanismFailure> ReadingModel::predict(
    const ToolPosition& position, const MechanismVisit& visit, Derivatives wanted) const {
  const auto reading = at({position.x_mm, position.y_mm});
  if (!reading) return tl::unexpected(mechanism_failure(reading.error()));
  LengthsPrediction result;
  result.lengths_mm =
      Eigen::Vector2d(reading->lengths.left_mm, reading->lengths.right_mm) + added_at(visit);
  result.by_position = reading->position_jacobian;
  const bool all = wanted == Derivatives::by_position_and_parameter;
  result.by_parameter.resize(2, all ? values().size() : 0);
  for (Eigen::Index i = 0; i < result.by_parameter.cols(); ++i) {
    result.by_parameter.col(i) =
        sensitivity(*reading, kMachineSettings[static_cast<std::size_t>(i)]);
  }
  return result;
}

tl::expected<ToolPosition, MechanismFailure> ReadingModel::locate(
    const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const {
  require_all(lengths_mm);
  const Eigen::Vector2d repeatable = lengths_mm - added_at(visit);
  const auto found = find({repeatable[0], repeatable[1]}, BedPoint{0.0, 0.0});
  if (!found) return tl::unexpected(mechanism_failure(found.error()));
  return ToolPosition{found->pose.position.x_mm, found->pose.position.y_mm};
}

ToolPosition ReadingModel::place_of_mark(const ToolPosition& written) const {
  const MarkPoint place = frame_.place({written.x_mm, written.y_mm});
  return {place.x_mm, place.y_mm};
}

std::vector<MechanismChange> ReadingModel::possible_changes() const {
  std::vector<MechanismChange> changes = changes_of_chains(machine_.sprocket.pitch_mm);
  MechanismChange motors{Change::motors, "", false, kChangePriors.motors};
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i) {
    if (parameters()[i].set_by_zeroing) continue;
    motors.quantities.push_back(
        {.kind = ChangedQuantity::Kind::parameter, .parameter = i, .sigma = kParameterShiftSigma});
  }
  changes.push_back(std::move(motors));
  return changes;
}

/// The direction in which each chain last moved.
class Session {
 public:
  explicit Session(const ReadingModel& model) : model_(model) {}

  tl::expected<ChainLengths, PoseFailure> read(const Visit& visit) {
    const PoseResult pose = model_.kinematics_->inverse(visit.position);
    if (!pose) return tl::unexpected(pose.error());
    ChainLengths read;
    for (const Side side : kSides) {
      const double before = pose->lengths[side] + model_.added(*pose, side).value;
      direction_[side] = sign_of_change(before - last_length_mm_[side], direction_[side]);
      last_length_mm_[side] = before;
      read[side] =
          model_.counted(before, side) + model_.added_at_visit(side, visit.order, direction_[side]);
    }
    return read;
  }

 private:
  /// The change before the first visit is unknown.
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  const ReadingModel& model_;
  PerSide<double> direction_{1.0, 1.0};
  PerSide<double> last_length_mm_{kNone, kNone};
};

tl::expected<std::vector<ChainLengths>, VisitFailure> readings(
    const ReadingModel& model, std::span<const Visit> visits,
    const std::function<void(std::size_t read)>& on_progress) {
  std::vector<std::size_t> sequence(visits.size());
  std::iota(sequence.begin(), sequence.end(), std::size_t{0});
  std::sort(sequence.begin(), sequence.end(),
            [&](std::size_t a, std::size_t b) { return visits[a].order < visits[b].order; });
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
