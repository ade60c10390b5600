// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/corrected_data.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/tape_distances.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using model::effects::find_effect;

bool is_of_the_paper(const Effect& effect) { return effect.station == Station::paper; }

bool is_of_the_machine(const Effect& effect) {
  return !is_of_the_paper(effect) && !depends_on_visit(effect);
}

/// The machine with only those effects for which `keep` is true.
template <class Keep>
Machine with_effects_that(Machine machine, Keep keep) {
  std::erase_if(machine.effects, [&](const AppliedEffect& applied) {
    const Effect* effect = find_effect(machine, applied.effect);
    return effect == nullptr || !keep(*effect);
  });
  return machine;
}

std::string names_of(const Machine& machine) {
  const auto name = [](const AppliedEffect& one) {
    return one.side.empty() ? one.effect : one.effect + " " + one.side;
  };
  return fmt::format("{}", fmt::join(mapped(machine.effects, name), ", "));
}

tl::expected<std::vector<ChainLengths>, FitFailure> readings_with(
    const Machine& machine, const std::vector<model::Visit>& visits) {
  auto read = model::readings(ReadingModel(machine), visits);
  if (read) return *std::move(read);
  return failed(FitReason::point_unreachable,
                fmt::format("point {} cannot be reached by the machine in your file: {}",
                            read.error().place + 1, read.error().sentence()));
}

/// Removes the visit effects from the readings, which are in the order of the points.
tl::expected<void, FitFailure> correct_readings(MeasuredGrid& grid, const Machine& with_visits,
                                                const Machine& without) {
  const auto points = length_points(grid);
  if (!points) return failed(FitReason::no_lengths, points.error());
  std::vector<model::Visit> visits;
  for (const MeasuredPoint& point : grid.points)
    visits.push_back({model::identity_placement(point.mark), *point.order});
  const auto disturbed = readings_with(with_visits, visits);
  if (!disturbed) return failed(disturbed);
  const auto quiet = readings_with(without, visits);
  if (!quiet) return failed(quiet);
  for (const auto i : each_index(grid.points)) {
    ChainLengths read = (*points)[i].lengths;
    for (const Side side : kSides) read[side] -= (*disturbed)[i][side] - (*quiet)[i][side];
    grid.points[i].lengths = read;
    grid.points[i].commanded.reset();
  }
  return {};
}

}  // namespace

tl::expected<CorrectedData, FitFailure> corrected_data(const MeasuredGrid& grid) {
  CorrectedData corrected{grid, {}};
  if (!grid.machine || !model::effects::problems_of_effects(*grid.machine).empty())
    return corrected;
  const Machine paper = with_effects_that(*grid.machine, is_of_the_paper);
  const Machine visit = with_effects_that(*grid.machine, model::effects::depends_on_visit);
  const Machine rest = with_effects_that(*grid.machine, is_of_the_machine);
  if (!paper.effects.empty()) {
    const model::MarkFrame marks(paper);
    for (MeasuredPoint& point : corrected.grid.points) point.mark = marks.place(point.mark);
    corrected.notes.push_back(
        fmt::format("The marks were moved to their true positions ({}).", names_of(paper)));
  }
  if (!visit.effects.empty()) {
    if (all_of(grid.points, &MeasuredPoint::order)) {
      Machine both = rest;
      append_all(both.effects, visit.effects);
      if (auto done = correct_readings(corrected.grid, both, rest); !done) return failed(done);
      corrected.notes.push_back(
          fmt::format("Changes during the session were removed from the readings ({}): the map, "
                      "and the errors with it and without, are for the machine before the change.",
                      names_of(visit)));
    } else {
      corrected.notes.push_back(
          fmt::format("{} could not be removed from the readings: the order of the visits is not "
                      "recorded.",
                      names_of(visit)));
    }
  }
  corrected.grid.machine->effects = rest.effects;
  return corrected;
}

MeasuredHoles with_true_tape(MeasuredHoles set) {
  if (!set.machine || !model::effects::problems_of_effects(*set.machine).empty()) return set;
  const double factor = observation::tape_factor(*set.machine);
  for (HoleDistance& distance : set.distances)
    distance.distance_mm = set.tape.tape_zero_offset_mm + length_of(set, distance) / factor;
  set.machine = with_effects_that(*set.machine, is_of_the_machine);
  return set;
}

}  // namespace chaintrue::grid
