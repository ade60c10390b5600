// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <utility>

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

Verb Verb::add_verb(const std::string& name, const std::string& help,
                    const std::string& footer) const {
  CLI::App* verb = app_->add_subcommand(name, help);
  if (!footer.empty()) verb->footer(footer);
  return Verb(*verb);
}

Verb Verb::add_choice(const std::string& name) const {
  CLI::App* group = app_->add_option_group(name);
  group->require_option(1);
  return Verb(*group);
}

void Verb::require_verb() const { app_->require_subcommand(1); }

void Verb::has(const std::vector<OptionRow>& rows) const {
  for (const OptionRow& row : rows) {
    const CLI::Option* option = row.value.declare(*this, row.names, row.help);
    if (!row.otherwise.empty())
      acts_on(option->get_name(), {{row.facts, row.otherwise}}, row.harmless);
    acts_on(option->get_name(), row.more, row.harmless);
  }
}

void Verb::acts_on(const std::string& option, const std::vector<ActsOn>& rules,
                   const std::string& harmless) const {
  const std::string name = "--" + app_->get_option(option)->get_single_name();
  for (const auto& [facts, otherwise] : rules)
    declared().rules.push_back({path(), name, facts, otherwise, harmless});
}

void Verb::needs(const Words& options, const std::string& other) const {
  for (const std::string& option : options)
    app_->get_option(option)->needs(app_->get_option(other));
}

void Verb::excludes(const Words& options, const std::string& other) const {
  for (const std::string& option : options)
    app_->get_option(option)->excludes(app_->get_option(other));
}

void Verb::when_chosen(Run run, std::function<void()> check) const {
  app_->callback([run = std::move(run), check = std::move(check)] {
    check();
    chosen_run() = run;
  });
}

Run& chosen_run() {
  static Run run;
  return run;
}

bool Verb::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

bool Verb::is_given(const std::string& name) const {
  const CLI::Option* option = app_->get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

std::vector<GivenOption> Verb::given_options() const {
  std::vector<GivenOption> given;
  for (const CLI::Option* option : parts_of(*app_).options) {
    const bool has_long_name = !option->get_lnames().empty();
    if (option->count() == 0 || (!has_long_name && option->get_snames().empty())) continue;
    const bool is_flag = option->get_items_expected_max() == 0;
    given.push_back({(has_long_name ? "--" : "-") + option->get_single_name(),
                     is_flag ? Words{} : option->results()});
  }
  return given;
}

void Verb::refuse_idle_options(Facts facts) const {
  OptionProblems problems;
  for (const auto& [name, words] : given_options()) {
    const std::string value = words.empty() ? "given" : fmt::format("{}", fmt::join(words, " "));
    for (const OptionRule& rule : declared().rules) {
      const bool is_harmless = !rule.harmless.empty() && value == rule.harmless;
      if (rule.verb != path() || rule.option != name) continue;
      if (is_harmless || (rule.acts_on & facts) != 0) continue;
      problems.add(name, value, rule.otherwise, ProblemKind::option_without_use);
      break;
    }
  }
  problems.throw_if_any();
}

std::string Verb::path() const {
  std::string words;
  for (const CLI::App* app = with_name().app_; app->get_parent() != nullptr;
       app = app->get_parent())
    words = app->get_name() + (words.empty() ? "" : " ") + words;
  return words;
}

bool Verb::is_chosen() const { return app_->parsed(); }

Verb Verb::with_name() const {
  CLI::App* verb = app_;
  while (verb->get_name().empty() && verb->get_parent() != nullptr) verb = verb->get_parent();
  return Verb(*verb);
}

VerbParts parts_of(CLI::App& verb) {
  VerbParts parts{verb.get_options(), {}};
  for (CLI::App* below : verb.get_subcommands([](CLI::App*) { return true; })) {
    // A group of options has no name and belongs to its verb.
    if (below->get_name().empty()) {
      append_all(parts.options, parts_of(*below).options);
    } else {
      parts.verbs.push_back(below);
    }
  }
  return parts;
}

Words long_names(const std::vector<CLI::Option*>& options) {
  Words names;
  for (const CLI::Option* option : options) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

Words names_of(const std::vector<CLI::App*>& verbs) {
  return mapped(verbs, [](const CLI::App* verb) { return verb->get_name(); });
}

void usage_error(const std::string& verb, const std::string& sentence) {
  throw CLI::ValidationError(verb, sentence);
}

void missing_option(const std::string& names) { throw CLI::RequiredError(names); }

void OptionProblems::add(std::string_view option, std::string value, std::string expected,
                         ProblemKind kind) {
  problems_.push_back(
      {"command line", std::string(option), std::move(value), std::move(expected), {}, kind});
}

void OptionProblems::require(std::string_view option, double value, double least, double most) {
  if (value >= least && value <= most) return;
  add(option, fmt::format("{}", value), fmt::format("a number from {} to {}", least, most),
      ProblemKind::out_of_range);
}

void OptionProblems::take_from(const std::function<void()>& check) {
  try {
    check();
  } catch (const InputError& error) {
    append_all(problems_, error.problems());
  }
}

void OptionProblems::throw_if_any() const {
  if (!problems_.empty()) throw InputError(problems_);
}

Declared& declared() {
  static Declared all;
  return all;
}

void add_option_check(Verb verb, std::function<void(OptionProblems&)> check) {
  declared().checks.push_back({verb, std::move(check)});
}

void check_command_line() {
  OptionProblems problems;
  problems.take_from([] { declared().misread.throw_if_any(); });
  for (const DeclaredCheck& one : declared().checks) {
    if (one.verb.is_chosen()) one.check(problems);
  }
  problems.take_from(check_places);
  problems.throw_if_any();
}

}  // namespace chaintrue::cli
