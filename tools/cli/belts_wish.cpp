// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_wish.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <utility>

#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/random.hpp"

namespace chaintrue::cli {
namespace {

/// Four times as many places is the most that is practical.
constexpr std::size_t kMostTimes = 4;
/// A fit of this many places takes a second (docs/reliability.md).
constexpr std::size_t kMostTried = 400;

/// A session simulated from the fit, with each place visited `times` times and the noise found.
/// Points keep their indices, which distances refer to; further visits of them follow. Its noise is
/// the same in every run.
MeasuredBelts measured_again(const MeasuredBelts& belts, const BeltsFit& fit, std::size_t times) {
  constexpr std::uint64_t kSeed = 31;
  grid::Random random(kSeed, times);
  MeasuredBelts result = belts;
  result.points.clear();
  const int factor = static_cast<int>(times);
  for (int visit = 0; visit < factor; ++visit) {
    for (std::size_t k = 0; k < belts.points.size(); ++k) {
      grid::BeltPoint point = belts.points[k];
      for (const model::Belt belt : model::kBelts) {
        point.lengths_mm[belt] +=
            fit.residual_sigma_mm * random.normal() - fit.places[k].belts[belt].residual_mm;
      }
      if (point.order) point.order = factor * *point.order + visit;
      result.points.push_back(std::move(point));
    }
  }
  return result;
}

struct AnchorsAndError {
  BeltsFit fit;
  std::optional<BeltsError> error;
};

std::optional<AnchorsAndError> fit_again(const MeasuredBelts& belts,
                                         const std::vector<grid::BeltHoles>& cut) {
  if (cut.empty()) {
    auto fit = diagnosis::fit_with_causes(belts);
    if (!fit) return std::nullopt;
    const auto error = grid::error_of_belts(*fit);
    return AnchorsAndError{*std::move(fit), error};
  }
  auto fit = diagnosis::fit_with_causes_and_holes(belts, cut);
  if (!fit) return std::nullopt;
  const auto error = grid::error_of_belts(fit->belts, &fit->holes);
  return AnchorsAndError{std::move(fit->belts), error};
}

/// The error to expect of such a session. The noise that its fit finds is a sample of the simulated
/// noise, and the error scales with it, so it is corrected for that. Empty without a fit.
std::optional<double> expected_of_places(const MeasuredBelts& belts,
                                         const std::vector<grid::BeltHoles>& cut,
                                         double noise_mm) {
  const auto again = fit_again(belts, cut);
  if (!again || !again->error || !(again->fit.residual_sigma_mm > 0.0)) return std::nullopt;
  return again->error->expected.rms_mm * noise_mm / again->fit.residual_sigma_mm;
}

/// After compensating the displacement that the holes show; empty if none was found.
std::optional<double> expected_when_compensated(const files::FittedAnchors& found) {
  if (!found.holes || !found.holes->displacement) return std::nullopt;
  grid::HolesWithBelts level = *found.holes;
  level.displacement.reset();
  const auto error = grid::error_of_belts(found.fit, &level);
  return error ? std::optional(error->expected.rms_mm) : std::nullopt;
}

}  // namespace

std::string belts_wish_sentence(const MeasuredBelts& belts,
                                const std::vector<grid::BeltHoles>& cut,
                                const files::FittedAnchors& found,
                                const std::optional<BeltsError>& error,
                                double wish_mm) {
  const std::string wish = fmt::format("Your target is {:g} mm: ", wish_mm);
  if (!error) return wish + "these readings do not show whether it is reached.";
  if (error->expected.rms_mm <= wish_mm)
    return wish +
           (found.fit.scale ? "reached." : "reached. Only a taped distance shows the scale.");
  const auto compensated = expected_when_compensated(found);
  if (compensated && *compensated <= wish_mm)
    return wish +
           "not reached with anchors alone. Compensated programs (gcode compensate) reach it.";
  const std::size_t places = belts.points.size();
  if (places == 0)
    return wish + "not reached. More distances or a better tape would reduce the error.";
  const double noise_mm = found.fit.residual_sigma_mm;
  const auto once = expected_of_places(measured_again(belts, found.fit, 1), cut, noise_mm);
  if (!once || 2 * places > kMostTried)
    return wish +
           "not reached. The number of places needed was not computed, because there are too many "
           "already.";
  std::size_t tried = 0;
  for (std::size_t times = 2; times <= kMostTimes && times * places <= kMostTried; ++times) {
    tried = times * places;
    const auto then = expected_of_places(measured_again(belts, found.fit, times), cut, noise_mm);
    if (then && error->expected.rms_mm * *then <= wish_mm * *once) {
      return wish +
             fmt::format("not reached. About {} places measured as accurately as these would reach "
                         "it.",
                         tried);
    }
  }
  return wish + fmt::format(
                    "not reached, not even with {} places measured as accurately as these. To look "
                    "for other causes, run chaintrue diagnose on the same belts.",
                    tried);
}

}  // namespace chaintrue::cli
