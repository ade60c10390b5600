// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/hole_distances.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::belts {

std::optional<TapedRows> taped_rows(const std::vector<BeltHoles>& sets,
                                    const AnchorVector& anchors,
                                    double log_scale) {
  std::vector<HoleRows> parts;
  Eigen::Index distances = 0;
  Eigen::Index holes = 0;
  for (const BeltHoles& set : sets) {
    auto part = hole_rows(set, anchors, log_scale);
    if (!part) return std::nullopt;
    distances += part->residual_mm.size();
    holes += std::ssize(part->marks);
    parts.push_back(*std::move(part));
  }
  TapedRows all{Eigen::VectorXd(distances),
                Eigen::MatrixXd(distances, kFrameUnknowns),
                Eigen::MatrixXd::Zero(distances, 2 * holes),
                Eigen::MatrixXd(distances, 2),
                Eigen::MatrixXd(distances, 3),
                {}};
  const model::FramePoint centre = model::centre_of(sets.front().machine);
  const double factor = std::exp(log_scale);
  Eigen::Index row = 0;
  for (const HoleRows& part : parts) {
    const Eigen::Index count = part.residual_mm.size();
    all.residual_mm.segment(row, count) = part.residual_mm;
    all.by_frame.middleRows(row, count) = part.by_frame;
    all.by_mark.block(row, 2 * std::ssize(all.marks), count, part.by_mark.cols()) = part.by_mark;
    all.by_size.middleRows(row, count) = part.by_size;
    all.by_sheet.middleRows(row, count) = part.by_sheet;
    for (const model::FramePoint& at : part.frame_places)
      all.marks.push_back({factor * (at.x_mm - centre.x_mm), factor * (at.y_mm - centre.y_mm)});
    row += count;
  }
  return all;
}

namespace {

std::optional<TapedRows> rows_about(const std::vector<BeltHoles>& sets,
                                    const model::Mechanism& mechanism) {
  if (mechanism.values().size() != kFrameUnknowns)
    throw precondition("holes of {} belts' parameters", mechanism.values().size());
  return taped_rows(
      sets, mechanism.values().head<kAnchorUnknowns>(), mechanism.values()[kAnchorUnknowns]);
}

constexpr model::MechanismReason kNowhere{"circles_do_not_meet",
                                          "the upper belts do not reach a hole"};

}  // namespace

HoleDistances::HoleDistances(const std::vector<BeltHoles>& sets, const Eigen::MatrixXd& covariance)
    : Observation(false, 0.0), sets_(&sets), covariance_(covariance) {
  measured_ = Eigen::VectorXd::Zero(covariance.rows());
  for (Eigen::Index row = 0; row < covariance.rows(); ++row)
    units_.push_back({row, 1, as_size(row)});
}

tl::expected<Eigen::VectorXd, observation::Unreachable> HoleDistances::predicted(
    const observation::View& view) const {
  const auto rows = rows_about(*sets_, *view.mechanism);
  if (!rows) return tl::unexpected(observation::Unreachable(kNowhere, 0));
  return Eigen::VectorXd(-covariance_.half_solve(rows->residual_mm));
}

tl::expected<observation::Linearisation, observation::Unreachable> HoleDistances::linearise(
    const observation::View& view, const observation::Columns& columns) const {
  const auto rows = rows_about(*sets_, *view.mechanism);
  if (!rows) return tl::unexpected(observation::Unreachable(kNowhere, 0));
  observation::Linearisation result;
  result.predicted = -covariance_.half_solve(rows->residual_mm);
  result.by_setting = columns.parameters ? covariance_.half_solve(rows->by_frame)
                                         : Eigen::MatrixXd(rows->residual_mm.size(), 0);
  result.by_nuisance.resize(rows->residual_mm.size(), 0);
  result.units.assign(units_.size(), {Eigen::MatrixXd::Identity(1, 1), {}});
  return result;
}

std::string HoleDistances::untestable(const model::effects::Effect& /*effect*/,
                                      model::effects::EffectSide /*side*/) const {
  return "a tape between holes shows only anchors, the scale and the tool's displacement";
}

std::string HoleDistances::name_of(std::size_t unit) const {
  for (const BeltHoles& set : *sets_) {
    if (unit < set.set.distances.size()) return words_of(set.set, set.set.distances[unit]);
    unit -= set.set.distances.size();
  }
  return fmt::format("distance {}", unit + 1);
}

}  // namespace chaintrue::grid::belts
