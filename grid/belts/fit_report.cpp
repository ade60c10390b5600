// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/fit_report.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/map/error_summary.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::Belt;
using model::kBelts;

namespace {

void fill_coordinates(const MeasuredBelts& belts, const FitDiagnostics& view, BeltsFit& fit) {
  const AnchorVector stated = anchors_of(belts.machine);
  const AnchorVector fitted = anchors_of(fit.machine);
  Eigen::Matrix<double, 5, 4> squares = Eigen::Matrix<double, 5, 4>::Zero();
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (!view.counts(k, belt)) continue;
      squares.col(static_cast<Index>(belt)) += view.influence(k, belt).head<5>().cwiseAbs2();
    }
  }
  for (std::size_t i = 0; i < fit.coordinates.size(); ++i) {
    const auto row = as_index(i);
    AnchorCoordinate& coordinate = fit.coordinates[i];
    coordinate.name = kCoordinateNames[i];
    if (belts.machine.anchors_known) coordinate.stated_mm = stated[row];
    coordinate.fitted_mm = fitted[row];
    coordinate.sigma_mm = std::sqrt(fit.covariance_mm2(row, row));
    for (const Belt belt : kBelts) {
      coordinate.variance_share[belt] =
          squares(row, static_cast<Index>(belt)) / squares.row(row).sum();
    }
  }
}

void fill_places(const MeasuredBelts& belts, const FitDiagnostics& view, BeltsFit& fit) {
  double square = 0.0;
  model::PerBelt<double> squares;
  model::PerBelt<int> counts;
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    FittedPlace place{view.frame().state.places[k], view.place_covariance_mm2(k), {}};
    std::vector<BadBeltReading> bad;
    for (const Belt belt : kBelts) {
      BeltResidual& residual = place.belts[belt];
      residual = view.residual(k, belt);
      square += residual.residual_mm * residual.residual_mm;
      if (residual.counts) {
        squares[belt] += residual.residual_mm * residual.residual_mm;
        ++counts[belt];
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
  fit.rms_mm = std::sqrt(square / (4.0 * as_double(belts.points.size())));
  for (const Belt belt : kBelts) {
    fit.rms_of_mm[belt] = counts[belt] > 0 ? std::sqrt(squares[belt] / counts[belt]) : 0.0;
  }
  stable_sort(fit.bad,
              descending([](const BadBeltReading& one) { return std::abs(one.residual_mm); }));
}

void fill_scale(const MeasuredBelts& belts, const FitDiagnostics& view, const MatrixXd& covariance,
                BeltsFit& fit) {
  if (!view.has_scale()) return;
  BeltScale scale;
  scale.factor = std::exp(view.frame().state.log_scale);
  scale.sigma = scale.factor * std::sqrt(covariance(kAnchorUnknowns, kAnchorUnknowns));
  for (std::size_t i = 0; i < belts.distances.size(); ++i) {
    scale.residuals_mm.push_back(view.equations().distance_residual[as_index(i)] *
                                 belts.distances[i].sigma_mm);
  }
  fit.scale = std::move(scale);
}

/// Residuals of the lower belts of a point from the prediction by the upper ones; nothing if a belt
/// that it takes does not count.
void predict_point(const MeasuredBelts& belts, std::size_t point, const AnchorVector& anchors,
                   const model::PerBelt<bool>& counting, std::vector<double>& residual_mm) {
  if (!counting.tl || !counting.tr) return;
  const model::BeltMachine machine = with_anchors(belts.machine, anchors);
  const auto& lengths = belts.points[point].lengths_mm;
  const auto place = model::place_of_upper(machine, lengths.tl, lengths.tr);
  if (!place) return;
  for (const Belt belt : {Belt::bl, Belt::br}) {
    const auto predicted = model::reading_at(machine, belt, *place);
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
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    // A taped place is not left out: the tape would still determine it.
    if (!view.is_placed(k) || view.is_taped(k)) continue;
    predict_point(belts, k, view.anchors_without(k), view.frame().counting[k], residual_mm);
  }
  return summed(residual_mm);
}

/// Points in the order of their visits, of the file where that is not known.
std::vector<std::size_t> in_order(const MeasuredBelts& belts) {
  auto order = numbers_below(belts.points.size());
  stable_sort(order, [&](std::size_t a, std::size_t b) {
    return belts.points[a].order.value_or(static_cast<int>(a)) <
           belts.points[b].order.value_or(static_cast<int>(b));
  });
  return order;
}

}  // namespace

BeltsFit fit_report(const MeasuredBelts& belts, const FitDiagnostics& view,
                    const MatrixXd& covariance) {
  BeltsFit fit;
  fit.machine = with_anchors(belts.machine, view.frame().state.anchors);
  fit.covariance_mm2 = covariance.topLeftCorner<5, 5>();
  fit.residual_sigma_mm = view.frame().residual_sigma_mm;
  fit.checks = static_cast<int>(view.frame().checks);
  fill_coordinates(belts, view, fit);
  fill_places(belts, view, fit);
  fill_scale(belts, view, covariance, fit);
  fit.one_left_out = predict_one_by_one(belts, view);
  return fit;
}

std::optional<BeltPrediction> predict_by_halves(const MeasuredBelts& belts, const AnchorFit& frame,
                                                const Refit& refit) {
  if (belts.points.size() < 2 * kFewestBeltPoints) return std::nullopt;
  const std::vector<std::size_t> order = in_order(belts);
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
