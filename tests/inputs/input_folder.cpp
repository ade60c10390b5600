// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/input_folder.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace chaintrue::inputs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path temporary_folder() {
  std::string name = fs::temp_directory_path() / "chaintrue-inputs-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for the test");
  return name;
}

/// Holes that the belts' own machine cut, all distances 0.07 % long.
std::string belt_holes(const std::string& belts) {
  Json file{{"file_type", "chaintrue_holes"}, {"format_version", "1.0"}};
  file["machine"] = Json::parse(belts).at("machine");
  const std::vector<std::pair<double, double>> at = {
      {-800, 400}, {0, 420}, {800, 380}, {-790, -390}, {10, -400}, {810, -410}, {0, 0}};
  for (std::size_t i = 0; i < at.size(); ++i) {
    const auto [x, y] = at[i];
    file["holes"].push_back({{"name", std::to_string(i)}, {"x_mm", x}, {"y_mm", y}});
    for (std::size_t j = 0; j < i; ++j) {
      const double apart = std::hypot(x - at[j].first, y - at[j].second);
      file["distances"].push_back({{"from", std::to_string(j)},
                                   {"to", std::to_string(i)},
                                   {"distance_mm", std::round(10.0 * apart * 1.0007) / 10.0}});
    }
  }
  return file.dump(1);
}

/// The points of a grid as a table, without the order of visits.
std::string as_csv(const std::string& grid) {
  std::string text = "x_mm,y_mm,left_mm,right_mm\n";
  const Json parsed = Json::parse(grid);
  for (const auto& point : parsed.at("points")) {
    for (const char* key : {"x_mm", "y_mm", "left_mm"}) text += point.at(key).dump() + ",";
    text += point.at("right_mm").dump() + "\n";
  }
  return text;
}

/// Files of the folder and the fixtures that they are copies of.
std::map<std::string, std::string> copied_files() {
  return {
      {"grid.json", "grids/seven_by_four.json"},
      {"few.json", "grids/five_new_points.json"},
      {"lattice.csv", "good/grid_plain.csv"},
      {"holes.json", "holes/nine_holes.json"},
      {"belts.json", "belts/thirty_one_places.json"},
      {"classic.json", "machines/classic.json"},
      {"stated.json", "machines/groundcontrol.json"},
      {"settings.ini", "good/groundcontrol_ring.ini"},
      {"maslow.yaml", "machines/maslow.yaml"},
      {"mural.txt", "plotter/mural.txt"},
      {"drawing.json", "plotter/mural_drawing.json"},
      {"plotter.json", "good/plotter_every_key.json"},
      {"log.txt", "good/maslow4_log.txt"},
      {"notes.txt", "good/maslow4_notes.txt"},
      {"scan.csv", "good/optical_scan.csv"}};
}

}  // namespace

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Rows rows_of(const std::string& table) {
  Rows rows;
  std::ifstream file(CHAINTRUE_FIXTURES "/../tests/" + table);
  if (!file) throw std::runtime_error("no table " + table);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    for (rows.emplace_back(); std::getline(cells, line, '\t');) rows.back().push_back(line);
  }
  return rows;
}

InputFolder::InputFolder() : folder_(temporary_folder()) {
  add_made_files("inputs/made_files.tsv");
  const std::string fixtures = CHAINTRUE_FIXTURES "/";
  for (const auto& [name, source] : copied_files()) fs::copy_file(fixtures + source, folder_ / name);
  write("grid.csv", as_csv(text_of("grid.json")));
  write("few.csv", as_csv(text_of("few.json")));
  write("belt_holes.json", belt_holes(text_of("belts.json")));
  // A plotter over a sheet of a router's size.
  write("wide_plotter.json", content_of(fixtures + "../tests/inputs/wide_plotter.json"));
  write("sweep.json",
        replaced(content_of(fixtures + "sweeps/quick.json"), "../machines/", ""));
  write("marks.csv", "x_mm,y_mm\n-900,-400\n0,-380\n900,-390\n-880,410\n20,400\n910,380\n");
  // With a line that may be left out.
  write("simple.nc",
        "G21 G90 G17\nF600\nG0 X-900 Y400\nG1 X900 Y400\n/G1 X900 Y-400\nG1 X0 Y0\nM2\n");
}

InputFolder::~InputFolder() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void InputFolder::make_missing_files(const std::string& lines) const {
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

std::vector<std::string> InputFolder::names() const {
  std::vector<std::string> all;
  for (const auto& entry : fs::directory_iterator(folder_))
    all.push_back(entry.path().filename().string());
  for (const auto& [name, line] : lines_) all.push_back(name);
  return all;
}

std::string InputFolder::text_of(const std::string& file) const {
  make_missing_files("@" + file);
  return content_of(folder_ / file);
}

void InputFolder::write(const std::string& file, const std::string& text) const {
  std::ofstream(folder_ / file, std::ios::binary) << text;
}

void InputFolder::add_made_files(const std::string& table) {
  for (const auto& row : rows_of(table)) lines_[row[0].substr(row[0].rfind('@') + 1)] = row[0];
}

Ran InputFolder::run(const std::string& lines) const {
  make_missing_files(lines);
  const fs::path folder = folder_ / "run";
  fs::create_directory(folder);
  // A map unfit for cutting gives exit code 1 but is written and can be queried.
  const std::string then = "; s=$?; [ $s -le 1 ] || exit $s; " CHAINTRUE_COMMAND " ";
  const std::string commands =
      replaced(replaced(lines, "; ", then), "@", folder_.string() + "/");
  const std::string shell = "cd " + folder.string() + " && { " CHAINTRUE_COMMAND " " + commands +
                            " ; } >../run.out 2>../run.err";
  const int status = std::system(shell.c_str());
  Ran ran;
  ran.code = WEXITSTATUS(status);
  ran.out = content_of(folder_ / "run.out");
  ran.err = content_of(folder_ / "run.err");
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      ran.files[fs::relative(entry.path(), folder).string()] = content_of(entry.path());
  }
  fs::remove_all(folder);
  return ran;
}

}  // namespace chaintrue::inputs
