// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sweeps: the cells that a folder lacks are computed, the results written there, and the page made.
#include "grid/files/sweep_file.hpp"
#include "grid/files/sweep_store.hpp"
#include "grid/sweep/run_sweep.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/sweep_page.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
namespace sweep = grid::sweep;

py::list as_records(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  py::list records;
  for (const files::LevelError& error : errors) {
    records.append(
        py::dict("factor"_a = sweep::kFactorNames.at(error.factor),
                 "level"_a = sweep::level_name(spec, error.factor, error.level),
                 "points"_a = spec.grids.at(error.grid).columns * spec.grids.at(error.grid).rows,
                 "cells"_a = error.cells,
                 "tool_rms_mm"_a = error.tool_rms_mm,
                 "tool_max_mm"_a = error.tool_max_mm));
  }
  return records;
}

py::dict run(const std::string& specification, const std::string& directory, int threads) {
  const files::ReadSweep read = files::read_sweep(specification);
  sweep::SweepRun settings;
  grid::use_threads(threads);
  const std::vector<files::LevelError> errors = [&] {
    const py::gil_scoped_release others_may_work;
    sweep::run_sweep(read.spec, files::cells_kept_in(directory, read, settings.share), settings);
    return files::write_results(read.spec, files::finished_cells(directory, read), directory);
  }();
  return py::dict("name"_a = read.spec.name,
                  "question"_a = read.spec.question,
                  "errors"_a = as_records(read.spec, errors),
                  "page"_a = report::render_html(cli::sweep_page(read.spec, errors)),
                  "warnings"_a = sentences_of(read.warnings));
}

}  // namespace

void add_sweeps(py::module_& module) { module.def("sweep", run); }

}  // namespace chaintrue::python
