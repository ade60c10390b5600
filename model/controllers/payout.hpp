// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The chain lengths that a controller pays out for a command: its own kinematics, in double precision with exact pi.
#pragma once

#include <memory>

#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// A controller's kinematics. Settings that a machine file leaves out are the stated machine's.
class ControllerKinematics {
 public:
  virtual ~ControllerKinematics() = default;
  /// Lengths as the controller counts them for the command (x, y), including the machine's chain_zero where the
  /// controller is `ideal`.
  [[nodiscard]] virtual tl::expected<ChainLengths, PoseFailure> lengths(BedPoint command) const = 0;
  /// The command for which the controller pays out these lengths (Newton on lengths(), 1e-9 mm).
  [[nodiscard]] virtual tl::expected<BedPoint, PoseFailure> command(ChainLengths lengths) const = 0;
};

std::unique_ptr<const ControllerKinematics> make_controller_kinematics(const Machine& machine);

}  // namespace chaintrue::model
