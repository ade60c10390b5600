// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/planted_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
const std::string kPlain = ":plain";
const std::string kPlanted = ":planted";

/// `hidden`: effect:side, empty where nothing is.
Outcome outcome_of(const std::string& kind,
                   std::uint64_t seed,
                   const grid::MeasuredGrid& grid,
                   const std::string& hidden) {
  const grid::diagnosis::Diagnosis found = diagnosed(grid);
  Outcome outcome;
  outcome.kind = kind;
  outcome.seed = seed;
  outcome.points = static_cast<int>(grid.points.size());
  outcome.verdict = grid::diagnosis::name(found.verdict);
  for (const Claim& claim : claims_of(found)) outcome.named.push_back(word_of(claim));
  if (hidden.empty()) return outcome;
  outcome.hidden.push_back(hidden);
  sealed::Trial trial;
  sealed::take_over(found, trial);
  trial.hidden = outcome.hidden;
  if (sealed::names_outright(trial) && sealed::in_set(trial)) outcome.facts.emplace_back("named");
  return outcome;
}

std::vector<Claim> claims_in(const Outcome& outcome) {
  std::vector<Claim> claims;
  for (const std::string& word : outcome.named) claims.push_back(parse_claim(word));
  return claims;
}

std::string scan_of(const Outcome& outcome) {
  return outcome.kind.substr(0, outcome.kind.rfind(':'));
}
bool is_plain(const Outcome& outcome) { return outcome.kind.ends_with(kPlain); }
bool is_planted(const Outcome& outcome) { return outcome.kind.ends_with(kPlanted); }

const std::vector<Claim>& whole_scan(const Outcome& outcome,
                                     const std::vector<Reference>& references) {
  return reference_of(references, scan_of(outcome)).claims;
}

/// Claims of this probability and more, the planted cause left out, whose class the whole scan has
/// within the bounds.
int count_claims(const Outcome& outcome,
                 const std::vector<Reference>& references,
                 double at_least,
                 const std::function<bool(double)>& in_reference) {
  int count = 0;
  for (const Claim& claim : claims_in(outcome)) {
    const bool own = !outcome.hidden.empty() && claim.means(outcome.hidden.front());
    if (own || claim.probability < at_least) continue;
    count += in_reference(probability_in(whole_scan(outcome, references), claim));
  }
  return count;
}
int denied(const Outcome& o, const std::vector<Reference>& references, double at_least) {
  return count_claims(o, references, at_least, [](double p) { return p < kDenied; });
}
int borne_out(const Outcome& o, const std::vector<Reference>& references, double at_least) {
  return count_claims(o, references, at_least, [](double p) { return p > kBorneOut; });
}

/// No class but the planted one goes from absent to present, or back.
bool others_stay(const Outcome& plain, const Outcome& planted) {
  const std::vector<Claim> before = claims_in(plain), after = claims_in(planted);
  const auto appears = [&](const std::vector<Claim>& in, const std::vector<Claim>& not_in) {
    return std::any_of(in.begin(), in.end(), [&](const Claim& claim) {
      return claim.probability > kIsPresent && !claim.means(planted.hidden.front()) &&
             probability_in(not_in, claim) < kWasAbsent;
    });
  };
  return !appears(after, before) && !appears(before, after);
}

double probability_of_hidden(const Outcome& planted) {
  return probability_in(claims_in(planted), {{planted.hidden.front()}, 0.0});
}

/// Rows of the table, each with what is counted and among which.
struct Row {
  std::string text;
  std::function<bool(const Outcome&)> counts;
  std::function<int(const Outcome&)> hits;
  bool is_rate = true;  ///< otherwise a number of claims
};

