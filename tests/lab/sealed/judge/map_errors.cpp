// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/map_errors.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "generator/hidden/grid_text.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Hidden;
using generator::Visit;

/// The reference for a map: effects that do not depend on the visit.
std::vector<Hidden> of_the_bed(std::vector<Hidden> effects) {
  std::erase_if(effects, [](const Hidden& h) {
    return h.cause == generator::Cause::drift || h.cause == generator::Cause::tooth_skip ||
           h.cause == generator::Cause::link_miscount || h.cause == generator::Cause::zero_shift ||
           h.cause == generator::Cause::direction_hysteresis;
  });
  return effects;
}

struct Missed {
  Eigen::Vector2d place_mm;
  Eigen::Vector2d chain_mm;
  Eigen::Matrix2d jacobian;
  Eigen::Vector2d sigma_mm;
  double tool_sigma_mm;
};

/// Removes the best-fit shift and turn from the tool's errors.
void lay_sheet(std::vector<Missed>& all) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto columns = [](const Missed& one) {
    Eigen::Matrix<double, 2, 3> motion;
    motion << 1.0, 0.0, -one.place_mm.y(), 0.0, 1.0, one.place_mm.x();
    return motion;
  };
  for (const Missed& one : all) {
    const Eigen::Matrix<double, 2, 3> motion = columns(one);
    normal += motion.transpose() * motion;
    right += motion.transpose() * (one.jacobian.inverse() * one.chain_mm);
  }
  const Eigen::Vector3d laid = normal.inverse() * right;
  for (Missed& one : all) one.chain_mm -= one.jacobian * (columns(one) * laid);
}

MapErrors errors_of(const std::vector<Missed>& all) {
  constexpr double kOf95 = 1.96;
  MapErrors errors;
  double true_mm2 = 0.0;
  double stated_mm2 = 0.0;
  for (const Missed& one : all) {
    true_mm2 += (one.jacobian.inverse() * one.chain_mm).squaredNorm();
    stated_mm2 += one.tool_sigma_mm * one.tool_sigma_mm;
    for (Eigen::Index chain = 0; chain < 2; ++chain)
      errors.covered += std::abs(one.chain_mm[chain]) <= kOf95 * one.sigma_mm[chain] ? 1 : 0;
  }
  errors.places = static_cast<int>(all.size());
  errors.true_rms_mm = std::sqrt(true_mm2 / errors.places);
  errors.stated_rms_mm = std::sqrt(stated_mm2 / errors.places);
  return errors;
}

std::optional<std::vector<Missed>> missed_by(const generator::HiddenMachine& lasting,
                                             const std::vector<Visit>& visits,
                                             const grid::CompensationMap& map) {
  const auto exact = lasting.exact(visits);
  if (!exact) return std::nullopt;
  std::vector<Missed> all;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const generator::Vec2 mark = generator::written(visits[i].place, lasting.hidden());
    const auto answer = map.query({mark.x, mark.y});
    if (!answer) return std::nullopt;
    all.push_back(
        {{mark.x, mark.y},
         {(*exact)[i][0] - answer->lengths.left_mm, (*exact)[i][1] - answer->lengths.right_mm},
         answer->mark_jacobian,
         {answer->sigma.left_mm, answer->sigma.right_mm},
         answer->tool_sigma_mm});
  }
  return all;
}

std::vector<Visit> area_of(const generator::HiddenMachine& machine) {
  generator::Dice dice(1, "area of a map");
  return generator::area_session(machine, dice);
}

}  // namespace

std::optional<MapErrors> map_errors(const generator::SealedSet& set,
                                    const grid::CompensationMap& map) {
  generator::HiddenMachine lasting(set.machine.stated(), set.machine.truth(),
                                   of_the_bed(set.machine.hidden()));
  lasting.suffers(set.machine.disturbance());
  const auto missed = missed_by(lasting, area_of(set.machine), map);
  if (!missed) return std::nullopt;
  return errors_of(*missed);
}

std::optional<MapErrors> map_errors_of_free_sheet(const generator::HiddenMachine& machine,
                                                  const grid::CompensationMap& map) {
  auto missed = missed_by(machine, area_of(machine), map);
  if (!missed) return std::nullopt;
  lay_sheet(*missed);
  return errors_of(*missed);
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
