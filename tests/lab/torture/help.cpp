// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/help.hpp"

#include <regex>
#include <sstream>
#include <stdexcept>

#include "torture/invocations.hpp"

namespace chaintrue::torture {
namespace {

std::vector<std::string> words_of(const std::string& text, char between) {
  std::vector<std::string> words;
  std::stringstream stream(text);
  for (std::string word; std::getline(stream, word, between);) words.push_back(word);
  return words;
}

std::string help_of(const Command& command, const std::string& verb) {
  std::vector<std::string> arguments = words_of(verb, ' ');
  arguments.push_back("--help");
  const Ended ended = command.run(arguments);
  if (ended.code != 0) throw std::runtime_error("no help of the verb: " + verb);
  return ended.out;
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

std::vector<std::string> verbs_of(const Command& command) {
  std::vector<std::string> verbs;
  for (const std::string& verb : subverbs(help_of(command, ""))) {
    if (!has_subverbs(verb)) {
      verbs.push_back(verb);
      continue;
    }
    for (const std::string& second : subverbs(help_of(command, verb)))
      verbs.push_back(verb + " " + second);
  }
  return verbs;
}

std::vector<Option> options_of(const Command& command, const std::string& verb) {
  static const std::regex line(
      R"(\s+(?:(-\w),)?(--[a-z0-9-]+)(?: (TEXT|INT|FLOAT)(?::\{([^}]*)\})?[^ ]*( x 2)?)?(?:\s.*)?)");
  std::vector<Option> options;
  for (const std::string& text : words_of(help_of(command, verb), '\n')) {
    std::smatch parts;
    if (!std::regex_match(text, parts, line) || parts[2].str().starts_with("--help")) continue;
    options.push_back(
        {parts[2], parts[1], parts[3], words_of(parts[4], ','), parts[5].matched ? 2 : 1});
  }
  return options;
}

}  // namespace chaintrue::torture
