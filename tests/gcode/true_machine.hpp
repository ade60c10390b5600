// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine whose lengths are those of its own kinematics: the target of G-code without a map.
#pragma once

#include <memory>

#include "tests/gcode/stub_map.hpp"

namespace chaintrue::gcode::testing_support {

class TrueMachine final : public StubMap {
 public:
  explicit TrueMachine(const model::Machine& machine)
      : StubMap({-1219.2, 1219.2, -609.6, 609.6}),
        kinematics_(model::make_controller_kinematics(machine)) {}

  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint point) const override {
    const auto found = kinematics_->lengths(point);
    if (!found) return tl::unexpected(grid::MapReason::unreachable);
    return *found;
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths lengths) const override {
    const auto found = kinematics_->command(lengths);
    if (!found) return tl::unexpected(grid::MapReason::unreachable);
    return *found;
  }

 private:
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
};

}  // namespace chaintrue::gcode::testing_support
