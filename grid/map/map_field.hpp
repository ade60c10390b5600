// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The implementation of CompensationMap at a mark: the machine's part and one surface for each
/// chain, continued beyond the measured points as the map states.
#pragma once

#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/chain_rows.hpp"
#include "grid/map/length_map.hpp"
#include "grid/map/map_contents.hpp"
#include "interp/measured_region.hpp"
#include "interp/tensor_spline.hpp"

namespace chaintrue::grid {

/// The slopes at the edges for `clamped` ends: those of the parabola through the outermost three
/// nodes of each line (two nodes: of the line through them). `values` are (ix, iy).
[[nodiscard]] interp::EdgeSlopes parabola_slopes(const std::vector<double>& x_nodes_mm,
                                                 const std::vector<double>& y_nodes_mm,
                                                 const Eigen::MatrixXd& values);

/// Immutable, thread safe. Marks anywhere; the map decides whether an answer may be used.
class MapField {
 public:
  virtual ~MapField() = default;
  [[nodiscard]] static std::shared_ptr<const MapField> make(const MapContents& contents);

  enum class Asked { lengths, spread };
  /// The spread only if asked for. If the map's continuation beyond the points differs from the
  /// surfaces' own, the difference is a separate direction, one sigma.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> at(model::MarkPoint mark,
                                                       Asked asked = Asked::lengths) const {
    auto answer = continued(mark, asked);
    if (!answer || !beyond_) return answer;
    const Eigen::Vector2d change = add_change(mark, answer->here);
    if (asked == Asked::lengths) return answer;
    answer->spread_mm.conservativeResize(Eigen::NoChange, answer->spread_mm.cols() + 1);
    answer->spread_mm.rightCols<1>() = change;
    return answer;
  }
  /// The marks' sheet on the bed.
  [[nodiscard]] const model::SheetPlacement& sheet() const { return sheet_; }

 protected:
  explicit MapField(model::SheetPlacement sheet = {}) : sheet_(sheet) {}
  /// With the surfaces' own continuation.
  [[nodiscard]] virtual tl::expected<MapSpread, MapFailure> continued(model::MarkPoint mark,
                                                                      Asked asked) const = 0;
  [[nodiscard]] virtual model::PerSide<const interp::Surface*> surfaces() const = 0;

 private:
  /// Adds the map's continuation minus the surfaces' own. \returns its lengths; zero within the
  /// points.
  Eigen::Vector2d add_change(model::MarkPoint mark, MapLengths& here) const {
    Eigen::Vector2d change = Eigen::Vector2d::Zero();
    if (beyond_->hull.contains(mark.x_mm, mark.y_mm)) return change;
    const model::PerSide<const interp::Surface*> both = surfaces();
    for (const model::Side side : model::kSides) {
      const Eigen::Index row = row_of(side);
      const interp::ValueGradient own = both[side]->at(mark.x_mm, mark.y_mm);
      const interp::ValueGradient reply =
          interp::evaluate(*both[side], beyond_->hull, beyond_->policy, {mark.x_mm, mark.y_mm});
      change[row] = reply.value - own.value;
      here.lengths[side] += change[row];
      here.mark_jacobian.row(row) += Eigen::RowVector2d(reply.dx - own.dx, reply.dy - own.dy);
    }
    return change;
  }

  struct Beyond {
    interp::ConvexHull hull;
    interp::RegionPolicy policy;
  };
  model::SheetPlacement sheet_;
  std::optional<Beyond> beyond_;  ///< none: the surfaces' own continuation
};

}  // namespace chaintrue::grid
