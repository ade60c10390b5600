// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Plans of marks, of holes and of a check: the places, and what the command writes of them.
#include <optional>
#include <utility>

#include "grid/files/holes_file.hpp"
#include "grid/planning/check_plan.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/planning/second_visits.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/holes_drawing.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/plan_after.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/sheet_page.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"
#include "tools/python/core/gather.hpp"

namespace chaintrue::python {
namespace {

/// What every plan is asked for; in mm.
struct Asked {
  int points = 0;
  std::optional<double> margin_mm;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::string measure;  ///< places, lengths, or empty: what the machine's owner can do
  double depth_mm = 0.0;
};

template <class Place>
Pairs rows_of(const std::vector<Place>& places) {
  Pairs rows = new_rows(places.size());
  double* number = rows.mutable_data();
  for (const Place& place : places) {
    *number++ = place.x_mm;
    *number++ = place.y_mm;
  }
  return rows;
}

/// The list as CSV and as JSON, the page and the program.
py::dict written(const cli::Sheet& sheet,
                 const model::Machine& machine,
                 const grid::observation::PointNoise& noise,
                 double depth_mm) {
  py::dict plan;
  plan["marks"] = rows_of(sheet.marks);
  std::vector<std::size_t> visits = sheet.visits;
  if (visits.empty()) {
    for (std::size_t i = 0; i < sheet.marks.size(); ++i) visits.push_back(i);
  }
  plan["visits"] = visits;
  plan["table"] = cli::sheet_csv(sheet);
  plan["sheet"] = cli::sheet_json(
      sheet, machine, {noise.length_mm, noise.position_mm, grid::StatedNoise{}.dof});
  plan["page"] = cli::sheet_page(sheet, machine, "");
  cli::DrillOptions drill;
  drill.depth_mm = depth_mm;
  plan["program"] = cli::sheet_gcode(sheet, drill);
  return plan;
}

py::dict plan_marks(const model::Machine& machine, const Asked& asked, std::size_t second_visits) {
  grid::PlanRequest request;
  request.points = asked.points;
  request.margin_mm = asked.margin_mm.value_or(cli::reachable_mm(machine.bed));
  request.noise.length_mm = asked.length_noise_mm.value_or(request.noise.length_mm);
  request.noise.position_mm = asked.position_noise_mm.value_or(request.noise.position_mm);
  const auto found = [&] {
    const py::gil_scoped_release others_may_work;
    return value_or_throw(grid::plan_measurement(machine, request));
  }();
  const cli::ExpectedErrors errors = cli::expected_errors(found.map, machine.bed);
  const cli::Sheet sheet{found.marks,
                         cli::sheet_of(asked.measure, &machine),
                         grid::with_second_visits(found.marks.size(), second_visits)};
  py::dict plan = written(sheet, machine, request.noise, asked.depth_mm);
  plan["drawing"] = cli::draw_plan(found, machine.bed, errors);
  plan["expected_rms_mm"] = errors.rms_mm;
  plan["expected_largest_mm"] = errors.largest_mm;
  return plan;
}

py::dict plan_check(const grid::CompensationMap& map, const Asked& asked) {
  grid::CheckPlanRequest request;
  request.points = asked.points;
  request.length_mm = asked.length_noise_mm.value_or(request.length_mm);
  request.position_mm = asked.position_noise_mm.value_or(request.position_mm);
  const model::Machine* machine = map.machine();
  request.margin_mm = asked.margin_mm.value_or(
      machine == nullptr ? cli::kReachableMm : cli::reachable_mm(machine->bed));
  const grid::CheckPlan found = value_or_throw(grid::plan_check(map, request));
  const cli::Sheet sheet{found.marks, cli::sheet_of(asked.measure, machine)};
  cli::FollowUpDrawing drawing;
  for (const grid::MapPoint& point : map.contents().points) drawing.measured.push_back(point.mark);
  for (std::size_t i = 0; i < found.marks.size(); ++i)
    drawing.next.push_back({fmt::format("{}", i + 1), found.marks[i]});
  py::dict plan =
      written(sheet, *machine, {request.length_mm, request.position_mm}, asked.depth_mm);
  plan["drawing"] = cli::draw_follow_up(drawing, machine->bed);
  plan["expected_sigmas"] = py::make_tuple(found.expected_sigmas.left, found.expected_sigmas.right);
  return plan;
}

py::dict plan_holes(const model::Machine& machine,
                    const Asked& asked,
                    int distances,
                    bool edges,
                    double tape_sigma_mm,
                    double hole_sigma_mm) {
  grid::HolesPlanRequest request;
  request.holes = asked.points;
  request.distances = distances;
  request.edges = edges;
  request.tape_sigma_mm = tape_sigma_mm;
  request.hole_sigma_mm = hole_sigma_mm;
  request.margin_mm = asked.margin_mm.value_or(cli::reachable_mm(machine.bed));
  const grid::HolesPlan found = [&] {
    const py::gil_scoped_release others_may_work;
    return value_or_throw(grid::plan_holes(machine, request));
  }();
  std::vector<model::BedPoint> places;
  std::vector<cli::DrillPlace> drilled;
  std::vector<std::size_t> visits;
  for (const grid::Hole& hole : found.set.holes) {
    visits.push_back(places.size());
    places.push_back(hole.commanded);
    drilled.push_back({"hole " + hole.name, hole.commanded});
  }
  cli::DrillOptions drill;
  drill.depth_mm = asked.depth_mm;
  py::dict plan;
  plan["marks"] = rows_of(places);
  plan["visits"] = visits;
  plan["table"] = cli::workshop_list(found);
  plan["sheet"] = grid::files::write_holes_sheet(found.set);
  plan["page"] = cli::holes_page(found, "");
  plan["program"] = cli::drill_gcode(fmt::format("{} holes", places.size()), drilled, drill);
  plan["drawing"] = cli::draw_holes_plan(found);
  plan["expected_rms_mm"] = found.expected_rms_mm;
  return plan;
}

py::dict followed_up(const std::optional<cli::FollowUpTexts>& texts,
                     const grid::diagnosis::Diagnosis& found) {
  if (!texts) {
    throw std::invalid_argument(
        "the diagnosis was made from other readings than these: diagnose these first");
  }
  std::vector<model::MarkPoint> places;
  std::vector<std::size_t> visits;
  for (const cli::FollowUpPlace& place : cli::follow_up_places(found)) {
    visits.push_back(places.size());
    places.push_back(place.mark);
  }
  py::dict plan;
  plan["marks"] = rows_of(places);
  plan["visits"] = visits;
  plan["table"] = texts->csv;
  plan["sheet"] = texts->json;
  plan["page"] = texts->list;
  plan["program"] = "";
  plan["drawing"] = texts->drawing;
  return plan;
}

py::dict plan_after(const grid::diagnosis::Diagnosis& found,
                    const Grids& grids,
                    const HolesRead& holes) {
  std::vector<grid::MeasuredHoles> sets;
  for (const grid::files::ReadHoles& read : holes) sets.push_back(read.holes);
  return followed_up(cli::follow_up_texts(found, grids, sets), found);
}

py::dict plan_after_belts(const grid::diagnosis::Diagnosis& found,
                          const grid::MeasuredBelts& belts) {
  return followed_up(cli::follow_up_texts(found, belts), found);
}

}  // namespace

void add_plans(py::module_& module) {
  py::class_<Asked>(module, "Asked")
      .def(py::init([](int points,
                       std::optional<double> margin_mm,
                       std::optional<double> length_noise_mm,
                       std::optional<double> position_noise_mm,
                       const std::string& measure,
                       double depth_mm) {
        return Asked{points, margin_mm, length_noise_mm, position_noise_mm, measure, depth_mm};
      }));
  module.def("plan_marks", plan_marks);
  module.def("plan_check", plan_check);
  module.def("plan_holes", plan_holes);
  module.def("plan_after", plan_after);
  module.def("plan_after_belts", plan_after_belts);
  module.attr("PLANNED_POINTS") = py::make_tuple(grid::kFewestPlanned, grid::kMostPlanned);
  module.attr("PLANNED_HOLES") = py::make_tuple(grid::kFewestPlannedHoles, grid::kMostPlannedHoles);
  module.attr("PLANNED_CHECK_POINTS") =
      py::make_tuple(grid::kFewestCheckPoints, grid::kMostCheckPoints);
  module.def("planned_distances", [](int holes, bool edges) {
    return py::make_tuple(grid::fewest_distances(edges), grid::most_distances(holes, edges));
  });
}

}  // namespace chaintrue::python
