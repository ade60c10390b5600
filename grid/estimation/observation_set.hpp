// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All observations of one machine: their rows one below the other, their places and units numbered
/// through, and the columns of what is unknown with what is stated of it.
///
/// Columns: the machine's settings, three for each sheet that somebody laid, two for each session whose
/// chain zeros are its own, the nuisances of each observation. Between two sessions in which chains are read
/// a chain may have been hung anew: the zeros of all but the first are other than the machine's by what is
/// estimated. Sets of holes share the machine's: distances hardly tell zeros, and the five published sets of
/// one machine predict each other worse with zeros of their own (0.65 mm left out, 0.60 without). Units
/// (observation.hpp) are those whose readings may be outliers; readings that cannot be outliers have
/// rows and are no units.
///
/// \code
///   const ObservationSet set = observation_set(machine, {points, holes});
///   const MachineState state = stated_state(set);
///   const auto system = linearise(set, ...);       // linearised_system.hpp
/// \endcode
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/single_readings.hpp"
#include "grid/observation/tape_distances.hpp"

namespace chaintrue::grid::estimation {

/// What is stated without any uncertainty is taken as known this well, in mm or rad.
inline constexpr double kKnownSigma = 1e-7;

/// One sigma beforehand of what a chain's zero is other in another session, mm: a zero that is set anew by
/// eye comes out within some millimetres. A grid tells it to tenths of a millimetre, so that a prior as wide
/// as this pulls a shift of a whole link by hundredths.
inline constexpr double kSessionZeroSigmaMm = 3.0;

/// Settings of the machine: the first columns.
inline constexpr auto kMachineSettingCount = std::ssize(model::kMachineSettings);

/// An observation's share of the rows, places, units and columns.
struct ObservationPart {
  std::shared_ptr<const observation::Observation> observation;
  Eigen::Index first_row = 0;
  std::size_t first_place = 0;
  std::size_t first_unit = 0;
  std::optional<std::size_t> sheet;            ///< which of the set's; none: the bed's frame
  std::vector<Eigen::Index> nuisance_columns;  ///< among all columns
  /// By how much the zero of either chain is more in this session than in the machine, among all columns;
  /// none of the session that the machine's zeros are those of.
  std::vector<Eigen::Index> zero_columns{};
  [[nodiscard]] bool reads_chains() const { return observation->kind().reads_chains; }
};

struct NumberedPlace {
  std::size_t part = 0;
  std::size_t index = 0;  ///< into the points, or the holes, of all files in their order
  model::MarkPoint mark;
  model::ChainLengths lengths;
  int order = 0;
};

struct NumberedUnit {
  std::size_t part = 0;
  std::size_t index = 0;  ///< into the points, or the distances, of all files in their order
  Eigen::Index first_row = 0;
  Eigen::Index rows = 1;
};

struct ObservationSet {
  model::Machine stated;
  /// What hangs: two chains of `stated`, or another mechanism, of which `stated` says nothing.
  std::shared_ptr<const model::Mechanism> mechanism;
  std::vector<ObservationPart> parts;
  std::vector<NumberedPlace> places;
  std::vector<NumberedUnit> units;
  /// Of two chains, those of a sheet once for each; empty of another mechanism.
  std::vector<model::Setting> settings;
  std::size_t sheets = 0;
  std::size_t own_zeros = 0;     ///< sessions whose chain zeros are their own
  Eigen::VectorXd stated_value;  ///< q: of the settings and zeros, then of the nuisances, each in its unit
  Eigen::VectorXd
      stated_sigma;  ///< q, one sigma of these, at least kKnownSigma; infinite: nothing is known
  Eigen::Index rows = 0;
  Eigen::Index observed_rows = 0;  ///< those of units
  /// How well the noise is known; of several observations that of the one that knows least.
  double noise_dof = 15.0;
  bool noise_from_repeats = false;
  /// With fewer units left, none is rejected.
  std::size_t fewest_units = 0;

