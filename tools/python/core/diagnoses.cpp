// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Diagnoses, and the pages of all that has one.
#include <cstdint>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/map_file.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/certificate.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using grid::diagnosis::Diagnosis;

/// `held_out` is the text of another grid, or empty.
Diagnosis diagnosis_of(const Texts& texts,
                       const grid::diagnosis::DiagnosisOptions& options,
                       const std::string& held_out) {
  if (files::kind_of(texts.front(), "") == files::FileKind::belts) {
    const grid::MeasuredBelts belts = files::parse_belts(texts.front(), "").belts;
    return value_or_throw(grid::diagnosis::diagnose(belts, options));
  }
  const grid::Measured measured = measured_of(texts);
  Diagnosis found = value_or_throw(grid::diagnosis::diagnose(measured, options));
  if (!held_out.empty()) {
    const grid::MeasuredGrid other = grid_of(held_out);
    found.transferred =
        value_or_throw(grid::diagnosis::transfer(*measured.grids().front(), found, other));
    if (found.transferred->to.empty()) found.transferred->to = other.name;
  }
  return found;
}

std::string diagnose(const Texts& texts,
                     std::uint64_t seed,
                     bool improvement,
                     const std::string& held_out,
                     const MadeBy& made_by) {
  const py::gil_scoped_release others_may_work;
  grid::diagnosis::DiagnosisOptions options;
  options.seed = seed;
  options.improvement = improvement;
  return files::write_diagnosis(diagnosis_of(texts, options, held_out), provenance_of(made_by));
}

report::Document document_of(const std::string& text, const std::string& source, bool certificate) {
  const files::FileKind kind = files::kind_of(text, "");
  if (kind == files::FileKind::diagnosis)
    return cli::diagnosis_document(files::parse_diagnosis(text, ""), source);
  if (kind == files::FileKind::anchors) {
    const files::FittedAnchors anchors = files::parse_anchors(text, "");
    return cli::anchors_document(
        {anchors.fit, anchors.holes ? &*anchors.holes : nullptr}, anchors.name, source);
  }
  const grid::CompensationMap map = files::parse_map(text, "");
  return certificate ? cli::certificate(map, source) : cli::map_document(map, source);
}

/// Of a map, of anchors or of a diagnosis, as `chaintrue report` makes it.
std::string page(const std::string& text, const std::string& source, bool certificate) {
  report::Document document = document_of(text, source, certificate);
  if (!certificate) cli::add_made_by(files::made_by_of(text, ""), document.sections);
  return report::render_html(document);
}

}  // namespace

void add_diagnoses(py::module_& module) {
  module.def("diagnose", diagnose);
  module.def("page", page);
}

}  // namespace chaintrue::python
