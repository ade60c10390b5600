// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/map_errors.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "generator/hidden/grid_text.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Hidden;
using generator::Visit;

/// What a map is held against: effects that do not hang on the visit.
std::vector<Hidden> of_the_bed(std::vector<Hidden> effects) {
  std::erase_if(effects, [](const Hidden& h) {
    return h.cause == generator::Cause::drift || h.cause == generator::Cause::tooth_skip ||
           h.cause == generator::Cause::link_miscount ||
           h.cause == generator::Cause::zero_shift ||
           h.cause == generator::Cause::direction_hysteresis;
  });
  return effects;
}

}  // namespace

std::optional<MapErrors> map_errors(const generator::SealedSet& set,
                                    const grid::CompensationMap& map) {
  generator::Dice dice(1, "area of a map");
  const std::vector<Visit> visits = generator::area_session(set.machine, dice);
  const std::vector<Hidden> hidden = of_the_bed(set.machine.hidden());
  generator::HiddenMachine lasting(set.machine.stated(), set.machine.truth(), hidden);
  if (set.answer.unlisted) lasting.suffers(*set.answer.unlisted);
  if (set.answer.pattern) lasting.suffers(set.answer.pattern->pattern);
  const auto exact = lasting.exact(visits);
  if (!exact) return std::nullopt;
  MapErrors errors;
  double true_mm2 = 0.0;
  double stated_mm2 = 0.0;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const generator::Vec2 mark = generator::written(visits[i].place, hidden);
    const auto answer = map.query({mark.x, mark.y});
    if (!answer) return std::nullopt;
    const Eigen::Vector2d missed((*exact)[i][0] - answer->lengths.left_mm,
                                 (*exact)[i][1] - answer->lengths.right_mm);
    true_mm2 += (answer->mark_jacobian.inverse() * missed).squaredNorm();
    stated_mm2 += answer->tool_sigma_mm * answer->tool_sigma_mm;
    constexpr double kOf95 = 1.96;
    errors.covered += std::abs(missed[0]) <= kOf95 * answer->sigma.left_mm ? 1 : 0;
    errors.covered += std::abs(missed[1]) <= kOf95 * answer->sigma.right_mm ? 1 : 0;
  }
  errors.places = static_cast<int>(visits.size());
  errors.true_rms_mm = std::sqrt(true_mm2 / errors.places);
  errors.stated_rms_mm = std::sqrt(stated_mm2 / errors.places);
  return errors;
}

generator::Recipe recipe_of_start() {
  generator::Recipe recipe;
  recipe.list_of_start = true;
  recipe.noise = {0.1, 0.5};
  return recipe;
}

std::string another_session(const generator::SealedSet& set, double zero_mm, std::uint64_t seed) {
  generator::Dice dice(seed, "another session");
  generator::TrueMachine truth = set.machine.truth();
  truth.chain_zero_mm[0] += zero_mm;
  generator::HiddenMachine again(set.machine.stated(), truth, of_the_bed(set.machine.hidden()));
  constexpr double kBesideMm = 8.0;
  const std::vector<Visit> visits = generator::fresh_session(set.machine, kBesideMm, dice);
  generator::WrittenGrid grid;
  grid.stated = set.machine.stated();
  grid.stated_noise = set.noise;
  for (const Visit& visit : visits) {
    const auto note = again.measure(visit.place, set.noise, dice);
    if (!note) throw std::runtime_error("another_session: a mark is out of reach");
    grid.notes.push_back(*note);
  }
  return generator::grid_text(grid);
}

}  // namespace chaintrue::sealed
