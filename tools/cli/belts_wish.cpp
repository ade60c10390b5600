// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_wish.hpp"

#include <fmt/format.h>

#include <cstddef>

#include "grid/diagnosis/anchors_with_causes.hpp"

namespace chaintrue::cli {
namespace {

/// Nobody measures more than four times as many places as before.
constexpr std::size_t kMostTimes = 4;
/// A fit of so many places takes a second (docs/reliability.md).
constexpr std::size_t kMostTried = 400;

/// Each place `times` times over, one visit behind the other. Points keep their indices, which
/// distances refer to; further visits of them follow.
grid::MeasuredBelts measured_again(const grid::MeasuredBelts& belts, std::size_t times) {
  grid::MeasuredBelts result = belts;
  result.points.clear();
  const int factor = static_cast<int>(times);
  for (int visit = 0; visit < factor; ++visit) {
    for (grid::BeltPoint point : belts.points) {
      if (point.order) point.order = factor * *point.order + visit;
      result.points.push_back(std::move(point));
    }
  }
  return result;
}

/// Of a fit with so many places; nothing where there is none.
std::optional<double> expected_with(const grid::MeasuredBelts& belts,
                                    const std::vector<grid::BeltHoles>& cut) {
  if (cut.empty()) {
    const auto fit = grid::diagnosis::fit_with_causes(belts);
    const auto error = fit ? grid::error_of_belts(*fit) : std::nullopt;
    return error ? std::optional(error->expected.rms_mm) : std::nullopt;
  }
  const auto fit = grid::diagnosis::fit_with_causes_and_holes(belts, cut);
  const auto error = fit ? grid::error_of_belts(fit->belts, &fit->holes) : std::nullopt;
  return error ? std::optional(error->expected.rms_mm) : std::nullopt;
}

/// With the displacement that the holes show taken out, as compensated programs do; nothing where
/// none was found.
std::optional<double> expected_when_compensated(const grid::files::FittedAnchors& found) {
  if (!found.holes || !found.holes->displacement) return std::nullopt;
  grid::HolesWithBelts level = *found.holes;
  level.displacement.reset();
  const auto error = grid::error_of_belts(found.fit, &level);
  return error ? std::optional(error->expected.rms_mm) : std::nullopt;
}

}  // namespace

std::string belts_wish_sentence(const grid::MeasuredBelts& belts,
                                const std::vector<grid::BeltHoles>& cut,
                                const grid::files::FittedAnchors& found,
                                const std::optional<grid::BeltsError>& error,
                                double wish_mm) {
  const std::string wish = fmt::format("You wish for {:g} mm: ", wish_mm);
  if (!error) return wish + "these readings cannot say whether that is reached.";
  if (error->expected.rms_mm <= wish_mm)
    return wish + (found.fit.scale ? "reached." : "reached, apart from the scale.");
  const auto compensated = expected_when_compensated(found);
  if (compensated && *compensated <= wish_mm)
    return wish + "not reached by anchors alone. Programs that are compensated (gcode compensate) reach it.";
  const std::size_t places = belts.points.size();
  if (places == 0) return wish + "not reached. More distances, or a better tape, would bring it down.";
  std::size_t tried = 0;
  for (std::size_t times = 2; times <= kMostTimes && times * places <= kMostTried; ++times) {
    tried = times * places;
    const auto then = expected_with(measured_again(belts, times), cut);
    if (then && *then <= wish_mm) {
      return wish + fmt::format("not reached. About {} places measured as well as these would reach it.", tried);
    }
  }
  return wish + fmt::format("not reached{}. Look for what else is wrong: chaintrue diagnose of the same belts.",
                            tried == 0 ? std::string{}
                                       : fmt::format(", and not by {} places measured as well as these", tried));
}

}  // namespace chaintrue::cli
