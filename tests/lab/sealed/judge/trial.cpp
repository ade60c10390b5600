// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/trial.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/follow_up.hpp"
#include "sealed/judge/true_errors.hpp"

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;

/// Names with a lower probability do not count as claims.
constexpr double kClaim = 0.9;

double strength_of(const generator::Answer& answer) {
  if (!answer.delta.empty()) return answer.delta.front();
  return answer.pattern ? answer.pattern->delta : answer.left_over_delta;
}

void add_names(const Trial& trial, Outcome& outcome) {
  for (const double least : {0.5, 0.9, 0.95, 0.99, 0.999}) {
    for (const bool right : {true, false}) {
      outcome.add(fmt::format("{}_{:g}", right ? "right" : "wrong", least),
                  trial.names_outright() && grid::any_of(trial.causes, [&](const Claim& claim) {
                    return claim.probability >= least && trial.is_hidden(claim) == right;
                  }));
    }
  }
  outcome.named.clear();
  for (const Claim& claim : trial.causes) outcome.named.push_back(word_of(claim));
  if (trial.names_something())
    outcome.numbers["named_causes"] = static_cast<double>(trial.causes.size());
}

void add_errors(const generator::SealedSet& set, const Diagnosis& found, Outcome& outcome) {
  const auto errors = true_errors(set, found);
  if (!errors) return;
  const double calibrated2 = errors->calibrated * errors->calibrated;
  const double drop = calibrated2 - errors->extended * errors->extended;
  outcome.numbers["calibrated_mm"] = errors->calibrated;
  outcome.numbers["extended_mm"] = errors->extended;
  outcome.numbers["oracle_mm"] = errors->oracle;
  outcome.numbers["extended_over_calibrated"] = errors->extended / errors->calibrated;
  // Naming a reading with a gross error hardly changes anything else.
  const bool only_miscounts = grid::all_of(set.answer.hidden, [](const generator::Hidden& h) {
    return h.cause == generator::Cause::link_miscount;
  });
  const auto is_near = [](double reported, double truth) {
    return std::abs(reported - truth) <= 0.15 * std::abs(truth);
  };
  outcome.add("gains", !outcome.has("no_name") && !only_miscounts);
  outcome.add("drop_near", is_near(errors->reported_drop, drop));
  outcome.add("share_near", is_near(errors->reported_share, drop / calibrated2));
}

}  // namespace

grid::diagnosis::DiagnosisOptions verdict_alone() {
  grid::diagnosis::DiagnosisOptions how;
  how.stability = how.improvement = how.next_measurements = false;
  return how;
}

std::string id_of(std::string_view effect, std::string_view side) {
  return fmt::format("{}:{}", effect, side.empty() ? "-" : side);
}

std::string id_of(const generator::Hidden& hidden) {
  return id_of(generator::card(hidden.cause).id, generator::word(hidden.where));
}

std::string id_of(const grid::diagnosis::CauseId& cause) {
  return id_of(cause.effect->id, model::effects::name(cause.side));
}

bool Claim::means(std::string_view id) const { return grid::contains(members, id); }

std::string name_of(const Claim& claim) { return fmt::format("{}", fmt::join(claim.members, "~")); }

std::string word_of(const Claim& claim) {
  return fmt::format("{}={:.4f}", name_of(claim), claim.probability);
}

Claim parse_claim(const std::string& word) {
  const auto at = word.rfind('=');
  if (at == std::string::npos || at == 0)
    throw std::invalid_argument("\"" + word + "\": expected effect:side=probability");
  return {words_of(word.substr(0, at), '~'), number_of<double>(word.substr(at + 1))};
}

std::vector<Claim> named_causes(const Diagnosis& found) {
  std::vector<Claim> causes;
  for (const auto& cause : found.causes) {
    Claim& claim = causes.emplace_back(Claim{{id_of(cause.cause)}, cause.probability});
    for (const auto& same : cause.same_as) claim.members.push_back(id_of(same.cause));
  }
  return causes;
}

