// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/holes_notes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "grid/map/map_parts.hpp"

namespace chaintrue::grid {
namespace {

/// A hook is spoken of from here on.
constexpr double kHookSigmas = 2.0;

void note_set_aside(const MeasuredHoles& set,
                    const FittedDistances& fit,
                    std::vector<std::string>& notes) {
  std::map<std::size_t, int> at_hole;
  for (std::size_t k = 0; k < fit.distances.size(); ++k) {
    const FittedDistance& distance = fit.distances[k];
    if (!distance.set_aside) continue;
    const HoleDistance& reading = set.distances[k];
    notes.push_back(
        fmt::format("{} ({:g} mm on the tape) was set aside: it is {:.1f} mm {} than the others "
                    "make it, {:.1f} times what tape and holes allow. Measure it again.",
                    words_of(set, reading),
                    reading.distance_mm,
                    std::abs(distance.left_out_mm),
                    distance.left_out_mm > 0.0 ? "longer" : "shorter",
                    std::abs(distance.sigmas())));
    ++at_hole[reading.from];
    if (!reading.edge) ++at_hole[reading.to];
  }
  for (const auto& [hole, count] : at_hole) {
    if (count < 2) continue;
    notes.push_back(
        fmt::format("{} of the distances set aside end at hole {}: perhaps it is the hole that is "
                    "off its place, not the tape.",
                    count,
                    set.holes[hole].name));
  }
}

}  // namespace

std::vector<std::string> distance_notes(const MeasuredHoles& set, const FittedDistances& fit) {
  std::vector<std::string> notes;
  note_set_aside(set, fit, notes);
  if (const auto hook = suspected_hook_offset_mm(set)) {
    notes.push_back(
        fmt::format("All distances are about {:.1f} mm {} than commanded, short ones like long "
                    "ones: was the tape's hook offset left out or taken off twice?",
                    std::abs(*hook),
                    *hook > 0.0 ? "longer" : "shorter"));
  }
  for (std::size_t session = 0; session < fit.hooks.size(); ++session) {
    const FoundHook& hook = fit.hooks[session];
    if (std::abs(hook.mm) < kHookSigmas * hook.sigma_mm) continue;
    notes.push_back(fmt::format(
        "The readings{} seem to be {:.2f} +- {:.2f} mm too {}, all alike: look how the tape was "
        "held to the holes.",
        fit.hooks.size() > 1 ? fmt::format(" of set {}", session + 1) : std::string{},
        std::abs(hook.mm),
        hook.sigma_mm,
        hook.mm > 0.0 ? "long" : "short"));
  }
  return notes;
}

std::vector<std::string> fit_notes(const MeasuredHoles& set, const HolesFit& fit) {
  std::vector<std::string> notes = distance_notes(set, fit);
  if (fit.estimate.noise_factor > kNoiseDisagreement) {
    notes.push_back(fmt::format(
        "The distances scatter {:.1f} times as much as stated ({:g} mm of tape, {:g} mm "
        "of hole): the intervals are that much wider.",
        fit.estimate.noise_factor,
        set.tape.sigma_mm,
        set.hole_sigma_mm));
  }
  note_settings_off(setting_results(*set.machine, fit.estimate, std::nullopt), notes);
  const observation::SheetPrior& measured = fit.sheet_measured;
  if (!measured.knows_x || !measured.knows_y || !measured.knows_rotation) {
    std::string free;
    for (const auto& [is_measured, word] : {std::pair(measured.knows_x, "sideways"),
                                            std::pair(measured.knows_y, "up and down"),
                                            std::pair(measured.knows_rotation, "in its turn")}) {
      if (!is_measured) free += fmt::format("{}{}", free.empty() ? "" : ", ", word);
    }
    notes.push_back(
        fmt::format("No edge of the sheet tells its place {}: there the sheet is laid so that the "
                    "holes lie, as "
                    "a whole, where they were commanded.",
                    free));
  }
  notes.push_back(
      fit.estimate.has_surface
          ? std::string("The distances ask for more than settings can explain: the map bends "
                        "smoothly where they do.")
          : std::string(
                "The distances do not ask for more than settings and chain scales: the map "
                "is the calibrated machine. What no setting explains is not in its expected "
                "error."));
  if (!fit.estimate.settled) {
    notes.emplace_back(
        "The fit had not quite settled after its last pass: some distances hover between good and "
        "bad. Measure the ones with the largest errors again.");
  }
  return notes;
}

}  // namespace chaintrue::grid
