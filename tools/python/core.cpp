// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core: the libraries for Python. Arrays are float64 of shape (n, 2); where there is no
/// answer a mask is false and the number is zero, never NaN. The user interface and its
/// documentation are in the package's chaintrue/__init__.py.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "tools/cli/certificate.hpp"
#include "tools/cli/diagnosis_document.hpp"
#include "tools/cli/map_document.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::python {
namespace {

namespace py = pybind11;
namespace files = grid::files;

using Pairs = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A task that failed with a message: chaintrue.Failure in Python.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class Expected>
auto value_or_throw(Expected result) {
  if (!result) throw Failure(result.error().sentence);
  return *std::move(result);
}

/// \throws std::invalid_argument for another shape, or a number that is not finite.
void check_pairs(const Pairs& pairs, const char* name) {
  if (pairs.ndim() != 2 || pairs.shape(1) != 2) {
    throw std::invalid_argument(
        fmt::format("{} must have the shape (n, 2), not {} dimensions", name, pairs.ndim()));
  }
  const double* numbers = pairs.data();
  for (py::ssize_t i = 0; i < pairs.size(); ++i) {
    if (!std::isfinite(numbers[i]))
      throw std::invalid_argument(
          fmt::format("{}: row {} holds a number that is none, or infinite", name, i / 2));
  }
}

Pairs new_pairs(std::size_t count) {
  Pairs pairs({static_cast<py::ssize_t>(count), py::ssize_t{2}});
  std::fill_n(pairs.mutable_data(), 2 * count, 0.0);
  return pairs;
}

void put(Pairs& pairs, std::size_t i, double first, double second) {
  pairs.mutable_data()[2 * i] = first;
  pairs.mutable_data()[2 * i + 1] = second;
}

std::vector<std::string> sentences_of(const std::vector<files::Warning>& warnings) {
  std::vector<std::string> sentences;
  for (const files::Warning& warning : warnings) sentences.push_back(warning.message());
  return sentences;
}

/// A column of the points, or nothing if one of them has none.
template <class Get>
std::optional<Pairs> column(const grid::MeasuredGrid& grid, Get get) {
  Pairs pairs = new_pairs(grid.points.size());
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const auto pair = get(grid.points[i]);
    if (!pair) return std::nullopt;
    put(pairs, i, pair->first, pair->second);
  }
  return pairs;
}

using Pair = std::optional<std::pair<double, double>>;

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

/// Converts the arrays to a file's text, so that the same input checks apply.
grid::MeasuredGrid grid_of(const Pairs& marks,
                           const std::optional<Pairs>& lengths,
                           const std::optional<Pairs>& commanded,
                           const std::optional<std::vector<int>>& order,
                           const std::optional<model::Machine>& machine,
                           const std::optional<grid::StatedNoise>& noise,
                           const std::string& name) {
  check_pairs(marks, "marks");
  if (lengths) check_pairs(*lengths, "lengths");
  if (commanded) check_pairs(*commanded, "commanded");
  const auto count = static_cast<std::size_t>(marks.shape(0));
  const auto same = [count](std::size_t other, const char* what) {
    if (other != count)
      throw std::invalid_argument(fmt::format("{} marks, but {} {}", count, other, what));
  };
  if (lengths) same(static_cast<std::size_t>(lengths->shape(0)), "lengths");
  if (commanded) same(static_cast<std::size_t>(commanded->shape(0)), "commanded places");
  if (order) same(order->size(), "orders");
  grid::MeasuredGrid grid;
  grid.name = name;
  grid.machine = machine;
  grid.noise = noise;
  for (std::size_t i = 0; i < count; ++i) {
    grid::MeasuredPoint point;
    point.mark = {marks.data()[2 * i], marks.data()[2 * i + 1]};
    if (lengths)
      point.lengths = model::ChainLengths{lengths->data()[2 * i], lengths->data()[2 * i + 1]};
    if (commanded)
      point.commanded = model::BedPoint{commanded->data()[2 * i], commanded->data()[2 * i + 1]};
    if (order) point.order = (*order)[i];
    grid.points.push_back(point);
  }
  return files::parse_grid(files::write_grid(grid), "arrays").grid;
}