Trial::Trial(const Diagnosis& found) : verdict(found.verdict), causes(named_causes(found)) {
  for (const auto& h : found.hypotheses) {
    if (h.effect == "unknown") unknown_probability = h.probability;
  }
  for (const auto& bad : found.outliers) bad_points.push_back(bad.index);
}

bool Trial::is_hidden(const Claim& claim) const {
  return grid::any_of(hidden, [&](const std::string& id) { return claim.means(id); });
}

bool Trial::is_named(const std::string& id) const {
  return grid::any_of(causes, [&](const Claim& claim) { return claim.means(id); });
}

bool Trial::names_outright() const {
  return verdict == Verdict::named || verdict == Verdict::several_causes;
}

bool Trial::names_something() const { return names_outright() || verdict == Verdict::named_set; }

bool Trial::names_wrongly() const {
  if (verdict == Verdict::named_set)
    return grid::none_of(causes, [&](const Claim& claim) { return is_hidden(claim); });
  return grid::any_of(causes, [&](const Claim& claim) { return !is_hidden(claim); });
}

Outcome outcome_of(const std::string& kind, std::uint64_t seed, const Trial& t) {
  Outcome outcome{kind, seed, 0, 0.0, t.hidden, std::string(name(t.verdict)), {}, {}, {}};
  for (const Claim& claim : t.causes) outcome.named.push_back(name_of(claim));
  const bool leads =
      !t.causes.empty() && !t.hidden.empty() && t.causes.front().means(t.hidden.front());
  const bool has_pattern = t.unknown_probability > 0.5;
  outcome.add("leads", leads);
  outcome.add("alone", t.verdict == Verdict::named && leads);
  outcome.add("held", !t.hidden.empty() && t.is_named(t.hidden.front()));
  outcome.add("all", !t.hidden.empty() &&
                         grid::all_of(t.hidden, [&](const auto& id) { return t.is_named(id); }));
  outcome.add("outright", t.names_outright());
  outcome.add("nothing_false", !t.names_wrongly());
  outcome.add("no_false_claim",
              !t.names_wrongly() || t.causes.empty() || t.causes.front().probability < kClaim);
  outcome.add("no_name", !t.names_something());
  outcome.add("pattern", has_pattern);
  outcome.add("no_pattern", !has_pattern);
  outcome.add("refused", t.verdict == Verdict::model_discrepancy);
  outcome.add("only_bad_points", t.verdict == Verdict::outliers);
  outcome.add("bad_found", grid::all_of(t.hidden_bad_points, [&](std::size_t i) {
                return grid::contains(t.bad_points, i);
              }));
  outcome.add("no_more_bad", t.bad_points.size() <= t.hidden_bad_points.size());
  return outcome;
}

Outcome run_trial(const std::string& kind, const TrialOptions& options, std::uint64_t seed) {
  generator::SealedSet set = generator::draw_set(options.recipe, seed);
  const grid::MeasuredGrid grid = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  grid::diagnosis::DiagnosisOptions how;
  how.improvement = options.improvement;
  how.next_measurements = options.follow_up;
  how.accept_class = true;  // the oracle is given the cause, so its class is accepted
  const auto found = grid::diagnosis::diagnose(grid, how);
  Trial trial(found ? *found : Diagnosis{});
  for (const auto& hidden : set.answer.hidden) trial.hidden.push_back(id_of(hidden));
  trial.hidden_bad_points = set.answer.bad_points;
  Outcome outcome = outcome_of(kind, seed, trial);
  outcome.points = options.recipe.points;
  outcome.strength = strength_of(set.answer);
  if (!found) outcome.fail();
  if (!found || !options.more) return outcome;
  add_names(trial, outcome);
  outcome.add("separable", set.answer.separable);
  if (options.improvement) add_errors(set, *found, outcome);
  if (options.follow_up && trial.verdict == Verdict::named_set) {
    outcome.add("followed", true);
    outcome.add("resolved", follow_up(set, grid, *found, how));
  }
  return outcome;
}

}  // namespace chaintrue::sealed
