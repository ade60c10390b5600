// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "grid/holes/hole_marks.hpp"
#include "grid/map/map_accuracy.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;

constexpr double kOffSigmas = 3.0;
/// A noise that the readings contradict by this much is worth a sentence.
constexpr double kNoiseDisagreement = 1.5;
/// A hook is spoken of from here on.
constexpr double kHookSigmas = 2.0;

void note_set_aside(const MeasuredHoles& set,
                    const HolesFit& fit,
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

std::vector<SettingResult> setting_results(const MeasuredHoles& set, const HolesFit& fit) {
  std::vector<SettingResult> results;
  const Eigen::MatrixXd& factor = fit.surface.covariance_factor;
  for (std::size_t i = 0; i < fit.surface.settings.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    SettingResult result{fit.surface.settings[i], 0.0, 0.0, factor.row(at).norm(), false};
    if (i < model::kMachineSettings.size()) {
      result.stated = model::stated_value(*set.machine, result.setting);
      result.calibrated = model::stated_value(fit.machine, result.setting);
      result.off = std::abs(result.calibrated - result.stated) >
                   kOffSigmas * model::stated_sigma(*set.machine, result.setting);
    } else {
      const double placed[] = {fit.sheet.x_mm, fit.sheet.y_mm, fit.sheet.rotation_rad};
      result.calibrated = placed[i - model::kMachineSettings.size()];
    }
    results.push_back(result);
  }
  return results;
}

}  // namespace

std::vector<std::string> fit_notes(const MeasuredHoles& set, const HolesFit& fit) {
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
  if (fit.noise_factor > kNoiseDisagreement) {
    notes.push_back(fmt::format(
        "The distances scatter {:.1f} times as much as stated ({:g} mm of tape, {:g} mm "
        "of hole): the intervals are that much wider.",
        fit.noise_factor,
        set.tape.sigma_mm,
        set.hole_sigma_mm));
  }
  for (const SettingResult& setting : setting_results(set, fit)) {
    if (!setting.off) continue;
    notes.push_back(fmt::format(
        "{} ended {:+.2f} mm from what was stated, more than three times its stated uncertainty: "
        "measure it again, or something else imitates it.",
        model::name(setting.setting),
        setting.calibrated - setting.stated));
  }
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
      fit.has_surface
          ? std::string("The distances ask for more than settings can explain: the map bends "
                        "smoothly where they do.")
          : std::string(
                "The distances do not ask for more than settings and chain scales: the map "
                "is the calibrated machine. What no setting explains is not in its expected "
                "error."));
  return notes;
}

CompensationMap map_of(const MeasuredHoles& set, const HolesFit& fit) {
  if (!set.machine) throw std::invalid_argument("a map of holes stands on a machine");
  MapContents map;
  map.name = set.name;
  map.surface = fit.surface;
  map.domain = holes_domain(set.machine->bed);
  std::vector<BedPoint> places;
  for (const FittedHole& hole : fit.holes) places.push_back(hole.predicted);
  const MeasuredArea area(places, map.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  map.noise = {0.0, set.hole_sigma_mm, "stated", fit.noise_factor};
  map.settings = setting_results(set, fit);
  for (const FittedHole& hole : fit.holes) {
    MapPoint point;
    point.mark = hole.place;
    point.lengths = hole.lengths;
    const auto beside = [&hole](BedPoint from) {
      return Eigen::Vector2d(hole.place.x_mm - from.x_mm, hole.place.y_mm - from.y_mm);
    };
    point.as_stated_mm = point.sheet_placed_mm = beside(hole.as_stated);
    point.mapped_mm = point.left_out_mm = beside(hole.predicted);
    map.points.push_back(point);
  }
  map.notes = fit.notes;
  DistancesUsed used;
  used.tape_sigma_mm = set.tape.sigma_mm;
  for (const FittedDistance& distance : fit.distances) {
    (distance.set_aside ? used.set_aside : used.used) += 1;
  }
  used.left_out_all = fit.left_out_all;
  used.left_out_good = fit.left_out_good;
  map.distances = used;
  map.accuracy.leave_one_out.tool = map.accuracy.leave_one_out.chain = fit.left_out_good;
  map.accuracy.blocked = map.accuracy.leave_one_out;
  const CompensationMap first(map);
  measure_expected_error(first, map.accuracy);
  return CompensationMap(std::move(map));
}

}  // namespace chaintrue::grid
