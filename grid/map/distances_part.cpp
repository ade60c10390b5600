// SPDX-License-Identifier: GPL-3.0-or-later
/// Treatment specific to distances between holes: a hook offset that was left out makes all of them
/// contradict the machine, and a sheet without measured edges is laid by its holes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/fit_part.hpp"
#include "grid/map/map_parts.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid {
namespace {

/// Sigmas from which a tape's zero offset is reported: one sound file in 370 exceeds it.
constexpr double kTapeZeroSigmas = 3.0;

void note_rejected(const MeasuredHoles& set, const FittedDistances& fit,
                   std::vector<std::string>& notes) {
  std::map<std::size_t, int> at_hole;
  for (const auto k : each_index(fit.distances)) {
    const FittedDistance& distance = fit.distances[k];
    if (!distance.rejected) continue;
    const HoleDistance& reading = set.distances[k];
    notes.push_back(fmt::format(
        "{} ({:g} mm on the tape) was left out: it is {:.1f} mm {} than the others "
        "predict, {:.1f} times the usual error of tape and holes. Measure it again.",
        words_of(set, reading), reading.distance_mm, std::abs(distance.left_out_mm),
        distance.left_out_mm > 0.0 ? "longer" : "shorter", std::abs(distance.sigmas())));
    ++at_hole[reading.from];
    if (!reading.edge) ++at_hole[reading.to];
  }
  for (const auto& [hole, count] : at_hole) {
    if (count < 2) continue;
    notes.push_back(
        fmt::format("{} of the distances that were left out end at hole {}: perhaps the hole is "
                    "misplaced and the tape is right.",
                    count, set.holes[hole].name));
  }
}

std::string tape_zero_sentence(const FoundTapeZero& zero) {
  return fmt::format(
      "Every tape distance reads {:.1f} +- {:.1f} mm too {}. This is corrected: {}",
      std::abs(zero.mm), zero.sigma_mm, zero.mm > 0.0 ? "long" : "short",
      zero.mm > 0.0
          ? "does it include the hook or the bit's width? Measure from centre to centre, or enter "
            "the offset (--hook-offset-mm)."
          : "was it measured between the near edges of the holes, or is the hook's offset "
            "too large?");
}

FittedDistances fitted_distances(const observation::TapeDistances& distances,
                                 const estimation::Estimate& estimate, std::size_t observation) {
  const MeasuredHoles& set = distances.set();
  const estimation::ObservationEstimate& own = estimate.observations[observation];
  FittedDistances fit;
  fit.file = observation;
  for (const estimation::UnitEstimate& unit : estimate.units) {
    if (unit.observation != observation) continue;
    const auto at = as_index(unit.unit);
    fit.distances.push_back({distances.measured()[at], commanded_mm(set, set.distances[unit.unit]),
                             own.predicted[at], unit.left_out[0],
                             std::sqrt(unit.left_out_covariance(0, 0)), unit.is_rejected()});
  }
  const auto holes = std::ssize(set.holes);
  const VectorXd shift = own.nuisance.tail(2 * holes);
  for (Index i = 0; i < holes; ++i) {
    const estimation::PlaceEstimate& place = own.places[as_size(i)];
    fit.holes.push_back({distances.places()[as_size(i)].lengths,
                         place.as_stated,
                         place.mark,
                         {place.mark.x_mm + shift[2 * i], place.mark.y_mm + shift[2 * i + 1]}});
  }
  // After the sheet's size (tape_distances.hpp).
  constexpr Index kTapeZero = 2;
  if (tape_zero_sigma_mm(set.tape) > 0.0)
    fit.tape_zero = FoundTapeZero{own.nuisance[kTapeZero], own.nuisance_sigma[kTapeZero]};
  return fit;
}

std::vector<std::string> distance_notes(const MeasuredHoles& set, const FittedDistances& fit) {
  std::vector<std::string> notes;
  note_rejected(set, fit, notes);
  if (const auto tape_zero = suspected_tape_zero_offset_mm(set)) {
    notes.push_back(
        fmt::format("All distances are about {:.1f} mm {} than commanded, whatever their length: "
                    "was the tape's hook offset left out or subtracted twice?",
                    std::abs(*tape_zero), *tape_zero > 0.0 ? "longer" : "shorter"));
  } else if (fit.tape_zero &&
             std::abs(fit.tape_zero->mm) >= kTapeZeroSigmas * fit.tape_zero->sigma_mm) {
    notes.push_back(tape_zero_sentence(*fit.tape_zero));
  }
  return notes;
}

class DistancesPart final : public FitPart {
 public:
  explicit DistancesPart(std::shared_ptr<const observation::TapeDistances> distances)
      : distances_(std::move(distances)) {
    observation = distances_;
    noise = {interp::NoiseKnowledge::from_repeats, set().noise_dof};
    domain = holes_domain(set().machine->bed);
    machine = *set().machine;
    readings = set().readings;
    fewest_good = kFewestHoleDistances;
  }

