// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random programs, like those of CAM programs and of people, and hostile ones; and machines that
/// differ from their controllers' kinematics.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <string>

#include "tools/gcode/corrector.hpp"

namespace chaintrue::gcode::testing_support {

/// Lines, arcs of every form, plane and size from 0.01 mm to half a metre, helices, rapids,
/// heights, drilling cycles, inches, steps, inverse time, moves of a few micrometres, words. The
/// path stays within 1000 mm of the middle in X and 480 mm in Y.
[[nodiscard]] std::string random_program(std::mt19937_64& random);

/// The machine as it is, as the target of G-code.
class TrueMachine final : public grid::LengthMap {
 public:
  explicit TrueMachine(const model::Machine& machine)
      : kinematics_(model::make_controller_kinematics(machine)) {}
  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint point) const override;
  [[nodiscard]] tl::expected<grid::LengthsAnswer, grid::MapFailure> query(
      model::BedPoint point) const override;
  [[nodiscard]] grid::MapStatus status(model::BedPoint) const override {
    return grid::MapStatus::inside;
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths lengths) const override;
  [[nodiscard]] std::span<const std::string_view> length_names() const override { return {}; }
  [[nodiscard]] const interp::Rectangle& domain() const override { return domain_; }

 private:
  interp::Rectangle domain_{-1219.2, 1219.2, -609.6, 609.6};
  std::unique_ptr<const model::ControllerKinematics> kinematics_;
};

/// One case of the law: a program, a machine, a controller and a tolerance.
struct LawCase {
  explicit LawCase(std::uint64_t seed);
  std::string program;
  double tolerance_mm = 0.05;
  model::Machine believed;
  std::unique_ptr<TrueMachine> map;
  std::unique_ptr<const model::ControllerKinematics> kinematics;
  std::unique_ptr<Corrector> corrector;
};

/// Empty if the law holds for the case of this seed: verify accepts the output of compensate, and rejects
/// it when the path is moved by 1.5 tolerances. Otherwise the fault, with the program.
/// \param accepted counts the programs that compensate accepts.
[[nodiscard]] std::string broken_law(std::uint64_t seed, int& accepted);

}  // namespace chaintrue::gcode::testing_support
