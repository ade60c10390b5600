// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_machine.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "model/machine_ranges.hpp"

namespace chaintrue::model {
namespace {

void check_anchors(const BeltMachine& machine, RangeChecks& checks) {
  for (const Belt belt : kBelts) {
    const Anchor& anchor = machine.anchors[belt];
    const std::string place = fmt::format("/anchors/{}", name(belt));
    checks.range(place + "/z_mm", anchor.z_mm, -1000.0, 1000.0);
    if (!machine.anchors_known) continue;
    checks.range(place + "/x_mm", anchor.x_mm, -20000.0, 20000.0);
    checks.range(place + "/y_mm", anchor.y_mm, -20000.0, 20000.0);
  }
  if (!machine.anchors_known || !checks.sound()) return;
  const PerBelt<Anchor>& a = machine.anchors;
  const auto zero = [&checks](const char* place, double value) {
    if (value == 0.0) return;
    checks.add(place, value,
               "0, because the bottom left anchor is the origin and the bottom right one is on the "
               "x axis");
  };
  zero("/anchors/bl/x_mm", a.bl.x_mm);
  zero("/anchors/bl/y_mm", a.bl.y_mm);
  zero("/anchors/br/y_mm", a.br.y_mm);
  constexpr double kLeastFrameMm = 300.0;
  if (!(a.br.x_mm >= kLeastFrameMm && a.tr.x_mm - a.tl.x_mm >= kLeastFrameMm)) {
    checks.add("/anchors",
               fmt::format("br at x {} and tr {} right of tl", a.br.x_mm, a.tr.x_mm - a.tl.x_mm),
               "right anchors at least 300 mm right of the left ones; were they swapped, "
               "or given in inches?");
  }
  if (!(a.tl.y_mm >= kLeastFrameMm && a.tr.y_mm >= kLeastFrameMm)) {
    checks.add("/anchors", fmt::format("tl at y {} and tr at y {}", a.tl.y_mm, a.tr.y_mm),
               "upper anchors at least 300 mm above the lower ones (y points up); were "
               "they swapped, or given in inches?");
  }
}

}  // namespace

std::string_view name(Belt belt) { return PerBelt<std::string_view>{"tl", "tr", "bl", "br"}[belt]; }

std::string_view words(Belt belt) {
  return PerBelt<std::string_view>{"top left", "top right", "bottom left", "bottom right"}[belt];
}

std::optional<Belt> belt_of(std::string_view word) {
  for (const Belt belt : kBelts) {
    if (word == name(belt)) return belt;
  }
  return std::nullopt;
}

std::string_view name(Orientation orientation) {
  return orientation == Orientation::upright ? "upright" : "flat";
}

std::string_view name(BeltLengths lengths) {
  constexpr std::array<std::string_view, 3> kNames = {"belt", "belt_and_arm", "span"};
  return kNames.at(static_cast<std::size_t>(lengths));
}

double reach_mm(const BeltMachine& machine) { return machine.arm_mm + machine.end_extension_mm; }

double height_mm(const BeltMachine& machine, Belt belt) {
  return machine.anchors[belt].z_mm + machine.surface_mm;
}

FramePoint centre_of(const BeltMachine& machine) {
  const PerBelt<Anchor>& a = machine.anchors;
  // bl + s (tr - bl) = br + t (tl - br), with bl the origin and br on the x axis
  const double across_x = a.tl.x_mm - a.br.x_mm;
  const double across_y = a.tl.y_mm - a.br.y_mm;
  const double determinant = a.tr.x_mm * across_y - a.tr.y_mm * across_x;
  if (!machine.anchors_known || determinant == 0.0) {
    throw std::logic_error(
        fmt::format("a frame of tl ({}, {}), tr ({}, {}), br ({}, {}) has no centre", a.tl.x_mm,
                    a.tl.y_mm, a.tr.x_mm, a.tr.y_mm, a.br.x_mm, a.br.y_mm));
  }
  const double s = (a.br.x_mm * across_y - a.br.y_mm * across_x) / determinant;
  return {s * a.tr.x_mm, s * a.tr.y_mm};
}

FramePoint to_frame(const BeltMachine& machine, BedPoint command) {
  const FramePoint centre = centre_of(machine);
  return {centre.x_mm + machine.scale_x * command.x_mm,
          centre.y_mm + machine.scale_y * command.y_mm};
}

std::vector<MachineProblem> problems_of(const BeltMachine& machine) {
  RangeChecks checks;
  check_anchors(machine, checks);
  checks.range("/arm_mm", machine.arm_mm, 0.0, 1000.0);
  checks.range("/end_extension_mm", machine.end_extension_mm, 0.0, 1000.0);
  checks.range("/surface_mm", machine.surface_mm, -500.0, 500.0);
  checks.range("/belt/turn_mm", machine.belt_turn_mm, 1.0, 1000.0);
  checks.range("/scale_x", machine.scale_x, 0.5, 2.0, "", "it is a factor, about 1");
  checks.range("/scale_y", machine.scale_y, 0.5, 2.0, "", "it is a factor, about 1");
  return checks.take();
}

}  // namespace chaintrue::model
