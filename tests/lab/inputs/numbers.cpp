// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/lab/inputs/numbers.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

namespace chaintrue::inputs {
namespace {

using Json = nlohmann::ordered_json;

void gather_numbers(const Json& json, const std::vector<std::string>& echoes,
                    std::string& numbers) {
  if (json.is_number() || json.is_boolean() || json.is_null()) numbers += json.dump() + " ";
  if (json.is_array()) {
    for (const auto& element : json) gather_numbers(element, echoes, numbers);
    numbers += "; ";
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (std::ranges::find(echoes, key) == echoes.end()) gather_numbers(value, echoes, numbers);
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

}  // namespace

std::string numbers_of(const Ran& ran, const std::vector<std::string>& echoes) {
  std::string numbers = std::to_string(ran.code) + " | " + numbers_of_text(ran.out, echoes);
  for (const auto& [name, text] : ran.files) numbers += " | " + numbers_of_text(text, echoes);
  return numbers;
}

}  // namespace chaintrue::inputs
