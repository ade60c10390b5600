// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was measured: machines, grids, holes and belts, from files and as arrays.
#include <optional>
#include <utility>

#include "grid/files/belts_file.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {
namespace {

namespace files = grid::files;
using OptionalMachine = std::optional<model::Machine>;
using Pair = std::optional<std::pair<double, double>>;

/// A column of the points, or nothing if one of them has none.
template <class Get>
std::optional<Pairs> column(const grid::MeasuredGrid& grid, Get get) {
  Pairs pairs = new_rows(grid.points.size());
  double* number = pairs.mutable_data();
  for (const grid::MeasuredPoint& point : grid.points) {
    const Pair pair = get(point);
    if (!pair) return std::nullopt;
    *number++ = pair->first;
    *number++ = pair->second;
  }
  return pairs;
}

std::optional<Pairs> marks_of(const grid::MeasuredGrid& grid) {
  return column(grid, [](const grid::MeasuredPoint& point) -> Pair {
    return std::pair(point.mark.x_mm, point.mark.y_mm);
  });
}
std::optional<Pairs> lengths_of(const grid::MeasuredGrid& grid) {
  return column(grid, [](const grid::MeasuredPoint& point) -> Pair {
    if (!point.lengths) return std::nullopt;
    return std::pair(point.lengths->left_mm, point.lengths->right_mm);
  });
}
std::optional<Pairs> commanded_of(const grid::MeasuredGrid& grid) {
  return column(grid, [](const grid::MeasuredPoint& point) -> Pair {
    if (!point.commanded) return std::nullopt;
    return std::pair(point.commanded->x_mm, point.commanded->y_mm);
  });
}
std::optional<std::vector<int>> order_of(const grid::MeasuredGrid& grid) {
  std::vector<int> order;
  for (const grid::MeasuredPoint& point : grid.points) {
    if (!point.order) return std::nullopt;
    order.push_back(*point.order);
  }
  return order;
}

Pairs belt_lengths_of(const grid::MeasuredBelts& belts) {
  Pairs rows = new_rows(belts.points.size(), 4);
  double* number = rows.mutable_data();
  for (const grid::BeltPoint& point : belts.points) {
    for (const model::Belt belt : model::kBelts) *number++ = point.lengths_mm[belt];
  }
  return rows;
}

/// A few points or distances only check what is known.
files::GridOptions grid_options(const OptionalMachine& machine, bool few) {
  files::GridOptions options;
  options.machine = machine;
  if (few) options.fewest_points = 1;
  return options;
}
files::HolesOptions holes_options(const OptionalMachine& machine, bool few) {
  files::HolesOptions options;
  options.machine = machine;
  if (few) options.fewest_distances = 1;
  return options;
}

template <class Read, class Thing>
py::tuple answer(Read read, Thing thing) {
  return py::make_tuple(std::move(thing), sentences_of(read.warnings));
}
py::tuple answer(files::ReadGrid read) { return answer(read, read.grid); }
py::tuple answer(files::ReadBelts read) { return answer(read, read.belts); }
py::tuple answer(files::ReadMachine read) { return answer(read, read.machine); }
py::tuple answer(files::ReadHoles read) { return answer(read, read); }

void add_measured_types(py::module_& module) {
  py::class_<model::Machine>(module, "Machine")
      .def_readonly("name", &model::Machine::name)
      .def("text", [](const model::Machine& machine) { return files::write_machine(machine); });
  py::class_<grid::MeasuredGrid>(module, "Grid")
      .def_readonly("name", &grid::MeasuredGrid::name)
      .def_readonly("machine", &grid::MeasuredGrid::machine)
      .def_property_readonly("marks", marks_of)
      .def_property_readonly("lengths", lengths_of)
      .def_property_readonly("commanded", commanded_of)
      .def_property_readonly("order", order_of)
      .def("text", [](const grid::MeasuredGrid& grid) { return files::write_grid(grid); });
  py::class_<files::ReadHoles>(module, "Holes")
      .def_property_readonly("name", [](const files::ReadHoles& read) { return read.holes.name; })
      .def_property_readonly("machine",
                             [](const files::ReadHoles& read) { return read.holes.machine; })
      .def_property_readonly(
          "of_belts", [](const files::ReadHoles& read) { return read.belt_machine.has_value(); })
      .def("text", [](const files::ReadHoles& read) {
        return files::write_holes(read.holes, read.belt_machine);
      });
  py::class_<grid::MeasuredBelts>(module, "Belts")
      .def_readonly("name", &grid::MeasuredBelts::name)
      .def_property_readonly("lengths", belt_lengths_of)
      .def("text", [](const grid::MeasuredBelts& belts) { return files::write_belts(belts); });
}

}  // namespace

void add_measured(py::module_& module) {
  add_measured_types(module);
  module.def("read_machine", [](const std::string& path) {
    return read_from_files([&] { return answer(files::read_machine_with_warnings(path)); });
  });
  module.def("parse_machine", [](const std::string& text, const std::string& file) {
    return answer(files::parse_machine_with_warnings(text, file));
  });
  module.def("read_grid", [](const std::string& path, const OptionalMachine& machine, bool few) {
    return read_from_files(
        [&] { return answer(files::read_grid(path, grid_options(machine, few))); });
  });
  module.def("parse_grid", [](const std::string& text, const std::string& file, bool few) {
    return answer(files::parse_grid(text, file, grid_options(std::nullopt, few)));
  });
  module.def("read_holes", [](const std::string& path, const OptionalMachine& machine, bool few) {
    return read_from_files(
        [&] { return answer(files::read_holes(path, holes_options(machine, few))); });
  });
  module.def("parse_holes", [](const std::string& text, const std::string& file, bool few) {
    return answer(files::parse_holes(text, file, holes_options(std::nullopt, few)));
  });
  module.def("read_belts", [](const std::string& path) {
    return read_from_files([&] { return answer(files::read_belts(path)); });
  });
  module.def("parse_belts", [](const std::string& text, const std::string& file) {
    return answer(files::parse_belts(text, file));
  });
  module.def("read_text", [](const std::string& path) {
    files::forget_sources();
    const std::string text = files::read_whole_file(path);
    return py::make_tuple(py::bytes(text), pairs_of(files::sources_read()));
  });
  module.def("made_by", [](const std::string& text) {
    MadeBy made_by;
    if (const auto found = files::made_by_of(text, ""))
      made_by = {found->version, found->verb, found->options, pairs_of(found->inputs)};
    return made_by;
  });
  module.def("write", [](const std::string& path, const std::string& text) {
    files::write_whole_file(path, text);
  });
  module.def("format_version", [](const std::string& file_type) {
    for (const files::Format* format : files::kFormats) {
      if (format->file_type == file_type) return std::string(format->version);
    }
    throw std::invalid_argument(fmt::format("there is no format \"{}\"", file_type));
  });
}

}  // namespace chaintrue::python
