// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// input_slips: puts every kind of gross slip into sessions of machines of tests/lab/generator, and
/// prints how often reading the file reports it; then sessions without one, and their messages. Not
/// part of the test run; its table is in docs/reliability.md.
///
///   input_slips --machines 10 --clean 400
#include <fmt/format.h>

#include <map>

#include "input_slips/judge/kinds.hpp"
#include "sealed/command/campaign.hpp"

namespace {

using namespace chaintrue::slips;
using chaintrue::sealed::PlannedSet;

const std::string kClean = ":clean";

std::string word_of(const Kind& kind) {
  std::string text = fmt::format("{}/{}:slip", word(kind.way), kind.id);
  std::ranges::replace(text, ' ', '_');
  return text;
}

std::vector<chaintrue::sealed::RateRow> all_rows() {
  std::vector<chaintrue::sealed::RateRow> rows;
  for (const Kind& kind : kinds())
    rows.push_back({std::string(word(kind.way)), kind.id, word_of(kind), {"named"}});
  rows.push_back({"all kinds", "identified", "slip", {"named"}, 0.0, 1e9, {}, 0.97});
  rows.push_back(
      {"no slip", "accepted without a message", "clean", {"accepted"}, 0.0, 1e9, {}, 0.99});
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  chaintrue::sealed::Campaign campaign("How often a gross slip in a measured file is named", argc,
                                       argv);
  campaign.sets = 10;
  int clean = 400;
  campaign.app.add_option("--machines", campaign.sets, "Of each kind");
  campaign.app.add_option("--clean", clean, "Sessions without a slip, of all ways together");
  std::map<std::string, const Kind*> by_word;
  for (const Kind& kind : kinds()) by_word[word_of(kind)] = &kind;
  const auto list = [&] {
    std::vector<std::string> words;
    for (const Kind& kind : kinds()) words.push_back(word_of(kind));
    std::vector<PlannedSet> sets = campaign.sets_of(words);
    constexpr std::uint64_t kOtherSeeds = 1000;
    for (int i = 0; i < clean; ++i) {
      const std::uint64_t seed = campaign.first_seed + kOtherSeeds + static_cast<std::uint64_t>(i);
      sets.push_back({std::string(word(kWays[i % 4])) + kClean, seed});
    }
    return sets;
  };
  const auto run = [&](const PlannedSet& set) {
    chaintrue::sealed::Outcome outcome{.kind = set.kind, .seed = set.seed};
    std::vector<std::string> said;
    if (set.kind.ends_with(kClean)) {
      said = false_alarms(*std::ranges::find(kWays, outcome.group(), word), set.seed);
      outcome.add("accepted", said.empty());
    } else {
      const Outcome tried = try_kind(*by_word.at(set.kind), set.seed);
      outcome.add("named", tried.is_named);
      said = tried.reported.messages;
      const auto& [words, place, refused] = tried.expected;
      said.push_back(
          fmt::format("expected {} {}{}", place, words.front(), refused ? ", refused" : ""));
    }
    if (campaign.show && outcome.facts.empty()) fmt::print("{}\n", fmt::join(said, "\n  "));
    return std::vector{outcome};
  };
  return campaign.run(list, run, all_rows());
}
