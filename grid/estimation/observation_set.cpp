// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/observation_set.hpp"

#include <algorithm>
#include <stdexcept>

#include "grid/precondition.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::estimation {
namespace {

/// Appends the rows, places and units of a part.
void append(ObservationPart part, ObservationSet& set) {
  const observation::Observation& own = *part.observation;
  const std::size_t number = set.parts.size();
  part.first_row = set.rows;
  part.first_place = set.places.size();
  part.first_unit = set.units.size();
  for (const observation::Place& place : own.places()) {
    set.places.push_back({place, number});
  }
  if (own.may_be_outlier()) {
    for (const observation::Unit& unit : own.units()) {
      set.units.push_back({number, unit.index, part.first_row + unit.first_row, unit.rows});
    }
  }
  set.rows += own.rows();
  set.parts.push_back(std::move(part));
}

/// The columns of zeros and nuisances, and the stated values of all columns.
void add_columns(ObservationSet& set) {
  const Index parameters = set.parameters();
  Index columns = parameters + 3 * as_index(set.sheets);
  bool is_first = true;
  for (ObservationPart& part : set.parts) {
    // Only for two chains: other mechanisms have no such zeros.
    if (set.settings.empty() || !part.reads_chains()) continue;
    if (!is_first) {
      part.zero_columns = {columns, columns + 1};
      columns += 2;
      ++set.own_zeros;
    }
    is_first = false;
  }
  for (ObservationPart& part : set.parts) {
    for (Index q = 0; q < part.observation->nuisance_sigma().size(); ++q) {
      part.nuisance_columns.push_back(columns++);
    }
  }
  set.stated_value = VectorXd::Zero(columns);
  set.stated_sigma = VectorXd::Zero(columns);
  set.stated_value.head(parameters) = set.mechanism->values();
  for (const Index k : each_below(parameters)) {
    set.stated_sigma(k) = set.mechanism->parameters()[as_size(k)].prior_sigma.value_or(kInfinity);
  }
  for (const ObservationPart& part : set.parts) {
    for (const Index column : part.zero_columns) set.stated_sigma(column) = kSessionZeroSigmaMm;
    for (const auto q : each_index(part.nuisance_columns)) {
      set.stated_sigma(part.nuisance_columns[q]) = part.observation->nuisance_sigma()(as_index(q));
    }
    if (!part.sheet) continue;
    set.stated_sigma.segment<3>(ObservationSet::sheet_column(*part.sheet)) =
        part.observation->sheet()->sigma();
  }
  set.stated_sigma = set.stated_sigma.cwiseMax(kKnownSigma);
}

}  // namespace

ObservationSet observation_set(Machine stated, const observation::Observations& observations,
                               std::shared_ptr<const Mechanism> mechanism) {
  ObservationSet set;
  const bool chains = mechanism == nullptr;
  set.mechanism = chains ? model::make_chain_mechanism(stated) : std::move(mechanism);
  set.stated = std::move(stated);
  if (chains) set.settings.assign(kMachineSettings.begin(), kMachineSettings.end());
  for (const auto& observation : observations) {
    ObservationPart part;
    if (observation->sheet()) {
      if (!chains) throw precondition("a sheet that was laid under {}", set.mechanism->kind());
      part.sheet = set.sheets++;
      set.settings.insert(set.settings.end(), model::kSheetSettings.begin(),
                          model::kSheetSettings.end());
    }
    part.observation = observation;
    append(std::move(part), set);
  }
  add_columns(set);
  set.noise_dof = kInfinity;
  for (const ObservationPart& part : set.parts) {
    set.noise_dof = std::min(set.noise_dof, part.observation->noise_dof());
  }
  return set;
}

ObservationSet with_observations(const ObservationSet& set, std::vector<FollowUp> parts) {
  ObservationSet other = set;
  other.parts.clear();
  other.places.clear();
  other.units.clear();
  other.rows = 0;
  for (FollowUp& one : parts) {
    ObservationPart part;
    part.sheet = set.parts[one.in_place_of].sheet;
    part.zero_columns = set.parts[one.in_place_of].zero_columns;
    part.nuisance_columns = set.parts[one.in_place_of].nuisance_columns;
    const VectorXd& sigma = one.observation->nuisance_sigma();
    const auto known = std::ssize(part.nuisance_columns);
    const Index more = std::max<Index>(sigma.size() - known, 0);
    const Index columns = other.stated_sigma.size();
    part.nuisance_columns.resize(as_size(std::min(known, sigma.size())));
    for (const Index q : each_below(more)) part.nuisance_columns.push_back(columns + q);
    other.stated_value.conservativeResizeLike(VectorXd::Zero(columns + more));
    other.stated_sigma.conservativeResize(columns + more);
    other.stated_sigma.tail(more) = sigma.tail(more);
    part.observation = std::move(one.observation);
    append(std::move(part), other);
  }
  return other;
}

MachineState stated_state(const ObservationSet& set) {
  return {set.mechanism, std::vector<SheetPlacement>(set.sheets)};
}

VectorXd setting_values(const ObservationSet& set, const MachineState& state) {
  VectorXd values = VectorXd::Zero(set.stated_value.size());
  values.head(set.parameters()) = state.mechanism->values();
  for (const std::size_t i : each_below(set.sheets)) {
    const SheetPlacement& sheet = state.sheets[i];
    values.segment<3>(ObservationSet::sheet_column(i)) << sheet.x_mm, sheet.y_mm,
        sheet.rotation_rad;
  }
  return values;
}

MachineState with_settings(const ObservationSet& set, MachineState state, const VectorXd& values) {
  state.mechanism = state.mechanism->with_values(values.head(set.parameters()));
  for (const std::size_t i : each_below(set.sheets)) {
    const Index at = ObservationSet::sheet_column(i);
    state.sheets[i] = {values(at), values(at + 1), values(at + 2)};
  }
  return state;
}

tl::expected<MachineState, std::string> moved_to(const ObservationSet& set, MachineState state,
                                                 const VectorXd& values) {
  try {
    return with_settings(set, std::move(state), values);
  } catch (const std::invalid_argument& failure) {
    return tl::unexpected(std::string(failure.what()));
  }
}

std::string name_of(const ObservationSet& set, std::size_t unit) {
  const ObservationPart& part = set.parts[set.units[unit].part];
  return part.observation->name_of(unit - part.first_unit);
}

}  // namespace chaintrue::grid::estimation