std::vector<Row> rows_of(const std::vector<Reference>& references) {
  const auto strong = [](double from, double to) {
    return [=](const Outcome& o) { return is_planted(o) && o.strength >= from && o.strength < to; };
  };
  const auto fact = [](const char* name) {
    return [=](const Outcome& o) { return static_cast<int>(o.has(name)); };
  };
  const auto no_fact = [](const char* name) {
    return [=](const Outcome& o) { return static_cast<int>(!o.has(name)); };
  };
  const auto number = [&](double at_least, bool wants_denied) {
    return [&references, at_least, wants_denied](const Outcome& o) {
      return wants_denied ? denied(o, references, at_least) : borne_out(o, references, at_least);
    };
  };
  return {{"planted, strength 7 and more: named", strong(7.0, 1e9), fact("named")},
          {"planted, 4 to 7: named", strong(4.0, 7.0), fact("named")},
          {"planted, below 4: named", strong(0.0, 4.0), fact("named")},
          {"planted, strength 7 and more: claimed at 90 %", strong(7.0, 1e9), fact("claimed_90")},
          {"nothing planted: a claim at 90 % that the whole scan denies",
           is_plain,
           no_fact("none_denied_90")},
          {"nothing planted: a claim at 60 % that the whole scan denies",
           is_plain,
           no_fact("none_denied_60")},
          {"nothing planted: claims at 90 %, borne out", is_plain, number(0.9, false), false},
          {"nothing planted: claims at 90 %, denied", is_plain, number(0.9, true), false},
          {"nothing planted: claims at 60 %, borne out", is_plain, number(0.6, false), false},
          {"nothing planted: claims at 60 %, denied", is_plain, number(0.6, true), false},
          {"planted: another claim at 90 % that the whole scan denies",
           is_planted,
           no_fact("none_denied_90")},
          {"planted: brings another name from below 20 % to above 80 %, or takes one away",
           is_planted,
           no_fact("others_stay")}};
}

/// Quantile 97.5 % of Student's t.
double t_975(std::size_t dof) {
  constexpr std::array kQuantiles = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306};
  return dof <= kQuantiles.size() ? kQuantiles[dof - 1] : 2.26;
}

std::string percent(double share) { return fmt::format("{:.0f}", 100.0 * share); }
std::string words(const sealed::RateBounds& bounds) {
  return percent(bounds.lower) + " to " + percent(bounds.upper);
}

}  // namespace

std::pair<Outcome, Outcome> run_draw(const Scan& scan,
                                     const std::vector<Reference>& references,
                                     std::uint64_t seed) {
  const Draw draw = draw_planted(scan, references, seed);
  std::pair<Outcome, Outcome> both{
      outcome_of(scan.name + kPlain, seed, draw.plain, ""),
      outcome_of(scan.name + kPlanted, seed, draw.planted, sealed::id_of(draw.hidden))};
  both.second.strength = draw.strength;
  for (Outcome* outcome : {&both.first, &both.second}) {
    if (draw.with_order) outcome->facts.emplace_back("order");
  }
  return both;
}

void set_facts(std::vector<Outcome>& outcomes, const std::vector<Reference>& references) {
  std::map<std::pair<std::string, std::uint64_t>, const Outcome*> plain;
  for (const Outcome& o : outcomes) {
    if (is_plain(o)) plain[{scan_of(o), o.seed}] = &o;
  }
  for (Outcome& o : outcomes) {
    const auto before = plain.find({scan_of(o), o.seed});
    if (before == plain.end() || !(is_plain(o) || is_planted(o))) {
      throw std::invalid_argument("no outcome of the plain readings of \"" + sealed::line_of(o) +
                                  "\"");
    }
    const bool with_order = o.has("order"), named = o.has("named");
    std::vector<std::string> facts;
    const auto add = [&](const char* name, bool holds) {
      if (holds) facts.emplace_back(name);
    };
    add("order", with_order);
    add("none_denied_90", denied(o, references, 0.9) == 0);
    if (is_plain(o)) {
      add("none_denied_60", denied(o, references, 0.6) == 0);
      add("borne_out_90", borne_out(o, references, 0.9) > 0);
      add("borne_out_60", borne_out(o, references, 0.6) > 0);
    } else {
      const double p = probability_of_hidden(o);
      add("named", named);
      add("claimed_90", p >= 0.9);
      add("claimed_60", p >= 0.6);
      add("others_stay", others_stay(*before->second, o));
    }
    o.facts = std::move(facts);
  }
}

