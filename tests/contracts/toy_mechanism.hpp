// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A third mechanism, not contained in the product: two strings from two nails on the x axis to a
/// point below it, each as long as the straight line. One effect, a knot that shortens both.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "model/mechanism.hpp"

namespace chaintrue::model {

class ToyMechanism final : public Mechanism {
 public:
  /// The left nail is stated to 5 mm; the right one has no prior.
  ToyMechanism(double left_x_mm, double right_x_mm)
      : values_(Eigen::Vector2d(left_x_mm, right_x_mm)),
        parameters_{{{"left_nail_x_mm", "mm", left_x_mm, 5.0},
                     {"right_nail_x_mm", "mm", right_x_mm, std::nullopt}}} {}

  [[nodiscard]] std::string_view kind() const override { return "toy"; }
  [[nodiscard]] std::span<const std::string_view> lengths() const override {
    static constexpr std::array<std::string_view, 2> kLengths = {"west", "east"};
    return kLengths;
  }
  [[nodiscard]] std::span<const MechanismParameter> parameters() const override {
    return parameters_;
  }
  [[nodiscard]] const Eigen::VectorXd& values() const override { return values_; }
  [[nodiscard]] MechanismExtent extent() const override { return {-600.0, 600.0, -1500.0, -500.0}; }
  [[nodiscard]] std::shared_ptr<const Mechanism> with_values(
      const Eigen::VectorXd& values) const override {
    if (values.size() != 2) throw std::invalid_argument("two nails");
    auto changed = std::make_shared<ToyMechanism>(*this);
    changed->values_ = values;
    return changed;
  }
  [[nodiscard]] std::span<const effects::Effect* const> effects() const override {
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
      const ToolPosition& position,
      const MechanismVisit& /*visit*/,
      Derivatives wanted = Derivatives::by_position_and_parameter) const override {
    if (!(position.y_mm < 0.0))
      return tl::unexpected(MechanismFailure{"above_the_nails", "the point is above the nails"});
    LengthsPrediction result;
    result.lengths_mm.resize(2);
    result.by_position.resize(2, 2);
    for (const Eigen::Index i : {0, 1}) {
      const Eigen::RowVector2d way(position.x_mm - values_[i], position.y_mm);
      result.lengths_mm[i] = way.norm() - shorter_mm_;
      result.by_position.row(i) = way / way.norm();
    }
    const bool all = wanted == Derivatives::by_position_and_parameter;
    result.by_parameter = Eigen::MatrixXd::Zero(2, all ? 2 : 0);
    if (all) result.by_parameter.diagonal() = -result.by_position.col(0);
    return result;
  }
  [[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const override {
    if (lengths_mm.size() != 2) throw std::invalid_argument("two strings");
    return locate_by_newton(*this, lengths_mm, visit, extent().centre());
  }

 private:
  static constexpr effects::EffectParameter kKnotSize[] = {{.name = "knot_mm",
                                                            .symbol = "k",
                                                            .meaning = "what the knots take",
                                                            .nominal = 2.0,
                                                            .lower = 0.0,
                                                            .upper = 50.0,
                                                            .prior_sigma = 2.0}};
  static constexpr effects::EffectSide kNoSide[] = {effects::EffectSide::none};
  static constexpr effects::Effect kKnot = {.id = "toy_knot",
                                            .station = effects::Station::chain,
                                            .sides = kNoSide,
                                            .parameters = kKnotSize,
                                            .cause = "both strings were knotted",
                                            .signature = "both lengths are short everywhere",
                                            .equation = "- k",
                                            .source = "a toy",
                                            .not_modelled = "nothing",
                                            .typical = "2 mm",
                                            .remedy = "untie the knots"};

  Eigen::VectorXd values_;
  std::array<MechanismParameter, 2> parameters_;
  double shorter_mm_ = 0.0;
};

}  // namespace chaintrue::model
