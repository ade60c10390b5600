// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/simulated_belts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/random.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::synthetic {

namespace {

/// Streams of the seed: draws of one do not depend on the others.
enum BeltStream : std::uint64_t { kNoiseStream = 1, kBadReadingStream = 2 };

std::vector<BedPoint> commands_of(const BeltMachine& stated, const BeltsSpec& spec) {
  const auto& a = stated.anchors;
  const double width = spec.width_share * 0.5 * (a.br.x_mm + a.tr.x_mm - a.tl.x_mm);
  const double height = spec.height_share * 0.5 * (a.tl.y_mm + a.tr.y_mm);
  std::vector<BedPoint> commands;
  for (const int row : each_below(spec.rows)) {
    for (const int i : each_below(spec.columns)) {
      const int column = row % 2 == 0 ? i : spec.columns - 1 - i;
      commands.push_back({width * (as_double(column) / (spec.columns - 1) - 0.5),
                          height * (as_double(row) / (spec.rows - 1) - 0.5)});
    }
  }
  return commands;
}

/// The tool's position when the upper belts have the lengths paid out for a command.
tl::expected<FramePoint, model::BeltFailure> place_of(const BeltMachine& stated,
                                                      const BeltMachine& truth, BedPoint command) {
  const auto paid_out = lengths_at(stated, to_frame(stated, command));
  if (!paid_out) return failed(paid_out);
  return place_of_upper(truth, paid_out->tl, paid_out->tr);
}

std::vector<std::optional<BeltPull>> passes_of(const BeltsSpec& spec) {
  if (spec.pulls.empty()) return {std::nullopt};
  std::vector<std::optional<BeltPull>> passes;
  for (const double pull : spec.pulls) passes.push_back(BeltPull{pull, BeltPull::Unit::relative});
  return passes;
}

/// Appends one visit of every place; orders continue. \returns the place that cannot be reached.
std::optional<BeltsUnreachable> add_pass(const BeltMachine& stated, const BeltMachine& truth,
                                         const BeltsSpec& spec, const std::optional<BeltPull>& pull,
                                         Random& noise, MeasuredBelts& belts) {
  const auto effects = model::effects::resolve(model::belts::belt_effects(), spec.hidden);
  const std::vector<BedPoint> commands = commands_of(stated, spec);
  const double over_least = pull ? pull->value / *min_element(spec.pulls) : 1.0;
  for (const auto i : each_index(commands)) {
    const auto place = place_of(stated, truth, commands[i]);
    if (!place) return place.error().at(commands[i]);
    BeltPoint point;
    point.commanded = commands[i];
    point.order = as_int(belts.points.size());
    point.pull = pull;
    const auto pulled =
        pulled_after(stated.orientation, commands[i == 0 ? 0 : i - 1], commands[i], i);
    // For an upright frame this is the default.
    if (stated.orientation == model::Orientation::flat) point.pulled = pulled;
    for (const Belt belt : kBelts) {
      const auto length = model::belts::read_belt(
          truth, effects, {belt, pulled_belts(point), *point.order, over_least}, *place);
      if (!length) return length.error().at(commands[i]);
      const double off = spec.heavy_tails ? noise.heavy_tailed() : noise.normal();
      double& read = point.lengths_mm[belt];
      read = length->value + spec.noise_mm * off;
      if (spec.rounding_mm > 0.0) read = spec.rounding_mm * std::round(read / spec.rounding_mm);
    }
    belts.points.push_back(std::move(point));
  }
  return std::nullopt;
}

void spoil(const BeltsSpec& spec, MeasuredBelts& belts) {
  Random random(spec.seed, kBadReadingStream);
  auto points = numbers_below(belts.points.size());
  random.shuffle(points);
  for (const std::size_t i : each_below(as_size(spec.bad_readings))) {
    const Belt belt = kBelts[random.below(kBelts.size())];
    const double sign = random.below(2) == 0 ? 1.0 : -1.0;
    belts.points[points[i]].lengths_mm[belt] += sign * spec.bad_size_mm;
  }
}

void check(const BeltsSpec& spec) {
  if (spec.columns >= 2 && spec.rows >= 2 && spec.bad_readings >= 0 &&
      spec.bad_readings <= spec.columns * spec.rows)
    return;
  throw std::logic_error(fmt::format("{} x {} places with {} bad readings", spec.columns, spec.rows,
                                     spec.bad_readings));
}

}  // namespace

tl::expected<MeasuredBelts, BeltsUnreachable> simulate_belts(const BeltMachine& stated,
                                                             const BeltMachine& truth,
                                                             const BeltsSpec& spec) {
  check(spec);
  MeasuredBelts belts;
  belts.machine = stated;
  Random noise(spec.seed, kNoiseStream);
  for (const std::optional<BeltPull>& pull : passes_of(spec)) {
    auto unreached = add_pass(stated, truth, spec, pull, noise, belts);
    if (unreached) return tl::unexpected(*unreached);
  }
  spoil(spec, belts);
  return belts;
}

}  // namespace chaintrue::grid::synthetic
