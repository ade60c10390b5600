// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_fit.hpp"

#include <fmt/format.h>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/belts/repeated_pulls.hpp"
#include "grid/failed.hpp"

namespace chaintrue::grid {

namespace {

/// An anchor with a larger sigma was not determined: an arm's length.
constexpr double kLostAnchorMm = 100.0;
/// Readings with a larger rms residual do not belong to one frame: the machine itself gives up at 5
/// mm of its own measure.
constexpr double kNoFrameMm = 50.0;

tl::unexpected<BeltsFitFailure> not_determined(const MeasuredBelts& belts) {
  const std::string pulls = repeated_pulls_in_words(belts);
  return failed(
      BeltsFitFailure::Reason::not_determined,
      fmt::format("the places do not determine the anchors, because they lie on a line or in one "
                  "spot. Measure at places spread over the sheet's width and height{}{}",
                  pulls.empty() ? "" : ". ", pulls));
}

/// No belt's readings differ by more than this: all places are in one spot.
bool are_in_one_spot(const MeasuredBelts& belts) {
  constexpr double kSpotMm = 50.0;
  return all_of(kBelts, [&](Belt belt) {
    const auto length_mm = [&](const BeltPoint& point) { return point.lengths_mm[belt]; };
    const auto [least, most] = minmax_element(belts.points, ascending(length_mm));
    return length_mm(*most) - length_mm(*least) < kSpotMm;
  });
}

}  // namespace

tl::expected<BeltsFit, BeltsFitFailure> fit_belts(const MeasuredBelts& belts) {
  using Reason = BeltsFitFailure::Reason;
  if (belts.points.size() < kFewestBeltPoints) {
    return failed(Reason::too_few_points,
                  fmt::format("{} places are too few: {} give {} checks for five anchor "
                              "coordinates; measure at more places",
                              belts.points.size(), kFewestBeltPoints, 2 * kFewestBeltPoints - 5));
  }
  const bool has_holes = any_of(belts.distances, [](const BeltDistance& distance) {
    return std::holds_alternative<CutHole>(distance.from) ||
           std::holds_alternative<CutHole>(distance.to);
  });
  if (has_holes && !belts.machine.anchors_known) {
    return failed(Reason::hole_without_anchors,
                  "a distance ends at a hole, whose position depends on the anchors in force when "
                  "it was cut: state x_mm and y_mm of these anchors");
  }
  const auto frame = belts::fit_anchors_robustly(belts);
  constexpr const char* kNoFrame =
      "no four anchors fit these lengths: are they from one frame, in mm, each under its own belt?";
  if (!frame)
    return are_in_one_spot(belts) ? not_determined(belts) : failed(Reason::no_frame, kNoFrame);
  const FitDiagnostics view(belts, *frame);
  if (frame->residual_sigma_mm > kNoFrameMm) {
    return failed(Reason::no_frame,
                  fmt::format("the lengths contradict each other by {:.0f} mm whatever the "
                              "anchors: are they from one frame, in mm, each under its own belt?",
                              frame->residual_sigma_mm));
  }
  const VectorXd variance = view.covariance().diagonal().head<5>();
  if (!view.covariance().allFinite() || variance.minCoeff() <= 0.0 ||
      variance.maxCoeff() > kLostAnchorMm * kLostAnchorMm ||
      belts::are_on_a_line(frame->state.places)) {
    return not_determined(belts);
  }
  if (!frame->is_sound) return failed(Reason::no_frame, kNoFrame);
  BeltsFit fit = fit_report(belts, view, view.covariance());
  fit.half_left_out = predict_by_halves(
      belts, *frame, [&belts](const AnchorFit& from) -> std::optional<belts::Refitted> {
        auto fitted = fit_anchors_from(without_distances(belts), from.state, from.counting);
        if (!fitted) return std::nullopt;
        return belts::Refitted{*std::move(fitted), belts};
      });
  return fit;
}

}  // namespace chaintrue::grid
