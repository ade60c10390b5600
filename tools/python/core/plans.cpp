// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Plans of marks, of holes and of a check: the places, and what the command writes of them.
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/planning/check_plan.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/planning/second_visits.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/holes_drawing.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/plan_after.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/sheet_page.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

/// What every plan is asked for: points, and in mm margin, noise of a length and of a position; places,
/// lengths, or empty for what the machine's owner can do; depth in mm.
using Asked = std::tuple<int,
                         std::optional<double>,
                         std::optional<double>,
                         std::optional<double>,
                         std::string,
                         double>;

template <class Expected>
auto value_or_throw(Expected result) {
  if (result) return *std::move(result);
  throw cli::Failed("chaintrue plan", result.error());
}

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

std::vector<std::size_t> each_once(std::size_t count) {
  std::vector<std::size_t> visits(count);
  std::iota(visits.begin(), visits.end(), std::size_t{0});
  return visits;
}

/// The list as CSV and as JSON, the page and the program; adds what a plan of its kind expects.
py::dict written(const cli::Sheet& sheet,
                 const model::Machine& machine,
                 const grid::observation::PointNoise& noise,
                 double depth_mm,
                 const std::string& drawing) {
  cli::DrillOptions drill;
  drill.depth_mm = depth_mm;
  return py::dict(
      "marks"_a = rows_of(sheet.marks),
      "visits"_a = sheet.visits.empty() ? each_once(sheet.marks.size()) : sheet.visits,
      "table"_a = cli::sheet_csv(sheet),
      "sheet"_a = cli::sheet_json(
          sheet, machine, {noise.length_mm, noise.position_mm, grid::StatedNoise{}.dof}),
      "page"_a = cli::sheet_page(sheet, machine, ""),
      "program"_a = cli::sheet_gcode(sheet, drill),
      "drawing"_a = drawing);
}

py::dict plan_marks(const std::string& text, const Asked& asked, std::size_t second_visits) {
  const auto& [points, margin_mm, length_noise_mm, position_noise_mm, measure, depth_mm] = asked;
  const model::Machine machine = grid::files::parse_machine(text, "");
  grid::PlanRequest request;
  request.points = points;
  request.margin_mm = margin_mm.value_or(cli::reachable_mm(machine.bed));
  request.noise.length_mm = length_noise_mm.value_or(request.noise.length_mm);
  request.noise.position_mm = position_noise_mm.value_or(request.noise.position_mm);
  const auto found = [&] {
    const py::gil_scoped_release others_may_work;
    return value_or_throw(grid::plan_measurement(machine, request));
  }();
  const cli::ExpectedErrors errors = cli::expected_errors(found.map, machine.bed);
  const cli::Sheet sheet{found.marks,
                         cli::sheet_of(measure, &machine),
                         grid::with_second_visits(found.marks.size(), second_visits)};
  py::dict plan =
      written(sheet, machine, request.noise, depth_mm, cli::draw_plan(found, machine.bed, errors));
  plan["expected_rms_mm"] = errors.rms_mm;
  plan["expected_largest_mm"] = errors.largest_mm;
  return plan;
}

py::dict plan_check(const std::string& text, const Asked& asked) {
  const auto& [points, margin_mm, length_noise_mm, position_noise_mm, measure, depth_mm] = asked;
  const grid::CompensationMap map = grid::files::parse_map(text, "");
  const model::Machine* machine = map.machine();
  grid::CheckPlanRequest request;
  request.points = points;
  request.length_mm = length_noise_mm.value_or(request.length_mm);
  request.position_mm = position_noise_mm.value_or(request.position_mm);
  request.margin_mm =
      margin_mm.value_or(machine == nullptr ? cli::kReachableMm : cli::reachable_mm(machine->bed));
  const grid::CheckPlan found = value_or_throw(grid::plan_check(map, request));
  cli::FollowUpDrawing drawing;
  for (const grid::MapPoint& point : map.contents().points) drawing.measured.push_back(point.mark);
  for (std::size_t i = 0; i < found.marks.size(); ++i)
    drawing.next.push_back({std::to_string(i + 1), found.marks[i]});
  py::dict plan = written({found.marks, cli::sheet_of(measure, machine)},
                          *machine,
                          {request.length_mm, request.position_mm},
                          depth_mm,
                          cli::draw_follow_up(drawing, machine->bed));
  plan["expected_sigmas"] = py::make_tuple(found.expected_sigmas.left, found.expected_sigmas.right);
  return plan;
}

