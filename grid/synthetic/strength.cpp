// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/strength.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/unit_whitening.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "grid/synthetic/design.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::Visit;

std::vector<ChainLengths> lengths_of(const Machine& machine, const std::vector<Visit>& visits) {
  const auto lengths = model::readings(ReadingModel(machine), visits);
  if (!lengths) {
    const BedPoint p = visits[lengths.error().place].position;
    throw precondition("signature: ({}, {}) mm cannot be reached: {}", p.x_mm, p.y_mm,
                       lengths.error().sentence());
  }
  return *lengths;
}

}  // namespace

std::vector<Visit> regular_session(const Machine& machine, int columns, int rows) {
  Design design;
  design.columns = columns;
  design.rows = rows;
  Random unused(0);
  std::vector<Visit> visits;
  for (const Mark& mark : marks(machine.bed, design, unused)) {
    visits.push_back({identity_placement(mark.place), as_int(visits.size())});
  }
  return visits;
}

std::vector<Vector2d> SessionSignature::tool_shift_mm() const {
  std::vector<Vector2d> shift;
  for (const auto i : each_index(residual_mm)) {
    shift.emplace_back(-length_by_xy[i].inverse() * residual_mm[i]);
  }
  return shift;
}

SessionSignature signature(const Machine& stated, const std::vector<AppliedEffect>& effects,
                           const std::vector<Visit>& visits) {
  Machine true_machine = stated;
  append_all(true_machine.effects, effects);
  const ReadingModel plain(stated);
  const model::MarkFrame mark_frame(true_machine);
  const model::MarkFrame stated_mark_frame(stated);
  const std::vector<ChainLengths> before = lengths_of(stated, visits);
  const std::vector<ChainLengths> after = lengths_of(true_machine, visits);
  SessionSignature result;
  for (const auto i : each_index(visits)) {
    const auto reading = plain.at(visits[i].position);
    if (!reading) {
      throw precondition("signature: visit {}: {}", i, reading.error().sentence());
    }
    const MarkPoint place = identity_placement(visits[i].position);
    const MarkPoint written = mark_frame.written(place);
    const MarkPoint usual = stated_mark_frame.written(place);
    const Vector2d moved = difference(written, usual);
    const Vector2d gained = difference(after[i], before[i]);
    result.length_by_xy.push_back(reading->position_jacobian);
    result.residual_mm.emplace_back(gained - reading->position_jacobian * moved);
  }
  return result;
}

StrengthTable::StrengthTable(const Machine& stated, std::vector<model::Visit> visits,
                             const StatedNoise& noise)
    : stated_(stated), visits_(std::move(visits)) {
  if (!(noise.length_mm > 0.0 && noise.position_mm >= 0.0)) {
    throw precondition("strength: noise of {} mm in length, {} mm in position", noise.length_mm,
                       noise.position_mm);
  }
  const auto count = std::ssize(visits_);
  const auto settings = std::ssize(kMachineSettings);
  MatrixXd by_setting = MatrixXd::Zero(2 * count + settings, settings);
  const ReadingModel model(stated);
  for (const Index i : each_below(count)) {
    const auto reading = model.at(visits_[as_size(i)].position);
    if (!reading) throw precondition("strength: visit {}: {}", i, reading.error().sentence());
    const Matrix2d& j = reading->position_jacobian;
    length_by_xy_.push_back(j);
    whitening_.emplace_back(estimation::unit_whitening(
        observation::covariance_of({noise.length_mm, noise.position_mm}, j)));
    for (const Index k : each_below(settings)) {
      by_setting.block<2, 1>(2 * i, k) =
          whitening_.back() * model.sensitivity(*reading, kMachineSettings[as_size(k)]);
    }
  }
  for (const Index k : each_below(settings)) {
    by_setting(2 * count + k, k) =
        1.0 / std::max(kKnownSigma, stated_sigma(stated, kMachineSettings[as_size(k)]));
  }
  settings_basis_ = linear::orthonormal_columns(by_setting);
  for (const Effect* effect : model::effects::effects_of(stated_)) {
    for (const EffectSide side : effect->sides) add_entries(*effect, side);
  }
}

