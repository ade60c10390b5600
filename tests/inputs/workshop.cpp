// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/workshop.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace chaintrue::inputs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

fs::path temporary_folder() {
  std::string name = fs::temp_directory_path() / "chaintrue-inputs-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for the test");
  return name;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// Holes that the belts' own machine cut, 40 mm out of true along x at the right side.
std::string belt_holes(const std::string& belts) {
  const Json machine = Json::parse(belts).at("machine");
  Json file{{"file_type", "chaintrue_holes"}, {"format_version", "1.1"}, {"machine", machine}};
  const std::vector<std::pair<double, double>> at = {
      {-800, 400}, {0, 420}, {800, 380}, {-790, -390}, {10, -400}, {810, -410}, {0, 0}};
  for (std::size_t k = 0; k < at.size(); ++k)
    file["holes"].push_back(
        {{"name", std::string(1, static_cast<char>('A' + k))}, {"x_mm", at[k].first}, {"y_mm", at[k].second}});
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = i + 1; j < at.size(); ++j) {
      const double d = std::hypot(at[i].first - at[j].first, at[i].second - at[j].second);
      file["distances"].push_back({{"from", file["holes"][i]["name"]},
                                   {"to", file["holes"][j]["name"]},
                                   {"distance_mm", std::round(10.0 * d * 1.0007) / 10.0}});
    }
  }
  return file.dump(1);
}

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

/// The points of a grid without what says when they were visited, as CSV.
std::string as_csv(const std::string& grid, std::size_t most) {
  std::string text = "x_mm,y_mm,left_mm,right_mm\n";
  std::size_t taken = 0;
  const Json parsed = Json::parse(grid);
  for (const auto& point : parsed.at("points")) {
    if (taken++ == most) break;
    const char* separator = "";
    for (const char* key : {"x_mm", "y_mm", "left_mm", "right_mm"}) {
      text += separator + point.at(key).dump();
      separator = ",";
    }
    text += "\n";
  }
  return text;
}

void gather_numbers(const Json& json, const std::vector<std::string>& echoes, std::string& numbers) {
  if (json.is_number() || json.is_boolean() || json.is_null()) numbers += json.dump() + " ";
  if (json.is_array()) {
    for (const auto& element : json) gather_numbers(element, echoes, numbers);
    numbers += "; ";
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (std::find(echoes.begin(), echoes.end(), key) == echoes.end())
      gather_numbers(value, echoes, numbers);
  }
}

std::string numbers_of_text(const std::string& text, const std::vector<std::string>& echoes) {
  const Json json = Json::parse(text, nullptr, false);
  std::string numbers;
  if (json.is_object() || json.is_array()) {
    gather_numbers(json, echoes, numbers);
    return numbers;
  }
  // The head of a compensated program says which options were given.
  static const std::regex origin(R"(\((?:chaintrue|option|from|sha256) [^)]*\))");
  const std::string own = std::regex_replace(text, origin, "");
  static const std::regex number(R"([-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?)");
  for (std::sregex_iterator at(own.begin(), own.end(), number), end; at != end; ++at)
    numbers += at->str() + " ";
  return numbers;
}

