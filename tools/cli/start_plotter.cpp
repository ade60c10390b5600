// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "grid/files/drawing_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/plotter/test_drawing.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace fs = std::filesystem;

/// A mural and a Polargraph read a picture, the others a program.
FolderFile drawn_page_of(const grid::TestDrawing& drawing) {
  if (drawing.firmware == PlotterFirmware::mural || drawing.firmware == PlotterFirmware::polargraph)
    return {"page.svg", drawing_svg(drawing), Origin::drawing};
  return {"page.gcode",
          "; chaintrue start: the test drawing of a V-plotter\n" + drawing_gcode(drawing),
          Origin::program};
}

/// \throws InputError for a cross that the controller does not reach.
void require_reach(const grid::TestDrawing& drawing, const std::string& file) {
  const auto refuse_cross = [&](std::size_t place, std::string_view why) {
    const grid::DrawnCross& cross = drawing.crosses[place];
    refuse(file, "/set/machine/area",
           fmt::format("a cross at ({:.1f}, {:.1f}) mm, {}", cross.commanded.x_mm,
                       cross.commanded.y_mm, why),
           "an area that the pen reaches");
  };
  const auto drawn = drawn_measures_of(drawing);
  if (!drawn) refuse_cross(drawn.error().place, drawn.error().sentence());
  if (const auto cross = cross_beyond_belt(drawing))
    refuse_cross(*cross, fmt::format("beyond a belt of {:g} mm (/set/longest_belt_mm)",
                                     *drawing.longest_belt_mm));
}

}  // namespace

bool is_of_a_plotter(const InputFile& file) {
  return file.kind == FileKind::plotter ||
         (!is_json(file.text) && files::is_of_a_plotter_alone(file.text));
}

files::ReadPlotter load_plotter(const InputFile& file) {
  if (is_json(file.text)) {
    require_kind(file, {FileKind::plotter});
    return {files::parse_plotter(file.text, file.name), {}};
  }
  return files::parse_plotter_settings(file.text, file.name);
}

int start_plotter(Verb verb, const InputFile& file, std::string folder) {
  const files::ReadPlotter read = load_plotter(file);
  print_warnings(read.warnings);
  grid::SetPlotter set = read.plotter.set;
  const bool is_ours = file.kind == FileKind::plotter;
  if (folder.empty() && is_ours) folder = fs::path(file.path).parent_path().string();
  if (folder.empty()) folder = ".";
  if (read.plotter.found) {
    set = once_typed_in(set, machine_found(set, *read.plotter.found));
    say("This page is for the plotter with the numbers from export plotter typed in.");
  }
  const grid::TestDrawing drawing = planned_drawing(set);
  require_reach(drawing, file.name);
  const FolderFile page = drawn_page_of(drawing);
  std::vector<FolderFile> contents = {
      page,
      {"sheet.txt", measuring_list(drawing), Origin::list},
      {"drawing.json", files::write_blank_drawing(drawing), Origin::measured}};
  if (!is_ours) {
    contents.push_back({"plotter.json",
                        files::write_plotter(read.plotter, sentences_of(read.warnings)),
                        Origin::machine});
  }
  write_folder(verb, folder, contents);
  const auto in_folder = [&](const char* name) { return (fs::path(folder) / name).string(); };
  say("{0} holds the test page: draw {1}, print sheet.txt, measure with a ruler and a "
      "string, and write what you read into drawing.json in place of each null.",
      folder, page.name);
  say_next({"fit", in_folder("drawing.json"), "-o", in_folder("found.json")});
  return kDone;
}

}  // namespace chaintrue::cli
