// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads files, and checks texts like files.
#include <algorithm>
#include <limits>
#include <optional>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/sources.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/python/core/bind.hpp"

namespace chaintrue::python {

namespace files = grid::files;

namespace {

/// The text as this program writes it, and its warnings. `machine` is the text of a machine that
/// replaces the file's, or empty.
py::tuple parse(const std::string& kind,
                const std::string& text,
                const std::string& file,
                const std::string& machine,
                bool few) {
  const auto answer = [](const std::string& written, const std::vector<files::Warning>& warnings) {
    std::vector<std::string> sentences;
    for (const files::Warning& warning : warnings) sentences.push_back(warning.message());
    return py::make_tuple(written, sentences);
  };
  files::MeasuredOptions options{.few = few};
  if (!machine.empty()) options.machine = files::parse_machine(machine, "");
  if (kind == "grid") {
    const files::ReadGrid read = files::parse_grid(text, file, options);
    return answer(files::write_grid(read.grid), read.warnings);
  }
  if (kind == "holes") {
    const files::ReadHoles read = files::parse_holes(text, file, options);
    return answer(files::write_holes(read.holes, read.belt_machine), read.warnings);
  }
  if (kind == "belts") {
    const files::ReadBelts read = files::parse_belts(text, file);
    return answer(files::write_belts(read.belts), read.warnings);
  }
  if (kind == "machine") {
    const files::ReadMachine read = files::parse_machine_with_warnings(text, file);
    return answer(files::write_machine(read.machine), read.warnings);
  }
  if (kind == "map") {
    const grid::CompensationMap map = files::parse_map(text, file);
    return answer(files::write_map(map, files::made_by_of(text, file)), {});
  }
  if (kind == "anchors") {
    const files::FittedAnchors anchors = files::parse_anchors(text, file);
    return answer(files::write_anchors(anchors, files::made_by_of(text, file)), {});
  }
  const grid::diagnosis::Diagnosis found = files::parse_diagnosis(text, file);
  return answer(files::write_diagnosis(found, files::made_by_of(text, file)), {});
}

/// As above for a file, with the files that were read for it.
py::tuple read(const std::string& kind,
               const std::string& path,
               const std::string& machine,
               bool few) {
  files::forget_sources();
  const py::tuple found =
      parse(kind, files::read_whole_file(path), files::name_in_messages(path), machine, few);
  // By name and SHA-256.
  std::vector<std::pair<std::string, std::string>> sources;
  for (const grid::SourceFile& file : files::sources_read())
    sources.emplace_back(file.name, file.sha256);
  return py::make_tuple(found[0], found[1], sources);
}

}  // namespace

Pairs new_rows(std::size_t count, std::size_t columns) {
  Pairs rows({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(columns)});
  std::fill_n(rows.mutable_data(), count * columns, std::numeric_limits<double>::quiet_NaN());
  return rows;
}

grid::MeasuredGrid grid_of(const std::string& text) {
  return files::parse_grid(text, "", {.few = true}).grid;
}

files::ReadHoles holes_of(const std::string& text) {
  return files::parse_holes(text, "", {.few = true});
}

void add_measured(py::module_& module) {
  module.def("parse", parse);
  module.def("read", read);
  module.def("write", [](const std::string& path, const std::string& text) {
    files::write_whole_file(path, text);
  });
  module.def("format_version", [](const std::string& file_type) {
    const auto* const format =
        std::find_if(std::begin(files::kFormats), std::end(files::kFormats), [&](const auto* one) {
          return one->file_type == file_type;
        });
    return std::string((*format)->version);
  });
}

}  // namespace chaintrue::python
