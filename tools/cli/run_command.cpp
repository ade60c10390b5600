// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/run_command.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "grid/files/sources.hpp"
#include "grid/printing.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/command_line.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

/// --quiet and --threads may also follow the verb.
void let_verbs_pass_on(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    // A group of options has no name and belongs to its verb.
    if (verb->get_name().empty()) continue;
    verb->fallthrough();
    let_verbs_pass_on(*verb);
  }
}

}  // namespace

int run_command(const std::vector<std::string>& typed, const Guard& guard) {
  begin_command_line();
  files::forget_sources();
  CLI::App app{"chaintrue makes a hanging two-chain router cut accurately.", "chaintrue"};
  app.require_subcommand(1);
  app.set_version_flag("-V,--version", CHAINTRUE_VERSION);
  bool is_quiet = false;
  app.add_flag("-q,--quiet", is_quiet, "Print problems only");
  int threads = 0;
  add_number(Verb(app),
             "--threads",
             threads,
             {"", 0.0, 4096.0},
             "Largest number of cores, 0 for all; results do not depend on it");
  app.footer("chaintrue help VERB, or VERB --help, lists the options of a verb, with an example.");
  app.set_help_all_flag("--help-all", "The help of every verb");
#define CHAINTRUE_VERB(id) add_##id(Verb(app));
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
  let_verbs_pass_on(app);
  const std::vector<std::string> words = words_of(typed);
  try {
    // The parser reads its words from the end.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    // An unknown word is reported alone: the parser's other complaints follow from it.
    const bool is_help_of_a_verb = typed.size() > 1 && typed.front() == "help";
    if (error.get_exit_code() != 0 || is_help_of_a_verb) {
      const std::string unknown = did_you_mean(app, words);
      if (!unknown.empty()) {
        fmt::print(stderr, "{}", unknown);
        return kUsage;
      }
    }
    return guard([&] {
      std::ostringstream out, err;
      const int code = app.exit(error, out, err) == 0 ? kDone : kUsage;
      fmt::print("{}", out.str());
      fmt::print(stderr, "{}", err.str());
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