EffectStrength StrengthTable::strength(const Effect& effect, EffectSide side) const {
  const Entry& own = usual(effect, side);
  EffectStrength result;
  result.signal_to_noise = own.left.norm();
  result.share_left = own.norm > 0.0 ? result.signal_to_noise / own.norm : 0.0;
  const EffectParameter& size = effect.parameters.front();
  const double per_size = result.signal_to_noise / std::abs(size.nominal);
  result.detectable_size = kDetectableSignalToNoise / per_size;
  // The most collinear place of each rival.
  std::vector<Rival> rivals;
  for (const Entry& other : entries_) {
    if (other.effect == &effect && other.side == side) continue;
    const double length = other.left.norm();
    if (!(length > 0.0 && result.signal_to_noise > 0.0)) continue;
    const double collinearity =
        std::min(1.0, std::abs(own.left.dot(other.left)) / (length * result.signal_to_noise));
    auto* same = find_where(
        rivals, [&](const Rival& r) { return r.effect == other.effect && r.side == other.side; });
    if (same == nullptr) {
      rivals.push_back({other.effect, other.side, collinearity});
    } else {
      same->collinearity = std::max(same->collinearity, collinearity);
    }
  }
  stable_sort(rivals, descending(&Rival::collinearity));
  double needed = kDetectableSignalToNoise;
  for (const Rival& rival : rivals) {
    if (rival.collinearity >= kInseparable) {
      result.inseparable.push_back(rival);
    } else {
      result.nearest = rival;
      needed = std::max(needed, 1.645 * std::sqrt(2.0 / (1.0 - rival.collinearity)));
      break;
    }
  }
  const double named = needed / per_size;
  if (named <= size.upper) result.named_size = named;
  return result;
}

std::vector<Vector2d> StrengthTable::calibrated_shift_mm(const AppliedEffect& applied) const {
  const VectorXd left = entry(applied).left;
  std::vector<Vector2d> shift;
  for (const auto i : each_index(visits_)) {
    const Vector2d pair = left.segment<2>(2 * as_index(i));
    shift.emplace_back(-length_by_xy_[i].inverse() * (whitening_[i].inverse() * pair));
  }
  return shift;
}

std::vector<std::vector<double>> StrengthTable::place_choices(const Effect& effect,
                                                              std::size_t visits) {
  constexpr int kSteps = 12;
  std::vector<std::vector<double>> choices = {nominal_values(effect)};
  for (const auto i : each_index(effect.parameters)) {
    const EffectParameter& parameter = effect.parameters[i];
    if (parameter.role != ParameterRole::place) continue;
    const bool counts_visits = parameter.integer;
    const bool declared = effect.law != nullptr;
    const double from = counts_visits ? 1.0
                        : declared    ? parameter.lower
                                      : std::max(parameter.lower, 0.0);
    const double to = counts_visits ? as_double(visits) - 1.0
                      : declared    ? parameter.upper
                                    : std::min(parameter.upper, std::numbers::pi);
    std::vector<std::vector<double>> more;
    for (const auto& choice : choices) {
      for (const int k : each_below(kSteps)) {
        std::vector<double> other = choice;
        const double place = from + (to - from) * (k + 0.5) / kSteps;
        other[i] = counts_visits ? std::floor(place) : place;
        more.push_back(other);
      }
    }
    append_all(choices, more);
  }
  return choices;
}

void StrengthTable::add_entries(const Effect& effect, EffectSide side) {
  bool usual = true;
  for (const auto& values : place_choices(effect, visits_.size())) {
    Machine with = stated_;
    with.effects.push_back(applied(effect, side, values));
    if (!model::effects::problems_of_effects(with).empty()) return;  // cannot act on such a machine
    entries_.push_back(entry(with.effects.back()));
    entries_.back().effect = &effect;
    entries_.back().side = side;
    entries_.back().usual = usual;
    usual = false;
  }
}

StrengthTable::Entry StrengthTable::entry(const AppliedEffect& applied) const {
  Entry result{};
  const std::vector<Vector2d> residual_mm = signature(stated_, {applied}, visits_).residual_mm;
  VectorXd g = VectorXd::Zero(settings_basis_.rows());
  for (const auto i : each_index(visits_))
    g.segment<2>(2 * as_index(i)) = whitening_[i] * residual_mm[i];
  result.norm = g.norm();
  result.left = g - settings_basis_ * (settings_basis_.transpose() * g);
  return result;
}

const StrengthTable::Entry& StrengthTable::usual(const Effect& effect, EffectSide side) const {
  auto* found = find_where(
      entries_, [&](const Entry& e) { return e.usual && e.effect == &effect && e.side == side; });
  if (found == nullptr) {
    throw precondition("strength: {} cannot act on this machine", effect.id);
  }
  return *found;
}

}  // namespace chaintrue::grid::synthetic
