// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine whose lengths are those of its own kinematics: the target of G-code without a map.
#pragma once

#include <memory>
#include <optional>

#include "tools/gcode/corrector.hpp"

namespace chaintrue::gcode::testing_support {

class TrueMachine final : public grid::LengthMap {
 public:
  explicit TrueMachine(const model::Machine& machine)
      : kinematics_(model::make_controller_kinematics(machine)) {}

  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint point) const override {
    const auto found = kinematics_->lengths(point);
    if (!found) return tl::unexpected(grid::MapReason::unreachable);
    return *found;
  }
  [[nodiscard]] tl::expected<grid::LengthsAnswer, grid::MapFailure> query(
      model::BedPoint point) const override {
    const auto found = lengths(point);
    if (!found) return tl::unexpected(found.error());
    return grid::LengthsAnswer{
        Eigen::Vector2d(found->left_mm, found->right_mm), {}, std::nullopt, status(point)};
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths lengths) const override {
    const auto found = kinematics_->command(lengths);
    if (!found) return tl::unexpected(grid::MapReason::unreachable);
    return *found;
  }
  [[nodiscard]] grid::MapStatus status(model::BedPoint) const override {
    return grid::MapStatus::inside;
  }
  [[nodiscard]] std::span<const std::string_view> length_names() const override { return {}; }
  [[nodiscard]] const interp::Rectangle& domain() const override { return domain_; }

 private:
  interp::Rectangle domain_{-1219.2, 1219.2, -609.6, 609.6};
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
};

}  // namespace chaintrue::gcode::testing_support
