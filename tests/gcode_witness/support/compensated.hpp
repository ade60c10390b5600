// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measured machine and its controllers, for tests that compensate.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "grid/map/map_in_frame.hpp"
#include "tests/gcode_witness/follower/tool_path.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::witness {

/// The map of fixtures/grids/seven_by_four.json, fitted once.
[[nodiscard]] const grid::CompensationMap& measured_map(const std::string& fixtures);

class Shop {
 public:
  Shop(const grid::CompensationMap& map, model::ControllerKind kind);
  Shop(const Shop&) = delete;
  Shop& operator=(const Shop&) = delete;

  /// The output; empty if it was rejected, with the reason.
  [[nodiscard]] std::optional<std::string> compensate(const std::string& program,
                                                      double tolerance_mm,
                                                      std::string& why) const;
  /// verify's verdict: empty if the file passes, otherwise its message.
  [[nodiscard]] std::string verify(const std::string& original,
                                   const std::string& output,
                                   double tolerance_mm) const;
  /// The independent check: distance of the simulated tool from the intended path, up to most_mm.
  /// \throws std::runtime_error if the follower does not understand one of the files.
  [[nodiscard]] double distance_mm(const std::string& original,
                                   const std::string& output,
                                   double most_mm) const;
  /// Whether it is at most this.
  [[nodiscard]] bool follows(const std::string& original,
                             const std::string& output,
                             double distance_mm) const;
  [[nodiscard]] const char* name() const { return corrector_.firmware().name; }

 private:
  grid::MapInFrame target_;
  model::Machine machine_;
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
  gcode::Corrector corrector_;
  follower::Workshop workshop_;
};

}  // namespace chaintrue::witness
