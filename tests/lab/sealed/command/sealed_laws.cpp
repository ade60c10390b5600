// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_laws: hides a law, a field that is no law, a listed cause or nothing in many sessions, diagnoses
/// each and prints how often the law that is reported is right. Not part of the test run; its table is in
/// docs/diagnosis_rates.md.
///
///   sealed_laws --sets 300 --only laws --show
#include "sealed/command/campaign.hpp"
#include "sealed/judge/laws_trial.hpp"

int main(int argc, char** argv) {
  using namespace chaintrue::sealed;
  Campaign campaign("How often a reported law is right", argc, argv);
  campaign.sets = 60;
  bool in_use = false;
  campaign.app.add_flag("--in-use", in_use,
                        "Claimed laws in a second session, in another machine's and in a map");
  const std::vector<RateRow> rows = rows_of("laws");
  return campaign.run([&] { return campaign.sets_of(kinds_of(rows)); },
                      [&](const PlannedSet& set) {
                        return std::vector{run_laws_trial(set.kind, set.seed, in_use)};
                      },
                      rows);
}
