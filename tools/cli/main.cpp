// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command's entrance: parses, runs the chosen verb, turns outcomes into exit codes.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "grid/files/input_error.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

int report_bad_input(const grid::files::InputError& error) {
  for (const auto& problem : error.problems()) fmt::print(stderr, "{}\n", problem.message());
  return kBadInput;
}

int main_with_exit_code(int argc, char** argv) {
  CLI::App app{"chaintrue makes a hanging two-chain router cut true.", "chaintrue"};
  app.require_subcommand(1);
  app.set_version_flag("--version", CHAINTRUE_VERSION);
  app.set_help_all_flag("--help-all", "The help of every verb");
  Run run;
#define CHAINTRUE_VERB(id) add_##id(app, run);
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  }
  try {
    return run();
  } catch (const grid::files::InputError& error) {
    return report_bad_input(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "chaintrue: internal error, please report it: {}\n", error.what());
    return kInternal;
  }
}

}  // namespace
}  // namespace chaintrue::cli

int main(int argc, char** argv) { return chaintrue::cli::main_with_exit_code(argc, argv); }
