// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/belts_trial.hpp"

#include <algorithm>

#include "grid/diagnosis/diagnose.hpp"

namespace chaintrue::sealed {
namespace {

grid::MeasuredBelts measured(const generator::BeltDraw& draw) {
  grid::MeasuredBelts belts;
  belts.machine.lengths = model::BeltLengths::belt;
  int order = 0;
  for (const generator::FourLengths& read : draw.lengths_mm) {
    grid::BeltPoint point;
    point.lengths_mm = {read[0], read[1], read[2], read[3]};
    point.order = order++;
    belts.points.push_back(std::move(point));
  }
  return belts;
}

bool same_bad(const generator::BeltSecret& secret, const grid::diagnosis::Diagnosis& found) {
  if (found.outliers.size() != secret.bad.size()) return false;
  return std::all_of(found.outliers.begin(), found.outliers.end(), [&](const auto& bad) {
    return std::any_of(secret.bad.begin(), secret.bad.end(), [&](const auto& hidden) {
      return bad.belt && static_cast<int>(bad.index) == hidden[0] &&
             static_cast<int>(*bad.belt) == hidden[1];
    });
  });
}

/// False as well where it is not among the causes that are compared: nothing points to it.
bool is_separable(const generator::BeltSecret& secret, const grid::diagnosis::Diagnosis& found) {
  const auto is_hidden = [&](const auto& cause) {
    return cause.effect->id == secret.effect && name(cause.side) == secret.side;
  };
  bool compared = false;
  for (const auto& pair : found.separations) {
    if (!is_hidden(pair.first) && !is_hidden(pair.second)) continue;
    compared = true;
    if (pair.signal_to_noise_needed > secret.strength) return false;
  }
  return compared;
}

}  // namespace

BeltsTrial run_belts_trial(const generator::BeltRecipe& recipe, std::uint64_t seed) {
  const generator::BeltDraw draw = generator::draw_belts(recipe, seed);
  BeltsTrial trial{seed, draw.secret};
  const auto found = grid::diagnosis::diagnose(measured(draw));
  if (!found) {
    trial.failed = true;
    trial.sentence = found.error().sentence;
    return trial;
  }
  trial.sentence = found->sentence;
  trial.named = !found->causes.empty();
  const auto is_hidden = [&](const auto& cause) {
    return cause.cause.effect->id == draw.secret.effect &&
           name(cause.cause.side) == draw.secret.side;
  };
  const auto holds = [&](const grid::diagnosis::Cause& cause) {
    return is_hidden(cause) || std::any_of(cause.same_as.begin(), cause.same_as.end(), is_hidden);
  };
  trial.held = std::any_of(found->causes.begin(), found->causes.end(), holds);
  trial.exact = found->verdict == grid::diagnosis::Verdict::named && trial.held;
  trial.right_belt =
      trial.named && name(found->causes.front().cause.side) == draw.secret.side;
  trial.separable = is_separable(draw.secret, *found);
  trial.bad_found = same_bad(draw.secret, *found);
  return trial;
}

}  // namespace chaintrue::sealed
