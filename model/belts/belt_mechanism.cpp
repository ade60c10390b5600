// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_mechanism.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace chaintrue::model {
namespace {

/// A coordinate of an anchor that is fixed by the choice of the frame.
struct Coordinate {
  Eigen::Index parameter;
  std::string_view name;
  Belt belt;
  double Anchor::*member;
  Eigen::Index axis;
};

constexpr std::array kCoordinates = {
    Coordinate{0, "tl_x_mm", Belt::tl, &Anchor::x_mm, 0},
    Coordinate{1, "tl_y_mm", Belt::tl, &Anchor::y_mm, 1},
    Coordinate{2, "tr_x_mm", Belt::tr, &Anchor::x_mm, 0},
    Coordinate{3, "tr_y_mm", Belt::tr, &Anchor::y_mm, 1},
    Coordinate{4, "br_x_mm", Belt::br, &Anchor::x_mm, 0},
};

constexpr std::array<std::string_view, 4> kBeltLengths = {"tl", "tr", "bl", "br"};

constexpr MechanismReason kAnchorsNotKnown{"anchors_not_known",
                                           "the positions of the anchors are unknown"};

/// Index of the scale among the parameters.
constexpr auto kScale = static_cast<Eigen::Index>(kCoordinates.size());

std::vector<MechanismParameter> stated_parameters(const BeltMachine& machine,
                                                  std::optional<double> sigma_mm,
                                                  std::optional<BeltScaleKnowledge> scale) {
  std::vector<MechanismParameter> parameters;
  for (const Coordinate& own : kCoordinates) {
    MechanismParameter parameter{own.name, "mm", std::nullopt, std::nullopt};
    if (machine.anchors_known) {
      parameter.stated = machine.anchors[own.belt].*own.member;
      parameter.prior_sigma = sigma_mm;
    }
    parameters.push_back(parameter);
  }
  if (scale) parameters.push_back({"log_scale", "", 0.0, scale->sigma});
  return parameters;
}

Eigen::VectorXd stated_values(const BeltMachine& machine, std::size_t parameters) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(parameters));
  if (!machine.anchors_known) return values;
  for (const Coordinate& own : kCoordinates)
    values[own.parameter] = machine.anchors[own.belt].*own.member;
  return values;
}

}  // namespace

std::shared_ptr<const BeltMechanism> make_belt_mechanism(const BeltMachine& machine,
                                                         std::optional<double> anchor_sigma_mm,
                                                         std::optional<BeltScaleKnowledge> scale) {
  return std::make_shared<const BeltMechanism>(machine, anchor_sigma_mm, scale);
}

BeltMechanism::BeltMechanism(const BeltMachine& machine, std::optional<double> anchor_sigma_mm,
                             std::optional<BeltScaleKnowledge> scale)
    : BeltMechanism(machine, stated_parameters(machine, anchor_sigma_mm, scale),
                    stated_values(machine, kCoordinates.size() + (scale ? 1 : 0)), {}) {
  require_none(problems_of(machine));
}

BeltMechanism::BeltMechanism(BeltMachine machine, std::vector<MechanismParameter> parameters,
                             Eigen::VectorXd values, std::vector<AppliedEffect> applied)
    : MechanismBase("belts", kBeltLengths, belts::belt_effects(), std::move(parameters),
                    std::move(values), std::move(applied)),
      machine_(std::move(machine)),
      acting_(effects::resolve(belts::belt_effects(), this->applied())) {}

MechanismExtent BeltMechanism::extent() const {
  const PerBelt<Anchor>& a = machine_.anchors;
  const double reach = reach_mm(machine_);
  return {std::max(a.tl.x_mm, a.bl.x_mm) + reach, std::min(a.tr.x_mm, a.br.x_mm) - reach,
          std::max(a.bl.y_mm, a.br.y_mm) + reach, std::min(a.tl.y_mm, a.tr.y_mm) - reach};
}

std::shared_ptr<const Mechanism> BeltMechanism::rebuild(const Eigen::VectorXd& values,
                                                        std::vector<AppliedEffect> applied) const {
  BeltMachine changed = machine_;
  for (const Coordinate& own : kCoordinates)
    changed.anchors[own.belt].*own.member = values[own.parameter];
  changed.anchors_known = machine_.anchors_known || values != this->values();
  return std::shared_ptr<const Mechanism>(
      new BeltMechanism(std::move(changed), stated(), values, std::move(applied)));
}

std::vector<FixedPoint> BeltMechanism::fixed_points() const {
  std::vector<FixedPoint> points;
  for (const Belt belt : kBelts) {
    const Anchor& anchor = machine_.anchors[belt];
    FixedPoint point{
        name(belt), {anchor.x_mm, anchor.y_mm}, Eigen::Matrix2Xd::Zero(2, values().size())};
    for (const Coordinate& own : kCoordinates) {
      if (own.belt == belt) point.by_parameter(own.axis, own.parameter) = 1.0;
    }
    points.push_back(std::move(point));
  }
  return points;
}

