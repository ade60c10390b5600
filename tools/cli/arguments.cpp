// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/arguments.hpp"

#include <utility>

#include <CLI/CLI.hpp>

#include "grid/containers.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct Rule {
  const CLI::Option* option;
  Facts acts_on;
  std::string otherwise;
  std::string harmless;
};

/// Of the current command line, all verbs.
std::vector<Rule>& rules() {
  static std::vector<Rule> all;
  return all;
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::one_of(const Words& words) const {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::needs(Option other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::takes(int values) const {
  option_->expected(values);
  return *this;
}

Option Option::shows_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::shows_default(const std::string& text) const {
  option_->default_str(text);
  return *this;
}

Option Option::value_word(const std::string& word) const {
  option_->type_name(word);
  return *this;
}

Option Option::refuses(std::function<std::string(const std::string&)> fault) const {
  option_->check(
      CLI::Validator([fault = std::move(fault)](std::string& text) { return fault(text); }, ""));
  return *this;
}

Option Option::acts_on(Facts facts, std::string otherwise, std::string harmless) const {
  rules().push_back({option_, facts, std::move(otherwise), std::move(harmless)});
  return *this;
}

Verb Verb::add_verb(const std::string& name, const std::string& help) const {
  return Verb(*app_->add_subcommand(name, help));
}

Verb Verb::add_choice(const std::string& name) const {
  CLI::App* group = app_->add_option_group(name);
  group->require_option(1);
  return Verb(*group);
}

void Verb::require_verb() const { app_->require_subcommand(1); }

Option Verb::add_option(const std::string& names,
                        std::string& value,
                        const std::string& help) const {
  return Option(*app_->add_option(names, value, help));
}

Option Verb::add_option(const std::string& names, Words& values, const std::string& help) const {
  return Option(*app_->add_option(names, values, help));
}

Option Verb::add_option(const std::string& names,
                        std::function<void(const Words&)> take,
                        const std::string& help) const {
  return Option(*app_->add_option_function<Words>(names, std::move(take), help));
}

Option Verb::add_option(const std::string& names,
                        std::function<void(const std::string&)> take,
                        const std::string& help) const {
  return Option(*app_->add_option_function<std::string>(names, std::move(take), help));
}

Option Verb::add_flag(const std::string& names, bool& value, const std::string& help) const {
  return Option(*app_->add_flag(names, value, help));
}

void Verb::add_flag(const std::string& name, const std::string& help) const {
  app_->add_flag(name)->description(help);
}

void Verb::footer(const std::string& text) const { app_->footer(text); }

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

Option Verb::option(const std::string& name) const { return Option(*app_->get_option(name)); }

bool Verb::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

bool Verb::is_given(const std::string& name) const {
  const CLI::Option* option = app_->get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

std::string Verb::value_of(const std::string& name) const {
  const CLI::Option* option = app_->get_option_no_throw(name);
  if (option == nullptr || option->count() == 0) return "";
  if (option->get_items_expected_max() == 0) return "given";
  std::string text;
  for (const std::string& word : option->results()) text += (text.empty() ? "" : " ") + word;
  return text;
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
  const CLI::Option* refused = nullptr;
  for (const CLI::Option* option : app_->get_options()) {
    for (const Rule& rule : rules()) {
      if (rule.option != option || option == refused || (rule.acts_on & facts) != 0) continue;
      const std::string name = "--" + option->get_single_name();
      if (!is_given(name) || (!rule.harmless.empty() && value_of(name) == rule.harmless)) continue;
      problems.add(name, value_of(name), rule.otherwise, ProblemKind::option_without_use);
      refused = option;
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

void forget_option_rules() { rules().clear(); }

std::vector<OptionRule> option_rules() {
  // Checks and places of other tables keep what they point at.
  static CLI::App app;
#define CHAINTRUE_VERB(id) add_##id(Verb(app));
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
  std::vector<OptionRule> named;
  const auto gather = [&](const auto& self, CLI::App& verb) -> void {
    const VerbParts parts = parts_of(verb);
    for (const CLI::Option* option : parts.options) {
      for (const Rule& rule : rules()) {
        if (rule.option == option)
          named.push_back({Verb(verb).path(),
                           "--" + option->get_single_name(),
                           rule.acts_on,
                           rule.otherwise,
                           rule.harmless});
      }
    }
    for (CLI::App* below : parts.verbs) self(self, *below);
  };
  gather(gather, app);
  return named;
}

VerbParts parts_of(CLI::App& verb) {
  VerbParts parts{verb.get_options(), {}};
  for (CLI::App* below : verb.get_subcommands([](CLI::App*) { return true; })) {
    // A group of options has no name and belongs to its verb.
    if (below->get_name().empty()) {
      grid::append_all(parts.options, parts_of(*below).options);
    } else {
      parts.verbs.push_back(below);
    }
  }
  return parts;
}

std::vector<std::string> long_names(const std::vector<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> names_of(const std::vector<CLI::App*>& verbs) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  return names;
}

void usage_error(const std::string& verb, const std::string& sentence) {
  throw CLI::ValidationError(verb, sentence);
}

void missing_option(const std::string& names) { throw CLI::RequiredError(names); }

}  // namespace chaintrue::cli
