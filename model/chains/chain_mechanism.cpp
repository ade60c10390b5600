// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/chains/chain_mechanism.hpp"

#include <array>
#include <cstdlib>

#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

constexpr std::array<std::string_view, 2> kChainLengths = {"left", "right"};

std::vector<MechanismParameter> stated_parameters(const Machine& machine) {
  std::vector<MechanismParameter> parameters;
  for (const Setting setting : kMachineSettings) {
    parameters.push_back({name(setting),
                          "mm",
                          stated_value(machine, setting),
                          stated_sigma(machine, setting),
                          setting == Setting::chain_zero_left_mm ||
                              setting == Setting::chain_zero_right_mm});
  }
  return parameters;
}

Eigen::VectorXd values_of(const Machine& machine) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(kMachineSettings.size()));
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = stated_value(machine, kMachineSettings[i]);
  return values;
}

/// The chains that a word of `side` means.
std::vector<std::size_t> chains_of(std::string_view side) {
  if (side == "left") return {0};
  if (side == "right") return {1};
  return {0, 1};
}

/// Zeros shift independently of each other.
void add_zeros(std::string_view side, MechanismChange& change) {
  for (const std::size_t chain : chains_of(side)) {
    change.quantities.push_back({.kind = ChangedQuantity::Kind::added,
                                 .lengths = {chain},
                                 .sigma = kZeroShiftSigmaMm});
  }
}

/// Both chains wear equally.
void add_pitch(std::string_view side, MechanismChange& change) {
  change.quantities.push_back({.kind = ChangedQuantity::Kind::elongation,
                               .lengths = chains_of(side),
                               .sigma = kPitchGrowthSigma,
                               .only_grows = true});
}

PerSide<double> directions_of(const MechanismVisit& visit) {
  if (visit.direction.empty()) return {1.0, 1.0};
  return {visit.direction.at(0), visit.direction.at(1)};
}

}  // namespace

std::shared_ptr<const ChainMechanism> make_chain_mechanism(const Machine& machine) {
  return std::make_shared<const ChainMechanism>(machine);
}

ChainMechanism::ChainMechanism(const Machine& machine, Model model)
    : ChainMechanism(ReadingModel(machine, model)) {}

ChainMechanism::ChainMechanism(ReadingModel readings)
    : ChainMechanism(readings, stated_parameters(readings.machine())) {}

ChainMechanism::ChainMechanism(ReadingModel readings, std::vector<MechanismParameter> parameters)
    : MechanismBase(effects::effects_of(readings.machine()),
                    std::move(parameters),
                    values_of(readings.machine()),
                    readings.machine().effects),
      readings_(std::move(readings)),
      frame_(machine()) {}

std::span<const std::string_view> ChainMechanism::lengths() const { return kChainLengths; }

MechanismExtent ChainMechanism::extent() const {
  const Bed& bed = machine().bed;
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

std::shared_ptr<const Mechanism> ChainMechanism::made_anew(
    const Eigen::VectorXd& values, std::vector<AppliedEffect> applied) const {
  Machine changed = machine();
  changed.effects = std::move(applied);
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i) {
    changed =
        with_setting(std::move(changed), kMachineSettings[i], values[static_cast<Eigen::Index>(i)]);
  }
  return std::shared_ptr<const Mechanism>(
      new ChainMechanism(ReadingModel(changed, readings_.model()), stated()));
}

std::vector<MachineProblem> ChainMechanism::problems_of_effects(
    const std::vector<AppliedEffect>& applied) const {
  Machine changed = machine();
  changed.effects.insert(changed.effects.end(), applied.begin(), applied.end());
  return effects::problems_of_effects(changed);
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
  result.by_parameter.resize(2, all ? values().size() : 0);
  for (Eigen::Index i = 0; i < result.by_parameter.cols(); ++i) {
    result.by_parameter.col(i) =
        readings_.sensitivity(*reading, kMachineSettings[static_cast<std::size_t>(i)]);
  }
  return result;
}

tl::expected<ToolPosition, MechanismFailure> ChainMechanism::locate(
    const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const {
  require_all(lengths_mm);
  const ChainLengths added = readings_.added_at_visit(visit.order, directions_of(visit));
  const auto found = readings_.find({lengths_mm[0] - added.left_mm, lengths_mm[1] - added.right_mm},
                                    BedPoint{0.0, 0.0});
  if (!found) return tl::unexpected(mechanism_failure(found.error()));
  return ToolPosition{found->pose.position.x_mm, found->pose.position.y_mm};
}

std::vector<MechanismChange> changes_of_chains(double pitch_mm) {
  const ChangePriors& p = kChangePriors;
  std::vector<MechanismChange> changes;
  for (const char* side : {"left", "right", "both"}) {
    const bool one = chains_of(side).size() == 1;
    MechanismChange zero{Change::zero, side, true, one ? 0.5 * p.one_zero : p.both_zeros};
    add_zeros(side, zero);
    changes.push_back(std::move(zero));
    MechanismChange pitch{Change::pitch, side, false, p.pitch / 3.0};
    add_pitch(side, pitch);
    changes.push_back(std::move(pitch));
    MechanismChange both{Change::zeros_and_pitch, side, false, p.zeros_and_pitch / 3.0};
    add_zeros("both", both);
    add_pitch(side, both);
    changes.push_back(std::move(both));
  }
  for (const int teeth : {-2, -1, 1, 2}) {
    // A second tooth is four times as rare as the first.
    const double share = p.tooth * (std::abs(teeth) == 1 ? 0.2 : 0.05);
    for (const char* side : {"left", "right"}) {
      MechanismChange tooth{Change::tooth, side, true, share, {}, teeth};
      tooth.quantities.push_back({.lengths = chains_of(side), .mean = teeth * pitch_mm});
      changes.push_back(std::move(tooth));
    }
  }
  return changes;
}

std::vector<MechanismChange> ChainMechanism::possible_changes() const {
  std::vector<MechanismChange> changes = changes_of_chains(machine().sprocket.pitch_mm);
  MechanismChange motors{Change::motors, "", false, kChangePriors.motors};
  for (std::size_t i = 0; i < kMachineSettings.size(); ++i) {
    if (parameters()[i].set_by_zeroing) continue;
    motors.quantities.push_back({.kind = ChangedQuantity::Kind::parameter,
                                 .parameter = i,
                                 .sigma = kMotorShiftSigmaMm});
  }
  changes.push_back(std::move(motors));
  return changes;
}

ToolPosition ChainMechanism::place_of_mark(const ToolPosition& written) const {
  const MarkPoint place = frame_.place({written.x_mm, written.y_mm});
  return {place.x_mm, place.y_mm};
}

}  // namespace chaintrue::model