/// On the causes that are found.
grid::CompensationMap fit_on_causes(const grid::Measured& measured, bool accept_class) {
  const py::gil_scoped_release others_may_work;
  grid::diagnosis::CausesFitOptions options;
  options.accept_class = accept_class;
  return value_or_throw(grid::diagnosis::fit_with_causes(measured, options)).fit.map;
}

grid::CompensationMap fit_points(const grid::MeasuredGrid& grid, bool direct) {
  const py::gil_scoped_release others_may_work;
  grid::FitOptions options;
  if (direct) options.surface = grid::SurfaceKind::direct;
  return value_or_throw(grid::fit(grid, options));
}

grid::CompensationMap fit_distances(const grid::MeasuredHoles& holes) {
  const py::gil_scoped_release others_may_work;
  return value_or_throw(grid::joint_fit(holes)).map;
}

py::dict query(const grid::CompensationMap& map, const Pairs& points, bool bed) {
  check_pairs(points, "points");
  const auto count = static_cast<std::size_t>(points.shape(0));
  Pairs lengths = new_pairs(count), sigma = new_pairs(count);
  py::array_t<double> tool(static_cast<py::ssize_t>(count));
  py::array_t<bool> outside(static_cast<py::ssize_t>(count));
  std::vector<std::string> status;
  for (std::size_t i = 0; i < count; ++i) {
    const model::BedPoint asked{points.data()[2 * i], points.data()[2 * i + 1]};
    const auto answer = map.query(bed ? map.to_mark(asked) : model::identity_placement(asked));
    outside.mutable_data()[i] = !answer;
    tool.mutable_data()[i] = answer ? answer->tool_sigma_mm : 0.0;
    status.emplace_back(grid::name(answer ? answer->status : grid::MapStatus::outside));
    if (!answer) continue;
    put(lengths, i, answer->lengths.left_mm, answer->lengths.right_mm);
    put(sigma, i, answer->sigma.left_mm, answer->sigma.right_mm);
  }
  py::dict result;
  result["lengths"] = lengths;
  result["sigma"] = sigma;
  result["tool_sigma"] = tool;
  result["outside"] = outside;
  result["status"] = status;
  return result;
}

py::tuple inverse(const grid::CompensationMap& map, const Pairs& lengths, bool bed) {
  check_pairs(lengths, "lengths");
  const auto count = static_cast<std::size_t>(lengths.shape(0));
  Pairs points = new_pairs(count);
  py::array_t<bool> outside(static_cast<py::ssize_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const auto mark = map.inverse({lengths.data()[2 * i], lengths.data()[2 * i + 1]});
    outside.mutable_data()[i] = !mark;
    if (!mark) continue;
    const model::BedPoint point = bed ? map.to_bed(*mark) : model::identity_placement(*mark);
    put(points, i, point.x_mm, point.y_mm);
  }
  return py::make_tuple(points, outside);
}

grid::diagnosis::Diagnosis diagnose(const std::vector<grid::MeasuredGrid>& grids,
                                    const std::vector<grid::MeasuredHoles>& holes,
                                    std::uint64_t seed,
                                    bool improvement) {
  const py::gil_scoped_release others_may_work;
  grid::Measured measured;
  for (const grid::MeasuredGrid& grid : grids) measured.add(grid);
  for (const grid::MeasuredHoles& set : holes) measured.add(set);
  grid::diagnosis::DiagnosisOptions options;
  options.seed = seed;
  options.improvement = improvement;
  return value_or_throw(grid::diagnosis::diagnose(measured, options));
}