  /// Of the mechanism: the first columns.
  [[nodiscard]] Eigen::Index parameters() const { return mechanism->values().size(); }
  /// Of the mechanism's parameters and the sheets: the first columns.
  [[nodiscard]] Eigen::Index setting_columns() const { return parameters() + 3 * as_index(sheets); }
  [[nodiscard]] Eigen::Index nuisances() const {
    return stated_value.size() - setting_columns() - 2 * as_index(own_zeros);
  }
  /// Whether two chains hang, of which `stated` says all.
  [[nodiscard]] bool is_of_chains() const { return !settings.empty(); }
  [[nodiscard]] bool reads_chains() const;
  [[nodiscard]] bool has_distances() const;
  /// Chains were read, and the visits' order is known.
  [[nodiscard]] bool ordered() const;
  [[nodiscard]] bool ordered(const NumberedPlace& place) const {
    return parts[place.part].observation->ordered();
  }
  /// The readings of the machine itself; none where there are none.
  [[nodiscard]] const std::vector<ExtraReading>& readings() const;
  /// Whether the readings know of the setting in this column at all.
  [[nodiscard]] bool knows(std::size_t column) const;
  /// The first of the three columns of a sheet.
  [[nodiscard]] static Eigen::Index sheet_column(std::size_t sheet);
  /// Columns of an observation's own settings, as observation::columns_of() has them.
  [[nodiscard]] std::vector<Eigen::Index> columns_of(const ObservationPart& part) const;
  /// What these units are together: "points", "distances", "readings" where there are both.
  [[nodiscard]] std::string_view units_word() const;
};

/// In the order of `observations`. The machine's zeros are those of the first session that reads chains.
/// \throws std::invalid_argument for a sheet that was laid under
/// another mechanism than two chains.
[[nodiscard]] ObservationSet observation_set(
    model::Machine stated,
    const observation::Observations& observations,
    std::shared_ptr<const model::Mechanism> mechanism = nullptr);

/// The same machine with other observations in place of the set's, each in the frame (sheet and
/// nuisances) of one of its parts; nuisances that it has beyond the part's come after all columns.
struct FollowUp {
  std::shared_ptr<const observation::Observation> observation;
  std::size_t in_place_of = 0;
};
[[nodiscard]] ObservationSet with_observations(const ObservationSet& set,
                                               std::vector<FollowUp> parts);

/// The parts of one kind. `What` is ChainLengthReadings or TapeDistances.
template <class What>
[[nodiscard]] std::vector<std::pair<const ObservationPart*, const What*>> parts_of(
    const ObservationSet& set) {
  std::vector<std::pair<const ObservationPart*, const What*>> result;
  for (const ObservationPart& part : set.parts) {
    if (const auto* own = dynamic_cast<const What*>(part.observation.get())) {
      result.emplace_back(&part, own);
    }
  }
  return result;
}

/// A machine with its settings somewhere, and where each sheet lies.
struct MachineState {
  model::Machine machine;
  std::vector<model::SheetPlacement> sheets;
  /// Of another mechanism than two chains; then `machine` says nothing.
  std::shared_ptr<const model::Mechanism> mechanism = nullptr;
  [[nodiscard]] model::SheetPlacement sheet_of(const ObservationPart& part) const {
    return part.sheet ? sheets.at(*part.sheet) : model::SheetPlacement{};
  }
  [[nodiscard]] observation::View view(const ObservationPart& part) const {
    if (mechanism) return {mechanism, sheet_of(part)};
    return {model::ReadingModel(machine), sheet_of(part)};
  }
};
[[nodiscard]] MachineState stated_state(const ObservationSet& set);
/// Zeros of other sessions and nuisances are nothing in every state: what they do is linear.
[[nodiscard]] Eigen::VectorXd setting_values(const ObservationSet& set, const MachineState& state);
/// \throws std::invalid_argument for another mechanism than two chains that cannot have these values.
[[nodiscard]] MachineState with_settings(const ObservationSet& set,
                                         MachineState state,
                                         const Eigen::VectorXd& values);
/// The same, or why there is no such machine.
[[nodiscard]] tl::expected<MachineState, model::MachineProblem> moved_to(
    const ObservationSet& set, MachineState state, const Eigen::VectorXd& values);

/// A unit in a workshop's words.
[[nodiscard]] std::string name_of(const ObservationSet& set, std::size_t unit);

}  // namespace chaintrue::grid::estimation
