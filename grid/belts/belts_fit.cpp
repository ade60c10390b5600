// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/belts/prediction.hpp"
#include "grid/belts/repeated_pulls.hpp"

namespace chaintrue::grid {

using model::Belt;
using model::kBelts;

namespace {

/// An anchor that is less sure than this was not found: an arm's length.
constexpr double kLostAnchorMm = 100.0;
/// Lengths whose rms residual is larger are no readings of four belts of one frame: the machine
/// itself gives up at 5 mm of its own kind.
constexpr double kNoFrameMm = 50.0;

constexpr std::array<std::string_view, 5> kCoordinateNames = {
    "tl_x_mm", "tl_y_mm", "tr_x_mm", "tr_y_mm", "br_x_mm"};

void fill_coordinates(const MeasuredBelts& belts,
                      const belts::FitDiagnostics& view,
                      BeltsFit& fit) {
  const belts::AnchorVector stated = belts::anchors_of(belts.machine);
  const belts::AnchorVector fitted = belts::anchors_of(fit.machine);
  Eigen::Matrix<double, 5, 4> squares = Eigen::Matrix<double, 5, 4>::Zero();
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (!view.counts(k, belt)) continue;
      squares.col(static_cast<Eigen::Index>(belt)) += view.influence(k, belt).head<5>().cwiseAbs2();
    }
  }
  for (std::size_t i = 0; i < fit.coordinates.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    AnchorCoordinate& coordinate = fit.coordinates[i];
    coordinate.name = kCoordinateNames[i];
    if (belts.machine.anchors_known) coordinate.stated_mm = stated[row];
    coordinate.fitted_mm = fitted[row];
    coordinate.sigma_mm = std::sqrt(fit.covariance_mm2(row, row));
    for (const Belt belt : kBelts) {
      coordinate.variance_share[belt] =
          squares(row, static_cast<Eigen::Index>(belt)) / squares.row(row).sum();
    }
  }
}

void fill_places(const MeasuredBelts& belts,
                 const belts::AnchorFit& frame,
                 const belts::FitDiagnostics& view,
                 BeltsFit& fit) {
  double square = 0.0;
  model::PerBelt<double> squares;
  model::PerBelt<int> counts;
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    FittedPlace place{frame.state.places[k], view.place_covariance_mm2(k), {}};
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
    // Two readings fix a place and check nothing.
    if (bad.size() > 1) {
      fit.bad_points.push_back(k);
    } else {
      fit.bad.insert(fit.bad.end(), bad.begin(), bad.end());
    }
    fit.places.push_back(std::move(place));
  }
  fit.rms_mm = std::sqrt(square / (4.0 * static_cast<double>(belts.points.size())));
  for (const Belt belt : kBelts) {
    fit.rms_of_mm[belt] = counts[belt] > 0 ? std::sqrt(squares[belt] / counts[belt]) : 0.0;
  }
  std::stable_sort(fit.bad.begin(), fit.bad.end(), [](const auto& a, const auto& b) {
    return std::abs(a.residual_mm) > std::abs(b.residual_mm);
  });
}

void fill_scale(const MeasuredBelts& belts,
                const belts::AnchorFit& frame,
                const belts::FitDiagnostics& view,
                BeltsFit& fit) {
  if (!view.has_scale()) return;
  BeltScale scale;
  scale.factor = std::exp(frame.state.log_scale);
  scale.sigma =
      scale.factor * std::sqrt(view.covariance()(belts::kAnchorUnknowns, belts::kAnchorUnknowns));
  for (std::size_t i = 0; i < belts.distances.size(); ++i) {
    scale.residuals_mm.push_back(view.equations().distance_residual[static_cast<Eigen::Index>(i)] *
                                 belts.distances[i].sigma_mm);
  }
  fit.scale = std::move(scale);
}

tl::unexpected<BeltsFitFailure> failure(BeltsFitFailure::Reason reason, std::string sentence) {
  return tl::unexpected(BeltsFitFailure{reason, std::move(sentence)});
}

