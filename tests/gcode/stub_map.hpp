// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of a map that tests of programs do not care for.
#pragma once

#include "tools/gcode/corrector.hpp"

namespace chaintrue::gcode {

/// Lengths and tool are the derived class's; measured everywhere, to 0.1 mm.
class StubMap : public grid::LengthMap {
 public:
  explicit StubMap(interp::Rectangle domain) : domain_(domain) {}
  [[nodiscard]] tl::expected<grid::LengthsAnswer, grid::MapFailure> query(
      model::BedPoint p) const override {
    const auto found = lengths(p);
    if (!found) return tl::unexpected(found.error());
    return grid::LengthsAnswer{
        Eigen::Vector2d(found->left_mm, found->right_mm), {0.1, 0.1}, std::nullopt, status(p)};
  }
  [[nodiscard]] grid::MapStatus status(model::BedPoint) const override {
    return grid::MapStatus::inside;
  }
  std::span<const std::string_view> length_names() const override { return {}; }
  const interp::Rectangle& domain() const override { return domain_; }

 private:
  interp::Rectangle domain_;
};

}  // namespace chaintrue::gcode
