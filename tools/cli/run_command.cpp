// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/run_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <sstream>

#include "grid/files/problems.hpp"
#include "grid/printing.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// Prepares command lines for the parser, and suggests what was meant if it rejects one.

/// The words for the parser; `help fit` becomes `fit --help`.
Words words_of(Words words) {
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

/// The message about an unknown verb or option, with the probable one or where to look; empty if
/// all are known.
std::string did_you_mean(CLI::App& app, const Words& words) {
  CLI::App* verb = &app;
  std::size_t at = 0;
  const auto is_verb = [&] { return at < words.size() && !words[at].starts_with('-'); };
  for (; is_verb(); ++at) {
    if (!contains(names_of(parts_of(*verb).verbs), words[at])) break;
    verb = verb->get_subcommand(words[at]);
  }
  const Words verbs = names_of(parts_of(*verb).verbs);
  const std::string verb_name = verb == &app ? "chaintrue" : "chaintrue " + verb->get_name();
  if (!verbs.empty() && is_verb()) {
    const std::string near = files::nearest(words[at], verbs);
    const std::string list = fmt::format("{} --help lists them all.\n", verb_name);
    if (near.empty()) return fmt::format("There is no {} {}. {}", verb_name, words[at], list);
    return fmt::format("There is no {} {}. Did you mean {} {}?\n", verb_name, words[at], verb_name,
                       near);
  }
  Words known = long_names(parts_of(*verb).options);
  append_all(known, long_names(parts_of(app).options));
  for (; at < words.size(); ++at) {
    const std::string option = words[at].substr(0, words[at].find('='));
    if (!option.starts_with("--") || option == "--") continue;
    if (contains(known, option)) continue;
    const std::string near = files::nearest(option, known);
    if (near.empty()) {
      return fmt::format("{} has no option {}. {} --help lists them all.\n", verb_name, option,
                         verb_name);
    }
    return fmt::format("{} has no option {}. Did you mean {}?\n", verb_name, option, near);
  }
  return {};
}

/// --quiet and --threads may also follow the verb.
void let_verbs_pass_on(CLI::App& app) {
  for (CLI::App* verb : parts_of(app).verbs) {
    verb->fallthrough();
    let_verbs_pass_on(*verb);
  }
}

}  // namespace

int run_command(const Words& typed, const Guard& guard) {
  declared() = {};
  files::forget_sources();
  CLI::App app{"chaintrue makes a hanging two-chain router cut accurately.", "chaintrue"};
  app.require_subcommand(1);
  app.set_version_flag("-V,--version", CHAINTRUE_VERSION);
  bool is_quiet = false;
  app.add_flag("-q,--quiet", is_quiet, "Print problems only");
  int threads = 0;
  Verb(app).has({{"--threads",
                  {threads, {"", 0.0, 4096.0}},
                  "Largest number of cores, 0 for all; results do not depend on it"}});
  app.footer("chaintrue help VERB, or VERB --help, lists the options of a verb, with an example.");
  app.set_help_all_flag("--help-all", "The help of every verb");
#define CHAINTRUE_VERB(id) add_##id(Verb(app));
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
  let_verbs_pass_on(app);
  const Words words = words_of(typed);
  try {
    // The parser reads its words from the end.
    app.parse(Words(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    // An unknown word is reported alone: the parser's other complaints follow from it.
    const bool is_help_of_a_verb = typed.size() > 1 && typed.front() == "help";
    if (error.get_exit_code() != 0 || is_help_of_a_verb) {
      const std::string unknown = did_you_mean(app, words);
      if (!unknown.empty()) {
        say_lines(unknown);
        return kUsage;
      }
    }
    return guard([&] {
      std::ostringstream out, err;
      const int code = app.exit(error, out, err) == 0 ? kDone : kUsage;
      fmt::print("{}", out.str());
      say_lines(err.str());
      return code;
    });
  }
  QuietTalk talk(is_quiet);
  const int code = guard([&] {
    check_command_line();
    grid::use_threads(threads);
    const ProgressLine line(app.get_subcommands().front()->get_name());
    return chosen_run()();
  });
  talk.end(code != kDone && code != kCheckFailed);
  return code;
}

}  // namespace chaintrue::cli
