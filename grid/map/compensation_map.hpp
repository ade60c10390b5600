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

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "grid/eigen.hpp"
#include "grid/map/map_field.hpp"
#include "grid/plane_vectors.hpp"

namespace chaintrue::grid {

/// Immutable, thread safe.
class CompensationMap {
 public:
  /// \throws std::invalid_argument if `fade` is requested for a surface without a machine.
  explicit CompensationMap(MapContents contents)
      : contents_(std::move(contents)), area_(contents_.hull, contents_.edge_mm, contents_.domain) {
    if (contents_.outside.way == Outside::fade && machine() == nullptr) {
      throw std::invalid_argument(
          "a map without a machine has no value where its surface fades out");
    }
    field_ = std::make_shared<const MapField>(contents_);
  }
  /// This map with another continuation.
  [[nodiscard]] CompensationMap with_outside(OutsideRule rule) const {
    MapContents contents = contents_;
    contents.outside = rule;
    return CompensationMap(std::move(contents));
  }
  /// This map with these sentences before its own.
  [[nodiscard]] CompensationMap with_notes_first(const std::vector<std::string>& notes) const {
    CompensationMap map = *this;
    map.contents_.notes.insert(map.contents_.notes.begin(), notes.begin(), notes.end());
    return map;
  }
  /// This map with sigmas beyond the measured part multiplied by a factor.
  [[nodiscard]] CompensationMap with_sigma_beyond(double factor) const {
    CompensationMap map = *this;
    map.contents_.sigma_factor_beyond = factor;
    return map;
  }
  const MapContents& contents() const { return contents_; }

  [[nodiscard]] tl::expected<MapAnswer, MapFailure> query(model::MarkPoint mark) const {
    const auto found = with_spread(mark);
    if (!found) return tl::unexpected(found.error());
    MapAnswer answer;
    answer.lengths = found->here.lengths;
    answer.mark_jacobian = found->here.mark_jacobian;
    answer.status = area_.status(mark);
    answer.covariance = found->spread_mm * found->spread_mm.transpose();
    answer.covariance *= std::pow(spread_factor(answer.status), 2);
    answer.sigma = {std::sqrt(answer.covariance(0, 0)), std::sqrt(answer.covariance(1, 1))};
    const Matrix2d to_tool = found->here.mark_jacobian.inverse();
    answer.tool_sigma_mm = std::sqrt((to_tool * answer.covariance * to_tool.transpose()).trace());
    return answer;
  }
  /// Without what a cause in the map adds to the sigmas beyond the measured part.
  [[nodiscard]] tl::expected<MapSpread, MapFailure> with_spread(model::MarkPoint mark) const {
    if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
    return field_->at(mark, MapField::Asked::spread);
  }
  /// Lengths and their derivative alone, some ten times faster: what a path needs between its
  /// corners.
  [[nodiscard]] tl::expected<MapLengths, MapFailure> lengths(model::MarkPoint mark) const {
    if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
    return field_->at(mark).map([](const MapSpread& found) { return found.here; });
  }
  /// Where the tool is when these lengths are paid out: Newton to 1e-9 mm, at most 30 steps.
  [[nodiscard]] tl::expected<model::MarkPoint, MapFailure> inverse(
      model::ChainLengths wanted) const {
    constexpr int kSteps = 30;
    constexpr double kConvergedMm = 1e-9;
    const interp::Rectangle& domain = contents_.domain;
    const auto field = field_to_search();
    model::MarkPoint mark{0.5 * (domain.x_min + domain.x_max), 0.5 * (domain.y_min + domain.y_max)};
    for (int step = 0; step < kSteps; ++step) {
      const auto found = field->at(mark);
      if (!found) return tl::unexpected(found.error());
      const MapLengths& here = found->here;
      const Vector2d missing = difference(wanted, here.lengths);
      const Vector2d move = here.mark_jacobian.inverse() * missing;
      if (!move.allFinite()) break;
      // A step may leave the domain temporarily, but not to where the chains cannot hold the sled.
      mark = within({mark.x_mm + move.x(), mark.y_mm + move.y()}, 50.0);
      if (move.norm() >= kConvergedMm) continue;
      // On the domain's edge the last step may end outside by the tolerance.
      const model::MarkPoint inside = within(mark, 0.0);
      if (distance_mm(inside, mark) < kConvergedMm) mark = inside;
      if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
      return mark;
    }
    return tl::unexpected(MapReason::not_converged);
  }

  [[nodiscard]] MapStatus status(model::MarkPoint mark) const {
    const MapStatus status = area_.status(mark);
    const bool refused =
        contents_.outside.way == Outside::refuse && status == MapStatus::extrapolated;
    return refused ? MapStatus::outside : status;
  }
  /// As in LengthMap; no columns where lengths() has no answer.
  Matrix2Xd tool_spread(model::MarkPoint mark) const {
    const auto found = with_spread(mark);
    if (!found) return Matrix2Xd(2, 0);
    // A length that is truly longer leaves the tool short of the mark.
    return -spread_factor(area_.status(mark)) * found->here.mark_jacobian.inverse() *
           found->spread_mm;
  }
  /// The same place in the other frame; a direct map knows only one.
  model::MarkPoint to_mark(model::BedPoint bed) const { return field_->sheet().to_mark(bed); }
  model::BedPoint to_bed(model::MarkPoint mark) const { return field_->sheet().to_bed(mark); }
  /// Null for a direct map.
  const model::Machine* machine() const {
    const auto* surface = std::get_if<ModelSurface>(&contents_.surface);
    return surface == nullptr ? nullptr : &surface->machine;
  }

 private:
  bool answers_at(model::MarkPoint mark) const {
    if (!contents_.domain.contains(mark.x_mm, mark.y_mm)) return false;
    return contents_.outside.way != Outside::refuse || status(mark) != MapStatus::outside;
  }
  double spread_factor(MapStatus status) const {
    return status == MapStatus::extrapolated ? contents_.sigma_factor_beyond : 1.0;
  }
  /// The nearest place that is no farther than this off the domain.
  model::MarkPoint within(model::MarkPoint mark, double beyond_mm) const {
    const interp::Rectangle& domain = contents_.domain;
    return {std::clamp(mark.x_mm, domain.x_min - beyond_mm, domain.x_max + beyond_mm),
            std::clamp(mark.y_mm, domain.y_min - beyond_mm, domain.y_max + beyond_mm)};
  }
  /// Constant lengths beyond the points stop a search, so it uses the surface's own continuation.
  std::shared_ptr<const MapField> field_to_search() const {
    if (contents_.outside.way != Outside::clamp || machine() != nullptr) return field_;
    return with_outside({Outside::linear}).field_;
  }

  MapContents contents_;
  MeasuredArea area_;
  std::shared_ptr<const MapField> field_;
};

/// The controller's machine unless a file states another: the map's, with the settings as they were
/// stated, not as they were calibrated. Empty for a map without a machine.
std::optional<model::Machine> stated_machine(const CompensationMap& map);

}  // namespace chaintrue::grid
