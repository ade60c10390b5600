// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/holes/sets_together.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "grid/observation/measured.hpp"
#include "model/controllers/payout.hpp"

namespace chaintrue::grid {
namespace {

/// Why `set` cannot stand beside `first`; empty where it can.
std::string mismatch(const MeasuredHoles& first, const MeasuredHoles& set) {
  if (!set.machine) return "the holes name no machine";
  if (std::string difference = difference_of_settings(*first.machine, *set.machine);
      !difference.empty())
    return difference;
  const auto differ = [](const char* what, double in_first_mm, double here_mm) {
    return in_first_mm == here_mm
               ? std::string{}
               : fmt::format(
                     "{} is {} in this file and {} in the first", what, here_mm, in_first_mm);
  };
  if (std::string why = differ("hole_sigma_mm", first.hole_sigma_mm, set.hole_sigma_mm);
      !why.empty())
    return why;
  if (std::string why = differ("hook_sigma_mm",
                               first.tape.hook_sigma_mm.value_or(0.0),
                               set.tape.hook_sigma_mm.value_or(0.0));
      !why.empty())
    return why;
  return {};
}

/// What the first controller would be told for the holes of another set.
tl::expected<std::vector<model::BedPoint>, std::string> commands(
    const model::ControllerKinematics& controller, const MeasuredHoles& set) {
  const auto own = model::make_controller_kinematics(*set.machine);
  std::vector<model::BedPoint> result;
  for (const Hole& hole : set.holes) {
    const auto command = own->lengths(hole.commanded).and_then([&](model::ChainLengths lengths) {
      return controller.command(lengths);
    });
    if (!command) {
      return tl::unexpected(fmt::format("hole {} at ({:.1f}, {:.1f}): {}",
                                        hole.name,
                                        hole.commanded.x_mm,
                                        hole.commanded.y_mm,
                                        model::explain(command.error())));
    }
    result.push_back(*command);
  }
  return result;
}

}  // namespace

tl::expected<MeasuredHoles, std::string> sets_together(const std::vector<MeasuredHoles>& sets) {
  if (sets.empty()) throw std::invalid_argument("no sets of holes to put together");
  MeasuredHoles all = sets.front();
  if (!all.machine) return tl::unexpected(std::string("the holes name no machine"));
  all.distances.clear();
  all.tape.hook_offset_mm = 0.0;
  const auto controller = model::make_controller_kinematics(*all.machine);
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const MeasuredHoles& set = sets[k];
    if (const std::string why = mismatch(sets.front(), set); !why.empty()) {
      return tl::unexpected(fmt::format("set {}: {}", k + 1, why));
    }
    const std::size_t before = k == 0 ? 0 : all.holes.size();
    if (k > 0) {
      const auto places = commands(*controller, set);
      if (!places) return tl::unexpected(fmt::format("set {}: {}", k + 1, places.error()));
      for (std::size_t i = 0; i < set.holes.size(); ++i)
        all.holes.push_back({fmt::format("{} ({})", set.holes[i].name, k + 1), (*places)[i]});
    }
    for (const HoleDistance& distance : set.distances) {
      if (k > 0 && distance.edge) continue;
      all.distances.push_back({.from = before + distance.from,
                               .to = distance.edge ? 0 : before + distance.to,
                               .edge = distance.edge,
                               .distance_mm = length_of(set, distance),
                               .sigma_mm = sigma_of(set, distance),
                               .session = k});
    }
  }
  return all;
}

}  // namespace chaintrue::grid
