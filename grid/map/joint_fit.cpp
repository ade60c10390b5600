// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/joint_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/map/fit_part.hpp"
#include "grid/map/largest_error.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/map/map_parts.hpp"
#include "grid/observation/single_readings.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

using Parts = std::vector<std::unique_ptr<FitPart>>;

tl::expected<void, FitFailure> check_one_machine(const std::vector<MeasuredFile>& files) {
  if (files.size() == 1) return {};
  for (const MeasuredFile& file : files) {
    const auto& machine = file.machine();
    if (!machine) {
      return failed(FitReason::no_machine,
                    fmt::format("{} has no machine: add --machine", file.name));
    }
    const std::string difference = difference_of_settings(*files.front().machine(), *machine);
    if (!difference.empty()) {
      return failed(FitReason::impossible_readings, fmt::format("{}: {}", file.name, difference));
    }
  }
  return {};
}

tl::expected<Parts, FitFailure> parts_of(const std::vector<MeasuredFile>& files,
                                         const Progress& progress) {
  if (auto one = check_one_machine(files); !one) return failed(one);
  const bool with_grids =
      any_of(files, [](const MeasuredFile& file) { return file.grid() != nullptr; });
  Parts parts;
  for (const MeasuredFile& file : files) {
    if (files.size() > 1) tell(progress, {"each file by itself", 1, 3});
    const MeasuredHoles* set = file.holes();
    auto part =
        set == nullptr ? part_of(*file.grid()) : part_of(with_grids ? with_true_tape(*set) : *set);
    if (!part) {
      return failed(part.error().reason, (files.size() > 1 ? file.name + ": " : std::string{}) +
                                             part.error().sentence());
    }
    parts.push_back(*std::move(part));
  }
  return parts;
}

estimation::EstimationInput estimation_input(const Parts& parts) {
  estimation::EstimationInput input;
  input.domain = parts.front()->domain;
  input.noise = parts.front()->noise;
  std::vector<ExtraReading> readings;
  bool reads_chains = false;
  std::size_t units = 0;
  for (const auto& part : parts) {
    input.observations.push_back(part->observation);
    take_in(input.domain, {part->domain.x_min, part->domain.y_min});
    take_in(input.domain, {part->domain.x_max, part->domain.y_max});
    input.noise.degrees_of_freedom =
        std::min(input.noise.degrees_of_freedom, part->noise.degrees_of_freedom);
    reads_chains = reads_chains || part->observation->kind().reads_chains;
    for (estimation::UnitGroup group : part->held_out_together) {
      for (std::size_t& unit : group) unit += units;
      input.held_out_together.push_back(std::move(group));
    }
    append_all(readings, part->readings);
    units += part->observation->units().size();
  }
  input.machine = with_readings(parts.front()->machine, readings);
  input.surface =
      reads_chains ? estimation::SurfaceUse::smoothed : estimation::SurfaceUse::on_evidence;
  if (!reads_chains) {
    input.intervals_x = kHolesIntervalsX;
    input.intervals_y = kHolesIntervalsY;
  }
  const auto of_settings = setting_readings(readings);
  if (!of_settings.empty())
    input.observations.push_back(std::make_shared<const observation::SingleReadings>(of_settings));
  return input;
}

/// A map must keep two thirds of a file's readings: more rejections are not writing errors.
tl::expected<void, FitFailure> check_enough_good(const std::vector<MeasuredFile>& files,
                                                 const Parts& parts,
                                                 const estimation::Estimate& estimate) {
  for (const auto k : each_index(parts)) {
    std::size_t all = 0, bad = 0;
    for (const estimation::UnitEstimate& unit : estimate.units) {
      all += unit.observation == k;
      bad += unit.observation == k && unit.is_rejected();
    }
    const bool alone = parts.size() == 1;
    if (3 * bad <= all && (!alone || all - bad >= parts[k]->fewest_good)) continue;
    const std::string_view units = parts[k]->observation->kind().units;
    return failed(
        FitReason::rank_deficient,
        alone ? fmt::format("{} of {} {} contradict the others or the machine file; check {}", bad,
                            all, units, parts[k]->to_check())
              : fmt::format("{}: {} of {} {} contradict the other files or the machine file: are "
                            "all from one machine, with the same chains on the same teeth?",
                            files[k].name, bad, all, units));
  }
  return {};
}

/// One file, with its noise estimated if it is not stated.
tl::expected<Fitting, FitFailure> fit_alone(FitPart& part, estimation::EstimationInput input) {
  auto fitting = Fitting::of(std::move(input));
  if (!fitting) return fitting;
  if (auto found = part.find_noise(*fitting); !found) return failed(found);
  return fitting;
}

