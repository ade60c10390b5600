// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command's entrance: parses, runs the chosen verb, turns outcomes into exit codes.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/printing.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/command_line.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

int report_bad_input(const grid::files::InputError& error) {
  std::fflush(stdout);
  for (const auto& problem : error.problems())
    fmt::print(stderr, "{}\n", in_red(with_name(problem.message(), problem.name())));
  return kBadInput;
}

/// A stream that is closed would lend its number to the next file that is opened; it is taken up
/// by one that can be neither read nor written in its place.
void take_up_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    const int taken = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (taken != stream && taken >= 0) ::close(taken);
  }
}

/// What was printed must have arrived: an answer that nobody could read is no answer. A pipe whose
/// reader has left is not worth a word.
int finish_standard_output(int code, int error_number) {
  const bool was_broken = std::ferror(stdout) != 0;
  errno = 0;
  const bool is_broken = std::fflush(stdout) != 0 || was_broken;
  if (!is_broken) return code;
  if (errno != 0) error_number = errno;
  if (error_number == EPIPE) return code;
  return report_bad_input(grid::files::InputError(
      {{"standard output",
        "",
        std::error_code(error_number == 0 ? EIO : error_number, std::generic_category()).message(),
        "something that can be written to",
        {},
        grid::ProblemKind::output_place}}));
}

int run_verb(const std::string& verb, int threads) {
  try {
    check_command_line();
    grid::use_threads(threads);
    const ProgressLine line(verb);
    return finish_standard_output(chosen_run()(), 0);
  } catch (const grid::files::InputError& error) {
    return report_bad_input(error);
  } catch (const grid::files::ReaderGone&) {
    return kDone;
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return finish_standard_output(kDone, error.code().value());
    fmt::print(stderr, "chaintrue: internal error, please report it: {}\n", error.what());
    return kInternal;
  } catch (const std::logic_error& error) {
    fmt::print(stderr, "chaintrue: internal error, please report it: {}\n", error.what());
    return kInternal;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "chaintrue: not enough memory for this much\n");
    return kNotSupportedOrOutside;
  } catch (const std::exception& error) {
    fmt::print(stderr, "chaintrue: internal error, please report it: {}\n", error.what());
    return kInternal;
  }
}

/// --quiet and --threads may stand behind the verb as well.
void let_verbs_pass_on(CLI::App& app) {
  for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    // A group of options has no name and belongs to its verb.
    if (verb->get_name().empty()) continue;
    verb->fallthrough();
    let_verbs_pass_on(*verb);
  }
}

int main_with_exit_code(int argc, char** argv) {
#ifdef __EMSCRIPTEN__
  ::umask(022);  // emscripten begins with 0777: nobody could read what is written
#endif
  if (argc > 0) set_called_as(argv[0]);
  take_up_closed_streams();
  keep_lines_whole();
  grid::files::remove_pending_files_on_signals();
  // A limit on file sizes is then an error of writing, reported like any other.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"chaintrue makes a hanging two-chain router cut true.", "chaintrue"};
  app.require_subcommand(1);
  app.set_version_flag("-V,--version", CHAINTRUE_VERSION);
  bool is_quiet = false;
  app.add_flag("-q,--quiet", is_quiet, "Print problems only");
  int threads = 0;
  add_number(Verb(app),
             "--threads",
             threads,
             {"", 0.0, 4096.0},
             "Largest number of cores, 0 for "
             "all; the answers do not depend "
             "on it");
  app.footer("chaintrue help VERB, or VERB --help, lists the options of a verb, with an example.");
  app.set_help_all_flag("--help-all", "The help of every verb");
#define CHAINTRUE_VERB(id) add_##id(Verb(app));
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
  let_verbs_pass_on(app);
  const std::vector<std::string> words = words_of(argc, argv);
  try {
    // The parser takes its words from the end.
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    // What nobody knows is said alone: what else the parser misses there follows from it.
    const bool is_help_of_a_verb = argc > 1 && std::string_view(argv[1]) == "help";
    if (error.get_exit_code() != 0 || is_help_of_a_verb) {
      const std::string unknown = did_you_mean(app, words);
      if (!unknown.empty()) {
        fmt::print(stderr, "{}", unknown);
        return kUsage;
      }
    }
    return finish_standard_output(app.exit(error) == 0 ? kDone : kUsage, 0);
  }
  QuietTalk talk(is_quiet);
  const int code = run_verb(app.get_subcommands().front()->get_name(), threads);
  talk.end(code != kDone && code != kCheckFailed);
  return code;
}

}  // namespace
}  // namespace chaintrue::cli

int main(int argc, char** argv) { return chaintrue::cli::main_with_exit_code(argc, argv); }
