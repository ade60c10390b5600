// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What to measure after a diagnosis, for a CSV and for a JSON file.
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {

namespace files = grid::files;

namespace {

/// Texts of files that this module wrote: a few points or distances are enough.
using Texts = std::vector<std::string>;

std::optional<cli::FollowUpTexts> follow_up(const grid::diagnosis::Diagnosis& found,
                                            const Texts& texts) {
  grid::Measured measured;
  std::vector<grid::MeasuredHoles> sets;
  for (const std::string& text : texts) {
    const files::FileKind kind = files::kind_of(text, "");
    if (kind == files::FileKind::belts)
      return cli::follow_up_texts(found, files::parse_belts(text, "").belts);
    if (kind == files::FileKind::grid) {
      measured.add(files::parse_grid(text, "", {.few = true}).grid);
    } else {
      sets.push_back(files::parse_holes(text, "", {.few = true}).holes);
    }
  }
  for (const grid::MeasuredHoles& set : sets) measured.add(set);
  return cli::follow_up_texts(found, measured);
}

py::dict plan_after(const std::string& diagnosis, const Texts& texts) {
  const auto found = files::parse_diagnosis(diagnosis, "");
  const auto plan = follow_up(found, texts);
  if (!plan) {
    throw std::invalid_argument(
        "the diagnosis was made from other readings than these: diagnose these first");
  }
  std::vector<std::pair<double, double>> marks;
  for (const cli::FollowUpPlace& place : cli::follow_up_places(found))
    marks.emplace_back(place.mark.x_mm, place.mark.y_mm);
  return py::dict("marks"_a = marks, "table"_a = plan->csv, "sheet"_a = plan->json,
                  "page"_a = plan->list, "drawing"_a = plan->drawing);
}

}  // namespace

void add_plans(py::module_& module) { module.def("plan_after", plan_after); }

}  // namespace chaintrue::python
