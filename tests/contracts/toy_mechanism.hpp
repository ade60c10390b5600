// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A third mechanism that no product code knows: three strings from nails on the x axis to a point
/// below it, of straight length; the middle nail is at 0. All share one zero. One effect, a knot
/// that shortens all.
#pragma once

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "model/mechanism.hpp"

namespace chaintrue::model {

class ToyMechanism final : public Mechanism {
 public:
  /// The left nail is stated to 5 mm, the right one has no prior. The zero is stated to 2 mm.
  ToyMechanism(double left_x_mm, double right_x_mm, double zero_mm = 0.0)
      : values_(Eigen::Vector3d(left_x_mm, right_x_mm, zero_mm)),
        parameters_{{{"left_nail_x_mm", "mm", left_x_mm, 5.0},
                     {"right_nail_x_mm", "mm", right_x_mm, std::nullopt},
                     {"zero_mm", "mm", zero_mm, 2.0, true}}} {}

  std::string_view kind() const override { return "toy"; }
  std::span<const std::string_view> lengths() const override {
    static constexpr std::array<std::string_view, 3> kLengths = {"west", "east", "middle"};
    return kLengths;
  }
  std::span<const MechanismParameter> parameters() const override { return parameters_; }
  const Eigen::VectorXd& values() const override { return values_; }
  MechanismExtent extent() const override { return {-600.0, 600.0, -1500.0, -500.0}; }
  [[nodiscard]] std::shared_ptr<const Mechanism> with_values(
      const Eigen::VectorXd& values) const override {
    if (values.size() != 3) throw std::invalid_argument("two nails and a zero");
    auto changed = std::make_shared<ToyMechanism>(*this);
    changed->values_ = values;
    return changed;
  }
  std::span<const effects::Effect* const> effects() const override {
    static constexpr std::array<const effects::Effect*, 1> kEffects = {&kKnot};
    return kEffects;
  }
  [[nodiscard]] std::vector<MachineProblem> problems_of_effects(
      const std::vector<AppliedEffect>& applied) const override {
    std::vector<MachineProblem> problems;
    for (std::size_t i = 0; i < applied.size(); ++i) {
      if (applied[i].effect != kKnot.id)
        problems.push_back({fmt::format("/effects/{}/effect", i), applied[i].effect, "toy_knot"});
    }
    return problems;
  }
  [[nodiscard]] std::shared_ptr<const Mechanism> with_effects(
      const std::vector<AppliedEffect>& applied) const override {
    if (!problems_of_effects(applied).empty()) throw std::invalid_argument("toy_knot alone");
    auto changed = std::make_shared<ToyMechanism>(*this);
    for (const AppliedEffect& one : applied) changed->shorter_mm_ += one.parameters.at("knot_mm");
    return changed;
  }
  [[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position, const MechanismVisit& /*visit*/,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override {
    if (!(position.y_mm < 0.0))
      return tl::unexpected(MechanismReason{"above_the_nails", "the point is above the nails"});
    LengthsPrediction result;
    result.lengths_mm.resize(3);
    result.by_position.resize(3, 2);
    for (const Eigen::Index i : {0, 1, 2}) {
      const double nail_x_mm = i < 2 ? values_[i] : 0.0;
      const Eigen::RowVector2d way(position.x_mm - nail_x_mm, position.y_mm);
      result.lengths_mm[i] = way.norm() + values_[2] - shorter_mm_;
      result.by_position.row(i) = way / way.norm();
    }
    const bool all = wanted == Derivatives::by_position_and_parameter;
    result.by_parameter = Eigen::MatrixXd::Zero(3, all ? 3 : 0);
    if (all) {
      result.by_parameter(0, 0) = -result.by_position(0, 0);
      result.by_parameter(1, 1) = -result.by_position(1, 0);
      result.by_parameter.col(2).setOnes();
    }
    return result;
  }
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override {
    if (lengths_mm.size() != 3) throw std::invalid_argument("three strings");
    return locate_by_newton(*this, lengths_mm, visit, extent().centre());
  }
  /// The nails.
  std::vector<FixedPoint> fixed_points() const override {
    std::vector<FixedPoint> nails;
    for (const Eigen::Index i : {0, 1}) {
      nails.push_back({lengths()[static_cast<std::size_t>(i)],
                       {values_[i], 0.0},
                       Eigen::Matrix2Xd::Zero(2, 3)});
      nails.back().by_parameter(0, i) = 1.0;
    }
    return nails;
  }

 private:
  static constexpr effects::Effect kKnot = {.id = "toy_knot",
                                            .station = effects::Station::chain,
                                            .parameters = {{.name = "knot_mm",
                                                            .symbol = "k",
                                                            .meaning = "what the knots take",
                                                            .nominal = 2.0,
                                                            .lower = 0.0,
                                                            .upper = 50.0,
                                                            .prior_sigma = 2.0}},
                                            .cause = "all strings were knotted",
                                            .signature = "all lengths are short everywhere",
                                            .equation = "- k",
                                            .source = "a toy",
                                            .not_modelled = "nothing",
                                            .typical = "2 mm",
                                            .remedy_kind = effects::RemedyKind::repair,
                                            .remedy = "untie the knots"};

  Eigen::VectorXd values_;
  std::array<MechanismParameter, 3> parameters_;
  double shorter_mm_ = 0.0;
};

}  // namespace chaintrue::model