  std::string to_check() const override {
    std::string sentence =
        "the machine's measures, the controller's settings, and which holes the distances join";
    if (const auto tape_zero = suspected_tape_zero_offset_mm(set())) {
      sentence += fmt::format(", and whether the tape's hook offset ({:.0f} mm?) was left out",
                              std::round(*tape_zero));
    }
    return sentence;
  }

  void add_to(MapDraft& draft, const Fitting& fitting, std::size_t file,
              const std::string& name) const override {
    FittedDistances fit = fitted_distances(*distances_, fitting.estimate, file);
    for (const FittedHole& hole : fit.holes)
      draft.good.push_back(fitting.in_frame(file, hole.predicted));
    for (const std::string& note : distance_notes(set(), fit))
      draft.notes.push_back(name.empty() ? note : fmt::format("{}: {}", name, note));
    if (name.empty()) note_noise(fitting.estimate.noise_factor, draft.notes);
    if (file == 0) note_frame(draft.frame_notes);
    const DistancesUsed used = distances_used(fit.distances, set().tape.sigma_mm);
    draft.sources.push_back(fmt::format(
        "{} distances between {} holes of {}{}, each predicted by the others within {:.2f} mm rms",
        fit.distances.size(), fit.holes.size(), name,
        used.rejected == 0 ? "" : fmt::format(" ({} left out)", used.rejected),
        used.left_out_good.rms_mm));
    if (fitting.input.surface == estimation::SurfaceUse::on_evidence)
      add_holes(draft, fitting, fit);
    draft.distances.push_back(std::move(fit));
  }

 private:
  const MeasuredHoles& set() const { return distances_->set(); }

  /// For sets of holes alone the points are the holes, and errors are those of distances.
  void add_holes(MapDraft& draft, const Fitting& fitting, const FittedDistances& fit) const {
    for (const FittedHole& hole : fit.holes) {
      MapPoint point{.mark = fitting.in_frame(fit.file, hole.place), .lengths = hole.lengths};
      const auto off = [&](MarkPoint from) {
        return difference(point.mark, fitting.in_frame(fit.file, from));
      };
      point.as_stated_mm = point.sheet_placed_mm = off(hole.as_stated);
      point.mapped_mm = point.left_out_mm = off(hole.predicted);
      draft.map.points.push_back(point);
    }
    if (fit.file > 0) return;
    draft.map.noise = {0.0, set().hole_sigma_mm, NoiseSource::stated,
                       fitting.estimate.noise_factor};
    draft.tape_sigma_mm = set().tape.sigma_mm;
  }

  /// For a single file: the noise relative to the stated one.
  void note_noise(double factor, std::vector<std::string>& notes) const {
    if (factor <= kNoiseDisagreement) return;
    notes.push_back(
        fmt::format("The distances scatter {:.1f} times as much as you entered ({:g} mm for the "
                    "tape, {:g} mm for a hole), so the results are that much less certain.",
                    factor, set().tape.sigma_mm, set().hole_sigma_mm));
  }

  void note_frame(std::vector<std::string>& notes) const {
    const observation::SheetPrior& measured = *distances_->sheet();
    std::string free;
    for (const auto& [is_measured, word] :
         {std::pair(measured.knows_x, "sideways"), std::pair(measured.knows_y, "up and down"),
          std::pair(measured.knows_rotation, "rotation")}) {
      if (!is_measured) free += fmt::format("{}{}", free.empty() ? "" : ", ", word);
    }
    if (free.empty()) return;
    notes.push_back(
        fmt::format("No edges were measured, so the position of the sheet is unknown ({}). The map "
                    "assumes that the holes, on average, are where they were commanded.",
                    free));
  }

  std::shared_ptr<const observation::TapeDistances> distances_;
};

}  // namespace

tl::expected<std::unique_ptr<FitPart>, FitFailure> part_of(const MeasuredHoles& set) {
  if (set.distances.empty())
    throw precondition("a fit of no distances between {} holes", set.holes.size());
  if (!set.machine) {
    return failed(FitReason::no_machine,
                  "the holes have no machine, whose controller turns commands into chain lengths: "
                  "add --machine");
  }
  auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) {
    return failed(FitReason::no_lengths, distances.error());
  }
  if (auto possible = check_readings_of(*set.machine, set.readings, "set's"); !possible)
    return failed(possible);
  return std::make_unique<DistancesPart>(
      std::make_shared<const observation::TapeDistances>(*std::move(distances)));
}

}  // namespace chaintrue::grid