/// Grids without stated noise are fitted alone to estimate it.
tl::expected<void, FitFailure> state_noises(const std::vector<MeasuredFile>& files, Parts& parts) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k]->noise.knowledge != interp::NoiseKnowledge::unknown) continue;
    Parts one;
    one.push_back(std::move(parts[k]));
    auto alone = fit_alone(*one.front(), estimation_input(one));
    if (alone) {
      if (auto good = check_enough_good({files[k]}, one, alone->estimate); !good)
        alone = tl::unexpected(good.error());
    }
    if (!alone)
      return failed(alone.error().reason, files[k].name + ": " + alone.error().sentence());
    one.front()->take_noise(*alone);
    parts[k] = std::move(one.front());
  }
  return {};
}

/// Sessions whose chains were hung differently from the map's session.
void note_zeros(const std::vector<MeasuredFile>& files, const estimation::Estimate& estimate,
                std::vector<std::string>& notes) {
  const auto own = [&](std::size_t k) -> const auto& { return estimate.observations[k].zeros; };
  std::size_t of_map = 0;
  while (of_map + 1 < files.size() && files[of_map].grid() == nullptr) ++of_map;
  for (const auto k : each_index(files)) {
    if (!own(k)) continue;
    const std::string words = estimation::words_of(*own(k));
    if (words.empty()) continue;
    notes.push_back(
        fmt::format("{}: the chains' zeros differ from those in {}: {}. The map is for the zeros "
                    "of {}. If the machine now has the other zeros, name that file first.",
                    files[k].name, files[of_map].name, words, files[of_map].name));
  }
}

std::vector<std::string> notes_of(const Parts& parts, const Fitting& fitting,
                                  const std::vector<MeasuredFile>& files, const MapDraft& draft,
                                  const std::vector<SettingResult>& settings) {
  std::vector<std::string> notes;
  for (const auto& part : parts) append_all(notes, part->corrections);
  if (parts.size() > 1) {
    notes.push_back(
        fmt::format("Fitted together: {}. The map's frame is that of {}. The noise is {:.2f} "
                    "times what the files state; the fewest degrees of freedom in any of them, "
                    "{:g}, keep this factor near 1.",
                    fmt::join(draft.sources, "; "), files.front().name,
                    fitting.estimate.noise_factor, fitting.input.noise.degrees_of_freedom));
    note_zeros(files, fitting.estimate, notes);
  }
  append_all(notes, draft.notes);
  note_settings_off(settings, notes);
  append_all(notes, draft.frame_notes);
  if (fitting.input.surface == estimation::SurfaceUse::on_evidence) {
    notes.emplace_back(
        fitting.estimate.has_surface
            ? "Settings cannot explain all of the distances, so the map includes a smooth "
              "correction."
            : "Settings and chain scales explain the distances, so the map is the calibrated "
              "machine. Its expected error does not include effects that no setting explains.");
  }
  if (!fitting.estimate.converged) {
    notes.push_back(fmt::format(
        "The fit had not fully converged after its last pass, because some {} are on the limit "
        "between good and bad. Measure those with the largest errors again.",
        parts.size() > 1 ? "readings" : parts.front()->observation->kind().units));
  }
  append_all(notes, draft.last_notes);
  return notes;
}

/// If readings scatter clearly more than stated, left-out blocks estimate the map's error better
/// than the fit, which treats all of the scatter as noise.
CompensationMap with_held_out_error(CompensationMap map) {
  // With 12 degrees of freedom stated and 40 in the fit, noise alone does so once in 500.
  constexpr double kClearly = 2.0;
  const MapNoise& noise = map.contents().noise;
  const double expected_mm = map.contents().accuracy.expected_tool.rms_mm;
  const bool is_stated = noise.source == NoiseSource::stated;
  if (!is_stated || noise.factor_found < kClearly || !(expected_mm > 0.0)) return map;
  const double left_out_mm2 =
      std::pow(map.contents().accuracy.blocked.tool.rms_mm, 2) - std::pow(noise_at_tool_mm(map), 2);
  if (left_out_mm2 <= expected_mm * expected_mm) return map;
  const double larger_mm = std::sqrt(left_out_mm2);
  return with_larger_error(map, larger_mm / expected_mm)
      .with_notes_first(
          {fmt::format("The fit expects an error of {:.2f} mm rms, but points in left-out parts of "
                       "the bed are off by {:.2f} mm, more than the scatter of the readings. The "
                       "larger number is reported. The map lacks some cause; chaintrue diagnose "
                       "looks for it.",
                       expected_mm, larger_mm)});
}

