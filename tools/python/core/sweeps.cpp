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
    py::dict record;
    record["factor"] = std::string(sweep::kFactorNames.at(error.factor));
    record["level"] = sweep::level_name(spec, error.factor, error.level);
    record["points"] = spec.grids.at(error.grid).columns * spec.grids.at(error.grid).rows;
    record["cells"] = error.cells;
    record["tool_rms_mm"] = error.tool_rms_mm;
    record["tool_max_mm"] = error.tool_max_mm;
    records.append(record);
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
  py::dict result;
  result["name"] = read.spec.name;
  result["question"] = read.spec.question;
  result["errors"] = as_records(read.spec, errors);
  result["page"] = report::render_html(cli::sweep_page(read.spec, errors));
  result["warnings"] = sentences_of(read.warnings);
  return result;
}

}  // namespace

void add_sweeps(py::module_& module) { module.def("sweep", run); }

}  // namespace chaintrue::python
