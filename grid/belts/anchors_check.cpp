// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchors_check.hpp"

#include <fmt/format.h>

#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/failed.hpp"
#include "grid/map/lengths_check.hpp"
#include "grid/statistics.hpp"
#include "model/belts/belt_mechanism.hpp"

namespace chaintrue::grid {
namespace {

std::string words_of_belts(const CheckHypothesis& h) {
  if (h.what == model::Change::zero && h.side.empty())
    return fmt::format("the zero of all four belts has shifted by {:+.1f} mm", h.size());
  const auto belt = words(model::belt_of(h.side).value());
  if (h.what == model::Change::zero)
    return fmt::format("the zero of the {} belt has shifted by {:+.1f} mm", belt, h.size());
  return fmt::format("the {} anchor has moved by some {:.1f} mm against the others", belt,
                     h.size());
}

CheckWords words_of_anchors() {
  return {"the anchors",
          "places",
          "The anchors are still valid",
          "The anchors are valid after retracting and extending the belts again",
          "Find the anchors again",
          words_of_belts};
}

}  // namespace

tl::expected<Check, CheckFailure> check_anchors(const BeltsFit& fit, const MeasuredBelts& belts) {
  using Reason = CheckFailure::Reason;
  if (fit.checks < 1 || !(fit.residual_sigma_mm > 0.0)) {
    return failed(
        Reason::no_noise,
        "these anchors were not fitted to belts, so the accuracy of new readings is unknown: fit "
        "belts, and check against those anchors");
  }
  std::vector<AppliedEffect> effects;
  for (const CauseInAnchorFit& cause : fit.causes)
    effects.push_back({cause.effect, cause.side, cause.parameters});
  const auto mechanism = make_belt_mechanism(with_anchors(belts.machine, anchors_of(fit.machine)))
                             ->with_effects(effects);
  const Counting all(belts.points.size(), kAllBelts);
  const auto check =
      check_lengths({mechanism, fit.covariance_mm2, fit.residual_sigma_mm, as_double(fit.checks)},
                    belts::readings_of(belts, all).readings(), words_of_anchors());
  // More than three turns of an encoder: a different frame rather than a changed one.
  constexpr double kAnotherFrameMm = 130.0;
  if (!check || !(rms(mapped(check->residuals, &CheckResidual::residual_mm)) < kAnotherFrameMm)) {
    return failed(
        Reason::nowhere,
        "the new lengths do not fit these anchors: are they from this frame, and is \"lengths\" "
        "right in their file?");
  }
  return check;
}

}  // namespace chaintrue::grid
