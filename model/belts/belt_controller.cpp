// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_controller.hpp"

namespace chaintrue::model {

namespace {

/// The equivalent failure of a two-chain pose.
PoseFailure pose_failure(const BeltFailure& failure) {
  return failure == BeltReason::inside_the_arm ? PoseReason::link_does_not_fit
                                               : PoseReason::too_short;
}

}  // namespace

BeltController::BeltController(const BeltMachine& machine)
    : machine_(machine), centre_(centre_of(machine)) {
  machine_.lengths = BeltLengths::belt;
}

tl::expected<ChainLengths, PoseFailure> BeltController::lengths(BedPoint command) const {
  const FramePoint place = to_frame(machine_, command);
  const auto left = reading_at(machine_, Belt::tl, place);
  if (!left) return tl::unexpected(pose_failure(left.error()));
  const auto right = reading_at(machine_, Belt::tr, place);
  if (!right) return tl::unexpected(pose_failure(right.error()));
  return ChainLengths{left->length_mm, right->length_mm};
}

tl::expected<BedPoint, PoseFailure> BeltController::command(ChainLengths lengths) const {
  const auto place = place_of_upper(machine_, lengths.left_mm, lengths.right_mm);
  if (!place) return tl::unexpected(pose_failure(place.error()));
  return BedPoint{(place->x_mm - centre_.x_mm) / machine_.scale_x,
                  (place->y_mm - centre_.y_mm) / machine_.scale_y};
}

}  // namespace chaintrue::model
