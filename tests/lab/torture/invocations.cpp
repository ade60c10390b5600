// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/invocations.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "tests/inputs/help.hpp"
#include "tests/inputs/invocations.hpp"

namespace chaintrue::torture {
namespace {

using Words = std::vector<std::string>;

/// Words of a line; names of files still begin with "@".
Words words_of(const inputs::Invocation& call) {
  std::istringstream line(call.line);
  Words words{std::istream_iterator<std::string>(line), {}};
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i - 1] == "-o" || inputs::is_output(words[i - 1])) words[i] = "OUT";
  }
  if (words[0] == "start") words.back() = "OUT";
  return words;
}

std::string without_at(const std::string& word) {
  return word.starts_with('@') ? word.substr(1) : word;
}

Words plain(Words words) {
  std::transform(words.begin(), words.end(), words.begin(), without_at);
  return words;
}

int weight_of(const std::string& verb) {
  const bool is_slow = verb == "diagnose" || verb == "sweep" || verb == "plan";
  return is_slow ? 1 : 4;
}

/// Readers of files that have every key, or another form.
std::vector<Reading> more_readings() {
  return {{"grid_every_key.json", 4, {"fit", "IN", "-o", "OUT"}},
          {"commas.csv", 4, {"fit", "IN", "--machine", "classic.json", "-o", "OUT"}},
          {"holes.csv", 4, {"fit", "IN", "--machine", "classic.json", "-o", "OUT"}},
          {"machine_every_key.json", 4, {"simulate", "--machine", "IN", "--grid", "3x3"}},
          {"machine_every_key.json", 4, {"start", "IN", "OUT"}},
          {"belts_every_key.json", 4, {"fit", "IN", "-o", "OUT"}},
          {"diagnosis_every_key.json", 4, {"report", "IN", "-o", "OUT"}},
          {"diagnosis_every_key.json", 2, {"export", "groundcontrol", "IN"}},
          {"part.nc", 10, {"gcode", "check", "IN"}},
          {"part.nc", 10, {"gcode", "compensate", "IN", "--map", "map.json", "-o", "OUT"}}};
}

}  // namespace

const std::vector<std::pair<std::string, std::string>>& copied_files() {
  static const std::vector<std::pair<std::string, std::string>> all = {
      {"grid_every_key.json", "good/grid_every_key.json"},
      {"commas.csv", "good/grid_decimal_commas_and_semicolons.csv"},
      {"machine_every_key.json", "good/machine_every_key.json"},
      {"holes.csv", "good/holes_plain.csv"},
      {"belts_every_key.json", "good/belts_every_key.json"},
      {"diagnosis_every_key.json", "good/diagnosis_every_key.json"},
      {"part.nc", "gcode/bracket.nc"}};
  return all;
}

const std::vector<Reading>& readings() {
  static const std::vector<Reading> all = [] {
    std::vector<Reading> found = more_readings();
    for (const inputs::Invocation& call : inputs::invocations()) {
      const Words words = words_of(call);
      for (std::size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with('@')) continue;
        const std::size_t end = std::min(words[i].find(':'), words[i].size());
        Words arguments = plain(words);
        arguments[i] = "IN" + words[i].substr(end);
        found.push_back({words[i].substr(1, end - 1), weight_of(call.verb), arguments});
      }
    }
    return found;
  }();
  return all;
}

std::vector<Reading> readings_of_hashed_files() {
  std::vector<Reading> found;
  std::copy_if(
      readings().begin(), readings().end(), std::back_inserter(found), [](const Reading& reading) {
        return reading.seed_file == "map.json" || reading.seed_file == "anchors.json";
      });
  return found;
}

const std::vector<Words>& calls() {
  static const std::vector<Words> all = [] {
    std::vector<Words> found;
    for (const inputs::Invocation& call : inputs::invocations())
      found.push_back(plain(words_of(call)));
    return found;
  }();
  return all;
}

std::string verb_of(const Words& arguments) {
  return inputs::has_subverbs(arguments[0]) ? arguments[0] + " " + arguments[1] : arguments[0];
}

}  // namespace chaintrue::torture
