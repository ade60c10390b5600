// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// input_slips: puts every kind of gross slip into sessions of machines of tests/lab/generator, and
/// prints how often reading the file reports it; then sessions without one, and their messages. Not
/// part of the test run; its table is in docs/reliability.md.
///
///   input_slips --machines 10 --clean 400
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "input_slips/judge/kinds.hpp"

namespace {

using namespace chaintrue::slips;

struct Arguments {
  int machines = 10;
  int clean = 400;
  std::uint64_t first_seed = 1;
  bool show = false;
};

void print_outcome(const Outcome& outcome) {
  fmt::print("    expected {} {}{}\n",
             outcome.expected.place,
             outcome.expected.words.front(),
             outcome.expected.refused ? ", refused" : "");
  for (const std::string& message : outcome.reported.messages) fmt::print("      {}\n", message);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("How often a gross slip in a measured file is named");
  app.add_option("--machines", arguments.machines, "Of each kind");
  app.add_option("--clean", arguments.clean, "Sessions without a slip, of all ways together");
  app.add_option("--first-seed", arguments.first_seed, "Of the first machine");
  app.add_flag("--show", arguments.show, "Tell what was said where a slip was not named");
  CLI11_PARSE(app, argc, argv);
  int named = 0;
  int all = 0;
  int fewest = arguments.machines;
  for (const Kind& kind : kinds()) {
    int of_kind = 0;
    for (int i = 0; i < arguments.machines; ++i) {
      const Outcome outcome = try_kind(kind, arguments.first_seed + static_cast<std::uint64_t>(i));
      of_kind += outcome.is_named ? 1 : 0;
      if (!outcome.is_named && arguments.show) print_outcome(outcome);
    }
    fmt::print("{:10}{:36}{:3} of {}\n", word(kind.way), kind.id, of_kind, arguments.machines);
    std::fflush(stdout);
    named += of_kind;
    all += arguments.machines;
    fewest = std::min(fewest, of_kind);
  }
  fmt::print("{} kinds: {} of {} named ({:.1f} %), fewest of a kind {}\n",
             kinds().size(),
             named,
             all,
             100.0 * named / std::max(all, 1),
             fewest);
  int alarms = 0;
  for (int i = 0; i < arguments.clean; ++i) {
    constexpr std::uint64_t kOtherSeeds = 1000;
    const Way way = kWays[i % 4];
    const auto said = false_alarms(way, arguments.first_seed + kOtherSeeds + static_cast<std::uint64_t>(i));
    if (said.empty()) continue;
    ++alarms;
    if (arguments.show) fmt::print("    {} {}: {}\n", word(way), i, said.front());
  }
  fmt::print("{} of {} clean sessions were not accepted without a word\n", alarms, arguments.clean);
}
