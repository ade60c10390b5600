// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/compensation_map.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid/failed.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {

std::string_view name(NoiseSource source) {
  return word_of(source, {"stated", "repeats", "fit", "assumed"});
}

MapFailure unreachable(const model::MechanismFailure& why) {
  return MapFailure(MapReason::unreachable).because_of(why.reason.words);
}

std::string_view sentence_of(MapReason reason) {
  switch (reason) {
    case MapReason::outside_map:
      return "the point is off the bed that was measured";
    case MapReason::unreachable:
      return "the chains cannot hold the sled there";
    case MapReason::not_converged:
      break;
  }
  return "no point of the bed was found for these chain lengths";
}

std::optional<Machine> stated_machine(const CompensationMap& map) {
  if (map.machine() == nullptr) return std::nullopt;
  Machine machine = *map.machine();
  for (const SettingResult& result : map.contents().settings) {
    if (!model::is_of_sheet(result.setting))
      machine = model::with_setting(std::move(machine), result.setting, result.stated);
  }
  return machine;
}

CompensationMap::CompensationMap(MapContents contents)
    : contents_(std::move(contents)), area_(contents_.hull, contents_.edge_mm, contents_.domain) {
  if (contents_.outside.way == Outside::fade && machine() == nullptr) {
    throw std::invalid_argument("a map without a machine has no value where its surface fades out");
  }
  field_ = std::make_shared<const MapField>(contents_);
}

CompensationMap CompensationMap::with_outside(OutsideRule rule) const {
  MapContents contents = contents_;
  contents.outside = rule;
  return CompensationMap(std::move(contents));
}

CompensationMap CompensationMap::with_notes_first(const std::vector<std::string>& notes) const {
  CompensationMap map = *this;
  map.contents_.notes.insert(map.contents_.notes.begin(), notes.begin(), notes.end());
  return map;
}

CompensationMap CompensationMap::with_sigma_beyond(double factor) const {
  CompensationMap map = *this;
  map.contents_.sigma_factor_beyond = factor;
  return map;
}

tl::expected<MapAnswer, MapFailure> CompensationMap::query(MarkPoint mark) const {
  const auto found = with_spread(mark);
  if (!found) return failed(found);
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

tl::expected<MapSpread, MapFailure> CompensationMap::with_spread(MarkPoint mark) const {
  if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
  return field_->at(mark, MapField::Asked::spread);
}

tl::expected<MapLengths, MapFailure> CompensationMap::lengths(MarkPoint mark) const {
  if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
  return field_->at(mark).map([](const MapSpread& found) { return found.here; });
}

tl::expected<MarkPoint, MapFailure> CompensationMap::inverse(ChainLengths wanted) const {
  constexpr int kSteps = 30;
  constexpr double kConvergedMm = 1e-9;
  const interp::Rectangle& domain = contents_.domain;
  const auto field = field_to_search();
  MarkPoint mark{0.5 * (domain.x_min + domain.x_max), 0.5 * (domain.y_min + domain.y_max)};
  for (int step = 0; step < kSteps; ++step) {
    const auto found = field->at(mark);
    if (!found) return failed(found);
    const MapLengths& here = found->here;
    const Vector2d missing = difference(wanted, here.lengths);
    const Vector2d move = here.mark_jacobian.inverse() * missing;
    if (!move.allFinite()) break;
    // A step may leave the domain temporarily, but not to where the chains cannot hold the sled.
    mark = within({mark.x_mm + move.x(), mark.y_mm + move.y()}, 50.0);
    if (move.norm() >= kConvergedMm) continue;
    // On the domain's edge the last step may end outside by the tolerance.
    const MarkPoint inside = within(mark, 0.0);
    if (distance_mm(inside, mark) < kConvergedMm) mark = inside;
    if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
    return mark;
  }
  return tl::unexpected(MapReason::not_converged);
}

MapStatus CompensationMap::status(MarkPoint mark) const {
  const MapStatus status = area_.status(mark);
  const bool refused =
      contents_.outside.way == Outside::refuse && status == MapStatus::extrapolated;
  return refused ? MapStatus::outside : status;
}

Matrix2Xd CompensationMap::tool_spread(MarkPoint mark) const {
  const auto found = with_spread(mark);
  if (!found) return Matrix2Xd(2, 0);
  // A length that is truly longer leaves the tool short of the mark.
  return -spread_factor(area_.status(mark)) * found->here.mark_jacobian.inverse() *
         found->spread_mm;
}

const Machine* CompensationMap::machine() const {
  const auto* surface = std::get_if<ModelSurface>(&contents_.surface);
  return surface == nullptr ? nullptr : &surface->machine;
}

bool CompensationMap::answers_at(MarkPoint mark) const {
  if (!contents_.domain.contains(mark.x_mm, mark.y_mm)) return false;
  return contents_.outside.way != Outside::refuse || status(mark) != MapStatus::outside;
}

MarkPoint CompensationMap::within(MarkPoint mark, double beyond_mm) const {
  const interp::Rectangle& domain = contents_.domain;
  return {std::clamp(mark.x_mm, domain.x_min - beyond_mm, domain.x_max + beyond_mm),
          std::clamp(mark.y_mm, domain.y_min - beyond_mm, domain.y_max + beyond_mm)};
}

std::shared_ptr<const MapField> CompensationMap::field_to_search() const {
  if (contents_.outside.way != Outside::clamp || machine() != nullptr) return field_;
  return with_outside({Outside::linear}).field_;
}

}  // namespace chaintrue::grid
