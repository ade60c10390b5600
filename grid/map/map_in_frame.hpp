// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map in the frame of the queries: numbers of its marks, or places on the bed with
/// the sheet's placement removed.
#pragma once

#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid {

/// The frame of x and y.
enum class MapFrame { marks, bed };

class MapInFrame final : public LengthMap {
 public:
  /// Keeps the reference.
  explicit MapInFrame(const CompensationMap& map, MapFrame frame = MapFrame::marks)
      : map_(map), frame_(frame) {}

  [[nodiscard]] std::span<const std::string_view> length_names() const override;
  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::ChainLengths, MapFailure> lengths(
      model::BedPoint point) const override;
  [[nodiscard]] tl::expected<model::BedPoint, MapFailure> tool(
      model::ChainLengths lengths) const override;
  [[nodiscard]] MapStatus status(model::BedPoint point) const override;
  /// In directions of the marks' axes.
  [[nodiscard]] Eigen::Matrix2Xd tool_spread(model::BedPoint point) const override;
  [[nodiscard]] const interp::Rectangle& domain() const override { return map_.contents().domain; }

 private:
  [[nodiscard]] model::MarkPoint mark_of(model::BedPoint point) const;

  const CompensationMap& map_;
  MapFrame frame_;
};

}  // namespace chaintrue::grid
