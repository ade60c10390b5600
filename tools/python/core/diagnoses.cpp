// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Diagnoses: made, read, and their pages.
#include <cstdint>
#include <optional>
#include <utility>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"
#include "tools/python/core/gather.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using grid::diagnosis::Diagnosis;

Diagnosis diagnose(const Grids& grids,
                   const HolesRead& holes,
                   std::uint64_t seed,
                   bool improvement,
                   const std::optional<grid::MeasuredGrid>& held_out) {
  const py::gil_scoped_release others_may_work;
  grid::diagnosis::DiagnosisOptions options;
  options.seed = seed;
  options.improvement = improvement;
  Diagnosis found = value_or_throw(grid::diagnosis::diagnose(gathered(grids, holes), options));
  if (held_out) {
    found.transferred = value_or_throw(grid::diagnosis::transfer(grids.front(), found, *held_out));
    if (found.transferred->to.empty()) found.transferred->to = held_out->name;
  }
  return found;
}

Diagnosis diagnose_belts(const grid::MeasuredBelts& belts, std::uint64_t seed) {
  const py::gil_scoped_release others_may_work;
  grid::diagnosis::DiagnosisOptions options;
  options.seed = seed;
  return value_or_throw(grid::diagnosis::diagnose(belts, options));
}

}  // namespace

void add_diagnoses(py::module_& module) {
  py::class_<Diagnosis>(module, "Diagnosis")
      .def_readonly("name", &Diagnosis::grid_name)
      .def_readonly("sentence", &Diagnosis::sentence)
      .def_property_readonly("of_belts",
                             [](const Diagnosis& found) { return found.belts.has_value(); })
      .def_readonly("machine", &Diagnosis::extended_machine)
      .def("text",
           [](const Diagnosis& found, const MadeBy& made_by) {
             return files::write_diagnosis(found, provenance_of(made_by));
           })
      .def("page", [](const Diagnosis& found, const std::string& source, const MadeBy& made_by) {
        report::Document document = cli::diagnosis_document(found, source);
        cli::add_made_by(provenance_of(made_by), document.sections);
        return report::render_html(document);
      });
  module.def("diagnose", diagnose);
  module.def("diagnose_belts", diagnose_belts);
  module.def("parse_diagnosis", [](const std::string& text, const std::string& file) {
    return py::make_tuple(files::parse_diagnosis(text, file), sentences_of({}));
  });
}

}  // namespace chaintrue::python
