// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/chains/chain_mechanism.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

constexpr std::array<std::string_view, 2> kLengths = {"left", "right"};

std::vector<MechanismParameter> stated_parameters(const Machine& machine) {
  std::vector<MechanismParameter> parameters;
  for (const Setting setting : kMachineSettings) {
    parameters.push_back(
        {name(setting), "mm", stated_value(machine, setting), stated_sigma(machine, setting)});
  }
  return parameters;
}

PerSide<double> directions_of(const MechanismVisit& visit) {
  if (visit.direction.empty()) return {1.0, 1.0};
  return {visit.direction.at(0), visit.direction.at(1)};
}

}  // namespace

MechanismFailure mechanism_failure(PoseFailure failure) {
  return {name(failure), explain(failure)};
}

std::shared_ptr<const ChainMechanism> make_chain_mechanism(const Machine& machine) {
  return std::make_shared<const ChainMechanism>(machine);
}

ChainMechanism::ChainMechanism(const Machine& machine, Model model)
    : ChainMechanism(ReadingModel(machine, model)) {}

ChainMechanism::ChainMechanism(ReadingModel readings)
    : ChainMechanism(readings, stated_parameters(readings.machine())) {}

ChainMechanism::ChainMechanism(ReadingModel readings, std::vector<MechanismParameter> parameters)
    : readings_(std::move(readings)),
      frame_(machine()),
      parameters_(std::move(parameters)),
      values_(static_cast<Eigen::Index>(kMachineSettings.size())) {
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i)
    values_[static_cast<Eigen::Index>(i)] = stated_value(machine(), kMachineSettings[i]);
}

std::span<const std::string_view> ChainMechanism::lengths() const { return kLengths; }

MechanismExtent ChainMechanism::extent() const {
  const Bed& bed = machine().bed;
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

std::shared_ptr<const Mechanism> ChainMechanism::with_values(const Eigen::VectorXd& values) const {
  if (values.size() != values_.size()) {
    throw std::invalid_argument(
        fmt::format("{} values of {} parameters", values.size(), values_.size()));
  }
  Machine changed = machine();
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i) {
    changed =
        with_setting(std::move(changed), kMachineSettings[i], values[static_cast<Eigen::Index>(i)]);
  }
  return std::shared_ptr<const Mechanism>(
      new ChainMechanism(ReadingModel(changed, readings_.model()), parameters_));
}

std::span<const effects::Effect* const> ChainMechanism::effects() const {
  return effects::catalogue();
}

std::vector<MachineProblem> ChainMechanism::problems_of_effects(
    const std::vector<AppliedEffect>& applied) const {
  Machine changed = machine();
  changed.effects.insert(changed.effects.end(), applied.begin(), applied.end());
  return effects::problems_of_effects(changed);
}

std::shared_ptr<const Mechanism> ChainMechanism::with_effects(
    const std::vector<AppliedEffect>& applied) const {
  Machine changed = machine();
  changed.effects.insert(changed.effects.end(), applied.begin(), applied.end());
  return std::shared_ptr<const Mechanism>(
      new ChainMechanism(ReadingModel(changed, readings_.model()), parameters_));
}

tl::expected<LengthsPrediction, MechanismFailure> ChainMechanism::predict(
    const ToolPosition& position, const MechanismVisit& visit, Derivatives wanted) const {
  const auto reading = readings_.at({position.x_mm, position.y_mm});
  if (!reading) return tl::unexpected(mechanism_failure(reading.error()));
  const ChainLengths added = readings_.added_at_visit(visit.order, directions_of(visit));
  LengthsPrediction result;
  result.lengths_mm = Eigen::Vector2d(reading->lengths.left_mm + added.left_mm,
                                      reading->lengths.right_mm + added.right_mm);
  result.by_position = reading->position_jacobian;
  const bool all = wanted == Derivatives::by_position_and_parameter;
  result.by_parameter.resize(2, all ? values_.size() : 0);
  for (Eigen::Index i = 0; i < result.by_parameter.cols(); ++i) {
    result.by_parameter.col(i) =
        readings_.sensitivity(*reading, kMachineSettings[static_cast<std::size_t>(i)]);
  }
  return result;
}

tl::expected<ToolPosition, MechanismFailure> ChainMechanism::locate(
    const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const {
  if (lengths_mm.size() != 2)
    throw std::invalid_argument(fmt::format("{} lengths of two chains", lengths_mm.size()));
  const ChainLengths added = readings_.added_at_visit(visit.order, directions_of(visit));
  const auto found = readings_.find({lengths_mm[0] - added.left_mm, lengths_mm[1] - added.right_mm},
                                    BedPoint{0.0, 0.0});
  if (!found) return tl::unexpected(mechanism_failure(found.error()));
  return ToolPosition{found->pose.position.x_mm, found->pose.position.y_mm};
}

ToolPosition ChainMechanism::place_of_mark(const ToolPosition& written) const {
  const MarkPoint place = frame_.place({written.x_mm, written.y_mm});
  return {place.x_mm, place.y_mm};
}

}  // namespace chaintrue::model
