// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue._core, part by part: each function adds its types and functions to the module. Private
/// to tools/python; what a user sees is the package's Python.
///
/// Arrays are float64 of shape (n, 2); where there is no answer a mask is false and the number is
/// zero, never NaN. What has a file is handed over as the text of this file, and read by its reader,
/// so that arrays are held to what a file is held to.
#pragma once

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::python {

namespace py = pybind11;

using Pairs = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// \throws std::invalid_argument for another shape, or a number that is not finite.
void check_pairs(const Pairs& pairs, const char* name);
/// (n, columns), zeros.
[[nodiscard]] Pairs new_rows(std::size_t count, std::size_t columns = 2);

[[nodiscard]] std::vector<std::string> sentences_of(
    const std::vector<grid::files::Warning>& warnings);

/// Files by name and SHA-256, as Python keeps them with what was read.
using Sources = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] Sources pairs_of(const std::vector<grid::SourceFile>& files);

/// What was read, what was assumed of it in sentences, and the files that were read for it.
template <class Read>
py::tuple read_from_files(Read read) {
  grid::files::forget_sources();
  py::tuple thing_and_sentences = read();
  return py::make_tuple(
      thing_and_sentences[0], thing_and_sentences[1], pairs_of(grid::files::sources_read()));
}

/// Version, verb, options and inputs of where a result comes from; None: not known.
using MadeBy =
    std::optional<std::tuple<std::string, std::string, std::vector<std::string>, Sources>>;
[[nodiscard]] std::optional<grid::Provenance> provenance_of(const MadeBy& made_by);

void add_measured(py::module_& module);
void add_maps(py::module_& module);
void add_diagnoses(py::module_& module);
void add_checks(py::module_& module);
void add_plans(py::module_& module);
void add_gcode(py::module_& module);
void add_sweeps(py::module_& module);

}  // namespace chaintrue::python
