// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/fit_diagnostics.hpp"

#include <cmath>
#include <limits>

#include "grid/estimation/reading_shifts.hpp"
#include "grid/map/error_summary.hpp"
#include "grid/statistics.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

ReadingLines reading_lines(const MeasuredBelts& belts, const FrameState& state) {
  const auto rows = 4 * std::ssize(belts.points);
  ReadingLines lines;
  lines.residual_mm.setZero(rows);
  lines.by_place.setZero(rows, 2);
  const BeltMachine machine = with_anchors(belts.machine, state.anchors);
  for (const auto k : each_index(belts.points)) {
    for (const Belt belt : kBelts) {
      const auto reading = reading_at(machine, belt, state.places[k]);
      if (!reading) continue;
      const Index row = row_of(k, belt);
      lines.residual_mm[row] = belts.points[k].lengths_mm[belt] - reading->length_mm;
      lines.by_place.row(row) = reading->by_place;
    }
  }
  return lines;
}

FitDiagnostics::FitDiagnostics(const MeasuredBelts& belts, const AnchorFit& frame)
    : frame_(frame), mechanism_(mechanism_at(belts, frame.state)), slots_(belts.points.size()) {
  const auto readings = readings_of(belts, frame_.counting, frame_.residual_sigma_mm);
  const observation::View view(mechanism_);
  const Index unknowns = mechanism_->values().size();
  equations_ = {reading_lines(belts, frame_.state), {}};
  precision_ = MatrixXd::Zero(unknowns, unknowns);
  for (const auto& own : readings.blocks()) {
    auto line = readings.block_line(view, own, true);
    if (!line) {
      precision_.setConstant(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    line->weight /= frame_.residual_sigma_mm * frame_.residual_sigma_mm;
    Block block{*std::move(line), {}, {}, {}, !own.distances.empty()};
    const MatrixXd weighed = block.line.by_position.transpose() * block.line.weight.asDiagonal();
    block.inverse = linear::Cholesky(linear::product(weighed, block.line.by_position)).inverse();
    block.by_unknown =
        linear::product(block.inverse, linear::product(weighed, block.line.by_parameter));
    block.left = block.line.by_parameter - block.line.by_position * block.by_unknown;
    precision_ += block.precision();
    for (const auto p : each_index(own.places)) {
      const std::size_t point = readings.readings()[own.places[p]].index;
      const auto slot = as_index(p);
      slots_[point] = Slot{blocks_.size(), slot};
      equations_.residual_mm.segment<4>(row_of(point, Belt::tl)) =
          block.line.residual_mm.segment<4>(4 * slot);
      equations_.by_place.middleRows<4>(row_of(point, Belt::tl)) =
          block.line.by_position.block<4, 2>(4 * slot, 2 * slot);
    }
    blocks_.push_back(std::move(block));
  }
  covariance_ = linear::PivotedCholesky(precision_).inverse();
  for (const BeltDistance& distance : belts.distances) {
    const auto at = distance_at(belts, *mechanism_, frame_.state, distance);
    equations_.distance_residual_mm.push_back(at ? distance.distance_mm - at->predicted_mm
                                                 : kInfinity);
  }
}

Matrix2d FitDiagnostics::place_covariance_mm2(std::size_t point) const {
  if (!slots_[point]) return Matrix2d::Zero();
  const Block& block = blocks_[slots_[point]->block];
  const Index at = 2 * slots_[point]->place;
  const Matrix2Xd gain = block.by_unknown.middleRows<2>(at);
  return block.inverse.block<2, 2>(at, at) + linear::carried(gain, covariance_);
}

VectorXd FitDiagnostics::influence(std::size_t point, Belt belt) const {
  const double weight = 1.0 / (frame_.residual_sigma_mm * frame_.residual_sigma_mm);
  const Slot& slot = slots_[point].value();
  return weight * (covariance_ * blocks_[slot.block].left.row(slot.row(belt)).transpose());
}

BeltResidual FitDiagnostics::residual(std::size_t point, Belt belt) const {
  BeltResidual result;
  const double r = equations_.residual_mm[row_of(point, belt)];
  result.residual_mm = r;
  result.counts = counts(point, belt);
  result.deleted_residual_mm = r;
  if (!slots_[point]) return result;
  const double s2 = frame_.residual_sigma_mm * frame_.residual_sigma_mm;
  const Block& block = blocks_[slots_[point]->block];
  const Index row = slots_[point]->row(belt);
  const VectorXd j = block.line.by_position.row(row), x = block.left.row(row);
  const double h = (j.dot(block.inverse * j) + x.dot(covariance_ * x)) / s2;
  const auto n = as_double(frame_.checks);
  if (!result.counts) {
    if (n >= 1.0)
      result.sigmas =
          estimation::normal_deviate(r / (frame_.residual_sigma_mm * std::sqrt(1.0 + h)), n);
    return result;
  }
  if (1.0 - h < estimation::kOwnWord || n < 2.0) return result;
  result.deleted_residual_mm = r / (1.0 - h);
  result.sigmas = estimation::deleted_deviate(r, 1.0 - h, s2, n);
  return result;
}

std::optional<FitDiagnostics::Expected> FitDiagnostics::expected(
    const MeasuredBelts& belts, const BeltDistance& distance) const {
  const auto line = distance_at(belts, *mechanism_, frame_.state, distance);
  if (!line) return std::nullopt;
  VectorXd by_unknown = line->by_parameter.transpose();
  std::vector<std::pair<Slot, RowVector2d>> ends;
  for (std::size_t e = 0; e < 2; ++e) {
    const auto* point = std::get_if<std::size_t>(e == 0 ? &distance.from : &distance.to);
    if (point == nullptr) continue;
    if (!slots_[*point]) return std::nullopt;
    ends.emplace_back(*slots_[*point], line->by_end[e]);
    by_unknown -= blocks_[ends.back().first.block]
                      .by_unknown.middleRows<2>(2 * ends.back().first.place)
                      .transpose() *
                  line->by_end[e].transpose();
  }
  const VectorXd with_all = covariance_ * by_unknown;
  Expected result{line->predicted_mm, by_unknown.dot(with_all), 0.0};
  for (const auto& [slot, by_end] : ends) {
    for (const auto& [other, by_other] : ends) {
      if (slot.block != other.block) continue;
      result.variance_mm2 +=
          by_end * blocks_[slot.block].inverse.block<2, 2>(2 * slot.place, 2 * other.place) *
          by_other.transpose();
    }
  }
  if (has_scale()) result.with_scale = with_all[kAnchorUnknowns];
  return result;
}

AnchorVector FitDiagnostics::anchors_without(std::size_t point) const {
  const Block& block = blocks_[slots_[point].value().block];
  const VectorXd change =
      linear::PivotedCholesky(precision_ - block.precision()).solve(-block.gradient());
  return frame_.state.anchors + change.head<kAnchorUnknowns>();
}

namespace {

void fill_coordinates(const MeasuredBelts& belts, const FitDiagnostics& view, BeltsFit& fit) {
  const AnchorVector stated = anchors_of(belts.machine);
  const AnchorVector fitted = anchors_of(fit.machine);
  Eigen::Matrix<double, 5, 4> squares = Eigen::Matrix<double, 5, 4>::Zero();
  for (const auto k : each_index(belts.points)) {
    for (const Belt belt : kBelts) {
      if (!view.counts(k, belt)) continue;
      squares.col(as_index(belt)) += view.influence(k, belt).head<5>().cwiseAbs2();
    }
  }
  for (const auto i : each_index(fit.coordinates)) {
    const auto row = as_index(i);
    AnchorCoordinate& coordinate = fit.coordinates[i];
    coordinate.name = kCoordinateNames[i];
    if (belts.machine.anchors_known) coordinate.stated_mm = stated[row];
    coordinate.fitted_mm = fitted[row];
    coordinate.sigma_mm = std::sqrt(fit.covariance_mm2(row, row));
    for (const Belt belt : kBelts) {
      coordinate.variance_share[belt] = squares(row, as_index(belt)) / squares.row(row).sum();
    }
  }
}

void fill_places(const MeasuredBelts& belts, const FitDiagnostics& view, BeltsFit& fit) {
  std::vector<double> all_mm;
  PerBelt<std::vector<double>> counting_mm;
  for (const auto k : each_index(belts.points)) {
    FittedPlace place{view.frame().state.places[k], view.place_covariance_mm2(k), {}};
    std::vector<BadBeltReading> bad;
    for (const Belt belt : kBelts) {
      BeltResidual& residual = place.belts[belt];
      residual = view.residual(k, belt);
      all_mm.push_back(residual.residual_mm);
      if (residual.counts) {
        counting_mm[belt].push_back(residual.residual_mm);
      } else {
        bad.push_back({k, belt, residual.deleted_residual_mm});
      }
    }
    // Two readings determine a place and leave no check.
    if (bad.size() > 1) {
      fit.bad_points.push_back(k);
    } else {
      append_all(fit.bad, bad);
    }
    fit.places.push_back(std::move(place));
  }
  fit.rms_mm = rms(all_mm);
  for (const Belt belt : kBelts) fit.rms_of_mm[belt] = rms(counting_mm[belt]);
  stable_sort(fit.bad,
              descending([](const BadBeltReading& one) { return std::abs(one.residual_mm); }));
}

/// Residuals of the lower belts of a point from the prediction by the upper ones; nothing if a belt
/// that it takes does not count.
void predict_point(const MeasuredBelts& belts, std::size_t point, const AnchorVector& anchors,
                   const PerBelt<bool>& counting, std::vector<double>& residual_mm) {
  if (!counting.tl || !counting.tr) return;
  const BeltMachine machine = with_anchors(belts.machine, anchors);
  const auto& lengths = belts.points[point].lengths_mm;
  const auto place = place_of_upper(machine, lengths.tl, lengths.tr);
  if (!place) return;
  for (const Belt belt : {Belt::bl, Belt::br}) {
    const auto predicted = reading_at(machine, belt, *place);
    if (counting[belt] && predicted) residual_mm.push_back(lengths[belt] - predicted->length_mm);
  }
}

BeltPrediction summed(const std::vector<double>& residual_mm) {
  const ErrorSummary errors = summary_of(residual_mm);
  return {residual_mm.size(), errors.rms_mm, errors.maximum_mm};
}

/// Each place predicted by anchors fitted without it. Rejected readings are excluded.
BeltPrediction predict_one_by_one(const MeasuredBelts& belts, const FitDiagnostics& view) {
  std::vector<double> residual_mm;
  for (const auto k : each_index(belts.points)) {
    // A taped place is not left out: the tape would still determine it.
    if (!view.is_placed(k) || view.is_taped(k)) continue;
    predict_point(belts, k, view.anchors_without(k), view.frame().counting[k], residual_mm);
  }
  return summed(residual_mm);
}

/// Points in the order of their visits, of the file where that is not known.
Indices in_order(const MeasuredBelts& belts) {
  auto order = numbers_below(belts.points.size());
  stable_sort(order, [&](std::size_t a, std::size_t b) {
    return belts.points[a].order.value_or(as_int(a)) < belts.points[b].order.value_or(as_int(b));
  });
  return order;
}

}  // namespace

BeltScale scale_of(const FrameState& state, const MatrixXd& covariance,
                   std::vector<double> residuals_mm) {
  const double factor = std::exp(state.log_scale);
  return {factor, factor * std::sqrt(covariance(kAnchorUnknowns, kAnchorUnknowns)),
          std::move(residuals_mm)};
}

BeltsFit fit_report(const MeasuredBelts& belts, const FitDiagnostics& view,
                    const MatrixXd& covariance) {
  BeltsFit fit;
  fit.machine = with_anchors(belts.machine, view.frame().state.anchors);
  fit.covariance_mm2 = covariance.topLeftCorner<5, 5>();
  fit.residual_sigma_mm = view.frame().residual_sigma_mm;
  fit.checks = as_int(view.frame().checks);
  fill_coordinates(belts, view, fit);
  fill_places(belts, view, fit);
  if (view.has_scale())
    fit.scale = scale_of(view.frame().state, covariance, view.equations().distance_residual_mm);
  fit.one_left_out = predict_one_by_one(belts, view);
  return fit;
}

std::optional<BeltPrediction> predict_by_halves(const MeasuredBelts& belts, const AnchorFit& frame,
                                                const Refit& refit) {
  if (belts.points.size() < 2 * kFewestBeltPoints) return std::nullopt;
  const Indices order = in_order(belts);
  std::vector<double> residual_mm;
  for (const std::size_t half : {0UL, 1UL}) {
    AnchorFit from = frame;
    for (std::size_t i = half; i < order.size(); i += 2) from.counting[order[i]] = {};
    const auto fitted = refit(from);
    if (!fitted || fitted->frame.checks < 1) return std::nullopt;
    for (std::size_t i = half; i < order.size(); i += 2) {
      predict_point(fitted->belts, order[i], fitted->frame.state.anchors, frame.counting[order[i]],
                    residual_mm);
    }
  }
  return summed(residual_mm);
}

}  // namespace chaintrue::grid::belts