/// What the command makes itself: a file's name, and the line that makes it.
std::map<std::string, std::string> made_by_the_command() {
  return {
      // Marks on part of the bed, on a sheet that was laid by hand.
      {"placed.json",
       "simulate --machine @classic.json --grid 7x5 --margin-mm 250 --length-noise-mm 0.2 "
       "--position-noise-mm 0.3 --sheet-shift-mm 8 --sheet-rotation-mrad 4 --effect "
       "chain_pitch_error:left:elongation=0.003 --seed 5 -o @placed.json"},
      {"map.json", "fit @placed.json -o @map.json"},
      {"map2.json", "fit @placed.json --machine @other.json -o @map2.json"},
      {"anchors.json", "fit @belts.json -o @anchors.json"},
      {"worn.json",
       "simulate --machine @classic.json --grid 7x4 --length-noise-mm 0.2 --position-noise-mm 0.3 "
       "--effect chain_pitch_error:left:elongation=0.0016 --seed 5 -o @worn.json"},
      // Worn equally on both sides, or a tape that is long: one class.
      {"worn_both.json",
       "simulate --machine @classic.json --grid 7x4 --length-noise-mm 0.2 --position-noise-mm 0.3 "
       "--effect chain_pitch_error:both:elongation=0.003 --seed 5 -o @worn_both.json"},
      // With a wave that no listed cause makes.
      {"wave.json",
       "simulate --machine @classic.json --effects @half_turn.json --grid 9x6 --repeats 6 --order random "
       "--length-noise-mm 0.05 --position-noise-mm 0.05 "
       "--effect second_harmonic:left:amplitude_mm=0.2,phase_rad=1.2 --seed 3 -o @wave.json"},
      {"wave_holes.json",
       "simulate --machine @classic.json --effects @half_turn.json --holes 24 --distances 100 "
       "--tape-sigma-mm 0.1 --hole-sigma-mm 0.05 --effect second_harmonic:left:amplitude_mm=0.3,phase_rad=1.2 "
       "--seed 3 -o @wave_holes.json"},
      {"lattice.json",
       "simulate --machine @classic.json --grid 5x4 --length-noise-mm 0.2 --position-noise-mm 0.3 "
       "--seed 9 -o @lattice.json"},
      {"holes2.json", "simulate --machine @classic.json --holes 9 --seed 4 -o @holes2.json"},
      {"few_belts.json",
       "simulate --belts @anchors.json --grid 4x3 --length-noise-mm 0.6 --seed 2 -o @few_belts.json"},
      {"belts2.json",
       "simulate --belts @anchors.json --grid 5x5 --length-noise-mm 1 --seed 9 -o @belts2.json"},
      {"worn_holes.json",
       "simulate --machine @classic.json --holes 9 --effect chain_pitch_error:both:elongation=0.003 "
       "--seed 5 -o @worn_holes.json"},
      {"commanded_diagnosis.json",
       "diagnose @commanded.csv --machine @classic.json --noise-length-mm 0.2 --noise-position-mm 0.3 "
       "-o @commanded_diagnosis.json"},
      {"mixed_diagnosis.json",
       "diagnose @commanded.csv --with @holes.json --machine @classic.json --noise-length-mm 0.2 "
       "--noise-position-mm 0.3 -o @mixed_diagnosis.json"},
      {"rapid_true.nc",
       "gcode compensate @rapid.nc --map @map.json --tolerance-mm 0.01 --keep-rapids-whole -o "
       "@rapid_true.nc"},
      {"rapid_belts_true.nc",
       "gcode compensate @rapid.nc --map @anchors.json --tolerance-mm 0.01 --keep-rapids-whole -o "
       "@rapid_belts_true.nc"},
      {"short_true.nc", "gcode compensate @short.nc --map @map.json --tolerance-mm 0.02 -o @short_true.nc"},
      {"short_belts_true.nc",
       "gcode compensate @short.nc --map @anchors.json --tolerance-mm 0.02 -o @short_belts_true.nc"},
      {"rapid_plotter_true.nc",
       "gcode compensate @rapid.nc --map @wide_plotter.json --tolerance-mm 0.01 --keep-rapids-whole -o "
       "@rapid_plotter_true.nc"},
      {"short_plotter_true.nc",
       "gcode compensate @short.nc --map @wide_plotter.json --tolerance-mm 0.02 -o @short_plotter_true.nc"},
      {"slow_plotter_true.nc",
       "gcode compensate @slow.nc --map @wide_plotter.json -o @slow_plotter_true.nc"},
      {"slow_true.nc", "gcode compensate @slow.nc --map @map.json -o @slow_true.nc"},
      {"slow_belts_true.nc", "gcode compensate @slow.nc --map @anchors.json -o @slow_belts_true.nc"},
      {"diagnosis.json", "diagnose @grid.json -o @diagnosis.json"},
      {"worn_diagnosis.json", "diagnose @worn.json -o @worn_diagnosis.json"},
      {"holes_diagnosis.json", "diagnose @holes.json -o @holes_diagnosis.json"},
      {"belts_diagnosis.json", "diagnose @belts.json -o @belts_diagnosis.json"},
      {"belts_before.json", "diagnose @belts2.json -o @belts_before.json"},
      {"true.nc", "gcode compensate @simple.nc --map @map.json -o @true.nc"},
      {"belts_true.nc", "gcode compensate @simple.nc --map @anchors.json -o @belts_true.nc"},
      {"plotter_true.nc", "gcode compensate @simple.nc --map @wide_plotter.json -o @plotter_true.nc"}};
}