sealed::RateBounds clustered_bounds(const std::vector<Cluster>& clusters) {
  int hits = 0, of = 0;
  for (const Cluster& c : clusters) {
    hits += c.hits;
    of += c.of;
  }
  const std::size_t scans = clusters.size();
  if (scans < 2 || of == 0) return {};
  const double rate = static_cast<double>(hits) / of;
  double square = 0.0;
  for (const Cluster& c : clusters) square += std::pow(c.hits - rate * c.of, 2);
  const double scan_count = static_cast<double>(scans);
  const double sigma = std::sqrt(scan_count / (scan_count - 1.0) * square) / of;
  const double off = t_975(scans - 1) * sigma;
  const sealed::RateBounds binomial = sealed::rate_bounds_95(hits, of);
  return {std::max(0.0, std::min(binomial.lower, rate - off)),
          std::min(1.0, std::max(binomial.upper, rate + off))};
}

sealed::Calibration claims_held_against(const std::vector<Outcome>& outcomes,
                                        const std::vector<Reference>& references) {
  sealed::Calibration result;
  for (const Outcome& o : outcomes) {
    for (const Claim& claim : claims_in(o)) {
      const bool planted = !o.hidden.empty() && claim.means(o.hidden.front());
      const double there = probability_in(whole_scan(o, references), claim);
      if (claim.probability >= kLeastClaim && (planted || there > kBorneOut || there < kDenied))
        result.add(claim.probability, planted || there > kBorneOut);
    }
  }
  return result;
}

std::string planted_table(const std::vector<Outcome>& outcomes,
                          const std::vector<Reference>& references) {
  std::vector<std::string> scans;
  for (const Outcome& o : outcomes) {
    if (std::find(scans.begin(), scans.end(), scan_of(o)) == scans.end())
      scans.push_back(scan_of(o));
  }
  std::string text = "| |";
  for (const std::string& scan : scans) text += " " + scan + " |";
  text += " all | % | binomial 95 % | clustered by scan |\n|---|";
  for (std::size_t k = 0; k < scans.size() + 4; ++k) text += "---|";
  text += "\n";
  for (const Row& row : rows_of(references)) {
    text += "| " + row.text + " |";
    std::vector<Cluster> clusters;
    Cluster all;
    for (const std::string& scan : scans) {
      Cluster cluster;
      for (const Outcome& o : outcomes) {
        if (scan_of(o) != scan || !row.counts(o)) continue;
        ++cluster.of;
        cluster.hits += row.hits(o);
      }
      all.hits += cluster.hits;
      all.of += cluster.of;
      if (cluster.of > 0) clusters.push_back(cluster);
      text += fmt::format(" {} of {} |", cluster.hits, cluster.of);
    }
    text += fmt::format(" {} of {} |", all.hits, all.of);
    if (row.is_rate && all.of > 0) {
      text += fmt::format(" {} | {} | {} |\n",
                          percent(static_cast<double>(all.hits) / all.of),
                          words(sealed::rate_bounds_95(all.hits, all.of)),
                          words(clustered_bounds(clusters)));
    } else {
      text += " | | |\n";
    }
  }
  const sealed::Calibration calibration = claims_held_against(outcomes, references);
  return text + fmt::format("\nStated probabilities, {} claims whose truth is known: calibration error {:.3f}\n",
                            calibration.claims(),
                            calibration.error());
}

const std::vector<sealed::RateRow>& planted_rows() {
  static const std::vector<sealed::RateRow> rows = {
      {"planted, strength 7 and more", "named", "planted", {"named"}, 7.0, 1e9},
      {"planted, 4 to 7", "named", "planted", {"named"}, 4.0, 7.0},
      {"planted, below 4", "named", "planted", {"named"}, 0.0, 4.0},
      {"planted, strength 7 and more", "claimed at 90 %", "planted", {"claimed_90"}, 7.0, 1e9},
      {"planted",
       "no other claim at 90 % that the whole scan denies",
       "planted",
       {"none_denied_90"}},
      {"planted", "no other name comes or goes", "planted", {"others_stay"}},
      {"nothing planted",
       "no claim at 90 % that the whole scan denies",
       "plain",
       {"none_denied_90"}},
      {"nothing planted",
       "no claim at 60 % that the whole scan denies",
       "plain",
       {"none_denied_60"}},
      {"nothing planted", "a claim at 90 % that is borne out", "plain", {"borne_out_90"}},
      {"nothing planted", "a claim at 60 % that is borne out", "plain", {"borne_out_60"}}};
  return rows;
}

}  // namespace chaintrue::planted
