// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/holes_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "grid/map/holes_notes.hpp"
#include "grid/map/residual_fit.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid {
namespace {

ErrorSummary summary_of(const std::vector<FittedDistance>& distances, bool with_set_aside) {
  ErrorSummary summary;
  double squares = 0.0;
  std::size_t count = 0;
  for (const FittedDistance& distance : distances) {
    if (distance.set_aside && !with_set_aside) continue;
    squares += distance.left_out_mm * distance.left_out_mm;
    summary.maximum_mm = std::max(summary.maximum_mm, std::abs(distance.left_out_mm));
    ++count;
  }
  if (count > 0) summary.rms_mm = std::sqrt(squares / static_cast<double>(count));
  return summary;
}

std::vector<FoundHook> hooks_of(const observation::TapeDistances& distances,
                                const estimation::ObservationEstimate& estimate) {
  std::vector<FoundHook> hooks;
  if (distances.set().tape.hook_sigma_mm.value_or(0.0) == 0.0) return hooks;
  // After the sheet's size (tape_distances.hpp).
  for (std::size_t i = 0; i < distances.hook_sessions().size(); ++i) {
    const auto at = 2 + static_cast<Eigen::Index>(i);
    hooks.push_back({estimate.nuisance[at], estimate.nuisance_sigma[at]});
  }
  return hooks;
}

/// A map that keeps less than two thirds of its distances is not the map of those distances.
tl::expected<void, FitFailure> check_enough_good(const MeasuredHoles& set, const HolesFit& fit) {
  const auto good = static_cast<std::size_t>(
      std::count_if(fit.distances.begin(), fit.distances.end(), [](const FittedDistance& one) {
        return !one.set_aside;
      }));
  const std::size_t all = fit.distances.size();
  if (3 * good >= 2 * all && good >= kFewestHoleDistances) return {};
  std::string sentence = fmt::format(
      "{} of {} distances contradict the others or the machine as stated; check the "
      "machine's measures, the controller's settings in force and which holes the "
      "distances join",
      all - good,
      all);
  if (const auto hook = suspected_hook_offset_mm(set)) {
    sentence += fmt::format(", and whether the tape's hook offset ({:.0f} mm?) was left out",
                            std::round(*hook));
  }
  return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient, sentence});
}

}  // namespace

FittedDistances fitted_distances(const observation::TapeDistances& distances,
                                 const estimation::Estimate& estimate,
                                 std::size_t observation) {
  const MeasuredHoles& set = distances.set();
  const estimation::ObservationEstimate& own = estimate.observations[observation];
  FittedDistances fit;
  for (const estimation::UnitEstimate& unit : estimate.units) {
    if (unit.observation != observation) continue;
    const auto at = static_cast<Eigen::Index>(unit.unit);
    fit.distances.push_back({distances.measured()[at],
                             commanded_mm(set, set.distances[unit.unit]),
                             own.predicted[at],
                             unit.left_out[0],
                             std::sqrt(unit.left_out_covariance(0, 0)),
                             unit.is_set_aside()});
  }
  const auto holes = static_cast<Eigen::Index>(set.holes.size());
  const Eigen::VectorXd shift = own.nuisance.tail(2 * holes);
  for (Eigen::Index i = 0; i < holes; ++i) {
    const estimation::PlaceEstimate& place = own.places[static_cast<std::size_t>(i)];
    fit.holes.push_back({distances.places()[static_cast<std::size_t>(i)].lengths,
                         place.as_stated,
                         place.mark,
                         {place.mark.x_mm + shift[2 * i], place.mark.y_mm + shift[2 * i + 1]}});
  }
  fit.hooks = hooks_of(distances, own);
  fit.left_out_all = summary_of(fit.distances, true);
  fit.left_out_good = summary_of(fit.distances, false);
  return fit;
}

DistancesUsed distances_used(const std::vector<FittedDistance>& distances, double tape_sigma_mm) {
  DistancesUsed used;
  used.tape_sigma_mm = tape_sigma_mm;
  for (const FittedDistance& distance : distances) {
    (distance.set_aside ? used.set_aside : used.used) += 1;
  }
  used.left_out_all = summary_of(distances, true);
  used.left_out_good = summary_of(distances, false);
  return used;
}

interp::Rectangle holes_domain(const model::Bed& bed) {
  constexpr double kBesideMm = 50.0;
  return {-0.5 * bed.width_mm - kBesideMm,
          0.5 * bed.width_mm + kBesideMm,
          -0.5 * bed.height_mm - kBesideMm,
          0.5 * bed.height_mm + kBesideMm};
}

tl::expected<HolesFit, FitFailure> fit_holes(
    const MeasuredHoles& set,
    const std::optional<estimation::MachineKnowledge>& knowledge,
    const Progress& progress) {
  if (!set.machine || set.distances.empty()) {
    throw precondition("a fit of {} distances {} a machine",
                       set.distances.size(),
                       set.machine ? "with" : "without");
  }
  const auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) {
    return tl::unexpected(FitFailure{FitFailure::Reason::no_lengths, distances.error().sentence});
  }
  estimation::EstimationInput input;
  input.machine = *set.machine;
  input.observations = {std::make_shared<const observation::TapeDistances>(*distances)};
  input.noise = {interp::NoiseKnowledge::from_repeats, set.noise_dof};
  input.surface = estimation::SurfaceUse::on_evidence;
  input.domain = holes_domain(set.machine->bed);
  input.intervals_x = kHolesIntervalsX;
  input.intervals_y = kHolesIntervalsY;
  input.knowledge = knowledge;
  input.progress = progress;
  auto estimate = estimation::estimate(input);
  if (!estimate) return tl::unexpected(failure_of(estimate.error()));
  HolesFit fit{fitted_distances(*distances, *estimate, 0),
               *std::move(estimate),
               *distances->sheet(),
               {}};
  if (auto sound = check_enough_good(set, fit); !sound) return tl::unexpected(sound.error());
  fit.notes = fit_notes(set, fit);
  return fit;
}

}  // namespace chaintrue::grid