FrameScale BeltMechanism::frame_scale() const {
  FrameScale scale{1.0, Eigen::RowVectorXd::Zero(values().size())};
  if (values().size() <= kScale) return scale;
  scale.factor = std::exp(values()[kScale]);
  scale.by_parameter[kScale] = scale.factor;
  return scale;
}

tl::expected<belts::AnchorNumber, BeltFailure> BeltMechanism::print(const belts::BeltVisit& visit,
                                                                    FramePoint place) const {
  // The same result without effects in a third of the time; other printed lengths differ by rounding.
  if (acting_.empty() && machine_.lengths == BeltLengths::belt) {
    return reading_at(machine_, visit.belt, place).map([&](const BeltReading& reading) {
      return belts::of_anchor(reading, visit.belt);
    });
  }
  return belts::read_belt(machine_, acting_, visit, place);
}

tl::expected<LengthsPrediction, MechanismFailure> BeltMechanism::predict(
    const ToolPosition& position, const MechanismVisit& visit, Derivatives wanted) const {
  if (!machine_.anchors_known) return tl::unexpected(kAnchorsNotKnown);
  PerBelt<bool> pulled;
  for (const Belt belt : kBelts)
    pulled[belt] = !visit.pulled.empty() && visit.pulled.at(static_cast<std::size_t>(belt));
  const bool all = wanted == Derivatives::by_position_and_parameter;
  LengthsPrediction result;
  result.lengths_mm.resize(4);
  result.by_position = Eigen::MatrixXd::Zero(4, 2);
  result.by_parameter = Eigen::MatrixXd::Zero(4, all ? values().size() : 0);
  for (const Belt belt : kBelts) {
    const auto row = static_cast<Eigen::Index>(belt);
    const auto printed =
        print({belt, pulled, visit.order, visit.pull}, {position.x_mm, position.y_mm});
    if (!printed) return tl::unexpected(mechanism_failure(printed.error()));
    result.lengths_mm[row] = printed->value;
    for (const Belt anchor : kBelts)
      result.by_position.row(row) -= belts::by_anchor(*printed, anchor);
    if (!all) continue;
    for (const Coordinate& own : kCoordinates)
      result.by_parameter(row, own.parameter) = belts::by_anchor(*printed, own.belt)[own.axis];
  }
  return result;
}

tl::expected<ToolPosition, MechanismFailure> BeltMechanism::locate(
    const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const {
  require_all(lengths_mm);
  if (!machine_.anchors_known) return tl::unexpected(kAnchorsNotKnown);
  const auto start = place_of_upper(machine_, lengths_mm[0], lengths_mm[1]);
  if (!start) return tl::unexpected(mechanism_failure(start.error()));
  return locate_by_newton(*this, lengths_mm, visit, {start->x_mm, start->y_mm});
}

tl::expected<ChainLengths, MechanismFailure> BeltMechanism::first_lengths(
    const ToolPosition& position) const {
  if (!machine_.anchors_known || !acting_.empty()) return Mechanism::first_lengths(position);
  const auto left = reading_at(machine_, Belt::tl, {position.x_mm, position.y_mm});
  if (!left) return tl::unexpected(mechanism_failure(left.error()));
  const auto right = reading_at(machine_, Belt::tr, {position.x_mm, position.y_mm});
  if (!right) return tl::unexpected(mechanism_failure(right.error()));
  return ChainLengths{left->length_mm, right->length_mm};
}

tl::expected<ToolPosition, MechanismFailure> BeltMechanism::locate_by_first(
    ChainLengths lengths) const {
  if (!machine_.anchors_known || !acting_.empty()) return Mechanism::locate_by_first(lengths);
  const auto place = place_of_upper(machine_, lengths.left_mm, lengths.right_mm);
  if (!place) return tl::unexpected(mechanism_failure(place.error()));
  return ToolPosition{place->x_mm, place->y_mm};
}

std::vector<MechanismChange> BeltMechanism::possible_changes() const {
  const ChangePriors& prior = kChangePriors;
  std::vector<MechanismChange> changes;
  ChangedQuantity of_all{.lengths = {}, .sigma = kBeltZeroShiftMm};
  for (const Belt belt : kBelts) {
    const auto at = static_cast<std::size_t>(belt);
    MechanismChange zero{Change::zero, std::string(name(belt)), true,
                         (prior.one_zero + prior.tooth) / static_cast<double>(kBelts.size())};
    zero.quantities.push_back({.lengths = {at}, .sigma = kBeltZeroShiftMm});
    of_all.lengths.push_back(at);
    changes.push_back(std::move(zero));
  }
  changes.push_back({Change::zero, "", true, prior.both_zeros, {of_all}});
  for (const Belt belt : {Belt::tl, Belt::tr, Belt::br}) {
    MechanismChange moved{Change::anchor, std::string(name(belt)), false,
                          (prior.motors + prior.pitch) / 3.0};
    for (const Coordinate& own : kCoordinates) {
      if (own.belt != belt) continue;
      moved.quantities.push_back({.kind = ChangedQuantity::Kind::parameter,
                                  .parameter = static_cast<std::size_t>(own.parameter),
                                  .sigma = kAnchorShiftMm});
    }
    changes.push_back(std::move(moved));
  }
  return changes;
}

}  // namespace chaintrue::model
