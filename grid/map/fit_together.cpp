// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit_together.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "grid/estimation/spatial_blocks.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/map/holes_notes.hpp"
#include "grid/map/map_parts.hpp"
#include "grid/map/points_map.hpp"
#include "grid/observation/single_readings.hpp"

namespace chaintrue::grid {
namespace {

using model::MarkPoint;

tl::unexpected<FitFailure> fail(FitFailure::Reason reason, const std::string& sentence) {
  return tl::unexpected(FitFailure{reason, sentence});
}

/// A file as an observation, with what its map needs.
struct FittedPart {
  std::shared_ptr<const observation::Observation> observation;
  std::optional<PointsFitInput> points;  ///< of a grid
  const MeasuredGrid* grid = nullptr;    ///< corrected
  std::shared_ptr<const observation::TapeDistances> distances;
  double noise_dof = 0.0;
  interp::Rectangle domain;
};

tl::expected<void, FitFailure> check_one_machine(const std::vector<MeasuredFile>& files) {
  for (const MeasuredFile& file : files) {
    const auto& machine = file.machine();
    if (!machine) {
      return fail(FitFailure::Reason::no_machine,
                  fmt::format("{} names no machine: give --machine", file.name));
    }
    const std::string difference = difference_of_settings(*files.front().machine(), *machine);
    if (!difference.empty()) {
      return fail(FitFailure::Reason::impossible_readings,
                  fmt::format("{}: {}", file.name, difference));
    }
  }
  return {};
}

/// A grid that states no noise is fitted alone for it.
tl::expected<FittedPart, FitFailure> part_of(const MeasuredGrid& grid) {
  const auto points = length_points(grid);
  if (!points)
    return tl::unexpected(FitFailure{FitFailure::Reason::no_lengths, points.error().sentence});
  if (auto possible = check_machine_read(grid); !possible) return tl::unexpected(possible.error());
  FittedPart part;
  part.grid = &grid;
  part.points = points_input(grid, *points);
  if (part.points->noise_scale.knowledge == interp::NoiseKnowledge::unknown) {
    auto alone = fit_grid(grid);
    if (!alone) return tl::unexpected(alone.error());
    const double factor = alone->fit.estimate.noise_factor;
    const double left =
        2.0 * static_cast<double>(points->size()) - alone->fit.estimate.effective_parameters;
    const bool repeats = alone->noise_source == "repeats";
    part.points->noise = {factor * alone->input.noise.length_mm,
                          factor * alone->input.noise.position_mm};
    part.points->noise_scale = {
        interp::NoiseKnowledge::from_repeats,
        repeats ? alone->input.noise_scale.degrees_of_freedom : std::max(left, 1.0)};
  }
  part.noise_dof = part.points->noise_scale.degrees_of_freedom;
  part.domain = part.points->domain;
  part.observation = std::make_shared<const observation::ChainLengthReadings>(chain_length_readings(
      part.points->points, part.points->noise, part.noise_dof, part.points->sheet));
  return part;
}

tl::expected<FittedPart, FitFailure> part_of(const MeasuredHoles& set) {
  auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) return fail(FitFailure::Reason::no_lengths, distances.error().sentence);
  FittedPart part;
  part.distances = std::make_shared<const observation::TapeDistances>(*std::move(distances));
  part.observation = part.distances;
  part.noise_dof = set.noise_dof;
  part.domain = holes_domain(set.machine->bed);
  return part;
}

interp::Rectangle around(const interp::Rectangle& a, const interp::Rectangle& b) {
  return {std::min(a.x_min, b.x_min),
          std::max(a.x_max, b.x_max),
          std::min(a.y_min, b.y_min),
          std::max(a.y_max, b.y_max)};
}

/// Readings of the machine from every grid that has some.
std::vector<ExtraReading> readings_of(const std::vector<FittedPart>& parts) {
  std::vector<ExtraReading> readings;
  for (const FittedPart& part : parts) {
    if (part.grid != nullptr)
      readings.insert(readings.end(), part.grid->readings.begin(), part.grid->readings.end());
  }
  return readings;
}

estimation::EstimationInput estimation_input(const model::Machine& stated,
                                             const std::vector<FittedPart>& parts) {
  estimation::EstimationInput input;
  const std::vector<ExtraReading> readings = readings_of(parts);
  input.machine = with_readings(stated, readings);
  input.domain = parts.front().domain;
  double dof = parts.front().noise_dof;
  bool reads_chains = false;
  std::size_t units = 0;
  for (const FittedPart& part : parts) {
    input.observations.push_back(part.observation);
    input.domain = around(input.domain, part.domain);
    dof = std::min(dof, part.noise_dof);
    reads_chains = reads_chains || part.points.has_value();
    if (part.points) {
      for (auto& block : spatial_blocks(part.points->points)) {
        for (std::size_t& unit : block) unit += units;
        input.held_out_together.push_back(std::move(block));
      }
    }
    units += part.observation->units().size();
  }
  input.noise = {interp::NoiseKnowledge::from_repeats, dof};
  input.surface =
      reads_chains ? estimation::SurfaceUse::smoothed : estimation::SurfaceUse::on_evidence;
  if (!reads_chains) {
    input.intervals_x = kHolesIntervalsX;
    input.intervals_y = kHolesIntervalsY;
  }
  const auto of_settings = setting_readings(readings);
  if (!of_settings.empty()) {
    input.observations.push_back(std::make_shared<const observation::SingleReadings>(of_settings));
  }
  return input;
}

/// A third of a file's readings against the others is no slip of the hand.
tl::expected<void, FitFailure> check_enough_good(const std::vector<MeasuredFile>& files,
                                                 const estimation::Estimate& estimate) {
  for (std::size_t k = 0; k < files.size(); ++k) {
    std::size_t all = 0;
    std::size_t aside = 0;
    for (const estimation::UnitEstimate& unit : estimate.units) {
      if (unit.observation != k) continue;
      ++all;
      aside += unit.is_set_aside() ? 1 : 0;
    }
    if (3 * aside <= all) continue;
    return fail(FitFailure::Reason::rank_deficient,
                fmt::format("{}: {} of {} {} contradict the other files or the machine as stated: "
                            "are all of one machine, with the same chains hung on the same teeth?",
                            files[k].name,
                            aside,
                            all,
                            files[k].grid() != nullptr ? "points" : "distances"));
  }
  return {};
}

/// What the map says of itself, gathered file by file.
class TogetherMap {
 public:
  TogetherMap(const std::vector<MeasuredFile>& files,
              const std::vector<FittedPart>& parts,
              const estimation::EstimationInput& input,
              const estimation::Estimate& estimate)
      : files_(files), parts_(parts), input_(input), estimate_(estimate) {}

