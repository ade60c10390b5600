// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reads files, and checks texts like files.
#include <string>
#include <utility>
#include <vector>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
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
py::tuple parse(const std::string& kind, const std::string& text, const std::string& file,
                const std::string& machine, bool few) {
  const auto answer = [](const std::string& written, const std::vector<files::Warning>& warnings) {
    std::vector<std::string> sentences;
    for (const files::Warning& warning : warnings) sentences.push_back(warning.message());
    return py::make_tuple(written, sentences);
  };
  files::MeasuredOptions options{.few = few};
  if (!machine.empty()) options.machine = files::parse_machine(machine, "").machine;
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
    const files::ReadMachine read = files::parse_machine(text, file);
    return answer(files::write_machine(read.machine), read.warnings);
  }
  const auto result = [&](auto parsed, auto written) {
    return answer(written(parsed(text, file), files::made_by_of(text, file)), {});
  };
  if (kind == "map") return result(files::parse_map, files::write_map);
  if (kind == "anchors") return result(files::parse_anchors, files::write_anchors);
  return result(files::parse_diagnosis, files::write_diagnosis);
}

/// As above for a file, with the files that were read for it.
py::tuple read(const std::string& kind, const std::string& path, const std::string& machine,
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

void add_measured(py::module_& module) {
  module.def("parse", parse);
  module.def("read", read);
  module.def("write", [](const std::string& path, const std::string& text) {
    files::write_whole_file(path, text);
  });
  module.def("format_version",
             [](const std::string& file_type) { return files::format_of(file_type)->version; });
}

}  // namespace chaintrue::python
