// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/trial.hpp"

#include <algorithm>
#include <ctime>

#include "grid/files/grid_file.hpp"
#include "sealed/judge/follow_up.hpp"
#include "sealed/judge/true_errors.hpp"

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;

std::string id_of(std::string_view effect, std::string_view side) {
  return std::string(effect) + ":" + (side.empty() ? "-" : std::string(side));
}

}  // namespace

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

grid::diagnosis::DiagnosisOptions verdict_alone() {
  grid::diagnosis::DiagnosisOptions how;
  how.stability = how.improvement = how.next_measurements = false;
  return how;
}

std::string id_of(const generator::Hidden& hidden) {
  return id_of(generator::card(hidden.cause).id, generator::word(hidden.where));
}

std::string id_of(const grid::diagnosis::CauseId& cause) {
  return id_of(cause.effect->id, model::effects::name(cause.side));
}

std::vector<NamedCause> named_causes(const Diagnosis& found) {
  std::vector<NamedCause> causes;
  for (const auto& cause : found.causes) {
    NamedCause named{id_of(cause.cause), cause.probability, {}};
    for (const auto& same : cause.same_as) named.same_as.push_back(id_of(same.cause));
    causes.push_back(std::move(named));
  }
  return causes;
}

void take_over(const Diagnosis& found, Trial& trial) {
  trial.verdict = found.verdict;
  trial.causes = named_causes(found);
  trial.hypotheses = found.hypotheses;
  for (const auto& h : found.hypotheses) {
    if (h.effect == "unknown") trial.unknown_probability = h.probability;
  }
  trial.family_wise_p = found.family_wise_p;
  for (const auto& bad : found.outliers) trial.bad_points.push_back(bad.index);
}

Trial run_trial(const TrialOptions& options, std::uint64_t seed) {
  generator::SealedSet set = generator::draw_set(options.recipe, seed);
  Trial trial;
  trial.seed = seed;
  trial.points = options.recipe.points;
  const grid::MeasuredGrid grid = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  grid::diagnosis::DiagnosisOptions how;
  how.improvement = options.improvement;
  how.next_measurements = options.follow_up;
  how.accept_class = true;  // the oracle is given the cause, so its class is accepted

  const double start = thread_seconds();
  const auto found = grid::diagnosis::diagnose(grid, how);
  trial.seconds = thread_seconds() - start;

  trial.answer = set.answer;
  for (const auto& hidden : set.answer.hidden) trial.hidden.push_back(id_of(hidden));
  if (!found) {
    trial.failed = true;
    return trial;
  }
  take_over(*found, trial);
  if (options.improvement) trial.errors = true_errors(set, *found);
  const bool ambiguous = trial.verdict == Verdict::named_set ||
                         (trial.verdict == Verdict::named && trial.causes.size() > 1);
  if (options.follow_up && ambiguous) {
    trial.follow_up = follow_up(set, grid, *found, how);
  }
  return trial;
}

bool means(const NamedCause& named, const std::string& id) {
  return named.id == id ||
         std::find(named.same_as.begin(), named.same_as.end(), id) != named.same_as.end();
}

bool names_something(const Trial& trial) {
  return trial.verdict == Verdict::named || trial.verdict == Verdict::named_set ||
         trial.verdict == Verdict::several_causes;
}

bool tells_pattern(const Trial& trial) { return trial.unknown_probability > 0.5; }

bool names_outright(const Trial& trial) {
  return trial.verdict == Verdict::named || trial.verdict == Verdict::several_causes;
}

bool names_wrongly(const Trial& trial) {
  if (trial.verdict == Verdict::named_set) {
    return std::none_of(trial.hidden.begin(), trial.hidden.end(), [&](const std::string& id) {
      return std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
        return means(c, id);
      });
    });
  }
  return std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
    return std::none_of(trial.hidden.begin(), trial.hidden.end(), [&](const std::string& id) {
      return means(c, id);
    });
  });
}

bool leads_right(const Trial& trial) {
  return !trial.hidden.empty() && !trial.causes.empty() &&
         means(trial.causes.front(), trial.hidden.front());
}

bool in_set(const Trial& trial) {
  return !trial.hidden.empty() &&
         std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
           return means(c, trial.hidden.front());
         });
}

bool all_named(const Trial& trial) {
  return std::all_of(trial.hidden.begin(), trial.hidden.end(), [&](const std::string& id) {
    return std::any_of(trial.causes.begin(), trial.causes.end(), [&](const NamedCause& c) {
      return means(c, id);
    });
  });
}

bool all_bad_found(const Trial& trial) {
  const auto& bad = trial.answer.bad_points;
  return std::all_of(bad.begin(), bad.end(), [&](std::size_t i) {
    return std::find(trial.bad_points.begin(), trial.bad_points.end(), i) != trial.bad_points.end();
  });
}

}  // namespace chaintrue::sealed
