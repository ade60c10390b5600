// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/compensation_map.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/map/map_field.hpp"
#include "model/calibration/setting.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {

using model::BedPoint;
using model::ChainLengths;
using model::MarkPoint;

std::string_view name(NoiseSource source) {
  constexpr std::string_view kNames[] = {"stated", "repeats", "fit", "assumed"};
  return kNames[static_cast<std::size_t>(source)];
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

namespace {

/// d/dt at t0 of the parabola through (t0, f0), (t1, f1), (t2, f2).
Eigen::VectorXd end_slope(const std::array<double, 3>& t,
                          const Eigen::VectorXd& f0,
                          const Eigen::VectorXd& f1,
                          const Eigen::VectorXd& f2) {
  const Eigen::VectorXd near = (f1 - f0) / (t[1] - t[0]);
  const Eigen::VectorXd far = (f2 - f0) / (t[2] - t[0]);
  return near - (far - near) * (t[1] - t[0]) / (t[2] - t[1]);
}

/// For the lines that are the rows of `values`, at their first node or, reversed, at their last.
Eigen::VectorXd slopes_at_end(const std::vector<double>& nodes,
                              const Eigen::MatrixXd& values,
                              bool last) {
  const auto count = std::ssize(nodes);
  const auto at = [&](Eigen::Index i) { return last ? count - 1 - i : i; };
  const auto node = [&](Eigen::Index i) { return nodes[as_size(at(i))]; };
  if (count == 2) return (values.col(at(1)) - values.col(at(0))) / (node(1) - node(0));
  return end_slope(
      {node(0), node(1), node(2)}, values.col(at(0)), values.col(at(1)), values.col(at(2)));
}

/// Constant lengths beyond the points stop a search, so it uses the surface's own continuation.
std::shared_ptr<const MapField> field_to_search(const MapContents& contents,
                                                const std::shared_ptr<const MapField>& field) {
  if (contents.outside.way != Outside::clamp ||
      !std::holds_alternative<DirectSurface>(contents.surface)) {
    return field;
  }
  MapContents going_on = contents;
  going_on.outside.way = Outside::linear;
  return MapField::make(going_on);
}

}  // namespace

interp::EdgeSlopes parabola_slopes(const std::vector<double>& x_nodes_mm,
                                   const std::vector<double>& y_nodes_mm,
                                   const Eigen::MatrixXd& values) {
  const Eigen::MatrixXd along_x = values.transpose();
  return {slopes_at_end(x_nodes_mm, along_x, false),
          slopes_at_end(x_nodes_mm, along_x, true),
          slopes_at_end(y_nodes_mm, values, false),
          slopes_at_end(y_nodes_mm, values, true)};
}

CompensationMap::CompensationMap(MapContents contents)
    : contents_(std::move(contents)), area_(contents_.hull, contents_.edge_mm, contents_.domain) {
  if (contents_.outside.way == Outside::fade &&
      std::holds_alternative<DirectSurface>(contents_.surface)) {
    throw std::invalid_argument(
        "a map without a machine has no value where its surface fades out");
  }
  field_ = MapField::make(contents_);
}

const model::Machine* CompensationMap::machine() const {
  const auto* surface = std::get_if<ModelSurface>(&contents_.surface);
  return surface == nullptr ? nullptr : &surface->machine;
}

MarkPoint CompensationMap::to_mark(BedPoint bed) const { return field_->sheet().to_mark(bed); }

BedPoint CompensationMap::to_bed(MarkPoint mark) const { return field_->sheet().to_bed(mark); }

MapStatus CompensationMap::status(MarkPoint mark) const {
  const MapStatus status = area_.status(mark);
  const bool refused =
      contents_.outside.way == Outside::refuse && status == MapStatus::extrapolated;
  return refused ? MapStatus::outside : status;
}

bool CompensationMap::answers_at(MarkPoint mark) const {
  if (!contents_.domain.contains(mark.x_mm, mark.y_mm)) return false;
  return contents_.outside.way != Outside::refuse || area_.status(mark) != MapStatus::extrapolated;
}

CompensationMap CompensationMap::with_accuracy(MapAccuracy accuracy) const {
  CompensationMap map = *this;
  map.contents_.accuracy = accuracy;
  return map;
}

CompensationMap CompensationMap::with_mirror(std::optional<MirrorTest> mirror) const {
  CompensationMap map = *this;
  map.contents_.mirror = std::move(mirror);
  return map;
}

CompensationMap CompensationMap::with_notes_first(std::vector<std::string> notes) const {
  CompensationMap map = *this;
  map.contents_.notes.insert(map.contents_.notes.begin(), notes.begin(), notes.end());
  return map;
}

CompensationMap CompensationMap::with_sigma_beyond(double factor) const {
  CompensationMap map = *this;
  map.contents_.sigma_factor_beyond = factor;
  return map;
}

CompensationMap CompensationMap::with_outside(OutsideRule rule) const {
  MapContents contents = contents_;
  contents.outside = rule;
  return CompensationMap(std::move(contents));
}

tl::expected<CompensationMap::Lengths, MapFailure> CompensationMap::lengths(MarkPoint mark) const {
  if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
  return field_->at(mark).map([](const MapSpread& found) { return found.here; });
}

tl::expected<MapSpread, MapFailure> CompensationMap::with_spread(MarkPoint mark) const {
  if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
  return field_->at(mark, MapField::Asked::spread);
}

tl::expected<MapAnswer, MapFailure> CompensationMap::query(MarkPoint mark) const {
  const auto found = with_spread(mark);
  if (!found) return tl::unexpected(found.error());
  MapAnswer answer;
  answer.lengths = found->here.lengths;
  answer.mark_jacobian = found->here.mark_jacobian;
  answer.status = area_.status(mark);
  answer.covariance = found->spread_mm * found->spread_mm.transpose();
  answer.covariance *= std::pow(spread_factor(answer.status), 2);
  answer.sigma = {std::sqrt(answer.covariance(0, 0)), std::sqrt(answer.covariance(1, 1))};
  const Eigen::Matrix2d to_tool = found->here.mark_jacobian.inverse();
  answer.tool_sigma_mm = std::sqrt((to_tool * answer.covariance * to_tool.transpose()).trace());
  return answer;
}

double CompensationMap::spread_factor(MapStatus status) const {
  return status == MapStatus::extrapolated ? contents_.sigma_factor_beyond : 1.0;
}

Eigen::Matrix2Xd CompensationMap::tool_spread(MarkPoint mark) const {
  const auto found = with_spread(mark);
  if (!found) return Eigen::Matrix2Xd(2, 0);
  // A length that is truly longer leaves the tool short of the mark.
  return -spread_factor(area_.status(mark)) * found->here.mark_jacobian.inverse() * found->spread_mm;
}

tl::expected<MarkPoint, MapFailure> CompensationMap::inverse(ChainLengths wanted) const {
  constexpr int kSteps = 30;
  constexpr double kConvergedMm = 1e-9;
  const interp::Rectangle& domain = contents_.domain;
  const std::shared_ptr<const MapField> field = field_to_search(contents_, field_);
  MarkPoint mark{0.5 * (domain.x_min + domain.x_max), 0.5 * (domain.y_min + domain.y_max)};
  for (int step = 0; step < kSteps; ++step) {
    const auto found = field->at(mark);
    if (!found) return tl::unexpected(found.error());
    const MapLengths& here = found->here;
    const Eigen::Vector2d missing(wanted.left_mm - here.lengths.left_mm,
                                  wanted.right_mm - here.lengths.right_mm);
    const Eigen::Vector2d move = here.mark_jacobian.inverse() * missing;
    if (!move.allFinite()) return tl::unexpected(MapReason::not_converged);
    // A step may leave the domain temporarily, but not to where the chains cannot hold the sled.
    mark.x_mm = std::clamp(mark.x_mm + move.x(), domain.x_min - 50.0, domain.x_max + 50.0);
    mark.y_mm = std::clamp(mark.y_mm + move.y(), domain.y_min - 50.0, domain.y_max + 50.0);
    if (move.norm() < kConvergedMm) {
      // On the domain's edge the last step may end outside by the tolerance.
      const MarkPoint within{std::clamp(mark.x_mm, domain.x_min, domain.x_max),
                             std::clamp(mark.y_mm, domain.y_min, domain.y_max)};
      if (std::hypot(within.x_mm - mark.x_mm, within.y_mm - mark.y_mm) < kConvergedMm)
        mark = within;
      if (!answers_at(mark)) return tl::unexpected(MapReason::outside_map);
      return mark;
    }
  }
  return tl::unexpected(MapReason::not_converged);
}

std::optional<model::Machine> stated_machine(const CompensationMap& map) {
  if (map.machine() == nullptr) return std::nullopt;
  model::Machine machine = *map.machine();
  for (const SettingResult& result : map.contents().settings) {
    if (!model::is_of_sheet(result.setting))
      machine = model::with_setting(std::move(machine), result.setting, result.stated);
  }
  return machine;
}

}  // namespace chaintrue::grid
