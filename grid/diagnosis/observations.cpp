// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressor_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/noise_from_repeats.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Reason = DiagnosisFailure::Reason;

/// The readings that the machine predicts; the sled's mass is taken as it was read.
std::vector<ExtraReading> predictable(const std::vector<ExtraReading>& readings, Machine& machine) {
  std::vector<ExtraReading> kept;
  std::vector<ExtraReading> masses;
  for (const ExtraReading& reading : readings) {
    if (reading.what == ReadingOf::sled_mass) masses.push_back(reading);
    if (observation::is_predictable(machine, reading)) kept.push_back(reading);
  }
  machine = with_readings(machine, masses);
  return kept;
}

/// Sigma of a value in the machine file that can also be measured directly.
double sigma_of_statement(const Machine& machine, ReadingOf what) {
  if (what == ReadingOf::motor_spacing || what == ReadingOf::beam_rise)
    return std::sqrt(2.0) * machine.uncertainty.motor_position_mm;
  if (what == ReadingOf::ring_radius) return machine.uncertainty.ring_radius_mm;
  // A chain's pitch may be off by half a per cent, its mass by more.
  if (what == ReadingOf::link_pitch) return 0.005 * machine.sprocket.pitch_mm;
  if (what == ReadingOf::tape_error) return 5.0;
  return machine.chain.mass_kg_per_m;
}

/// Secants of effects and the calibration are accurate to some micrometres over a bed: better
/// readings are given this sigma, and the noise found shows how accurate they were.
constexpr double kFinestLengthNoiseMm = 0.01;

constexpr double kContradiction = 6.0;  // sigmas: a slip of the pen, not of the tape

std::optional<std::string> contradiction(const Machine& machine,
                                         const std::vector<ExtraReading>& readings) {
  for (const auto i : each_index(readings)) {
    const ExtraReading& reading = readings[i];
    const double stated = observation::predicted_reading(machine, reading);
    const double sigma = std::hypot(sigma_of_statement(machine, reading.what), reading.sigma);
    const double apart = std::abs(reading.value - stated) / sigma;
    if (apart > kContradiction) {
      return fmt::format(
          "your reading of {} is {:.6g}, but the machine file has {:.6g}: {:.0f} sigma apart. "
          "Measure it again and correct whichever is wrong",
          name(reading.what), reading.value, stated, apart);
    }
    for (const std::size_t k : each_below(i)) {
      const ExtraReading& other = readings[k];
      if (other.what != reading.what || other.side != reading.side) continue;
      const double both = std::hypot(other.sigma, reading.sigma);
      if (std::abs(reading.value - other.value) > kContradiction * both) {
        return fmt::format(
            "two readings of {} contradict each other: {:.6g} and {:.6g}, {:.0f} sigma apart",
            name(reading.what), other.value, reading.value,
            std::abs(reading.value - other.value) / both);
      }
    }
  }
  return std::nullopt;
}

/// From the scatter of the residuals within each group of repeats.
std::optional<StatedNoise> noise_of_repeats(const Machine& stated, const MeasuredGrid& grid,
                                            const std::vector<LengthPoint>& points) {
  const ReadingModel model(stated);
  const StatedNoise usual;
  RepeatScatter scatter({usual.length_mm, usual.position_mm}, rounding_noise(grid));
  for (const auto& group : repeat_groups(points)) {
    for (const std::size_t i : group) {
      const auto reading = model.at(identity_placement(points[i].mark));
      if (!reading) continue;
      scatter.add({points[i].lengths.left_mm - reading->lengths.left_mm,
                   points[i].lengths.right_mm - reading->lengths.right_mm},
                  reading->position_jacobian);
    }
    scatter.end_group();
  }
  const auto found = scatter.noise();
  if (!found) return std::nullopt;
  return StatedNoise{found->factor * usual.length_mm, found->factor * usual.position_mm,
                     found->dof};
}

/// Pairs of holes without a measured distance, the farthest apart first.
std::vector<std::string> unmeasured(const MeasuredHoles& set, std::size_t most) {
  std::vector<HoleDistance> left;
  for (const auto i : each_index(set.holes)) {
    for (std::size_t j = i + 1; j < set.holes.size(); ++j) left.push_back({.from = i, .to = j});
  }
  std::erase_if(left, [&](const HoleDistance& own) { return is_measured(set, own); });
  stable_sort(left, descending([&](const HoleDistance& own) { return commanded_mm(set, own); }));
  std::vector<std::string> words;
  for (const HoleDistance& d : left) {
    if (words.size() < most) words.push_back(words_of(set, d));
  }
  return words;
}

std::string too_few_distances(const MeasuredHoles& set) {
  const std::size_t missing = kFewestDistances - set.distances.size();
  const std::vector<std::string> pairs = unmeasured(set, missing);
  std::string text = fmt::format(
      "{} distances are too few to name a cause: at least {} are needed. Nine holes and twenty "
      "distances are a good start",
      set.distances.size(), kFewestDistances);
  if (!pairs.empty()) text += fmt::format(". Measure also {}", fmt::join(pairs, ", "));
  if (pairs.size() < missing) {
    text += fmt::format("{} {}",
                        pairs.empty() ? ". Cut more holes and measure" : ", and from new holes",
                        missing - pairs.size());
  }
  return text;
}

struct PointsSoFar {
  bool noise_from_repeats = false;
  bool ordered = false;
};

