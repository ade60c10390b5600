// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Maps of two chains and anchors of four belts: fitted, read, asked, and their pages.
#include <optional>
#include <utility>

#include "grid/belts/belt_map.hpp"
#include "grid/belts/belts_and_holes.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/certificate.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/python/core/bind.hpp"
#include "tools/python/core/failures.hpp"
#include "tools/python/core/gather.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using files::FittedAnchors;

grid::CompensationMap fit(
    const Grids& grids, const HolesRead& holes, bool direct, bool plain, bool accept_class) {
  const py::gil_scoped_release others_may_work;
  const grid::Measured measured = gathered(grids, holes);
  if (direct) {
    grid::FitOptions options;
    options.surface = grid::SurfaceKind::direct;
    return value_or_throw(grid::fit(grids.front(), options));
  }
  if (plain) return value_or_throw(grid::joint_fit(measured)).map;
  grid::diagnosis::CausesFitOptions options;
  options.accept_class = accept_class;
  return value_or_throw(grid::diagnosis::fit_with_causes(measured, options)).fit.map;
}

/// A machine that holes do not name is that of the belts, where its anchors are known.
grid::BeltHoles on_belts(const files::ReadHoles& read,
                         const std::optional<grid::MeasuredBelts>& belts) {
  if (read.belt_machine) return {*read.belt_machine, read.holes};
  if (belts && belts->machine.anchors_known && !read.holes.machine)
    return {belts->machine, read.holes};
  throw std::invalid_argument(
      "these holes name no machine on four belts: give them the one that cut them, with the "
      "anchors "
      "in force at the time");
}

FittedAnchors fit_belts(const std::optional<grid::MeasuredBelts>& belts, const HolesRead& holes) {
  const py::gil_scoped_release others_may_work;
  if (holes.empty()) {
    return {belts.value().name, value_or_throw(grid::diagnosis::fit_with_causes(belts.value()))};
  }
  std::vector<grid::BeltHoles> sets;
  for (const files::ReadHoles& read : holes) sets.push_back(on_belts(read, belts));
  grid::MeasuredBelts measured;
  measured.machine = sets.front().machine;
  measured.name = sets.front().set.name;
  if (belts) measured = *belts;
  grid::BeltsAndHolesFit found = value_or_throw(grid::fit_belts_and_holes(measured, sets));
  return {measured.name, std::move(found.belts), std::move(found.holes)};
}

grid::BeltMap belt_map(const FittedAnchors& anchors) {
  if (!anchors.holes && !anchors.fit.coordinates.front().stated_mm) {
    throw Failure("no_anchors_in_force",
                  "These anchors were fitted to belts that do not say which anchors were in force: "
                  "where commands count from follows from them.");
  }
  return grid::BeltMap(anchors.fit, anchors.holes ? &*anchors.holes : nullptr);
}

py::dict query(const grid::LengthMap& map, const Pairs& points) {
  check_pairs(points, "points");
  const auto count = static_cast<std::size_t>(points.shape(0));
  const auto names = map.length_names();
  Pairs lengths = new_rows(count, names.size()), sigma = new_rows(count), tool = new_rows(count, 1);
  py::array_t<bool> outside(static_cast<py::ssize_t>(count));
  py::array_t<bool> tool_known(static_cast<py::ssize_t>(count));
  std::vector<std::string> status, why;
  for (std::size_t i = 0; i < count; ++i) {
    const auto answer = map.query({points.data()[2 * i], points.data()[2 * i + 1]});
    outside.mutable_data()[i] = !answer;
    tool_known.mutable_data()[i] = answer && answer->tool_sigma_mm;
    status.emplace_back(grid::name(answer ? answer->status : grid::MapStatus::outside));
    why.push_back(answer ? std::string() : answer.error().sentence());
    if (!answer) continue;
    for (std::size_t k = 0; k < names.size(); ++k) {
      lengths.mutable_data()[names.size() * i + k] =
          answer->lengths_mm[static_cast<Eigen::Index>(k)];
    }
    sigma.mutable_data()[2 * i] = answer->sigma.left_mm;
    sigma.mutable_data()[2 * i + 1] = answer->sigma.right_mm;
    tool.mutable_data()[i] = answer->tool_sigma_mm.value_or(0.0);
  }
  py::dict result;
  result["names"] = std::vector<std::string>(names.begin(), names.end());
  result["lengths"] = lengths;
  result["sigma"] = sigma;
  result["tool_sigma"] = tool;
  result["tool_known"] = tool_known;
  result["outside"] = outside;
  result["status"] = status;
  result["why"] = why;
  return result;
}

