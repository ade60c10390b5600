// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New readings against a map or anchors. What is found goes out as the text of its file, its page
/// and its sentences.
#include <utility>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/check_file.hpp"
#include "grid/map/map_check.hpp"
#include "tools/cli/check_document.hpp"
#include "tools/cli/typed_settings.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"
#include "tools/python/core/gather.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;

struct CheckFound {
  std::string text;
  std::string page;
  bool valid = false;
};

/// `settings`: the file of what the controller held, or nothing.
CheckFound check_map(const grid::CompensationMap& as_measured,
                     const Grids& grids,
                     const HolesRead& holes,
                     const std::string& settings) {
  const py::gil_scoped_release others_may_work;
  grid::Measured measured = gathered(grids, holes);
  const grid::CompensationMap map =
      settings.empty() ? as_measured
                       : cli::with_settings_of(settings, "the map", as_measured, measured);
  grid::Check check = value_or_throw(grid::check_map(map, measured));
  if (auto changed = cli::with_typed_settings(map, measured, check)) check = *std::move(changed);
  return {files::write_map_check(check),
          report::render_html(cli::map_check_document(check)),
          check.is_valid_as_it_is()};
}

CheckFound check_anchors(const files::FittedAnchors& anchors, const grid::MeasuredBelts& belts) {
  const py::gil_scoped_release others_may_work;
  const grid::Check check = value_or_throw(grid::check_anchors(anchors.fit, belts));
  return {files::write_anchors_check(check),
          report::render_html(cli::anchors_check_document(check)),
          check.is_valid_as_it_is()};
}

py::tuple handed_over(const CheckFound& found) {
  return py::make_tuple(found.text, found.page, found.valid);
}

}  // namespace

void add_checks(py::module_& module) {
  module.def("check_map",
             [](const grid::CompensationMap& map,
                const Grids& grids,
                const HolesRead& holes,
                const std::string& settings) {
               return handed_over(check_map(map, grids, holes, settings));
             });
  module.def("check_anchors",
             [](const files::FittedAnchors& anchors, const grid::MeasuredBelts& belts) {
               return handed_over(check_anchors(anchors, belts));
             });
}

}  // namespace chaintrue::python
