// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/target.hpp"

#include "grid/belts/belt_map.hpp"
#include "grid/map/map_in_frame.hpp"
#include "grid/plotter/plotter_map.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/start_plotter.hpp"

namespace chaintrue::cli {
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
  Lengths operator()(const files::FittedAnchors& found) const {
    if (!found.holes && !found.fit.coordinates.front().stated_mm) {
      refuse(file.name, "/fit/coordinates", "no stated_mm",
             "anchors fitted to a file with the anchors in force, which define the origin of "
             "commands (import maslow4 --settings maslow.yaml)");
    }
    return std::make_unique<const grid::BeltMap>(found.fit, holes_of(found));
  }
  Lengths operator()(const grid::KnownPlotter& plotter) const {
    try {
      return std::make_unique<const grid::MechanismMap>(grid::plotter_map(plotter));
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

grid::KnownPlotter load_found_plotter(const InputFile& file) {
  grid::KnownPlotter plotter = load_plotter(file).plotter;
  if (!plotter.found) {
    refuse(file.name, "/found", "",
           "results of a test drawing; chaintrue fit drawing.json -o found.json writes a plotter "
           "with them");
  }
  return plotter;
}

}  // namespace chaintrue::cli