py::tuple inverse(const grid::LengthMap& map, const Pairs& lengths) {
  check_pairs(lengths, "lengths");
  const auto count = static_cast<std::size_t>(lengths.shape(0));
  Pairs points = new_rows(count);
  py::array_t<bool> outside(static_cast<py::ssize_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto tool = map.tool({lengths.data()[2 * i], lengths.data()[2 * i + 1]});
    outside.mutable_data()[i] = !tool;
    if (!tool) continue;
    points.mutable_data()[2 * i] = tool->x_mm;
    points.mutable_data()[2 * i + 1] = tool->y_mm;
  }
  return py::make_tuple(points, outside);
}

grid::MapInFrame in_frame(const grid::CompensationMap& map, bool bed) {
  if (bed && map.machine() == nullptr) {
    throw Failure("no_machine", "A map without a machine knows only the frame of its marks.");
  }
  return grid::MapInFrame(map, bed ? grid::MapFrame::bed : grid::MapFrame::marks);
}

std::string page_of(const grid::CompensationMap& map,
                    const std::string& source,
                    bool certificate,
                    const MadeBy& made_by) {
  report::Document document =
      certificate ? cli::certificate(map, source) : cli::map_document(map, source);
  if (!certificate) cli::add_made_by(provenance_of(made_by), document.sections);
  return report::render_html(document);
}

std::string page_of(const FittedAnchors& anchors,
                    const std::string& source,
                    const MadeBy& made_by) {
  report::Document document = cli::anchors_document(
      {anchors.fit, anchors.holes ? &*anchors.holes : nullptr}, anchors.name, source);
  cli::add_made_by(provenance_of(made_by), document.sections);
  return report::render_html(document);
}

void add_map_types(py::module_& module) {
  using grid::CompensationMap;
  py::class_<CompensationMap>(module, "Map")
      .def_property_readonly("name", [](const CompensationMap& map) { return map.contents().name; })
      .def_property_readonly("notes",
                             [](const CompensationMap& map) { return map.contents().notes; })
      .def_property_readonly("sentence", cli::fit_sentence)
      .def_property_readonly("machine",
                             [](const CompensationMap& map) -> std::optional<model::Machine> {
                               if (map.machine() == nullptr) return std::nullopt;
                               return *map.machine();
                             })
      .def("query",
           [](const CompensationMap& map, const Pairs& points, bool bed) {
             return query(in_frame(map, bed), points);
           })
      .def("inverse",
           [](const CompensationMap& map, const Pairs& lengths, bool bed) {
             return inverse(in_frame(map, bed), lengths);
           })
      .def("text",
           [](const CompensationMap& map, const MadeBy& made_by) {
             return files::write_map(map, provenance_of(made_by));
           })
      .def("page",
           [](const CompensationMap& map,
              const std::string& source,
              bool certificate,
              const MadeBy& made_by) { return page_of(map, source, certificate, made_by); });
  py::class_<FittedAnchors>(module, "Anchors")
      .def_readonly("name", &FittedAnchors::name)
      .def("query",
           [](const FittedAnchors& anchors, const Pairs& points) {
             return query(belt_map(anchors), points);
           })
      .def("inverse",
           [](const FittedAnchors& anchors, const Pairs& lengths) {
             return inverse(belt_map(anchors), lengths);
           })
      .def("text",
           [](const FittedAnchors& anchors, const MadeBy& made_by) {
             return files::write_anchors(anchors, provenance_of(made_by));
           })
      .def("page",
           [](const FittedAnchors& anchors, const std::string& source, const MadeBy& made_by) {
             return page_of(anchors, source, made_by);
           })
      .def("settings", [](const FittedAnchors& anchors) {
        return files::write_maslow4_settings(anchors.fit).text;
      });
}

}  // namespace

void add_maps(py::module_& module) {
  add_map_types(module);
  module.def("fit", fit);
  module.def("fit_belts", fit_belts);
  module.def("parse_map", [](const std::string& text, const std::string& file) {
    return py::make_tuple(files::parse_map(text, file), sentences_of({}));
  });
  module.def("parse_anchors", [](const std::string& text, const std::string& file) {
    return py::make_tuple(files::parse_anchors(text, file), sentences_of({}));
  });
}

}  // namespace chaintrue::python