  [[nodiscard]] TogetherFit assemble() {
    std::vector<HolesAmongFiles> holes;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if (parts_[k].points) {
        add_points(k);
      } else {
        holes.push_back({k, fitted_distances(*parts_[k].distances, estimate_, k)});
        add_holes(k, holes.back().fit);
      }
    }
    finish(holes);
    return {estimate_, std::move(holes), with_expected_error(std::move(map_))};
  }

 private:
  /// A place in the first file's frame.
  [[nodiscard]] MarkPoint in_frame(std::size_t file, MarkPoint mark) const {
    if (file == 0) return mark;
    return estimate_.observations[0].sheet.to_mark(estimate_.observations[file].sheet.to_bed(mark));
  }

  void add_points(std::size_t file) {
    const PointsFitInput& points = *parts_[file].points;
    PointsFit fit{estimate_, fitted_points(points.points, estimate_, file)};
    std::size_t aside = 0;
    for (std::size_t i = 0; i < fit.points.size(); ++i) {
      const FittedPoint& point = fit.points[i];
      if (!point.bad) {
        good_.push_back(in_frame(file, point.point.mark));
        fitted_.push_back(point);
        continue;
      }
      ++aside;
      const Eigen::Vector2d off = point.mark_jacobian.inverse() * point.left_out_residual_mm;
      notes_.push_back(
          fmt::format("{}: point {} at ({:.0f}, {:.0f}) was set aside: it lies {:.1f} "
                      "mm beside where the others put it, {:.0f} times what the noise "
                      "allows. Measure it again.",
                      files_[file].name,
                      point.point.index + 1,
                      point.point.mark.x_mm,
                      point.point.mark.y_mm,
                      off.norm(),
                      point.distance));
    }
    for (MapPoint& point : map_points(points, fit, *parts_[file].grid)) {
      point.mark = in_frame(file, point.mark);
      map_.points.push_back(point);
    }
    sources_.push_back(fmt::format("{} points of {}{}",
                                   fit.points.size(),
                                   files_[file].name,
                                   aside == 0 ? "" : fmt::format(" ({} set aside)", aside)));
    if (!has_points_) {
      has_points_ = true;
      map_.noise = {points.noise.length_mm, points.noise.position_mm, "stated", 1.0};
    }
  }

  void add_holes(std::size_t file, const FittedDistances& fit) {
    const MeasuredHoles& set = parts_[file].distances->set();
    int aside = 0;
    for (const FittedDistance& distance : fit.distances) aside += distance.set_aside ? 1 : 0;
    for (const FittedHole& hole : fit.holes) good_.push_back(in_frame(file, hole.predicted));
    for (const std::string& note : distance_notes(set, fit))
      notes_.push_back(fmt::format("{}: {}", files_[file].name, note));
    sources_.push_back(fmt::format(
        "{} distances between {} holes of {}{}, which come out within {:.2f} mm rms left out one "
        "at a time",
        fit.distances.size(),
        fit.holes.size(),
        files_[file].name,
        aside == 0 ? "" : fmt::format(" ({} set aside)", aside),
        fit.left_out_good.rms_mm));
  }