/// The map's statements about itself, collected file by file.
CompensationMap map_of(const std::vector<MeasuredFile>& files, const Parts& parts,
                       const Fitting& fitting, MapDraft& draft) {
  const bool alone = files.size() == 1;
  MapContents& map = draft.map;
  map.surface = model_surface(fitting.estimate);
  for (const auto k : each_index(parts))
    parts[k]->add_to(draft, fitting, k, alone ? std::string{} : files[k].name);
  map.name = std::visit([](const auto& one) { return one.name; }, files.front().measured);
  map.domain = fitting.input.domain;
  const MeasuredArea area(draft.good, map.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  map.settings = setting_results(fitting.input.machine, fitting.estimate, parts.front()->sheet);
  if (draft.points.empty()) {
    std::vector<FittedDistance> all;
    for (const FittedDistances& one : draft.distances) append_all(all, one.distances);
    map.distances = distances_used(all, draft.tape_sigma_mm);
    map.accuracy.leave_one_out.tool = map.accuracy.leave_one_out.chain =
        map.distances->left_out_good;
    map.accuracy.blocked = map.accuracy.leave_one_out;
  } else {
    map.accuracy = held_out_accuracy(draft.points);
  }
  map.notes = notes_of(parts, fitting, files, draft, map.settings);
  CompensationMap finished = with_expected_error(std::move(map));
  if (draft.points.empty()) return finished;
  if (alone) finished = with_held_out_error(std::move(finished));
  MapContents with_mirror = finished.contents();
  with_mirror.mirror = test_mirror(finished);
  return CompensationMap(std::move(with_mirror));
}

}  // namespace

tl::expected<Fitting, FitFailure> Fitting::of(estimation::EstimationInput input) {
  auto estimate = estimation::estimate(input);
  if (!estimate) {
    constexpr FitReason kReasons[] = {FitReason::point_unreachable, FitReason::rank_deficient,
                                      FitReason::not_converged};  // by EstimationReason
    return failed(kReasons[as_size(estimate.error().reason)], estimate.error().sentence());
  }
  return Fitting{std::move(input), *std::move(estimate)};
}

MarkPoint Fitting::in_frame(std::size_t file, MarkPoint mark) const {
  if (file == 0) return mark;
  return estimate.observations[0].sheet.to_mark(estimate.observations[file].sheet.to_bed(mark));
}

tl::expected<void, FitFailure> check_readings_of(const Machine& machine,
                                                 const std::vector<ExtraReading>& readings,
                                                 const char* what) {
  const Machine read = with_readings(machine, readings);
  std::string problems;
  std::vector<model::MachineProblem> found = model::problems_of(read);
  append_all(found, model::effects::problems_of_effects(read));
  for (const model::MachineProblem& problem : found) {
    problems += fmt::format(" {} would be {}, expected {};", problem.parameter, problem.value,
                            problem.expected);
  }
  if (problems.empty()) return {};
  problems.back() = '.';
  return failed(FitReason::impossible_readings,
                fmt::format("with the {} readings put in,{}", what, problems));
}

tl::expected<JointFit, FitFailure> joint_fit(const Measured& measured,
                                             const JointFitOptions& options) {
  const std::vector<MeasuredFile>& files = measured.files();
  if (files.empty()) throw std::invalid_argument("no files to fit");
  auto parts = parts_of(files, options.progress);
  if (!parts) return failed(parts);
  const bool alone = files.size() == 1;
  if (!alone) {
    if (auto stated = state_noises(files, *parts); !stated) return failed(stated);
  }
  estimation::EstimationInput input = estimation_input(*parts);
  input.progress = options.progress;
  const bool finds_noise = input.noise.knowledge == interp::NoiseKnowledge::unknown;
  const int steps = !alone ? 3 : finds_noise ? FitPart::kStepsToFindNoise : 2;
  input.step = {"settings and correction", alone ? 1 : 2, steps};
  auto fitting =
      alone ? fit_alone(*parts->front(), std::move(input)) : Fitting::of(std::move(input));
  if (!fitting) return failed(fitting);
  if (auto good = check_enough_good(files, *parts, fitting->estimate); !good) return failed(good);
  tell(options.progress, {"the map's own error", steps, steps});
  MapDraft draft;
  CompensationMap map = map_of(files, *parts, *fitting, draft);
  if (options.outside.way != Outside::continued) map = map.with_outside(options.outside);
  return JointFit{std::move(fitting->estimate), std::move(draft.points), std::move(draft.distances),
                  std::move(map)};
}

}  // namespace chaintrue::grid
