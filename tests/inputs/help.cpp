// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/help.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace chaintrue::inputs {
namespace {

std::vector<std::string> words_of(const std::string& text, char between) {
  std::vector<std::string> words;
  std::stringstream stream(text);
  for (std::string word; std::getline(stream, word, between);) words.push_back(word);
  return words;
}

std::vector<std::string> subverbs(const std::string& help) {
  static const std::regex line("  ([a-z0-9]+) .*");
  std::vector<std::string> found;
  bool inside = false;
  for (const std::string& text : words_of(help, '\n')) {
    std::smatch parts;
    if (text == "Subcommands:") {
      inside = true;
    } else if (inside && std::regex_match(text, parts, line)) {
      found.push_back(parts[1]);
    } else {
      inside = false;
    }
  }
  if (found.empty()) throw std::runtime_error("no verbs in this help:\n" + help);
  return found;
}

}  // namespace

bool has_subverbs(std::string_view verb) {
  return verb == "import" || verb == "export" || verb == "gcode";
}

std::vector<std::string> verbs_in(const Help& help) {
  std::vector<std::string> verbs;
  for (const std::string& verb : subverbs(help(""))) {
    if (!has_subverbs(verb)) {
      verbs.push_back(verb);
      continue;
    }
    for (const std::string& second : subverbs(help(verb))) verbs.push_back(verb + " " + second);
  }
  return verbs;
}

std::vector<Option> options_in(const std::string& help) {
  static const std::regex line(
      R"(\s+(?:(-\w),)?(--[a-z0-9-]+)(?: (TEXT|INT|FLOAT)(?::\{([^}]*)\})?[^ ]*( x 2)?)?(?:\s.*)?)");
  std::vector<Option> options;
  for (const std::string& text : words_of(help, '\n')) {
    std::smatch parts;
    if (text.starts_with("Example")) break;
    if (!std::regex_match(text, parts, line) || parts[2].str().starts_with("--help")) continue;
    options.push_back(
        {parts[2], parts[1], parts[3], words_of(parts[4], ','), parts[5].matched ? 2 : 1});
  }
  return options;
}

}  // namespace chaintrue::inputs
