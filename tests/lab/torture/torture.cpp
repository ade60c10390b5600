// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `torture [SECONDS [SEED [COMMAND [LIMIT_S]]]]`: attacks the command for that time (600 s),
/// starting with that seed (1), and reports what it tried and the faults. Exit code 1 for any
/// fault; the inputs are then in torture_failures/. The criteria are in docs/reliability.md.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "torture/campaign.hpp"

namespace {

using chaintrue::torture::Campaign;
using chaintrue::torture::Command;
using chaintrue::torture::Tally;

bool report(const Campaign& campaign, std::uint64_t seed, double seconds) {
  Tally all;
  fmt::print("{:<44}{:>8}{:>10}{:>9}{:>9}{:>10}{:>11}\n",
             "attack",
             "runs",
             "answered",
             "refused",
             "stopped",
             "slowest_s",
             "failures");
  const auto line = [](const std::string& name, const Tally& tally) {
    fmt::print("{:<44}{:>8}{:>10}{:>9}{:>9}{:>10.2f}{:>11}\n",
               name,
               tally.runs,
               tally.answered,
               tally.refused,
               tally.stopped,
               tally.slowest_s,
               tally.failures);
  };
  for (const auto& [name, tally] : campaign.tallies()) {
    line(name, tally);
    all.runs += tally.runs;
    all.answered += tally.answered;
    all.refused += tally.refused;
    all.stopped += tally.stopped;
    all.failures += tally.failures;
    all.slowest_s = std::max(all.slowest_s, tally.slowest_s);
  }
  line("all", all);
  fmt::print("seed {}, {:.0f} s: {}\n",
             seed,
             seconds,
             all.failures == 0 ? "everything held" : "see torture_failures/");
  return all.failures == 0;
}

int run(int argc, char** argv) {
  namespace fs = std::filesystem;
  const double seconds = argc > 1 ? std::strtod(argv[1], nullptr) : 600.0;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const fs::path command = argc > 3 ? fs::path(argv[3]) : fs::path(CHAINTRUE_COMMAND);
  const double limit_s = argc > 4 ? std::strtod(argv[4], nullptr) : 60.0;
  fmt::print(
      "seed {}, {:g} s, at most {:g} s a run, {}\n", seed, seconds, limit_s, command.string());
  std::string place = (fs::temp_directory_path() / "chaintrue-torture-XXXXXX").string();
  if (::mkdtemp(place.data()) == nullptr) {
    fmt::print(stderr, "no folder to work in\n");
    return 2;
  }
  const fs::path folder = fs::path(place) / "work";
  fs::create_directory(folder);
  Campaign campaign(Command(command, folder, limit_s),
                    CHAINTRUE_FIXTURES,
                    fs::absolute("torture_failures"),
                    seed);
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed_s = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  while (elapsed_s() < seconds) campaign.attack();
  fs::remove_all(place);
  return report(campaign, seed, elapsed_s()) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "torture: {}\n", error.what());
    return 2;
  }
}
