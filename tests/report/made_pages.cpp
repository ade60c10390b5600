// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/report/made_pages.hpp"

#include <stdexcept>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "tests/holes/hole_sets.hpp"
#include "tests/support/files.hpp"
#include "tests/support/process.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue::report::testing {

std::string made_by(const std::string& line, const std::string& file) {
  const testing_support::TemporaryFolder folder;
  if (testing_support::run_line(folder.path(), line).code != 0)
    throw std::runtime_error("failed: " + line);
  return testing_support::read_text(folder / file);
}

std::string page_of(const grid::diagnosis::Diagnosis& found) {
  return made_by("cat >d.json <<'END'\n" + grid::files::write_diagnosis(found) +
                     "\nEND\nchaintrue report d.json -o page.html",
                 "page.html");
}

grid::diagnosis::Diagnosis diagnosis_with_laws() {
  using grid::diagnosis::Law;
  auto found = grid::testing::sample_diagnosis();
  Law wave;
  wave.of = grid::diagnosis::Coordinate::length_left;
  wave.shape = grid::diagnosis::LawShape::wave;
  wave.enters = grid::diagnosis::Enters::left;
  wave.probability = 0.95;
  wave.shape_probability = 0.9;
  wave.from = 0.0;
  wave.to = 4000.0;
  wave.parameters = {{"size_mm", 0.4, 0.05}, {"period_mm", 63.5, 0.3}, {"phase_rad", 0.2, 0.1}};
  for (const auto& point : found.points)
    wave.points.push_back({point.index, point.lengths.left_mm, 0.1, 0.05, -0.05});
  Law step = wave;
  step.of = grid::diagnosis::Coordinate::x;
  step.shape = grid::diagnosis::LawShape::step;
  step.probability = 0.04;
  step.from = -1200.0;
  step.to = 1200.0;
  step.parameters = {{"size_mm", 0.3, 0.1}, {"place_mm", 100.0, 50.0}};
  for (std::size_t k = 0; k < step.points.size(); ++k)
    step.points[k].at = found.points[k].mark.x_mm;
  if (!found.unexplained) found.unexplained.emplace();
  found.unexplained->laws = {wave, step};
  return found;
}

grid::diagnosis::Diagnosis diagnosis_of_holes() {
  using grid::diagnosis::MeasurementKind;
  grid::synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = 4;
  spec.hidden = {{"chain_pitch_error", "left", {{"elongation", 0.0015}}}};
  auto made = grid::synthetic::simulate_holes(testing_support::nine_holes(), spec);
  made->set.distances[3].distance_mm += 15.0;
  auto found = *grid::diagnosis::diagnose(made->set);
  found.grid_name = "nine holes";
  grid::diagnosis::NextMeasurement hole;
  hole.kind = MeasurementKind::distance;
  hole.words = "a new hole at (0, -500), measured to A, C";
  hole.mark = model::MarkPoint{0.0, -500.0};
  hole.to = {"A", "C"};
  grid::diagnosis::NextMeasurement pair;
  pair.kind = MeasurementKind::distance;
  pair.words = "the distance A-G";
  pair.from = "A";
  pair.to = {"G"};
  found.next_measurements = {hole, pair};
  return found;
}

}  // namespace chaintrue::report::testing
