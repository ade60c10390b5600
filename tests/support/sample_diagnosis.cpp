// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/sample_diagnosis.hpp"

#include "grid/files/diagnosis_file.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::grid::testing {

using diagnosis::Diagnosis;

Diagnosis sample_diagnosis() {
  return files::parse_diagnosis(
      testing_support::read_text(CHAINTRUE_FIXTURES "/good/diagnosis_sample.json"),
      "diagnosis_sample.json");
}

Diagnosis quiet_diagnosis() {
  Diagnosis found = sample_diagnosis();
  found.verdict = diagnosis::Verdict::nothing_found;
  found.sentence = "Nothing was found: the machine as calibrated explains the points.";
  found.what_to_do.clear();
  found.notes.clear();
  found.causes.clear();
  found.left_over = {};
  found.outliers.clear();
  found.hypotheses = {{"nothing", "", 0.99}, {"unknown", "", 0.01}};
  found.next_measurements.clear();
  found.data_corrections.clear();
  found.extended_machine.effects.clear();
  found.improvement.reset();
  found.transferred.reset();
  found.stability.reset();
  found.bed_parts.clear();
  found.sessions.clear();
  found.stated_noise.reset();
  found.seed = 1;
  for (diagnosis::PointPicture& point : found.points) {
    point.order.reset();
    point.bad = false;
    point.direction_left = point.direction_right = 0;
    point.best_mm.setZero();
    point.rival_mm.setZero();
  }
  return found;
}

}  // namespace chaintrue::grid::testing
