// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Machines that differ from what their controllers believe, for tests that compensate.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "grid/map/compensation_map.hpp"
#include "tests/gcode_witness/follower/tool_path.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::witness {

class Shop {
 public:
  /// The machine, and what its controller believes of it.
  Shop(std::unique_ptr<const grid::LengthMap> machine, const model::Machine& believed);
  Shop(const Shop&) = delete;
  Shop& operator=(const Shop&) = delete;

  /// The output; empty if it was rejected, with the reason.
  std::optional<std::string> compensate(const std::string& program, double tolerance_mm,
                                        std::string& why) const;
  /// verify's verdict: empty if the file passes, otherwise its message.
  std::string verify(const std::string& original, const std::string& output,
                     double tolerance_mm) const;
  /// The independent check: distance of the simulated tool from the intended path, up to most_mm.
  /// \throws std::runtime_error if the follower does not understand one of the files.
  double distance_mm(const std::string& original, const std::string& output, double most_mm) const;
  /// Whether it is at most this.
  bool follows(const std::string& original, const std::string& output, double distance_mm) const;
  const char* name() const { return corrector_.firmware().name; }

 private:
  std::unique_ptr<const grid::LengthMap> machine_;
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
  gcode::Corrector corrector_;
  follower::Workshop workshop_;
};

/// The machine of fixtures/grids/seven_by_four.json; its map is fitted once.
std::unique_ptr<const Shop> measured_shop(const std::string& fixtures, model::ControllerKind kind);
/// The default machine with random errors of its motors' places and of its chains' zeros.
std::unique_ptr<const Shop> random_shop(std::uint64_t seed, model::ControllerKind kind);

}  // namespace chaintrue::witness
