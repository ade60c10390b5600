// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_in_frame.hpp"

#include <array>

namespace chaintrue::grid {

std::span<const std::string_view> MapInFrame::length_names() const {
  static constexpr std::array<std::string_view, 2> kNames = {"left", "right"};
  return kNames;
}

model::MarkPoint MapInFrame::mark_of(model::BedPoint point) const {
  return frame_ == MapFrame::bed ? map_.to_mark(point) : model::identity_placement(point);
}

tl::expected<LengthsAnswer, MapFailure> MapInFrame::query(model::BedPoint point) const {
  const auto found = map_.query(mark_of(point));
  if (!found) return tl::unexpected(found.error());
  return LengthsAnswer{Eigen::Vector2d(found->lengths.left_mm, found->lengths.right_mm),
                       found->sigma,
                       found->tool_sigma_mm,
                       found->status};
}

tl::expected<model::ChainLengths, MapFailure> MapInFrame::lengths(model::BedPoint point) const {
  const auto found = map_.lengths(mark_of(point));
  if (!found) return tl::unexpected(found.error());
  return found->lengths;
}

tl::expected<model::BedPoint, MapFailure> MapInFrame::tool(model::ChainLengths lengths) const {
  const auto found = map_.inverse(lengths);
  if (!found) return tl::unexpected(found.error());
  return frame_ == MapFrame::bed ? map_.to_bed(*found) : model::identity_placement(*found);
}

MapStatus MapInFrame::status(model::BedPoint point) const { return map_.status(mark_of(point)); }

Eigen::Matrix2Xd MapInFrame::tool_spread(model::BedPoint point) const {
  return map_.tool_spread(mark_of(point));
}

}  // namespace chaintrue::grid