py::dict plan_holes(const std::string& text,
                    const Asked& asked,
                    int distances,
                    bool edges,
                    double tape_sigma_mm,
                    double hole_sigma_mm) {
  const model::Machine machine = grid::files::parse_machine(text, "");
  grid::HolesPlanRequest request;
  request.holes = std::get<0>(asked);
  request.distances = distances;
  request.edges = edges;
  request.tape_sigma_mm = tape_sigma_mm;
  request.hole_sigma_mm = hole_sigma_mm;
  request.margin_mm = std::get<1>(asked).value_or(cli::reachable_mm(machine.bed));
  const grid::HolesPlan found = [&] {
    const py::gil_scoped_release others_may_work;
    return value_or_throw(grid::plan_holes(machine, request));
  }();
  std::vector<model::BedPoint> places;
  std::vector<cli::DrillPlace> drilled;
  for (const grid::Hole& hole : found.set.holes) {
    places.push_back(hole.commanded);
    drilled.push_back({"hole " + hole.name, hole.commanded});
  }
  cli::DrillOptions drill;
  drill.depth_mm = std::get<5>(asked);
  return py::dict(
      "marks"_a = rows_of(places),
      "visits"_a = each_once(places.size()),
      "table"_a = cli::workshop_list(found),
      "sheet"_a = grid::files::write_holes_sheet(found.set),
      "page"_a = cli::holes_page(found, ""),
      "program"_a = cli::drill_gcode(std::to_string(places.size()) + " holes", drilled, drill),
      "drawing"_a = cli::draw_holes_plan(found),
      "expected_rms_mm"_a = found.expected_rms_mm);
}

std::optional<cli::FollowUpTexts> follow_up(const grid::diagnosis::Diagnosis& found,
                                            const Texts& texts) {
  if (grid::files::kind_of(texts.front(), "") == grid::files::FileKind::belts)
    return cli::follow_up_texts(found, grid::files::parse_belts(texts.front(), "").belts);
  std::vector<grid::MeasuredGrid> grids;
  std::vector<grid::MeasuredHoles> sets;
  for (const std::string& text : texts) {
    if (grid::files::kind_of(text, "") == grid::files::FileKind::grid) {
      grids.push_back(grid_of(text));
    } else {
      sets.push_back(holes_of(text).holes);
    }
  }
  return cli::follow_up_texts(found, grids, sets);
}

py::dict plan_after(const std::string& diagnosis, const Texts& texts) {
  const grid::diagnosis::Diagnosis found = grid::files::parse_diagnosis(diagnosis, "");
  const std::optional<cli::FollowUpTexts> plan = follow_up(found, texts);
  if (!plan) {
    throw std::invalid_argument(
        "the diagnosis was made from other readings than these: diagnose these first");
  }
  std::vector<model::MarkPoint> places;
  for (const cli::FollowUpPlace& place : cli::follow_up_places(found)) places.push_back(place.mark);
  return py::dict("marks"_a = rows_of(places),
                  "visits"_a = each_once(places.size()),
                  "table"_a = plan->csv,
                  "sheet"_a = plan->json,
                  "page"_a = plan->list,
                  "program"_a = "",
                  "drawing"_a = plan->drawing);
}

}  // namespace

void add_plans(py::module_& module) {
  module.def("plan_marks", plan_marks);
  module.def("plan_check", plan_check);
  module.def("plan_holes", plan_holes);
  module.def("plan_after", plan_after);
  module.attr("PLANNED_POINTS") = py::make_tuple(grid::kFewestPlanned, grid::kMostPlanned);
  module.attr("PLANNED_HOLES") = py::make_tuple(grid::kFewestPlannedHoles, grid::kMostPlannedHoles);
  module.attr("PLANNED_CHECK_POINTS") =
      py::make_tuple(grid::kFewestCheckPoints, grid::kMostCheckPoints);
  module.def("planned_distances", [](int holes, bool edges) {
    return py::make_tuple(grid::fewest_distances(edges), grid::most_distances(holes, edges));
  });
}

}  // namespace chaintrue::python