std::string wide_plotter(double pin_spacing_mm) {
  const auto found = [](double value, double sigma) { return Json{{"value", value}, {"sigma", sigma}}; };
  const Json plotter = {
      {"file_type", "chaintrue_plotter"},
      {"format_version", "1.1"},
      {"set",
       {{"firmware", "fluidnc"},
        {"machine",
         {{"pin_spacing_mm", pin_spacing_mm},
          {"motors", "wall"},
          {"gondola", {{"mass_kg", 2.0}}},
          {"area", {{"left_mm", -1200}, {"right_mm", 1200}, {"top_mm", -300}, {"bottom_mm", -1500}}}}},
        {"home", {{"x_mm", 0}, {"y_mm", -900}}},
        {"pins_middle", {{"x_mm", 0}, {"y_mm", 900}}}}},
      {"found",
       {{"pin_spacing_mm", found(3003.0, 0.5)},
        {"pin_rise_mm", found(2.0, 1.0)},
        {"zero_left_mm", found(6.0, 0.4)},
        {"zero_right_mm", found(-4.0, 0.4)},
        {"scale_left_mm_per_m", found(1.0, 0.2)},
        {"scale_right_mm_per_m", found(-0.5, 0.2)},
        {"correlations", std::vector<double>(15, 0.0)}}}};
  return plotter.dump(1);
}

}  // namespace

Workshop::Workshop() : folder_(temporary_folder()), lines_(made_by_the_command()) {
  const std::string fixtures = CHAINTRUE_FIXTURES;
  const std::map<std::string, std::string> copied = {
      {"grid.json", "grids/seven_by_four.json"},
      {"few.json", "grids/five_new_points.json"},
      {"lattice.csv", "good/grid_plain.csv"},
      {"holes.json", "holes/nine_holes.json"},
      {"belts.json", "belts/thirty_one_places.json"},
      {"classic.json", "machines/classic.json"},
      {"own.json", "effects/catalogue/own_chain_pitch_error.json"},
      {"half_turn.json", "effects/second_harmonic.json"},
      {"stated.json", "machines/groundcontrol.json"},
      {"every.json", "good/machine_every_key.json"},
      {"drawing.json", "plotter/mural_drawing.json"},
      {"plotter.json", "good/plotter_every_key.json"},
      {"part.nc", "gcode/bracket.nc"},
      {"log.txt", "good/maslow4_log.txt"},
      {"notes.txt", "good/maslow4_notes.txt"}};
  for (const auto& [name, source] : copied) fs::copy_file(fixtures + "/" + source, folder_ / name);
  write("grid.csv", as_csv(text_of("grid.json"), 100));
  write("few.csv", as_csv(text_of("few.json"), 5));
  write("grid_in_inches.csv", as_inches(text_of("grid.csv")));
  write("few_in_inches.csv", as_inches(text_of("few.csv")));
  write("commanded.csv", as_commands(text_of("grid.csv")));
  write("commanded_lattice.csv", as_commands(text_of("lattice.csv")));
  // Another machine, on another bed.
  Json other = Json::parse(text_of("classic.json"));
  other["bed"] = {{"width_mm", 2500.0}, {"height_mm", 1300.0}};
  other["motors"]["left"]["y_mm"] = other["motors"]["left"]["y_mm"].get<double>() + 12.0;
  other["attachment"]["radius_mm"] = 141.0;
  write("other.json", other.dump(1));
  // A sheet that the programs leave.
  Json small = Json::parse(text_of("classic.json"));
  small["bed"] = {{"width_mm", 1000.0}, {"height_mm", 600.0}};
  write("small.json", small.dump(1));
  Json moved = Json::parse(text_of("belts.json"));
  moved["machine"]["anchors"]["tl"]["x_mm"] = -19.0;
  write("moved_belts.json", moved.dump(1));
  // Over as large a sheet as a router's, as a drawing found it; and what its controller may hold now.
  write("wide_plotter.json", wide_plotter(3000.0));
  write("moved_plotter.json", wide_plotter(2996.0));
  write("belt_holes.json", belt_holes(text_of("belts.json")));
  write("narrow_holes.json", narrow_holes(text_of("holes.json")));
  // Links that are hardly longer than they should be, in place of the catalogue's.
  Json own = Json::parse(text_of("own.json"));
  own["parameters"][0]["upper"] = 0.001;
  write("own.json", own.dump(1));
  // Belts that are pulled behind each move, where the log alone is read as of an upright frame.
  write("flat.yaml", replaced(content_of(fixtures + "/machines/maslow.yaml"), "Maslow_vertical: true", "Maslow_vertical: false"));
  write("marks.csv", "x_mm,y_mm\n-900,-400\n0,-380\n900,-390\n-880,410\n20,400\n910,380\n");
  write("few_marks.csv", "x_mm,y_mm\n-800,-300\n10,-280\n820,290\n30,20\n");
  write("simple.nc", "G21 G90 G17\nF600\nG0 X-900 Y400\nG1 X900 Y400\n/G1 X900 Y-400\nG1 X0 Y0\nM2\n");
  write("offset.nc", "G21 G90 G17\nF600\nG0 X0 Y0\nG41 D1\nG1 X300 Y0\nG40\nG1 X0 Y0\nM2\n");
  // Long rapids bend; two digits do not show that a short rapid was made slow, three do; a feed may be off by a
  // hundredth.
  write("rapid.nc", "G21 G90 G17\nF600\nG0 X-1100 Y550\nG0 X1100 Y-550\nG1 X0 Y0\nM2\n");
  // A plotter's lines bend most in the middle of its sheet's upper edge.
  write("across.nc", "G21 G90 G17\nF600\nG0 X-1100 Y550\nG0 X1100 Y550\nG1 X1100 Y549\nM2\n");
  write("tiny.nc", "G21 G90 G17\nF600\nG0 X0 Y0\nG1 X100 Y0\nG0 X100.06 Y0\nG1 X100.06 Y100\nM2\n");
  write("short.nc",
        "G21 G90 G17\nF600\nG0 X0 Y0\nG1 X100 Y0\nG1 X100.06 Y0 F300\nG1 X100.06 Y100 F600\nM2\n");
  write("slow.nc", replaced(text_of("simple.nc"), "F600", "F588"));
  // Whoever wants to know of line 6 has to come out of the loop first.
  write("loop.nc",
        "G21 G90 G17 F600\n#1=0\no1 while [#1 lt 4]\n#1=[#1+1]\no1 endwhile\nG1 X100 Y0\n"
        "G1 X0 Y0\nM2\n");
  write("home.nc", "G21 G90 G17\nF600\nG1 X200 Y100\nG28\nG1 X0 Y0\nM2\n");
}

