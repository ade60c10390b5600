// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue completion and chaintrue man: completion for shells and manual pages, made from the
/// verbs and options themselves, the text of --help.
#include <fmt/format.h>

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/cli/verb.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {
namespace {

/// A verb as typed, and what it has.
struct Command {
  Words words;  ///< {"gcode", "verify"}; none: chaintrue itself
  const CLI::App* app = nullptr;
  VerbParts parts;
  std::vector<CLI::Option*> arguments;  ///< not among the parts' options
};

/// Covers this verb, to which these words belong, and the verbs below it.
std::vector<Command> commands_of(CLI::App& app, const Words& words = {}) {
  Command command{words, &app, parts_of(app), {}};
  std::erase_if(command.parts.options, [&](CLI::Option* option) {
    if (option->get_positional()) command.arguments.push_back(option);
    return option->get_positional();
  });
  std::vector<Command> all = {command};
  for (CLI::App* verb : command.parts.verbs) {
    Words below = words;
    below.push_back(verb->get_name());
    append_all(all, commands_of(*verb, below));
  }
  return all;
}

/// The branches of a shell's case: "gcode verify") and its words.
std::string branches(const std::vector<Command>& commands, const char* verbs, const char* options) {
  std::string text;
  for (const Command& command : commands) {
    text += fmt::format("    \"{}\") {}=\"{}\" {}=\"{}\" ;;\n", fmt::join(command.words, " "),
                        verbs, fmt::join(names_of(command.parts.verbs), " "), options,
                        fmt::join(long_names(command.parts.options), " "));
  }
  return text;
}

std::string bash(const std::vector<Command>& commands) {
  return fmt::format(
      R"(# bash completion of chaintrue: source it, or put it into /etc/bash_completion.d.
_chaintrue_words() {{
  case "$1" in
{}    *) return 1 ;;
  esac
}}
_chaintrue() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} path='' word verbs='' options=''
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    if _chaintrue_words "${{path:+$path }}$word"; then path="${{path:+$path }}$word"; fi
  done
  _chaintrue_words "$path"
  if [[ $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$cur")
  elif [[ -n $verbs ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$verbs" -- "$cur")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$cur")
  fi
}}
complete -o filenames -F _chaintrue chaintrue
)",
      branches(commands, "verbs", "options"));
}

std::string zsh(const std::vector<Command>& commands) {
  return fmt::format(
      R"(#compdef chaintrue
# zsh completion of chaintrue: a file called _chaintrue in a folder of $fpath.
_chaintrue_words() {{
  case "$1" in
{}    *) return 1 ;;
  esac
}}
_chaintrue() {{
  local path_ word verbs options
  for word in ${{words[2,CURRENT-1]}}; do
    if _chaintrue_words "${{path_:+$path_ }}$word"; then path_="${{path_:+$path_ }}$word"; fi
  done
  _chaintrue_words "$path_"
  if [[ ${{words[CURRENT]}} == -* ]]; then
    compadd -- ${{=options}}
  elif [[ -n $verbs ]]; then
    compadd -- ${{=verbs}}
  else
    _files
  fi
}}
compdef _chaintrue chaintrue
)",
      branches(commands, "verbs", "options"));
}

/// Within single quotes of fish.
std::string fish_quoted(const std::string& text) {
  return report::replaced(text, {{"\\", "\\\\"}, {"'", "\\'"}, {"\n", " "}});
}

std::string fish(const std::vector<Command>& commands) {
  std::string text =
      "# fish completion of chaintrue: put it into ~/.config/fish/completions/chaintrue.fish.\n";
  for (const Command& command : commands) {
    const std::string when =
        command.words.empty() ? "__fish_use_subcommand"
                              : fmt::format("__fish_seen_subcommand_from {}", command.words.back());
    for (const CLI::App* verb : command.parts.verbs) {
      text += fmt::format("complete -c chaintrue -f -n '{}' -a {} -d '{}'\n", when,
                          verb->get_name(), fish_quoted(verb->get_description()));
    }
    for (const CLI::Option* option : command.parts.options) {
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c chaintrue -n '{}' -l {}{} -d '{}'\n", when, name,
                            option->get_items_expected_max() > 0 ? " -r" : "",
                            fish_quoted(option->get_description()));
      }
    }
  }
  return text;
}

/// troff interprets a backslash, and a dot or a quote at the start of a line.
std::string troff(const std::string& text) {
  return report::replaced("\n" + text,
                          {{"\\", "\\e"}, {"-", "\\-"}, {"\n.", "\n\\&."}, {"\n'", "\n\\&'"}})
      .substr(1);
}

std::string item_of(const CLI::Option& option) {
  Words names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name());
  return fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(fmt::format("{}", fmt::join(names, ", "))),
                     troff(option.get_description()));
}

std::string manual_of(const Command& command) {
  Words words = {"chaintrue"};
  append_all(words, command.words);
  const std::string title = fmt::format("{}", fmt::join(words, "-"));
  std::string text =
      fmt::format(".TH \"{}\" 1 \"\" \"chaintrue {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n",
                  troff(title), CHAINTRUE_VERSION, troff(title),
                  troff(command.app->get_description()), fmt::join(words, " "));
  if (!command.parts.verbs.empty()) text += ".I verb\n";
  for (const CLI::Option* argument : command.arguments)
    text += fmt::format("[\\fI{}\\fR]\n", troff(argument->get_name()));
  text += "[\\fIoptions\\fR]\n";
  if (!command.parts.verbs.empty()) text += ".SH VERBS\n";
  for (const CLI::App* verb : command.parts.verbs) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", verb->get_name(), troff(verb->get_description()));
  }
  if (!command.arguments.empty()) text += ".SH ARGUMENTS\n";
  for (const CLI::Option* argument : command.arguments) text += item_of(*argument);
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : command.parts.options) text += item_of(*option);
  if (!command.app->get_footer().empty())
    text += fmt::format(".SH NOTES\n.nf\n{}\n.fi\n", troff(command.app->get_footer()));
  return text +
         ".SH EXIT STATUS\n0 done; 1 ran, but a check failed; 2 usage; 3 bad input; 4 not "
         "supported or outside the map; 5 internal.\n";
}

int print_manual(CLI::App& app, const Words& words) {
  for (const Command& command : commands_of(app)) {
    if (command.words != words) continue;
    fmt::print("{}", manual_of(command));
    return kDone;
  }
  say("chaintrue man: there is no verb {}", fmt::join(words, " "));
  return kUsage;
}

}  // namespace

void add_completion(Verb app) {
  const auto print = [app](const std::string& name) {
    const std::vector<Command> commands = commands_of(app.app());
    fmt::print("{}", name == "bash"  ? bash(commands)
                     : name == "zsh" ? zsh(commands)
                                     : fish(commands));
    return kDone;
  };
  auto [verb, shell] = app.add_verb<std::string>(
      "completion", "Print what bash, zsh or fish need to complete commands",
      R"(Example:
  build/chaintrue completion bash > chaintrue.bash)",
      print);
  verb.has({{"shell", required({shell, {"bash", "zsh", "fish"}}), "bash, zsh or fish"}});
}

void add_man(Verb app) {
  auto [verb, words] =
      app.add_verb<Words>("man", "Print a manual page (troff), as man -l - shows it",
                          R"(Example:
  build/chaintrue man gcode verify > chaintrue-gcode-verify.1)",
                          [app](const Words& own) { return print_manual(app.app(), own); });
  verb.has({{"verb", words, "The verb; by default the command itself"}});
}

}  // namespace chaintrue::cli
