// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map in the frame of the queries: numbers of its marks, or places on the bed with
/// the sheet's placement removed.
#pragma once

#include <array>

#include "grid/failed.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// The frame of x and y.
enum class MapFrame { marks, bed };

class MapInFrame final : public LengthMap {
 public:
  /// Keeps the reference.
  explicit MapInFrame(const CompensationMap& map, MapFrame frame = MapFrame::marks)
      : map_(map), frame_(frame) {}

  std::span<const std::string_view> length_names() const override {
    static constexpr std::array<std::string_view, 2> kNames = {"left", "right"};
    return kNames;
  }

  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(BedPoint point) const override {
    const auto found = map_.query(mark_of(point));
    if (!found) return failed(found);
    return LengthsAnswer{vector_of(found->lengths), found->sigma, found->tool_sigma_mm,
                         found->status};
  }

  [[nodiscard]] tl::expected<ChainLengths, MapFailure> lengths(BedPoint point) const override {
    const auto found = map_.lengths(mark_of(point));
    if (!found) return failed(found);
    return found->lengths;
  }

  [[nodiscard]] tl::expected<BedPoint, MapFailure> tool(ChainLengths lengths) const override {
    const auto found = map_.inverse(lengths);
    if (!found) return failed(found);
    return frame_ == MapFrame::bed ? map_.to_bed(*found) : model::identity_placement(*found);
  }

  [[nodiscard]] MapStatus status(BedPoint point) const override {
    return map_.status(mark_of(point));
  }
  /// In directions of the marks' axes.
  Matrix2Xd tool_spread(BedPoint point) const override { return map_.tool_spread(mark_of(point)); }

  const interp::Rectangle& domain() const override { return map_.contents().domain; }

 private:
  MarkPoint mark_of(BedPoint point) const {
    return frame_ == MapFrame::bed ? map_.to_mark(point) : model::identity_placement(point);
  }

  const CompensationMap& map_;
  MapFrame frame_;
};

}  // namespace chaintrue::grid