/// Points of one grid, numbered from `first_index` on.
tl::expected<std::shared_ptr<const observation::Observation>, DiagnosisFailure> points_of(
    MeasuredGrid grid, const Machine& stated, std::size_t first_index, PointsSoFar& so_far) {
  grid.machine = stated;
  const auto lengths = length_points(grid);
  if (!lengths) return failed(Reason::no_lengths, lengths.error());
  std::optional<StatedNoise> noise;
  if (grid.noise) {
    noise = not_below_rounding(*grid.noise, grid);
  } else {
    noise = noise_of_repeats(stated, grid, *lengths);
    so_far.noise_from_repeats = noise.has_value();
  }
  if (!noise) {
    return failed(Reason::no_noise,
                  "the accuracy of the points is unknown, and too few were measured twice to "
                  "estimate it. Enter it (\"noise\" in the grid file, or --noise-length-mm, "
                  "--noise-position-mm), or measure at least six points twice");
  }
  // Orders of different sessions are unrelated.
  const bool ordered = !so_far.ordered && all_of(grid.points, &MeasuredPoint::order);
  so_far.ordered = so_far.ordered || ordered;
  std::vector<Place> places = *lengths;
  for (Place& place : places) {
    place.index += first_index;
    place.name = fmt::format("{}", place.index + 1);
  }
  std::optional<observation::SheetPrior> sheet;
  if (grid.sheet) sheet = {grid.sheet->shift_mm, 1e-3 * grid.sheet->rotation_mrad};
  return std::make_shared<const ChainLengthReadings>(
      std::move(places), ordered,
      observation::PointNoise{std::max(noise->length_mm, kFinestLengthNoiseMm), noise->position_mm},
      noise->dof, sheet);
}

/// Eight points or eight distances; for both together, as many numbers as eight points give.
std::optional<std::string> too_few(const Measured& measured) {
  std::size_t points = 0;
  std::size_t distances = 0;
  for (const MeasuredGrid* grid : measured.grids()) points += grid->points.size();
  for (const MeasuredHoles* set : measured.holes()) distances += set->distances.size();
  if (measured.grids().empty()) {
    return distances < kFewestDistances
               ? std::optional(too_few_distances(*measured.holes().front()))
               : std::nullopt;
  }
  if (2 * points + distances >= 2 * kFewestPoints) return std::nullopt;
  if (!measured.holes().empty()) {
    return fmt::format(
        "{} points and {} distances are too few to name a cause: a point counts as two "
        "readings, and {} readings are needed",
        points, distances, 2 * kFewestPoints);
  }
  return fmt::format(
      "{} points are too few to name a cause: at least {} are needed, 28 "
      "with six of them measured twice are a good start",
      points, kFewestPoints);
}

}  // namespace

bool is_measured(const MeasuredHoles& set, const HoleDistance& wanted) {
  return any_of(set.distances, [&](const HoleDistance& d) {
    if (d.edge != wanted.edge) return false;
    if (d.edge) return d.from == wanted.from;
    return std::minmax(d.from, d.to) == std::minmax(wanted.from, wanted.to);
  });
}

tl::expected<ObservationSet, DiagnosisFailure> observations_of(const Measured& measured) {
  if (!measured.machine()) {
    return failed(Reason::no_machine,
                  measured.grids().empty()
                      ? "the holes have no machine, so the chain lengths for their commands are "
                        "unknown: add --machine M.json"
                      : "a diagnosis needs your machine's dimensions: add --machine M.json");
  }
  Machine stated = *measured.machine();
  std::vector<ExtraReading> readings;
  const auto take = [&](const std::vector<ExtraReading>& of_file) {
    const auto own = predictable(of_file, stated);
    append_all(readings, own);
  };
  for (const MeasuredGrid* grid : measured.grids()) take(grid->readings);
  for (const MeasuredHoles* set : measured.holes()) take(set->readings);
  if (auto said = too_few(measured)) return failed(Reason::too_few_points, *std::move(said));
  if (auto said = contradiction(stated, readings)) {
    return failed(Reason::contradictory_settings, *std::move(said));
  }
  observation::Observations observations;
  const auto add = [&](std::shared_ptr<const observation::Observation> one) {
    if (one->rows() > 0) observations.push_back(std::move(one));
  };
  PointsSoFar so_far;
  std::size_t index = 0;
  for (const MeasuredGrid* grid : measured.grids()) {
    auto points = points_of(*grid, stated, index, so_far);
    if (!points) return failed(points);
    add(*std::move(points));
    index += grid->points.size();
  }
  observation::NumberedFrom first;
  const auto sets = measured.holes();
  for (const auto k : each_index(sets)) {
    MeasuredHoles set = *sets[k];
    if (!set.machine) set.machine = stated;
    for (Hole& hole : set.holes) {
      if (k > 0) hole.name = fmt::format("{} ({})", hole.name, k + 1);
    }
    auto distances = TapeDistances::of(set, first);
    if (!distances) return failed(Reason::point_unreachable, distances.error());
    add(std::make_shared<const TapeDistances>(*std::move(distances)));
    first.hole += set.holes.size();
    first.distance += set.distances.size();
  }
  if (!readings.empty()) {
    add(std::make_shared<const observation::SingleReadings>(std::move(readings)));
  }
  ObservationSet set = estimation::observation_set(std::move(stated), observations);
  set.noise_from_repeats = so_far.noise_from_repeats;
  set.fewest_units = set.reads_chains() ? kFewestPoints : kFewestGoodDistances;
  return set;
}

}  // namespace chaintrue::grid::diagnosis
