// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/command_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "grid/containers.hpp"
#include "grid/files/problems.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {
namespace {

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    // Groups of options are subcommands without a name.
    if (!verb->get_name().empty()) names.push_back(verb->get_name());
  }
  return names;
}

void add_options(const CLI::App& app, std::vector<std::string>& names) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* group : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (group->get_name().empty()) add_options(*group, names);
  }
}

const CLI::App* verb_named(const CLI::App& app, const std::string& name) {
  const std::vector<std::string> names = verbs_of(app);
  if (!grid::contains(names, name)) return nullptr;
  return app.get_subcommand(name);
}

}  // namespace

std::vector<std::string> words_of(std::vector<std::string> words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

std::string did_you_mean(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* verb = &app;
  std::size_t at = 0;
  for (; at < words.size() && words[at].rfind('-', 0) != 0; ++at) {
    const CLI::App* next = verb_named(*verb, words[at]);
    if (next == nullptr) break;
    verb = next;
  }
  const std::string verb_name = verb == &app ? "chaintrue" : "chaintrue " + verb->get_name();
  if (!verbs_of(*verb).empty() && at < words.size() && words[at].rfind('-', 0) != 0) {
    const std::string near = files::nearest(words[at], verbs_of(*verb));
    const std::string list = fmt::format("{} --help lists them all.\n", verb_name);
    if (near.empty()) return fmt::format("There is no {} {}. {}", verb_name, words[at], list);
    return fmt::format(
        "There is no {} {}. Did you mean {} {}?\n", verb_name, words[at], verb_name, near);
  }
  std::vector<std::string> known;
  add_options(*verb, known);
  add_options(app, known);
  for (; at < words.size(); ++at) {
    const std::string option = words[at].substr(0, words[at].find('='));
    if (option.rfind("--", 0) != 0 || option == "--") continue;
    if (grid::contains(known, option)) continue;
    const std::string near = files::nearest(option, known);
    if (near.empty()) {
      return fmt::format(
          "{} has no option {}. {} --help lists them all.\n", verb_name, option, verb_name);
    }
    return fmt::format("{} has no option {}. Did you mean {}?\n", verb_name, option, near);
  }
  return {};
}

}  // namespace chaintrue::cli
