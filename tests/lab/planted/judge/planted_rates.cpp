// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/planted_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "sealed/judge/trial.hpp"

namespace chaintrue::planted {
namespace {

constexpr double kDenied = 0.5;
constexpr double kBorneOut = 0.9;
/// Below it nothing is claimed: of the dozens of causes nearly all are as unlikely as they should be.
constexpr double kLeastClaim = 0.1;
constexpr double kWasAbsent = 0.2;
constexpr double kIsPresent = 0.8;
const std::string kPlain = "plain";
const std::string kPlanted = "planted";

/// `hidden`: effect:side, empty where nothing is.
Outcome outcome_of(const std::string& kind, std::uint64_t seed, const grid::MeasuredGrid& grid,
                   const std::vector<std::string>& hidden) {
  const grid::diagnosis::Diagnosis found = diagnosed(grid);
  sealed::Trial trial(found);
  trial.hidden = hidden;
  Outcome outcome = sealed::outcome_of(kind, seed, trial);
  const bool is_named = outcome.has("outright") && outcome.has("held");
  outcome.points = static_cast<int>(grid.points.size());
  outcome.named.clear();
  outcome.facts.clear();
  for (const Claim& claim : claims_of(found)) outcome.named.push_back(word_of(claim));
  outcome.add("named", is_named);
  return outcome;
}

std::vector<Claim> claims_in(const Outcome& outcome) {
  std::vector<Claim> claims;
  for (const std::string& word : outcome.named) claims.push_back(sealed::parse_claim(word));
  return claims;
}

bool is_plain(const Outcome& outcome) { return outcome.way() == kPlain; }

/// Claims of this probability and more, the planted cause left out, whose class the whole scan denies, or bears out.
int count_claims(const Outcome& outcome, const std::vector<Reference>& references, double at_least,
                 bool is_denied) {
  const std::vector<Claim>& whole = reference_of(references, outcome.group()).claims;
  return static_cast<int>(std::ranges::count_if(claims_in(outcome), [&](const Claim& claim) {
    if (claim.probability < at_least ||
        (!outcome.hidden.empty() && claim.means(outcome.hidden.front())))
      return false;
    const double there = probability_in(whole, claim);
    return is_denied ? there < kDenied : there > kBorneOut;
  }));
}

/// No class but the planted one goes from absent to present, or back.
bool others_stay(const Outcome& plain, const Outcome& planted) {
  const std::vector<Claim> before = claims_in(plain), after = claims_in(planted);
  const auto appears = [&](const std::vector<Claim>& in, const std::vector<Claim>& not_in) {
    return std::ranges::any_of(in, [&](const Claim& claim) {
      return claim.probability > kIsPresent && !claim.means(planted.hidden.front()) &&
             probability_in(not_in, claim) < kWasAbsent;
    });
  };
  return !appears(after, before) && !appears(before, after);
}

}  // namespace

std::pair<Outcome, Outcome> run_draw(const Scan& scan, const std::vector<Reference>& references,
                                     std::uint64_t seed) {
  const Draw draw = draw_planted(scan, references, seed);
  std::pair<Outcome, Outcome> both{
      outcome_of(scan.name + ":" + kPlain, seed, draw.plain, {}),
      outcome_of(scan.name + ":" + kPlanted, seed, draw.planted, {sealed::id_of(draw.hidden)})};
  both.second.strength = draw.strength;
  for (Outcome* outcome : {&both.first, &both.second}) {
    if (draw.with_order) outcome->facts.emplace_back("order");
  }
  return both;
}

void set_facts(std::vector<Outcome>& outcomes, const std::vector<Reference>& references) {
  std::map<std::pair<std::string, std::uint64_t>, const Outcome*> plain;
  for (const Outcome& o : outcomes) {
    if (is_plain(o)) plain[{o.group(), o.seed}] = &o;
  }
  for (Outcome& o : outcomes) {
    const auto before = plain.find({o.group(), o.seed});
    if (before == plain.end())
      throw std::invalid_argument("no outcome of the plain readings of \"" + line_of(o) + "\"");
    const bool with_order = o.has("order"), named = o.has("named");
    o.facts.clear();
    o.add("order", with_order);
    for (const int percent : {90, 60}) {
      for (const bool is_denied : {true, false})
        o.numbers[fmt::format("{}_{}", is_denied ? "denied" : "borne_out", percent)] =
            count_claims(o, references, 0.01 * percent, is_denied);
      o.add(fmt::format("none_denied_{}", percent),
            o.numbers[fmt::format("denied_{}", percent)] == 0.0);
    }
    if (is_plain(o)) continue;
    o.add("named", named);
    o.add("others_stay", others_stay(*before->second, o));
  }
}

sealed::Calibration claims_held_against(const std::vector<Outcome>& outcomes,
                                        const std::vector<Reference>& references) {
  sealed::Calibration result;
  for (const Outcome& o : outcomes) {
    for (const Claim& claim : claims_in(o)) {
      const bool planted = !o.hidden.empty() && claim.means(o.hidden.front());
      const double there = probability_in(reference_of(references, o.group()).claims, claim);
      if (claim.probability >= kLeastClaim && (planted || there > kBorneOut || there < kDenied))
        result.add(claim.probability, planted || there > kBorneOut);
    }
  }
  return result;
}

}  // namespace chaintrue::planted