Workshop::~Workshop() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Workshop::make_what_is_missing(const std::string& lines) const {
  for (std::size_t at = lines.find('@'); at != std::string::npos; at = lines.find('@', at + 1)) {
    const std::size_t end = std::min(lines.find_first_of(" :;", at), lines.size());
    const auto own = lines_.find(lines.substr(at + 1, end - at - 1));
    if (own == lines_.end()) continue;
    const std::string line = own->second;
    lines_.erase(own);  // before it runs: it names its own output
    const Ran ran = run(line);
    if (ran.code != 0) throw std::runtime_error("cannot make a file: " + line + "\n" + ran.err);
  }
}

std::string Workshop::text_of(const std::string& file) const {
  make_what_is_missing("@" + file);
  return content_of(folder_ / file);
}

void Workshop::write(const std::string& file, const std::string& text) const {
  std::ofstream(folder_ / file) << text;
}

Ran Workshop::run(const std::string& lines) const {
  make_what_is_missing(lines);
  static std::atomic<int> next = 0;
  const fs::path folder = folder_ / ("run" + std::to_string(next++));
  fs::create_directory(folder);
  // A map that is not to be cut with ends with 1, and is written and asked all the same.
  const std::string then = "; s=$?; [ $s -le 1 ] || exit $s; " CHAINTRUE_COMMAND " ";
  std::string shell =
      "cd " + folder.string() + " && { " CHAINTRUE_COMMAND " " + replaced(lines, "; ", then);
  shell = replaced(shell, "@", folder_.string() + "/") + " ; } >../out" + folder.filename().string() +
          " 2>../err" + folder.filename().string();
  const int status = std::system(shell.c_str());
  Ran ran;
  ran.code = WEXITSTATUS(status);
  ran.out = content_of(folder_ / ("out" + folder.filename().string()));
  ran.err = content_of(folder_ / ("err" + folder.filename().string()));
  for (const auto& entry : fs::directory_iterator(folder))
    ran.files[entry.path().filename().string()] = content_of(entry.path());
  fs::remove_all(folder);
  return ran;
}

std::string numbers_of(const Ran& ran, const std::vector<std::string>& echoes) {
  std::string numbers = std::to_string(ran.code) + " | " + numbers_of_text(ran.out, echoes);
  for (const auto& [name, text] : ran.files) numbers += " | " + numbers_of_text(text, echoes);
  return numbers;
}

}  // namespace chaintrue::inputs
