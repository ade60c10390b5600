// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/holes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "grid/failed.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/random.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::synthetic {
namespace {

// Random streams: draws of one do not depend on those of another.
constexpr std::uint64_t kSettingStream = 11;
constexpr std::uint64_t kHoleStream = 12;
constexpr std::uint64_t kTapeStream = 13;
constexpr std::uint64_t kBadStream = 14;

}  // namespace

Machine hidden_truth(const Machine& stated, const HolesSpec& spec) {
  Random random(spec.seed, kSettingStream);
  Machine truth = stated;
  if (spec.draw_settings) {
    for (const Setting setting : kMachineSettings) {
      truth = with_setting(
          std::move(truth), setting,
          stated_value(stated, setting) + stated_sigma(stated, setting) * random.normal());
    }
  }
  if (spec.scale_sigma > 0.0) {
    for (const char* side : {"left", "right"}) {
      truth.effects.push_back(
          {"chain_pitch_error", side, {{"elongation", spec.scale_sigma * random.normal()}}});
    }
  }
  append_all(truth.effects, spec.hidden);
  return truth;
}

tl::expected<SyntheticHoles, CutFailure> simulate_holes(const MeasuredHoles& design,
                                                        const HolesSpec& spec,
                                                        const std::optional<Machine>& truth) {
  if (!design.machine) throw std::invalid_argument("holes are cut by a machine; none was given");
  const auto distances = observation::TapeDistances::in_given_order(design);
  if (!distances) {
    return failed(CutReason::no_lengths, distances.error());
  }
  SyntheticHoles made{design, truth ? *truth : hidden_truth(*design.machine, spec), {}};
  const ReadingModel model(made.truth);
  Random hole_noise(spec.seed, kHoleStream);
  for (const auto i : each_index(design.holes)) {
    const auto reading = model.find(distances->places()[i].lengths, design.holes[i].commanded);
    if (!reading) {
      return failed(CutReason::unreachable,
                    fmt::format("hole {} at ({:.1f}, {:.1f}) cannot be cut: {}",
                                design.holes[i].name, design.holes[i].commanded.x_mm,
                                design.holes[i].commanded.y_mm, reading.error().sentence()));
    }
    const MarkPoint at = spec.sheet.to_mark(reading->pose.position);
    const double dx = design.hole_sigma_mm * hole_noise.normal();
    const double dy = design.hole_sigma_mm * hole_noise.normal();
    made.places.push_back({at.x_mm + dx, at.y_mm + dy});
    made.lengths.push_back(distances->places()[i].lengths);
  }
  const observation::DistanceGeometry geometry =
      observation::distance_geometry(design, made.places);
  const double tape = observation::tape_factor(made.truth);
  Random tape_noise(spec.seed, kTapeStream);
  for (const auto k : each_index(made.set.distances)) {
    HoleDistance& distance = made.set.distances[k];
    double reading = tape * geometry.predicted_mm[as_index(k)] + design.tape.tape_zero_offset_mm +
                     sigma_of(design, distance) * tape_noise.normal();
    if (spec.rounding_mm > 0.0) reading = spec.rounding_mm * std::round(reading / spec.rounding_mm);
    distance.distance_mm = reading;
  }
  Random bad(spec.seed, kBadStream);
  auto order = numbers_below(made.set.distances.size());
  bad.shuffle(order);
  for (std::size_t k = 0; k < order.size() && as_int(k) < spec.bad_readings; ++k) {
    made.set.distances[order[k]].distance_mm +=
        bad.uniform() < 0.5 ? -spec.bad_size_mm : spec.bad_size_mm;
    made.bad_readings.push_back(order[k]);
  }
  sort(made.bad_readings);
  return made;
}

}  // namespace chaintrue::grid::synthetic