void add_types(py::module_& module) {
  py::class_<model::Machine>(module, "Machine")
      .def_readonly("name", &model::Machine::name)
      .def("text", [](const model::Machine& machine) { return files::write_machine(machine); });
  py::class_<grid::StatedNoise>(module, "Noise")
      .def(py::init([](double length_mm, double position_mm, double dof) {
        return grid::StatedNoise{length_mm, position_mm, dof};
      }));
  py::class_<grid::MeasuredGrid>(module, "Grid")
      .def_readonly("name", &grid::MeasuredGrid::name)
      .def_readonly("machine", &grid::MeasuredGrid::machine)
      .def_property_readonly("marks", marks_of)
      .def_property_readonly("lengths", lengths_of)
      .def_property_readonly("commanded", commanded_of)
      .def_property_readonly("order", order_of)
      .def("text", [](const grid::MeasuredGrid& grid) { return files::write_grid(grid); });
  py::class_<grid::MeasuredHoles>(module, "Holes")
      .def_readonly("name", &grid::MeasuredHoles::name)
      .def("text", [](const grid::MeasuredHoles& holes) { return files::write_holes(holes); });
  py::class_<grid::CompensationMap>(module, "Map")
      .def_property_readonly("name",
                             [](const grid::CompensationMap& map) { return map.contents().name; })
      .def_property_readonly("notes",
                             [](const grid::CompensationMap& map) { return map.contents().notes; })
      .def("query", query)
      .def("inverse", inverse)
      .def("text", [](const grid::CompensationMap& map) { return files::write_map(map); })
      .def("page",
           [](const grid::CompensationMap& map, const std::string& source, bool certificate) {
             return report::render_html(certificate ? cli::certificate(map, source)
                                               : cli::map_document(map, source));
           });
  using grid::diagnosis::Diagnosis;
  py::class_<Diagnosis>(module, "Diagnosis")
      .def_readonly("sentence", &Diagnosis::sentence)
      .def("text", [](const Diagnosis& found) { return files::write_diagnosis(found); })
      .def("page", [](const Diagnosis& found, const std::string& source) {
        return report::render_html(cli::diagnosis_document(found, source));
      });
}

void add_functions(py::module_& module) {
  module.def("read_machine", [](const std::string& path) {
    const files::ReadMachine read = files::read_machine_with_warnings(path);
    return py::make_tuple(read.machine, sentences_of(read.warnings));
  });
  module.def("read_grid",
             [](const std::string& path, const std::optional<model::Machine>& machine) {
               files::GridOptions options;
               options.machine = machine;
               files::ReadGrid read = files::read_grid(path, options);
               return py::make_tuple(read.grid, sentences_of(read.warnings));
             });
  module.def("read_holes",
             [](const std::string& path, const std::optional<model::Machine>& machine) {
               files::HolesOptions options;
               options.machine = machine;
               files::ReadHoles read = files::read_holes(path, options);
               return py::make_tuple(read.holes, sentences_of(read.warnings));
             });
  module.def("read_map", [](const std::string& path) {
    std::vector<files::Warning> warnings;
    grid::CompensationMap map = files::read_map(path, &warnings);
    return py::make_tuple(std::move(map), sentences_of(warnings));
  });
  module.def("read_diagnosis", [](const std::string& path) {
    std::vector<files::Warning> warnings;
    grid::diagnosis::Diagnosis found = files::read_diagnosis(path, &warnings);
    return py::make_tuple(std::move(found), sentences_of(warnings));
  });
  module.def("write", [](const std::string& path, const std::string& text) {
    files::write_whole_file(path, text);
  });
  module.def("grid_of", grid_of);
  module.def("fit_points", fit_points);
  module.def("fit_distances", fit_distances);
  module.def("fit_points_on_causes", [](const grid::MeasuredGrid& grid, bool accept_class) {
    return fit_on_causes(grid, accept_class);
  });
  module.def("fit_distances_on_causes", [](const grid::MeasuredHoles& holes, bool accept_class) {
    return fit_on_causes(holes, accept_class);
  });
  module.def("diagnose", diagnose);
}

}  // namespace
}  // namespace chaintrue::python

PYBIND11_MODULE(_core, module) {
  namespace py = pybind11;
  module.attr("__version__") = CHAINTRUE_VERSION;
  py::register_exception<chaintrue::python::Failure>(module, "Failure", PyExc_RuntimeError);
  py::register_exception<chaintrue::grid::files::InputError>(
      module, "InputError", PyExc_ValueError);
  chaintrue::python::add_types(module);
  chaintrue::python::add_functions(module);
}
