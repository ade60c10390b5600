// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The implementation of CompensationMap at a mark: the machine's part and one surface for each
/// chain, continued beyond the measured points as the map states. Internal to grid/map.
#pragma once

#include <memory>
#include <optional>

#include "grid/map/compensation_map.hpp"
#include "interp/measured_region.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid {

/// Immutable, thread safe. Marks anywhere; the map decides whether an answer may be used.
class MapField {
 public:
  virtual ~MapField() = default;
  [[nodiscard]] static std::shared_ptr<const MapField> make(const MapContents& contents);

  enum class Asked { lengths, spread };
  /// The spread only if asked for. If the map's continuation beyond the points differs from the
  /// surfaces' own, the difference is a separate direction, one sigma.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> at(model::MarkPoint mark,
                                                       Asked asked = Asked::lengths) const;
  /// The marks' sheet on the bed.
  [[nodiscard]] const model::SheetPlacement& sheet() const { return sheet_; }

 protected:
  explicit MapField(model::SheetPlacement sheet = {}) : sheet_(sheet) {}
  /// With the surfaces' own continuation.
  [[nodiscard]] virtual tl::expected<MapSpread, MapFailure> continued(model::MarkPoint mark,
                                                                      Asked asked) const = 0;
  [[nodiscard]] virtual model::PerSide<const interp::Surface*> surfaces() const = 0;

 private:
  /// The map's continuation minus the surfaces' own; zero within the points.
  struct Change {
    Eigen::Vector2d lengths_mm = Eigen::Vector2d::Zero();
    Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero();
    void add_to(MapLengths& here) const {
      here.lengths.left_mm += lengths_mm[0];
      here.lengths.right_mm += lengths_mm[1];
      here.mark_jacobian += jacobian;
    }
  };
  [[nodiscard]] std::optional<Change> change(model::MarkPoint mark) const;

  struct Beyond {
    interp::ConvexHull hull;
    interp::RegionPolicy policy;
  };
  model::SheetPlacement sheet_;
  std::optional<Beyond> beyond_;  ///< none: the surfaces' own continuation
};

}  // namespace chaintrue::grid