  /// Of sets of holes alone the points are the holes, and errors those of distances.
  void tell_holes(const std::vector<HolesAmongFiles>& holes) {
    std::vector<FittedDistance> all;
    for (const HolesAmongFiles& one : holes) {
      for (const FittedHole& hole : one.fit.holes) {
        FittedHole moved = hole;
        moved.predicted = in_frame(one.file, hole.predicted);
        moved.as_stated = in_frame(one.file, hole.as_stated);
        moved.place = in_frame(one.file, hole.place);
        map_.points.push_back(map_point(moved));
      }
      all.insert(all.end(), one.fit.distances.begin(), one.fit.distances.end());
    }
    const MeasuredHoles& first = parts_.front().distances->set();
    map_.noise = {0.0, first.hole_sigma_mm, "stated", 1.0};
    map_.distances = distances_used(all, first.tape.sigma_mm);
    map_.accuracy.leave_one_out.tool = map_.accuracy.leave_one_out.chain =
        map_.distances->left_out_good;
    map_.accuracy.blocked = map_.accuracy.leave_one_out;
  }

  void finish(const std::vector<HolesAmongFiles>& holes) {
    map_.name = std::visit([](const auto& one) { return one.name; }, files_.front().measured);
    map_.surface = model_surface(estimate_);
    map_.domain = input_.domain;
    const MeasuredArea area(good_, map_.domain);
    map_.hull = area.hull();
    map_.edge_mm = area.edge_mm();
    const MeasuredGrid* grid = files_.front().grid();
    map_.settings =
        setting_results(input_.machine, estimate_, grid != nullptr ? grid->sheet : std::nullopt);
    if (has_points_) {
      map_.accuracy = held_out_accuracy(fitted_);
    } else {
      tell_holes(holes);
    }
    map_.noise.factor_found = estimate_.noise_factor;
    map_.notes.push_back(
        fmt::format("Fitted together: {}. The map's frame is that of {}; the noise is what each "
                    "file states, times {:.2f} as found, which the fewest degrees of freedom that "
                    "any of them states, {:g}, hold near 1.",
                    fmt::join(sources_, "; "),
                    files_.front().name,
                    estimate_.noise_factor,
                    input_.noise.degrees_of_freedom));
    map_.notes.insert(map_.notes.end(), notes_.begin(), notes_.end());
    note_settings_off(map_.settings, map_.notes);
    if (!estimate_.settled) {
      map_.notes.emplace_back(
          "The fit had not quite settled after its last pass: some readings hover between good and "
          "bad. Measure the ones with the largest errors again.");
    }
  }

  const std::vector<MeasuredFile>& files_;
  const std::vector<FittedPart>& parts_;
  const estimation::EstimationInput& input_;
  const estimation::Estimate& estimate_;
  MapContents map_;
  std::vector<FittedPoint> fitted_;  ///< the good points of all grids
  std::vector<MarkPoint> good_;
  std::vector<std::string> sources_;
  std::vector<std::string> notes_;
  bool has_points_ = false;
};

}  // namespace

tl::expected<TogetherFit, FitFailure> fit_together(const Measured& measured,
                                                   const Progress& progress) {
  const std::vector<MeasuredFile>& files = measured.files();
  if (files.empty()) throw std::invalid_argument("no files to fit together");
  constexpr int kSteps = 3;
  if (auto one = check_one_machine(files); !one) return tl::unexpected(one.error());
  std::vector<CorrectedData> corrected(files.size());
  std::vector<FittedPart> parts;
  std::vector<std::string> corrections;
  for (std::size_t k = 0; k < files.size(); ++k) {
    tell(progress, {"each file by itself", 1, kSteps});
    const MeasuredGrid* grid = files[k].grid();
    tl::expected<FittedPart, FitFailure> part;
    if (grid != nullptr) {
      auto data = corrected_data(*grid);
      if (!data) return fail(data.error().reason, files[k].name + ": " + data.error().sentence);
      corrected[k] = *std::move(data);
      corrections.insert(corrections.end(), corrected[k].notes.begin(), corrected[k].notes.end());
      part = part_of(corrected[k].grid);
    } else {
      part = part_of(*files[k].holes());
    }
    if (!part) return fail(part.error().reason, files[k].name + ": " + part.error().sentence);
    parts.push_back(*std::move(part));
  }
  const model::Machine stated =
      parts.front().grid != nullptr ? *parts.front().grid->machine : *files.front().machine();
  estimation::EstimationInput input = estimation_input(stated, parts);
  input.progress = progress;
  input.step = {"settings and correction", 2, kSteps};
  const auto estimate = estimation::estimate(input);
  if (!estimate) return tl::unexpected(failure_of(estimate.error()));
  if (auto sound = check_enough_good(files, *estimate); !sound)
    return tl::unexpected(sound.error());
  tell(progress, {"the map's own error", kSteps, kSteps});
  TogetherFit fit = TogetherMap(files, parts, input, *estimate).assemble();
  if (!corrections.empty()) {
    MapContents contents = fit.map.contents();
    contents.notes.insert(contents.notes.begin(), corrections.begin(), corrections.end());
    fit.map = CompensationMap(std::move(contents));
  }
  return fit;
}

}  // namespace chaintrue::grid
