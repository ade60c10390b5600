// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/input_file.hpp"

#include <fmt/format.h>
#include <set>

#include "grid/belts/belt_map.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/map/map_in_frame.hpp"
#include "grid/plotter/plotter_map.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

InputFile open_input(const std::string& path) {
  InputFile file{path, name_in_messages(path), read_whole_file(path)};
  file.kind = files::kind_of(file.text, file.name);
  return file;
}

Facts InputFile::fact() const { return Facts{1} << static_cast<Facts>(kind); }

void require_kind(const InputFile& file, const std::vector<FileKind>& taken,
                  const std::string& also) {
  if (contains(taken, file.kind)) return;
  if (also.empty() && file.kind == FileKind::belt_holes && contains(taken, FileKind::holes)) {
    return require_kind(file, taken,
                        "holes cut by four belts are fitted together with belt lengths: chaintrue "
                        "fit belts.json --with FILE");
  }
  const bool is_json = files::is_json(file.text);
  // No accepted kind can be a table: report why it is not JSON.
  const auto is_table = [](FileKind kind) {
    return kind == FileKind::grid || kind == FileKind::holes;
  };
  if (!is_json && none_of(taken, is_table)) (void)files::file_type_of(file.text, file.name);
  const std::string what_takes = is_json && file.kind != FileKind::belt_holes && also.empty()
                                     ? files::what_takes(files::file_type_of(file.text, file.name))
                                     : "";
  refuse(file.name,
         file.kind == FileKind::belt_holes ? "/machine"
         : is_json                         ? "/file_type"
                                           : "",
         files::found_kind(file.text, file.name),
         fmt::format("{}{}{}{}", files::expected_kinds(taken), also.empty() ? "" : "; ", also,
                     what_takes),
         ProblemKind::file_kind);
}

FittedAnchors load_anchors(const InputFile& file) {
  return files::parse_anchors(file.text, file.name);
}

const HolesWithBelts* holes_of(const FittedAnchors& found) {
  return found.holes ? &*found.holes : nullptr;
}

Diagnosis load_diagnosis(const InputFile& file) {
  return files::parse_diagnosis(file.text, file.name);
}

Machine load_machine(const InputFile& file) {
  files::ReadMachine read = files::parse_machine(file.text, file.name);
  print_warnings(read.warnings);
  return std::move(read.machine);
}

ReadBelts load_belts(const InputFile& file, const std::string& work,
                     const std::vector<std::size_t>& without) {
  ReadBelts read = files::parse_belts(file.text, file.name, without);
  print_warnings(read.warnings);
  if (read.belts.points.size() > grid::kMostBeltPoints) {
    refuse(file.name, "/points",
           fmt::format("{} places are more than {} accepts ({})", read.belts.points.size(), work,
                       grid::kMostBeltPoints),
           "fewer: leave some out, evenly over the sheet", ProblemKind::too_many);
  }
  return read;
}

CompensationMap load_map(const InputFile& file) {
  require_kind(file, {FileKind::map},
               file.kind == FileKind::anchors ? "anchors of four belts are read by chaintrue "
                                                "query, report, check, gcode and export maslow4"
                                              : "");
  return files::parse_map(file.text, file.name);
}

Machine read_machine_input(const std::string& path) {
  static std::set<std::string> reported;
  files::ReadMachine read = files::read(files::parse_machine, path);
  if (reported.insert(path).second) print_warnings(read.warnings);
  return std::move(read.machine);
}

BeltMachine read_belt_machine_input(const std::string& path) {
  return load_belt_machine(open_input(path));
}

BeltMachine load_belt_machine(const InputFile& file) {
  require_kind(file, {FileKind::belts, FileKind::anchors});
  if (file.kind == FileKind::anchors) return files::machine_as_pasted(load_anchors(file).fit);
  BeltMachine machine = load_belts(file, "a machine").belts.machine;
  if (!machine.anchors_known) {
    refuse(file.name, "/machine/anchors", "",
           "x_mm and y_mm of all four anchors that are in force");
  }
  return machine;
}

namespace {

CompensationMap map_of(const InputFile& file, const OutsideOption& outside) {
  const CompensationMap map = load_map(file);
  if (outside.way == "fade" && map.machine() == nullptr) {
    throw Failed(file.path, "no_machine",
                 "fade needs a map with a machine; choose another --outside",
                 kNotSupportedOrOutside);
  }
  return outside.way.empty() ? map : map.with_outside(rule_of(outside, map.contents().outside));
}

Target::Content content_of(const InputFile& file, const OutsideOption& outside) {
  if (file.kind == FileKind::anchors) return load_anchors(file);
  if (file.kind == FileKind::plotter) return load_found_plotter(file);
  return map_of(file, outside);
}

/// The lengths of each content.
struct LengthsOf {
  using Lengths = std::unique_ptr<const grid::LengthMap>;
  const InputFile& file;
  grid::MapFrame frame;

  Lengths operator()(const CompensationMap& map) const {
    return std::make_unique<const grid::MapInFrame>(map, frame);
  }
  Lengths operator()(const FittedAnchors& found) const {
    if (!found.holes && !found.fit.coordinates.front().stated_mm) {
      refuse(file.name, "/fit/coordinates", "no stated_mm",
             "anchors fitted to a file with the anchors in force, which define the origin of "
             "commands (import maslow4 --settings maslow.yaml)");
    }
    return std::make_unique<const grid::BeltMap>(found.fit, holes_of(found));
  }
  Lengths operator()(const KnownPlotter& plotter) const {
    try {
      return std::make_unique<const grid::MechanismMap>(plotter_map(plotter));
    } catch (const std::invalid_argument& error) {
      refuse(file.name, "/set/machine/area", error.what(),
             "an area that the pen reaches, with the old and the new settings");
    }
  }
};

}  // namespace

InputFile open_target_file(const std::string& path) {
  InputFile file = open_input(path);
  require_kind(file, {FileKind::map, FileKind::anchors, FileKind::plotter});
  return file;
}

Target open_target(const InputFile& file, const std::string& frame, const OutsideOption& outside) {
  Target target{std::make_unique<const Target::Content>(content_of(file, outside)), nullptr};
  target.lengths =
      std::visit(LengthsOf{file, frame == "bed" ? grid::MapFrame::bed : grid::MapFrame::marks},
                 *target.content);
  return target;
}

OptionRow frame_row(std::string& frame, std::string help) {
  return {"--frame",
          {frame, {"marks", "bed"}},
          std::move(help),
          facts::target,
          "to be left out without --map",
          {{facts::map | facts::anchors,
            "\"marks\", because a plotter has only its controller's frame"},
           {facts::map,
            "\"marks\", because belts have only one frame, from the crossing of its diagonals"}},
          "marks"};
}

KnownPlotter load_found_plotter(const InputFile& file) {
  KnownPlotter plotter = load_plotter(file).plotter;
  if (!plotter.found) {
    refuse(file.name, "/found", "",
           "results of a test drawing; chaintrue fit drawing.json -o found.json writes a plotter "
           "with them");
  }
  return plotter;
}

}  // namespace chaintrue::cli