tl::unexpected<BeltsFitFailure> not_determined(const MeasuredBelts& belts) {
  const std::string pulls = repeated_pulls_in_words(belts);
  return failure(
      BeltsFitFailure::Reason::not_determined,
      fmt::format(
          "the places do not tell where the anchors are: they lie on a line, or all in one "
          "spot; measure at places spread over the sheet's width and height{}{}",
          pulls.empty() ? "" : ". ",
          pulls));
}

/// No belt's readings differ by more than the width of a spot: no frame can be made of them.
bool are_in_one_spot(const MeasuredBelts& belts) {
  constexpr double kSpotMm = 50.0;
  return std::all_of(kBelts.begin(), kBelts.end(), [&](Belt belt) {
    const auto [least, most] = std::minmax_element(
        belts.points.begin(), belts.points.end(), [&](const BeltPoint& a, const BeltPoint& b) {
          return a.lengths_mm[belt] < b.lengths_mm[belt];
        });
    return most->lengths_mm[belt] - least->lengths_mm[belt] < kSpotMm;
  });
}

}  // namespace

tl::expected<BeltsFit, BeltsFitFailure> fit_belts(const MeasuredBelts& belts) {
  using Reason = BeltsFitFailure::Reason;
  if (belts.points.size() < kFewestBeltPoints) {
    return failure(Reason::too_few_points,
                   fmt::format("{} places are too few: {} leave {} checks of five anchor "
                               "coordinates; measure at more places",
                               belts.points.size(),
                               kFewestBeltPoints,
                               2 * kFewestBeltPoints - 5));
  }
  const bool has_holes =
      std::any_of(belts.distances.begin(), belts.distances.end(), [](const BeltDistance& distance) {
        return std::holds_alternative<CutHole>(distance.from) ||
               std::holds_alternative<CutHole>(distance.to);
      });
  if (has_holes && !belts.machine.anchors_known) {
    return failure(Reason::hole_without_anchors,
                   "a distance ends at a hole, and where the machine cut that follows from the "
                   "anchors that it had at the time: state x_mm and y_mm of the anchors in force");
  }
  const auto frame = belts::fit_anchors_robustly(belts);
  constexpr const char* kNoFrame =
      "no four anchors make sense of these lengths: are they of one frame, in mm, each under its "
      "own "
      "belt?";
  if (!frame)
    return are_in_one_spot(belts) ? not_determined(belts) : failure(Reason::no_frame, kNoFrame);
  const belts::FitDiagnostics view(belts, *frame);
  if (frame->residual_sigma_mm > kNoFrameMm) {
    return failure(Reason::no_frame,
                   fmt::format("the lengths contradict each other by {:.0f} mm whatever the "
                               "anchors: are they of one frame, in mm, each under its own belt?",
                               frame->residual_sigma_mm));
  }
  const Eigen::VectorXd variance = view.covariance().diagonal().head<5>();
  if (!view.covariance().allFinite() || variance.minCoeff() <= 0.0 ||
      variance.maxCoeff() > kLostAnchorMm * kLostAnchorMm ||
      belts::are_on_a_line(frame->state.places)) {
    return not_determined(belts);
  }
  if (!frame->is_sound) return failure(Reason::no_frame, kNoFrame);
  BeltsFit fit;
  fit.machine = belts::with_anchors(belts.machine, frame->state.anchors);
  fit.covariance_mm2 = view.covariance().topLeftCorner<5, 5>();
  fit.residual_sigma_mm = frame->residual_sigma_mm;
  fit.checks = static_cast<int>(frame->checks);
  fill_coordinates(belts, view, fit);
  fill_places(belts, *frame, view, fit);
  fill_scale(belts, *frame, view, fit);
  fit.one_left_out = belts::predict_one_by_one(belts, view);
  fit.half_left_out = belts::predict_by_halves(belts, *frame);
  return fit;
}

}  // namespace chaintrue::grid
