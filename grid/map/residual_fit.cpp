// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/residual_fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/map/lattice_residual.hpp"
#include "grid/map/noise_from_repeats.hpp"
#include "grid/map/points_map.hpp"
#include "grid/observation/length_points.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

/// A stated noise of zero means readings with all digits; this much is left of it and of any finer
/// one. Beside settings known to a millimetre the squares of finer weights leave no digit for what
/// the points do not tell: at 1e-6 mm the fit is taken for undetermined.
constexpr double kLeastNoiseMm = 1e-5;

/// The bed, as far as hand-laid marks may lie beside it, and all points.
interp::Rectangle domain_of(const MeasuredGrid& grid, const std::vector<LengthPoint>& points) {
  const model::Bed& bed = grid.machine->bed;
  double beyond = 0.0;
  if (grid.sheet)
    beyond = 2.0 * grid.sheet->shift_mm + 1e-3 * grid.sheet->rotation_mrad * 0.5 * bed.width_mm;
  interp::Rectangle domain{-0.5 * bed.width_mm - beyond,
                           0.5 * bed.width_mm + beyond,
                           -0.5 * bed.height_mm - beyond,
                           0.5 * bed.height_mm + beyond};
  for (const LengthPoint& point : points) {
    domain.x_min = std::min(domain.x_min, point.mark.x_mm);
    domain.x_max = std::max(domain.x_max, point.mark.x_mm);
    domain.y_min = std::min(domain.y_min, point.mark.y_mm);
    domain.y_max = std::max(domain.y_max, point.mark.y_mm);
  }
  return domain;
}

/// What a fit tells of itself: where the noise is to be found, too, it takes two steps more.
WorkStep first_step(bool noise_stated) {
  return {"settings and correction", 1, noise_stated ? 2 : 4};
}
constexpr WorkStep kSmoother{"a smoother correction", 2, 4};
constexpr WorkStep kNoise{"how large the noise is", 3, 4};
WorkStep last_step(bool noise_stated) {
  const int steps = first_step(noise_stated).of;
  return {"the map's own error", steps, steps};
}

bool states_noise(const MeasuredGrid& grid) {
  return grid.noise && (grid.noise->length_mm > 0.0 || grid.noise->position_mm > 0.0);
}

/// Readings with all their digits, as a simulator or a very good measurement gives them, bear a
/// smoother surface than noisy ones. It is taken where it predicts left-out points a fifth better;
/// then `input` says so.
void prefer_smoother(PointsFitInput& input, PointsFit& joint) {
  constexpr double kClearlyBetter = 0.8;
  PointsFitInput smoother = input;
  smoother.bending_order = 3;
  smoother.step = kSmoother;
  auto fit = fit_points(smoother);
  if (!fit) return;
  const double before = held_out_accuracy(joint.points).leave_one_out.chain.rms_mm;
  if (held_out_accuracy(fit->points).leave_one_out.chain.rms_mm > kClearlyBetter * before) return;
  input = std::move(smoother);
  joint = *std::move(fit);
}

/// A surface through every node leaves nothing there, and has left-out residuals of its own.
void tell_residuals(PointsFit& joint, const LatticeFit& lattice) {
  for (std::size_t i = 0; i < joint.points.size(); ++i) {
    if (joint.points[i].bad) continue;
    joint.points[i].residual_mm.setZero();
    joint.points[i].left_out_residual_mm = lattice.left_out_residual_mm[i];
  }
}

/// A map that keeps less than two thirds of its points is not the map of those points.
tl::expected<void, FitFailure> check_enough_good(const PointsFit& joint) {
  const auto good = std::count_if(joint.points.begin(),
                                  joint.points.end(),
                                  [](const FittedPoint& point) { return !point.bad; });
  const auto all = static_cast<std::ptrdiff_t>(joint.points.size());
  if (3 * good >= 2 * all && good >= 6) return {};
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      fmt::format("{} of {} points contradict the others or the machine as stated; check the "
                  "machine's measures, the order of the columns and the units",
                  all - good,
                  all)});
}

