// SPDX-License-Identifier: GPL-3.0-or-later
// Every number in a file of measurements or of a machine affects every verb that accepts the file:
// a change of it changes numbers of the answer, or is rejected with a message. idle_keys.tsv gives
// the reasons for keys without effect on a verb; a key that is not in it and changes nothing fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/lab/inputs/numbers.hpp"
#include "tests/lab/inputs/tellings.hpp"

namespace chaintrue {
namespace {

using inputs::InputFolder;
using inputs::Ran;
using Json = nlohmann::ordered_json;

/// A verb on a file, FILE in the line. `echoes` are keys that repeat the input and are not part of
/// the answer.
struct Reader {
  const char* verb;
  const char* line;
};

bool is_idle(const std::string& kind, const std::string& verb, const std::string& key) {
  static const inputs::Rows idle = inputs::rows_of("lab/inputs/idle_keys.tsv");
  return std::ranges::any_of(idle, [&](const auto& row) {
    return row.at(0) == kind && row.at(1) == verb && key.starts_with(row.at(2));
  });
}

/// Pointers of all numbers; of a list of similar entries the first one only.
void gather(const Json& json, const std::string& pointer, std::vector<std::string>& pointers) {
  if (json.is_number()) pointers.push_back(pointer);
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) gather(value, pointer + "/" + key, pointers);
  }
  if (!json.is_array()) return;
  const bool few_and_different = pointer.ends_with("readings") || pointer.ends_with("effects") ||
                                 pointer.ends_with("distances");
  for (std::size_t k = 0; k < json.size() && k < (few_and_different ? 2U : 1U); ++k)
    gather(json[k], pointer + "/" + std::to_string(k), pointers);
}

bool holds(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// A distinguishable value: as far from the old one as is still valid for such a number.
Json telling_value(const std::string& pointer, const Json& value) {
  const double old = value.get<double>();
  if (pointer.ends_with("/order")) return 5000;
  if (pointer.ends_with("teeth") || pointer.ends_with("gearteeth")) return value.get<int>() + 1;
  if (holds(pointer, "bed")) return 1.1 * old;
  for (const char* part :
       {"sigma", "dof", "noise", "shift_mm", "rotation_mrad", "uncertainty", "size_"}) {
    if (holds(pointer, part)) return 2.0 * old;
  }
  if (holds(pointer, "/readings")) return 1.0003 * old;
  for (const char* part : {"/points", "/holes/", "/distances"}) {
    if (holds(pointer, part)) return old + 1.5;
  }
  if (holds(pointer, "parameters")) return 1.5 * old;
  return 1.01 * old + (old == 0.0 ? 0.5 : 0.0);
}

class KeyMatrix : public testing::Test {
 protected:
  KeyMatrix() { inputs::add_telling_files(folder_); }
  void expect_every_key_acts(const std::string& kind, const Json& file,
                             const std::vector<Reader>& readers) const {
    static const std::vector<std::string> kEchoes = {
        "content_hash",     "name",      "noise",    "tape",
        "hole_sigma_mm",    "noise_dof", "seed",     "machine",
        "extended_machine", "sheet",     "readings", "distances",
        "made_by"};
    std::vector<std::string> pointers;
    gather(file, "", pointers);
    for (const Reader& reader : readers) {
      const std::string name = kind + ".key.json";
      std::string line = reader.line;
      line.replace(line.find("FILE"), 4, "@" + name);
      const auto answer = [&](const Json& content) {
        folder_.write(name, content.dump(1));
        Ran ran = folder_.run(line);
        if (ran.code != 3) ran.files.clear();
        return ran;
      };
      const Ran base = answer(file);
      ASSERT_LT(base.code, 2) << line << "\n" << base.err;
      for (const std::string& pointer : pointers) {
        Json changed = file;
        Json& value = changed[Json::json_pointer(pointer)];
        value = telling_value(pointer, value);
        const Ran ran = answer(changed);
        const bool is_refused = ran.code == 3 && !ran.err.empty();
        const bool acts = is_refused || numbers_of(ran, kEchoes) != numbers_of(base, kEchoes);
        EXPECT_TRUE(acts || is_idle(kind, reader.verb, pointer))
            << kind << " " << reader.verb << " " << pointer << " is silent";
      }
    }
  }
  Json made(const std::string& line) const {
    const Ran ran = folder_.run(line);
    EXPECT_EQ(ran.code, 0) << line << "\n" << ran.err;
    return Json::parse(ran.out);
  }
  static Json readings() {
    return Json::parse(R"([{"what": "motor_spacing_mm", "value": 2979.5, "sigma": 1},
                           {"what": "link_pitch_mm", "side": "left", "value": 6.353, "sigma": 0.001}])");
  }

  InputFolder folder_;
};

TEST_F(KeyMatrix, CoversGrids) {
  Json grid = made(
      "simulate --machine @classic.json --grid 6x4 --length-noise-mm 0.2 --position-noise-mm 0.3 "
      "--sheet-shift-mm 8 --sheet-rotation-mrad 4 --repeats 4 --seed 3");
  grid["readings"] = readings();
  grid.erase("machine");
  grid["machine_file"] = "classic.json";
  expect_every_key_acts(
      "grid", grid,
      {{"fit", "fit FILE -o map.json; query map.json 0 0 700 300 -1100 500 --json"},
       {"diagnose", "diagnose FILE --json"},
       {"check", "check @map.json FILE --json"}});
}

TEST_F(KeyMatrix, CoversHoles) {
  Json holes = made("simulate --machine @classic.json --holes 9 --edges --seed 3");
  holes["readings"] = readings();
  holes["tape"]["hook_offset_mm"] = 0.5;
  holes["tape"]["hook_sigma_mm"] = 0.2;
  holes["sheet"] = {{"width_mm", 2440.0}, {"height_mm", 1220.0}, {"size_sigma_mm", 1.0}};
  holes["distances"][0]["sigma_mm"] = 0.8;
  holes.erase("machine");
  holes["machine_file"] = "classic.json";
  expect_every_key_acts(
      "holes", holes,
      {{"fit", "fit FILE -o map.json; query map.json 0 0 700 300 -1100 500 --json"},
       {"diagnose", "diagnose FILE --json"},
       {"check", "check @map.json FILE --json"}});
}

TEST_F(KeyMatrix, CoversBelts) {
  Json belts = made("simulate --belts @belts.json --grid 5x5 --length-noise-mm 0.6 --seed 3");
  belts["distances"] = Json::parse(R"([
      {"from": "bl", "to": "br", "distance_mm": 2953, "sigma_mm": 1.5},
      {"from": {"x_mm": -500, "y_mm": 0}, "to": {"x_mm": 500, "y_mm": 0}, "distance_mm": 1001.4}])");
  belts["firmware_fit"] = {{"rms_mm", 0.4}, {"max_mm", 1.2}};
  expect_every_key_acts("belts", belts,
                        {{"fit",
                          "fit FILE -o anchors.json; export maslow4 anchors.json; "
                          "query anchors.json 0 0 300 200"},
                         {"diagnose", "diagnose FILE --json"},
                         {"check", "check @anchors.json FILE --json"},
                         {"simulate", "simulate --belts FILE --grid 4x3 --seed 2"}});
}

TEST_F(KeyMatrix, CoversMachines) {
  Json machine = Json::parse(folder_.text_of("every.json"));
  expect_every_key_acts(
      "machine", machine,
      {{"simulate",
        "simulate --machine FILE --grid 4x3 --length-noise-mm 0.1 --draw-settings --seed 2"}});
}

}  // namespace
}  // namespace chaintrue
