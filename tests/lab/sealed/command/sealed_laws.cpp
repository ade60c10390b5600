// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// sealed_laws: hides a law, a field that is no law, a listed cause or nothing in many sessions, diagnoses
/// each and prints how often the law that is reported is right. Not part of the test run; its table is in
/// docs/diagnosis_rates.md.
///
///   sealed_laws --sets 300 --only laws --show
#include <mutex>

#include "sealed/command/sets.hpp"
#include "sealed/judge/laws_trial.hpp"
#include "sealed/judge/table.hpp"

namespace {

using chaintrue::sealed::LawInUse;
using chaintrue::sealed::LawsKind;
using chaintrue::sealed::LawsTrial;
using chaintrue::sealed::Share;

void print_row(const std::string& hidden, const char* what, const char* goal, const Share& share) {
  fmt::print("| {} | {} | {} | {} |\n", hidden, what, goal, text(share));
}

/// For laws that were claimed and then declared as an effect.
void print_use(const std::string& hidden, const std::vector<LawsTrial>& all) {
  using Says = LawInUse::Says;
  Share confirmed, denied, wrongly;
  std::vector<double> ratios;
  for (const LawsTrial& t : all) {
    if (!t.in_use) continue;
    confirmed.count(t.in_use->second == Says::confirmed);
    denied.count(t.in_use->foreign == Says::denied);
    wrongly.count(t.in_use->foreign == Says::confirmed);
    if (t.in_use->error_ratio) ratios.push_back(*t.in_use->error_ratio);
  }
  if (ratios.empty()) return;
  std::sort(ratios.begin(), ratios.end());
  print_row(hidden, "a second session confirms the law", "95 %", confirmed);
  print_row(hidden, "another machine's session denies it", "95 %", denied);
  print_row(hidden, "another machine's session confirms it", "", wrongly);
  fmt::print("| {} | the tool's true error with the law over that without, median; worst | 0.6; 1.1 | {:.2f}; {:.2f} ({}) |\n",
             hidden,
             ratios[ratios.size() / 2],
             ratios.back(),
             ratios.size());
}

void print_rows(const LawsKind& kind, const std::vector<LawsTrial>& all) {
  Share claims, leads, in_set, claims_right, near, wrong, wrong_given_law;
  for (const LawsTrial& t : all) {
    claims.count(t.claimed);
    leads.count(t.leads);
    in_set.count(t.in_set);
    if (t.claimed) claims_right.count(t.leads);
    if (t.worst_sigmas) near.count(*t.worst_sigmas <= 3.0);
    wrong.count(t.names.wrong);
    wrong_given_law.count(t.names_given_law.wrong);
  }
  const std::string hidden(kind.hidden);
  print_row(hidden, "a wrong cause named at 90 %, or given the law", "", wrong_given_law);
  print_row(hidden, "a wrong cause named at 90 %", "", wrong);
  if (!kind.is_law) {
    print_row(hidden, "a law claimed", "at most 2 %", claims);
    return;
  }
  print_row(hidden, "variable and entry right, or among the (at most 3) reported", "90 %", in_set);
  print_row(hidden, "the first is right", "", leads);
  print_row(hidden, "a law claimed at 90 %", "", claims);
  print_row(hidden, "a claim is right", "97 %", claims_right);
  print_row(hidden, "place or period, and size, within three sigmas", "97 %", near);
  print_use(hidden, all);
  if (kind.word != "both") return;
  Share causes, causes_given_law, both;
  for (const LawsTrial& t : all) {
    causes.count(t.names.right);
    causes_given_law.count(t.names_given_law.right);
    both.count(t.in_set && t.names_given_law.right);
  }
  print_row(hidden, "the cause named, or given the law", "", causes_given_law);
  print_row(hidden, "the cause named", "", causes);
  print_row(hidden, "both told", "75 %", both);
}

}  // namespace

int main(int argc, char** argv) {
  chaintrue::sealed::Sets sets{.count = 60};
  std::vector<std::string> only;
  bool show = false, in_use = false;
  CLI::App app("How often a reported law is right");
  sets.offer(app);
  app.add_option("--only", only, "These kinds");
  app.add_flag("--in-use", in_use, "Claimed laws in a second session, in another machine's and in a map");
  app.add_flag("--show", show, "A line for each set");
  return chaintrue::sealed::run_command(app, argc, argv, [&] {
    fmt::print("| hidden | quantity | asked | reached |\n|---|---|---|---|\n");
    for (const LawsKind& kind : chaintrue::sealed::laws_kinds()) {
      if (!only.empty() && std::ranges::find(only, kind.word) == only.end()) continue;
      std::mutex printing;
      print_rows(kind, sets.each([&](std::uint64_t seed) {
        LawsTrial own = chaintrue::sealed::run_laws_trial(kind.word, seed, in_use);
        if (show) {
          const std::lock_guard lock(printing);
          fmt::print("{}\n", line_of(kind.word, own));
          std::fflush(stdout);
        }
        return own;
      }));
    }
  });
}
