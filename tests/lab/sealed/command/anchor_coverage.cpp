// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_coverage: how often the 95 % intervals of the anchors of four belts hold the true ones, for
/// each cause at its usual size, and those of anchors alone. Not part of the test run; its table is
/// in docs/maslow4_rates.md.
///
///   anchor_coverage --sessions 40 --first-seed 1
#include "sealed/judge/anchor_coverage.hpp"
#include "sealed/command/campaign.hpp"

int main(int argc, char** argv) {
  using namespace chaintrue::sealed;
  Campaign campaign("How often the intervals of anchors hold the true ones", argc, argv);
  campaign.sets = 40;
  int side = 9;
  campaign.app.add_option("--sessions", campaign.sets, "For each cause")
      ->check(CLI::PositiveNumber);
  campaign.app.add_option("--side", side, "Places along each side of the grid")
      ->check(CLI::Range(3, 20));
  const auto list = [&] {
    std::vector<std::string> kinds;
    for (const UsualCause& cause : usual_causes()) kinds.emplace_back(cause.effect);
    return campaign.sets_of(kinds);
  };
  return campaign.run(
      list,
      [&](const PlannedSet& set) { return std::vector{coverage_of(set.kind, set.seed, side)}; },
      {});
}
