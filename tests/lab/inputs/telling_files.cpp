// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/lab/inputs/tellings.hpp"

namespace chaintrue::inputs {
namespace {

using Json = nlohmann::ordered_json;

/// The holes of the bed's left and middle, so that a part of it lies outside.
std::string narrow_holes(const std::string& holes) {
  Json file = Json::parse(holes);
  const auto is_right = [&](const Json& name) { return name == "F" || name == "I"; };
  Json kept = Json::array();
  for (const Json& hole : file["holes"]) {
    if (!is_right(hole["name"])) kept.push_back(hole);
  }
  file["holes"] = kept;
  kept = Json::array();
  for (const Json& distance : file["distances"]) {
    if (!is_right(distance["from"]) && !is_right(distance["to"])) kept.push_back(distance);
  }
  file["distances"] = kept;
  return file.dump(1);
}

/// Numbers of a table in inches, under the same header.
std::string as_inches(const std::string& csv) {
  std::istringstream rows(csv);
  std::string text;
  std::getline(rows, text);
  for (std::string row; std::getline(rows, row);) {
    text += "\n";
    std::istringstream cells(row);
    const char* separator = "";
    for (std::string cell; std::getline(cells, cell, ',');) {
      std::ostringstream inches;
      inches.precision(12);
      inches << std::stod(cell) / 25.4;
      text += separator + inches.str();
      separator = ",";
    }
  }
  return text + "\n";
}

/// Marks as places that the controller was sent to, 2 mm aside.
std::string as_commands(const std::string& csv) {
  std::istringstream rows(csv);
  std::string text = "x_mm,y_mm,commanded_x_mm,commanded_y_mm\n";
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    double x = 0.0;
    double y = 0.0;
    char comma = 0;
    std::istringstream(row) >> x >> comma >> y;
    std::ostringstream line;
    line << x << "," << y << "," << x + 2.0 << "," << y - 1.5 << "\n";
    text += line.str();
  }
  return text;
}

}  // namespace

void add_telling_files(InputFolder& folder) {
  folder.add_made_files("lab/inputs/made_files.tsv");
  const std::string fixtures = CHAINTRUE_FIXTURES "/";
  folder.write("every.json", testing_support::read_text(fixtures + "good/machine_every_key.json"));
  folder.write("half_turn.json",
               testing_support::read_text(fixtures + "effects/second_harmonic.json"));
  folder.write("grid_in_inches.csv", as_inches(folder.text_of("grid.csv")));
  folder.write("few_in_inches.csv", as_inches(folder.text_of("few.csv")));
  folder.write("commanded.csv", as_commands(folder.text_of("grid.csv")));
  folder.write("commanded_lattice.csv", as_commands(folder.text_of("lattice.csv")));
  // Another machine, on another bed.
  Json other = Json::parse(folder.text_of("classic.json"));
  other["bed"] = {{"width_mm", 2500.0}, {"height_mm", 1300.0}};
  other["motors"]["left"]["y_mm"] = other["motors"]["left"]["y_mm"].get<double>() + 12.0;
  other["attachment"]["radius_mm"] = 141.0;
  folder.write("other.json", other.dump(1));
  // A sheet that the programs leave.
  Json small = Json::parse(folder.text_of("classic.json"));
  small["bed"] = {{"width_mm", 1000.0}, {"height_mm", 600.0}};
  folder.write("small.json", small.dump(1));
  Json moved = Json::parse(folder.text_of("belts.json"));
  moved["machine"]["anchors"]["tl"]["x_mm"] = -19.0;
  folder.write("moved_belts.json", moved.dump(1));
  // Possible present settings of the plotter's controller.
  folder.write("moved_plotter.json", replaced(folder.text_of("wide_plotter.json"), "3000", "2996"));
  folder.write("narrow_holes.json", narrow_holes(folder.text_of("holes.json")));
  // Links with a slightly long pitch, instead of the catalogue's cause.
  Json own = Json::parse(
      testing_support::read_text(fixtures + "effects/catalogue/own_chain_pitch_error.json"));
  own["parameters"][0]["upper"] = 0.001;
  folder.write("own.json", own.dump(1));
  // Belts that are pulled behind each move, where the log alone is read as of an upright frame.
  folder.write("flat.yaml", replaced(folder.text_of("maslow.yaml"), "Maslow_vertical: true",
                                     "Maslow_vertical: false"));
  folder.write("few_marks.csv", "x_mm,y_mm\n-800,-300\n10,-280\n820,290\n30,20\n");
  folder.write("offset.nc", "G21 G90 G17\nF600\nG0 X0 Y0\nG41 D1\nG1 X300 Y0\nG40\nG1 X0 Y0\nM2\n");
  // Long rapids bend; two digits do not show that a short rapid was made slow, three do; a feed may be off by a
  // hundredth.
  folder.write("rapid.nc", "G21 G90 G17\nF600\nG0 X-1100 Y550\nG0 X1100 Y-550\nG1 X0 Y0\nM2\n");
  // A plotter's lines bend most in the middle of its sheet's upper edge.
  folder.write("across.nc",
               "G21 G90 G17\nF600\nG0 X-1100 Y550\nG0 X1100 Y550\nG1 X1100 Y549\nM2\n");
  folder.write("tiny.nc",
               "G21 G90 G17\nF600\nG0 X0 Y0\nG1 X100 Y0\nG0 X100.06 Y0\nG1 X100.06 Y100\nM2\n");
  folder.write(
      "short.nc",
      "G21 G90 G17\nF600\nG0 X0 Y0\nG1 X100 Y0\nG1 X100.06 Y0 F300\nG1 X100.06 Y100 F600\nM2\n");
  folder.write("slow.nc", replaced(folder.text_of("simple.nc"), "F600", "F588"));
  // Explaining line 6 requires leaving the loop first.
  folder.write("loop.nc",
               "G21 G90 G17 F600\n#1=0\no1 while [#1 lt 4]\n#1=[#1+1]\no1 endwhile\nG1 X100 Y0\n"
               "G1 X0 Y0\nM2\n");
  folder.write("home.nc", "G21 G90 G17\nF600\nG1 X200 Y100\nG28\nG1 X0 Y0\nM2\n");
}

}  // namespace chaintrue::inputs
