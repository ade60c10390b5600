// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_kinematics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace chaintrue::model {
namespace {

/// The printed length of a span, with its derivative.
struct Printed {
  double length_mm;
  double by_span;
};

tl::expected<Printed, BeltFailure> printed(const BeltMachine& machine, Belt belt, double span_mm) {
  const double level_mm = span_mm - reach_mm(machine);
  if (!(level_mm > 0.0)) return tl::unexpected(BeltReason::inside_the_arm);
  const double c = height_mm(machine, belt);
  if (machine.lengths == BeltLengths::belt) {
    const double length = std::hypot(level_mm, c);  // (1)
    return Printed{length, level_mm / length};
  }
  if (machine.lengths == BeltLengths::belt_and_arm) {
    const double length = std::hypot(span_mm, c);  // (2)
    return Printed{length, span_mm / length};
  }
  return Printed{span_mm, 1.0};  // (3)
}

}  // namespace

MechanismReason named(BeltReason reason) {
  constexpr std::array<MechanismReason, 3> kReasons = {{
      {"inside_the_arm",
       "the tool would be closer to the anchor than the length of arm and "
       "extension"},
      {"shorter_than_height", "the length is less than the anchor's height"},
      {"circles_do_not_meet", "two belts of these lengths do not meet"},
  }};
  return kReasons.at(static_cast<std::size_t>(reason));
}

tl::expected<BeltReading, BeltFailure> reading_at(const BeltMachine& machine, Belt belt,
                                                  FramePoint place) {
  if (!machine.anchors_known) {
    throw std::logic_error(
        fmt::format("no length of {} where its anchor is not known", name(belt)));
  }
  const Anchor& anchor = machine.anchors[belt];
  const Eigen::RowVector2d way(place.x_mm - anchor.x_mm, place.y_mm - anchor.y_mm);
  const double span_mm = std::hypot(way.x(), way.y());
  const auto length = printed(machine, belt, span_mm);
  if (!length || span_mm == 0.0) return tl::unexpected(BeltReason::inside_the_arm);
  return BeltReading{length->length_mm, length->by_span / span_mm * way};
}

tl::expected<PerBelt<double>, BeltFailure> lengths_at(const BeltMachine& machine,
                                                      FramePoint place) {
  PerBelt<double> lengths;
  for (const Belt belt : kBelts) {
    const auto reading = reading_at(machine, belt, place);
    if (!reading) return tl::unexpected(reading.error());
    lengths[belt] = reading->length_mm;
  }
  return lengths;
}

tl::expected<double, BeltFailure> span_of(const BeltMachine& machine, Belt belt, double length_mm) {
  const double c = height_mm(machine, belt);
  if (machine.lengths != BeltLengths::span && !(length_mm > std::abs(c))) {
    return tl::unexpected(BeltReason::shorter_than_height);
  }
  double span_mm = length_mm;
  if (machine.lengths == BeltLengths::belt) {
    span_mm = std::sqrt((length_mm - c) * (length_mm + c)) + reach_mm(machine);
  } else if (machine.lengths == BeltLengths::belt_and_arm) {
    span_mm = std::sqrt((length_mm - c) * (length_mm + c));
  }
  if (!(span_mm > reach_mm(machine))) return tl::unexpected(BeltReason::inside_the_arm);
  return span_mm;
}

tl::expected<FramePoint, BeltFailure> crossing(FramePoint first, double first_mm, FramePoint second,
                                               double second_mm) {
  const double dx = second.x_mm - first.x_mm;
  const double dy = second.y_mm - first.y_mm;
  const double apart = std::hypot(dx, dy);
  if (!(apart > 0.0)) return tl::unexpected(BeltReason::circles_do_not_meet);
  const double along = 0.5 * (apart + (first_mm - second_mm) * ((first_mm + second_mm) / apart));
  const double square = (first_mm - along) * (first_mm + along);
  if (!(square >= 0.0)) return tl::unexpected(BeltReason::circles_do_not_meet);
  const double aside = std::sqrt(square);
  return FramePoint{first.x_mm + (along * dx + aside * dy) / apart,
                    first.y_mm + (along * dy - aside * dx) / apart};
}

tl::expected<FramePoint, BeltFailure> place_of_upper(const BeltMachine& machine, double tl_mm,
                                                     double tr_mm) {
  const auto left = span_of(machine, Belt::tl, tl_mm);
  if (!left) return tl::unexpected(left.error());
  const auto right = span_of(machine, Belt::tr, tr_mm);
  if (!right) return tl::unexpected(right.error());
  const Anchor& tl = machine.anchors.tl;
  const Anchor& tr = machine.anchors.tr;
  return crossing({tl.x_mm, tl.y_mm}, *left, {tr.x_mm, tr.y_mm}, *right);
}

}  // namespace chaintrue::model
