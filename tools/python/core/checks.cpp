// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// New readings against a map or anchors: the text of the check's file, and its page.
#include <utility>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/map/map_check.hpp"
#include "tools/cli/check_document.hpp"
#include "tools/cli/typed_settings.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using TextAndPage = std::pair<std::string, std::string>;

/// `settings`: the file of what the controller held, or nothing.
TextAndPage check_map(const std::string& text, const Texts& texts, const std::string& settings) {
  const py::gil_scoped_release others_may_work;
  grid::Measured measured = measured_of(texts);
  grid::CompensationMap map = files::parse_map(text, "");
  if (!settings.empty()) map = cli::with_settings_of(settings, "the map", map, measured);
  grid::Check check = value_or_throw(grid::check_map(map, measured));
  if (auto changed = cli::with_typed_settings(map, measured, check)) check = *std::move(changed);
  return {files::write_map_check(check), report::render_html(cli::map_check_document(check))};
}

TextAndPage check_anchors(const std::string& anchors, const std::string& belts) {
  const py::gil_scoped_release others_may_work;
  const grid::Check check = value_or_throw(grid::check_anchors(
      files::parse_anchors(anchors, "").fit, files::parse_belts(belts, "").belts));
  return {files::write_anchors_check(check),
          report::render_html(cli::anchors_check_document(check))};
}

}  // namespace

void add_checks(py::module_& module) {
  module.def("check_map", check_map);
  module.def("check_anchors", check_anchors);
}

}  // namespace chaintrue::python
