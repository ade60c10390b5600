// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The compensation map: true chain lengths for any point of the bed, with their uncertainty.
///
/// Frame: the map is queried in the coordinates of the grid's points (the marks). A place on the
/// bed goes through to_mark() first, because the two frames differ by the sheet's placement.
/// Lengths are what a reading would be without drift, skips and hysteresis.
///
/// \code
///   const CompensationMap map(contents);        // from fit() or files::parse_map()
///   if (const auto answer = map.query({100.0, -200.0})) use(answer->lengths, answer->sigma);
///   if (const auto mark = map.inverse({1702.1, 1821.4})) use(*mark);
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/map_field.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// Immutable, thread safe.
class CompensationMap {
 public:
  /// \throws std::invalid_argument if `fade` is requested for a surface without a machine.
  explicit CompensationMap(MapContents contents);
  /// This map with another continuation.
  [[nodiscard]] CompensationMap with_outside(OutsideRule rule) const;
  /// This map with these sentences before its own.
  [[nodiscard]] CompensationMap with_notes_first(const std::vector<std::string>& notes) const;
  /// This map with sigmas beyond the measured part multiplied by a factor.
  [[nodiscard]] CompensationMap with_sigma_beyond(double factor) const;
  const MapContents& contents() const { return contents_; }

  [[nodiscard]] tl::expected<MapAnswer, MapFailure> query(MarkPoint mark) const;
  /// Without what a cause in the map adds to the sigmas beyond the measured part.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> with_spread(MarkPoint mark) const;
  /// Lengths and their derivative alone, some ten times faster: what a path needs between its
  /// corners.
  [[nodiscard]] tl::expected<MapLengths, MapFailure> lengths(MarkPoint mark) const;
  /// Where the tool is when these lengths are paid out: Newton to 1e-9 mm, at most 30 steps.
  [[nodiscard]] tl::expected<MarkPoint, MapFailure> inverse(ChainLengths wanted) const;

  [[nodiscard]] MapStatus status(MarkPoint mark) const;
  /// As in LengthMap; no columns where lengths() has no answer.
  Matrix2Xd tool_spread(MarkPoint mark) const;
  /// The same place in the other frame; a direct map knows only one.
  MarkPoint to_mark(BedPoint bed) const { return field_->sheet().to_mark(bed); }
  BedPoint to_bed(MarkPoint mark) const { return field_->sheet().to_bed(mark); }
  /// Null for a direct map.
  const Machine* machine() const;

 private:
  bool answers_at(MarkPoint mark) const;
  double spread_factor(MapStatus status) const {
    return status == MapStatus::extrapolated ? contents_.sigma_factor_beyond : 1.0;
  }
  /// The nearest place that is no farther than this off the domain.
  MarkPoint within(MarkPoint mark, double beyond_mm) const;
  /// Constant lengths beyond the points stop a search, so it uses the surface's own continuation.
  std::shared_ptr<const MapField> field_to_search() const;

  MapContents contents_;
  MeasuredArea area_;
  std::shared_ptr<const MapField> field_;
};

/// The controller's machine unless a file states another: the map's, with the settings as they were
/// stated, not as they were calibrated. Empty for a map without a machine.
std::optional<Machine> stated_machine(const CompensationMap& map);

}  // namespace chaintrue::grid
