// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The implementation of CompensationMap at a mark: the machine's part and one surface for each
/// chain, continued beyond the measured points as the map states.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/length_map.hpp"
#include "grid/map/map_contents.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "interp/measured_region.hpp"
#include "interp/spline_pair.hpp"
#include "interp/tensor_spline.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {

/// The slopes at the edges for `clamped` ends: those of the parabola through the outermost three
/// nodes of each line (two nodes: of the line through them). `values` are (ix, iy).
interp::EdgeSlopes parabola_slopes(const std::vector<double>& x_nodes_mm,
                                   const std::vector<double>& y_nodes_mm, const MatrixXd& values);

/// Immutable, thread safe. Marks anywhere; the map decides whether an answer may be used.
///
///   length_i(q) = (1 + e_i) f_i(q) + t_i(q)                                                   (1)
///
/// with f_i and e_i of the machine, or 0 for a map without one, and a surface t_i for each chain.
class MapField {
 public:
  explicit MapField(const MapContents& contents);

  enum class Asked { lengths, spread };
  /// The spread only if asked for. If the map's continuation beyond the points differs from the
  /// surfaces' own, the difference is a separate direction, one sigma.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> at(MarkPoint mark,
                                                       Asked asked = Asked::lengths) const;

  /// The marks' sheet on the bed.
  const SheetPlacement& sheet() const { return sheet_; }

  /// The uncertainty of an answer; what the machine reads at the mark is null for a map without one.
  using SpreadAt =
      std::function<Matrix2Xd(MarkPoint, const MapLengths&, const model::PointReading*)>;

 private:
  /// Adds the map's continuation minus the surfaces' own. \returns its lengths; zero within the
  /// points.
  Vector2d add_change(MarkPoint mark, MapLengths& here) const;

  struct Beyond {
    interp::ConvexHull hull;
    interp::RegionPolicy policy;
  };

  SheetPlacement sheet_;
  std::optional<ReadingModel> machine_;
  PerSide<double> scale_{};
  PerSide<std::shared_ptr<const interp::Surface>> surfaces_;
  std::optional<interp::SplinePair> pair_;  ///< a direct map's two surfaces, evaluated together
  SpreadAt spread_at_;
  std::optional<Beyond> beyond_;  ///< none: the surfaces' own continuation
};

}  // namespace chaintrue::grid
