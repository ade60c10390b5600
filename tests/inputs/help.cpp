// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/help.hpp"

#include <regex>
#include <sstream>

namespace chaintrue::inputs {
namespace {

std::vector<std::string> words_of(const std::string& text, char between) {
  std::vector<std::string> words;
  std::stringstream stream(text);
  for (std::string word; std::getline(stream, word, between);) words.push_back(word);
  return words;
}

/// Of a help without any: none.
std::vector<std::string> subverbs(const std::string& help) {
  static const std::regex line("  ([a-z0-9]+) .*");
  std::vector<std::string> found;
  bool inside = false;
  for (const std::string& text : words_of(help, '\n')) {
    std::smatch parts;
    if (inside && std::regex_match(text, parts, line))
      found.push_back(parts[1]);
    else
      inside = text == "Subcommands:";
  }
  return found;
}

}  // namespace

std::vector<std::string> verbs_in(const Help& help) {
  std::vector<std::string> verbs;
  for (const std::string& verb : subverbs(help(""))) {
    const std::vector<std::string> seconds = subverbs(help(verb));
    if (seconds.empty()) verbs.push_back(verb);
    for (const std::string& second : seconds) verbs.push_back(verb + " " + second);
  }
  return verbs;
}

std::vector<Option> options_in(const std::string& help) {
  static const std::regex line(
      R"(\s+(?:-\w,)?(--[a-z0-9-]+)(?: (TEXT|INT|FLOAT)(?::\{([^}]*)\})?[^ ]*( x 2)?)?(?:\s.*)?)");
  std::vector<Option> options;
  for (const std::string& text : words_of(help, '\n')) {
    std::smatch parts;
    if (text.starts_with("Example")) break;
    if (!std::regex_match(text, parts, line) || parts[1].str().starts_with("--help")) continue;
    options.push_back({parts[1], parts[2], words_of(parts[3], ','), parts[4].matched ? 2 : 1});
  }
  return options;
}

}  // namespace chaintrue::inputs
