// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/anchors_with_causes.hpp"

#include <algorithm>
#include <cmath>

#include "grid/belts/fit_report.hpp"
#include "grid/diagnosis/belts_report.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using belts::AnchorFit;
using belts::FitDiagnostics;
using belts::kAnchorUnknowns;
using model::Belt;
using model::kBelts;

/// Places, and the spread about them.
void place_and_judge(const MeasuredBelts& without_causes, std::size_t sizes, AnchorFit& frame) {
  const MeasuredBelts untaped = without_distances(without_causes);
  belts::place_all(untaped, frame);
  frame.checks = std::max<Index>(belts::checks_of(frame.counting) - as_index(sizes), 1);
  const belts::ReadingLines lines = belts::reading_lines(untaped, frame.state);
  double square = 0.0;
  for (std::size_t k = 0; k < frame.counting.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (frame.counting[k][belt]) square += std::pow(lines.residual_mm[belts::row_of(k, belt)], 2);
    }
  }
  frame.residual_sigma_mm =
      std::max(std::sqrt(square / as_double(frame.checks)), belts::kLeastSpreadMm);
}

/// (1) of anchors_with_causes.hpp. \returns the covariance of anchors and scale; empty if the
/// distances do not converge.
std::optional<MatrixXd> take_distances(const MeasuredBelts& without_causes,
                                       const AveragedAnchors& averaged, AnchorFit& frame) {
  const MeasuredBelts untaped = without_distances(without_causes);
  const auto alone = belts::fit_anchors_from(untaped, frame.state, frame.counting);
  const auto taped = belts::fit_anchors_from(without_causes, frame.state, frame.counting);
  if (!alone || !taped || !taped->is_sound) return std::nullopt;
  constexpr Index kAll = kAnchorUnknowns + 1;
  const MatrixXd own = FitDiagnostics(untaped, *alone).precision();
  const MatrixXd with_tape = FitDiagnostics(without_causes, *taped).precision();
  const MatrixXd known = linear::Cholesky(averaged.covariance_mm2).inverse();
  VectorXd there(kAll);
  there << taped->state.anchors, taped->state.log_scale;
  MatrixXd precision = with_tape;
  precision.topLeftCorner(kAnchorUnknowns, kAnchorUnknowns) += known - own;
  VectorXd sum = with_tape * there;
  sum.head(kAnchorUnknowns) += known * averaged.anchors - own * alone->state.anchors;
  const linear::PivotedCholesky factor(precision);
  const VectorXd found = factor.solve(sum);
  frame.state.anchors = found.head<kAnchorUnknowns>();
  frame.state.log_scale = found[kAnchorUnknowns];
  belts::place_all(without_causes, frame);
  return factor.inverse();
}

/// Clamped, because an average over models may be slightly outside the parameter's range.
CauseInAnchorFit cause_in_fit(const AveragedCause& own) {
  CauseInAnchorFit result;
  result.effect = own.cause.cause.effect->id;
  result.side = name(own.cause.cause.side);
  for (std::size_t i = 0; i < own.cause.values.size(); ++i) {
    const auto& parameter = own.cause.cause.effect->parameters[i];
    result.parameters[std::string(parameter.name)] =
        std::clamp(own.cause.values[i], parameter.lower, parameter.upper);
  }
  result.sigma = own.sigma;
  result.probability = own.probability;
  return result;
}

/// A fit, with the prior it gives for holes.
struct AnchorsWithCauses {
  BeltsByThemselves alone;
  MeasuredBelts without_causes;
};

tl::expected<AnchorsWithCauses, BeltsFitFailure> fit_anchors_with_causes(
    const BeltsAnalysis& analysis) {
  const MeasuredBelts& belts = analysis.measured;
  const AveragedAnchors& averaged = analysis.averaged;
  std::vector<CauseInAnchorFit> causes;
  std::vector<SizedCause> sizes;
  for (const AveragedCause& own : averaged.causes) {
    causes.push_back(cause_in_fit(own));
    sizes.push_back(own.cause);
  }
  AnchorFit frame = analysis.frame;
  frame.counting = decided_counting(analysis);
  frame.state.anchors = averaged.anchors;
  MeasuredBelts without_causes = without_effects(belts, sizes, frame.state);
  place_and_judge(without_causes, sizes.size(), frame);
  MatrixXd covariance = averaged.covariance_mm2;
  if (!belts.distances.empty()) {
    const auto with_scale = take_distances(without_causes, averaged, frame);
    // Distances without positions with these readings: the contradiction shows with the uncorrected
    // readings.
    if (!with_scale) {
      return fit_by_themselves(belts).map([&](BeltsByThemselves as_read) {
        return AnchorsWithCauses{std::move(as_read), belts};
      });
    }
    covariance = *with_scale;
  }
  BeltsFit fit =
      belts::fit_report(without_causes, FitDiagnostics(without_causes, frame), covariance);
  fit.causes = std::move(causes);
  fit.rms_mm = analysis.before.rms_mm;
  fit.half_left_out = prediction_by_halves(analysis.belts, frame, sizes);
  return AnchorsWithCauses{{std::move(fit), std::move(frame), std::move(covariance)},
                           std::move(without_causes)};
}

}  // namespace

tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(const BeltsAnalysis& analysis) {
  return fit_anchors_with_causes(analysis).map(
      [](AnchorsWithCauses found) { return std::move(found.alone.fit); });
}

tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(const MeasuredBelts& belts) {
  return analyse(belts, {}).and_then(
      [](const BeltsAnalysis& analysis) { return fit_with_causes(analysis); });
}

tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_with_causes_and_holes(
    const MeasuredBelts& belts, const std::vector<BeltHoles>& sets) {
  if (belts.points.empty()) return fit_belts_and_holes(belts, sets);
  return analyse(belts, {})
      .and_then(fit_anchors_with_causes)
      .and_then([&sets](AnchorsWithCauses found) {
        return fit_belts_and_holes(found.without_causes, sets, std::move(found.alone));
      });
}

}  // namespace chaintrue::grid::diagnosis
