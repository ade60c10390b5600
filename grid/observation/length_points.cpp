// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/length_points.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "grid/containers.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

using model::Machine;

void take_ring_radius(Machine& machine, const ExtraReading& reading) {
  auto* ring = std::get_if<model::Ring>(&machine.attachment);
  if (ring == nullptr) return;
  const double stated = 1.0 / std::pow(machine.uncertainty.ring_radius_mm, 2);
  const double read = 1.0 / std::pow(reading.sigma, 2);
  ring->radius_mm = (stated * ring->radius_mm + read * reading.value) / (stated + read);
}

/// A reading replaces an elongation that was stated for the same chain.
void take_link_pitch(Machine& machine, const ExtraReading& reading) {
  std::erase_if(machine.effects, [&](const model::AppliedEffect& applied) {
    return applied.effect == "chain_pitch_error" && applied.side == reading.side;
  });
  machine.effects.push_back({"chain_pitch_error",
                             reading.side,
                             {{"elongation", reading.value / machine.sprocket.pitch_mm - 1.0}}});
}

/// A measured tape error replaces a stated one.
void take_tape_error(Machine& machine, const ExtraReading& reading) {
  const std::string side = reading.side.empty() ? "both" : reading.side;
  std::erase_if(machine.effects, [&](const model::AppliedEffect& applied) {
    return applied.effect == "tape_scale" && applied.side == side;
  });
  machine.effects.push_back({"tape_scale", side, {{"scale", 1e-3 * reading.value}}});
}

using TakeReading = std::function<void(Machine&, const ExtraReading&)>;

const std::map<ReadingOf, TakeReading>& machine_readings() {
  static const std::map<ReadingOf, TakeReading> kReadings = {
      {ReadingOf::sled_mass, [](Machine& m, const ExtraReading& r) { m.sled.mass_kg = r.value; }},
      {ReadingOf::chain_mass,
       [](Machine& m, const ExtraReading& r) { m.chain.mass_kg_per_m = r.value; }},
      {ReadingOf::ring_radius, take_ring_radius},
      {ReadingOf::link_pitch, take_link_pitch},
      {ReadingOf::tape_error, take_tape_error},
  };
  return kReadings;
}

tl::unexpected<NoLengths> no_lengths(std::size_t index, const std::string& why) {
  return tl::unexpected(
      NoLengths{LengthPointsReason::no_lengths,
                fmt::format("point {} gives a command and no lengths, but {}", index + 1, why)});
}

}  // namespace

tl::expected<std::vector<LengthPoint>, NoLengths> length_points(const MeasuredGrid& grid) {
  const bool commands =
      any_of(grid.points, [](const MeasuredPoint& point) { return !point.lengths; });
  std::unique_ptr<const model::ControllerKinematics> controller;
  if (commands && grid.machine) controller = model::make_controller_kinematics(*grid.machine);
  std::vector<LengthPoint> points;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const MeasuredPoint& point = grid.points[i];
    LengthPoint result{i, point.mark, {}, std::nullopt};
    if (point.lengths) {
      result.lengths = *point.lengths;
    } else {
      if (!controller) return no_lengths(i, "no machine with a controller is given");
      if (!point.commanded) return no_lengths(i, "the command is missing");
      const auto paid_out = controller->lengths(*point.commanded);
      if (!paid_out)
        return no_lengths(
            i, fmt::format("the controller cannot go there: {}", paid_out.error().sentence()));
      result.lengths = *paid_out;
      result.commanded = point.commanded;
    }
    points.push_back(result);
  }
  return points;
}

observation::ChainLengthReadings chain_length_readings(
    const std::vector<LengthPoint>& points,
    observation::PointNoise noise,
    double noise_dof,
    const std::optional<SheetUncertainty>& sheet) {
  std::vector<observation::Place> places;
  for (const LengthPoint& point : points) {
    places.push_back({point.index, std::to_string(point.index + 1), point.mark, point.lengths, 0});
  }
  std::optional<observation::SheetPrior> prior;
  if (sheet) prior = observation::SheetPrior{sheet->shift_mm, 1e-3 * sheet->rotation_mrad};
  return observation::ChainLengthReadings::in_given_order(
      std::move(places), false, noise, noise_dof, prior);
}

std::vector<std::vector<std::size_t>> repeat_groups(const std::vector<LengthPoint>& points) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto near = [&](const std::vector<std::size_t>& group) {
      const model::MarkPoint first = points[group.front()].mark;
      return std::hypot(first.x_mm - points[i].mark.x_mm, first.y_mm - points[i].mark.y_mm) <=
             kRepeatDistanceMm;
    };
    auto* group = find_where(groups, near);
    if (group == nullptr) {
      groups.push_back({i});
    } else {
      group->push_back(i);
    }
  }
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

namespace {

/// Readings of one quantity are combined, weighted by their sigmas, in the order of the first.
std::vector<ExtraReading> combined(const std::vector<ExtraReading>& readings) {
  std::vector<ExtraReading> result;
  for (const ExtraReading& reading : readings) {
    auto* same = find_where(result, [&](const ExtraReading& other) {
      return other.what == reading.what && other.side == reading.side;
    });
    if (same == nullptr) {
      result.push_back(reading);
      continue;
    }
    const double before = 1.0 / (same->sigma * same->sigma);
    const double more = 1.0 / (reading.sigma * reading.sigma);
    same->value = (before * same->value + more * reading.value) / (before + more);
    same->sigma = 1.0 / std::sqrt(before + more);
  }
  return result;
}

}  // namespace

std::string_view name(ReadingOf what) {
  constexpr std::string_view kNames[] = {"beam_rise_mm",
                                         "chain_mass_kg_per_m",
                                         "link_pitch_mm",
                                         "motor_spacing_mm",
                                         "ring_radius_mm",
                                         "sled_mass_kg",
                                         "tape_error_mm_per_m"};
  return kNames[static_cast<std::size_t>(what)];
}

Machine with_readings(Machine machine, const std::vector<ExtraReading>& readings) {
  for (const ExtraReading& reading : combined(readings)) {
    const auto take = machine_readings().find(reading.what);
    if (take != machine_readings().end()) take->second(machine, reading);
  }
  return machine;
}

std::vector<ExtraReading> setting_readings(const std::vector<ExtraReading>& readings) {
  std::vector<ExtraReading> result;
  for (const ExtraReading& reading : readings) {
    if (reading.what == ReadingOf::motor_spacing || reading.what == ReadingOf::beam_rise)
      result.push_back(reading);
  }
  return result;
}

}  // namespace chaintrue::grid