/// Of points whose noise nobody stated: how smooth the surface is, and how large the noise.
tl::expected<void, FitFailure> find_noise(FittedGrid& fitted) {
  prefer_smoother(fitted.input, fitted.fit);
  const auto repeats = noise_from_repeats(fitted.fit, fitted.input.noise);
  if (repeats) {
    fitted.input.noise.length_mm *= repeats->factor;
    fitted.input.noise.position_mm *= repeats->factor;
    fitted.input.noise_scale = {interp::NoiseKnowledge::from_repeats, repeats->dof};
    fitted.noise_source = "repeats";
    fitted.input.step = kNoise;
    auto fit = fit_points(fitted.input);
    if (!fit) return tl::unexpected(failure_of(fit.error()));
    fitted.fit = *std::move(fit);
    return {};
  }
  PointsFit plain = with_plain_calibration(fitted.input, fitted.fit);
  if (auto lattice = fit_lattice(plain)) {
    fitted.fit = std::move(plain);
    tell_residuals(fitted.fit, *lattice);
    fitted.lattice = std::move(lattice->residual);
  }
  return {};
}

}  // namespace

PointsFitInput points_input(const MeasuredGrid& grid, const std::vector<LengthPoint>& points) {
  PointsFitInput input;
  input.machine = with_readings(*grid.machine, grid.readings);
  input.points = points;
  // A stated noise of nothing at all states nothing: it is found from the points.
  if (states_noise(grid)) {
    input.noise = {std::max(grid.noise->length_mm, kLeastNoiseMm),
                   std::max(grid.noise->position_mm, kLeastNoiseMm)};
    input.noise_scale = {interp::NoiseKnowledge::from_repeats, grid.noise->dof};
  } else {
    input.noise_scale = {interp::NoiseKnowledge::unknown, 0.0};
  }
  input.sheet = grid.sheet;
  input.readings = setting_readings(grid.readings);
  input.domain = domain_of(grid, points);
  return input;
}

tl::expected<void, FitFailure> check_machine_read(const MeasuredGrid& grid) {
  const model::Machine machine = with_readings(*grid.machine, grid.readings);
  std::string problems;
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    problems += fmt::format(
        " {} would be {}, expected {};", problem.parameter, problem.value, problem.expected);
  }
  for (const auto& problem : model::effects::problems_of_effects(machine)) {
    problems += fmt::format(
        " {} would be {}, expected {};", problem.parameter, problem.value, problem.expected);
  }
  if (problems.empty()) return {};
  problems.back() = '.';
  return tl::unexpected(FitFailure{FitFailure::Reason::impossible_readings,
                                   "with the grid's readings put in," + problems});
}

FitFailure failure_of(const estimation::EstimationFailure& failure) {
  using Reason = estimation::EstimationFailure::Reason;
  switch (failure.reason) {
    case Reason::place_unreachable:
      return {FitFailure::Reason::point_unreachable, failure.sentence};
    case Reason::rank_deficient:
      return {FitFailure::Reason::rank_deficient, failure.sentence};
    case Reason::not_converged:
      break;
  }
  return {FitFailure::Reason::not_converged, failure.sentence};
}

tl::expected<FittedGrid, FitFailure> fit_grid(const MeasuredGrid& grid, const Progress& progress) {
  if (!grid.machine) {
    return tl::unexpected(FitFailure{
        FitFailure::Reason::no_machine,
        "the grid names no machine; a residual surface stands on one: give --machine, or "
        "ask for --surface direct"});
  }
  const auto points = length_points(grid);
  if (!points)
    return tl::unexpected(FitFailure{FitFailure::Reason::no_lengths, points.error().sentence});
  if (auto possible = check_machine_read(grid); !possible) return tl::unexpected(possible.error());
  const bool stated = states_noise(grid);
  PointsFitInput input = points_input(grid, *points);
  input.progress = progress;
  input.step = first_step(stated);
  auto fit = fit_points(input);
  if (!fit) return tl::unexpected(failure_of(fit.error()));
  FittedGrid fitted{std::move(input), *std::move(fit), stated ? "stated" : "fit", std::nullopt};
  if (!stated) {
    if (auto found = find_noise(fitted); !found) return tl::unexpected(found.error());
  }
  if (auto sound = check_enough_good(fitted.fit); !sound) return tl::unexpected(sound.error());
  return fitted;
}

tl::expected<CompensationMap, FitFailure> fit_residual(const MeasuredGrid& grid,
                                                       const Progress& progress) {
  return fit_grid(grid, progress).map([&](const FittedGrid& fitted) {
    tell(progress, last_step(states_noise(grid)));
    return map_of(grid, fitted);
  });
}

}  // namespace chaintrue::grid
