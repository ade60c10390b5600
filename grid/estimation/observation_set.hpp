// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All observations of one machine: their rows one below the other, their places and units numbered
/// through, and the columns of the unknowns with their stated values.
///
/// Columns: the machine's settings, three for each sheet that was placed by hand, two for each
/// session whose chain zeros are its own, the nuisances of each observation. A chain may have been
/// re-hung between two sessions of chain readings: the zeros of all but the first differ from the
/// machine's by an estimated amount. Sets of holes share the machine's zeros: distances hardly
/// determine them, and the five published sets of one machine predict each other worse with
/// separate zeros (0.65 mm left out, 0.60 without). Units (observation.hpp) are those whose
/// readings may be outliers; readings that cannot be outliers have rows and are no units.
///
/// \code
///   const ObservationSet set = observation_set(machine, {points, holes});
///   const MachineState state = stated_state(set);
///   const auto system = linearise(set, ...);       // linearised_system.hpp
/// \endcode
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/single_readings.hpp"
#include "grid/observation/tape_distances.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::estimation {

/// Sigma of values stated without uncertainty, in mm or rad.
inline constexpr double kKnownSigma = 1e-7;

/// Prior sigma of a change of a chain's zero between sessions, mm: a zero set again by eye is
/// within some millimetres. A grid determines it to tenths of a millimetre, so this prior pulls a
/// shift of a whole link only by hundredths.
inline constexpr double kSessionZeroSigmaMm = 3.0;

/// Settings of the machine: the first columns.
inline constexpr auto kMachineSettingCount = std::ssize(kMachineSettings);

/// An observation's share of the rows, places, units and columns.
struct ObservationPart {
  std::shared_ptr<const observation::Observation> observation;
  Index first_row = 0;
  std::size_t first_place = 0;
  std::size_t first_unit = 0;
  std::optional<std::size_t> sheet;  ///< which of the set's; none: the bed's frame
  ColumnSet nuisance_columns;        ///< among all columns
  /// Columns of the zeros of this session minus the machine's; empty for the session that defines
  /// the machine's.
  ColumnSet zero_columns{};
  bool reads_chains() const { return observation->kind().reads_chains; }
};

/// Its index is into the points, or the holes, of all files in their order.
struct NumberedPlace : observation::Place {
  std::size_t part = 0;
};

struct NumberedUnit {
  std::size_t part = 0;
  std::size_t index = 0;  ///< into the points, or the distances, of all files in their order
  Index first_row = 0;
  Index rows = 1;
};

struct ObservationSet;
/// The parts of one kind. `What` is ChainLengthReadings or TapeDistances.
template <class What>
std::vector<std::pair<const ObservationPart*, const What*>> parts_of(const ObservationSet& set);

struct ObservationSet {
  Machine stated;
  /// The mechanism: two chains of `stated`, or another one, which `stated` does not describe.
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<ObservationPart> parts;
  std::vector<NumberedPlace> places;
  std::vector<NumberedUnit> units;
  /// For two chains, those of a sheet once for each; empty for another mechanism.
  std::vector<Setting> settings;
  std::size_t sheets = 0;
  std::size_t own_zeros = 0;  ///< sessions whose chain zeros are their own
  VectorXd stated_value;  ///< q: of the settings and zeros, then of the nuisances, each in its unit
  VectorXd stated_sigma;  ///< q, their sigmas, at least kKnownSigma; infinite: no prior
  Index rows = 0;
  /// Degrees of freedom of the noise: the smallest number among all observations.
  double noise_dof = 15.0;
  bool noise_from_repeats = false;
  /// With fewer units left, none is rejected.
  std::size_t fewest_units = 0;

  /// For the mechanism: the first columns.
  Index parameters() const { return mechanism->values().size(); }
  /// For the mechanism's parameters and the sheets: the first columns.
  Index setting_columns() const { return parameters() + 3 * as_index(sheets); }
  Index nuisances() const {
    return stated_value.size() - setting_columns() - 2 * as_index(own_zeros);
  }

  /// Whether the mechanism is two chains, described by `stated`.
  bool is_of_chains() const { return !settings.empty(); }
  bool reads_chains() const {
    return any_of(parts, [](const ObservationPart& part) { return part.reads_chains(); });
  }

  bool has_distances() const { return !parts_of<observation::TapeDistances>(*this).empty(); }

  /// Chains were read, and the visits' order is known.
  bool ordered() const {
    return any_of(parts, [](const ObservationPart& part) {
      return part.reads_chains() && part.observation->ordered();
    });
  }

  /// The readings of the machine itself, if any.
  const std::vector<ExtraReading>& readings() const {
    static const std::vector<ExtraReading> kNone;
    const auto own = parts_of<observation::SingleReadings>(*this);
    return own.empty() ? kNone : own.front().second->readings();
  }

  /// Whether the readings depend on the setting in this column.
  bool knows(std::size_t column) const {
    if (column >= settings.size() || !model::is_of_sheet(settings[column])) return true;
    return any_of(parts, [&](const ObservationPart& part) {
      return part.sheet && part.observation->sheet() &&
             (column - kMachineSettings.size()) / 3 == *part.sheet &&
             part.observation->sheet()->knows(settings[column]);
    });
  }

  /// The first of the three columns of a sheet.
  static Index sheet_column(std::size_t sheet) {
    return kMachineSettingCount + as_index(model::kSheetSettings.size() * sheet);
  }

  /// Columns of an observation's own settings, as observation::columns_of() has them.
  ColumnSet columns_of(const ObservationPart& part) const {
    ColumnSet columns;
    for (const Index k : each_below(parameters())) columns.push_back(k);
    // Follow-up readings may be in the frame of a sheet that they do not depend on.
    const bool has_sheet = part.sheet && part.observation->sheet();
    for (std::size_t k = 0; has_sheet && k < model::kSheetSettings.size(); ++k)
      columns.push_back(sheet_column(*part.sheet) + as_index(k));
    return columns;
  }

  /// Word for these units: "points", "distances", or "readings" for both.
  std::string_view units_word() const {
    std::string_view word;
    for (const ObservationPart& part : parts) {
      if (!part.observation->may_be_outlier()) continue;
      const std::string_view own = part.observation->kind().units;
      word = word.empty() || word == own ? own : "readings";
    }
    return word;
  }
};

/// In the order of `observations`. The machine's zeros are those of the first session that reads chains.
/// \throws std::invalid_argument for a sheet under a mechanism other than two chains.
ObservationSet observation_set(Machine stated, const observation::Observations& observations,
                               std::shared_ptr<const Mechanism> mechanism = nullptr);

/// The machine with other observations, each in the frame (sheet and nuisances) of one of the set's
/// parts; additional nuisances come after all columns.
struct FollowUp {
  std::shared_ptr<const observation::Observation> observation;
  std::size_t in_place_of = 0;
};
[[nodiscard]] ObservationSet with_observations(const ObservationSet& set,
                                               std::vector<FollowUp> parts);

template <class What>
std::vector<std::pair<const ObservationPart*, const What*>> parts_of(const ObservationSet& set) {
  std::vector<std::pair<const ObservationPart*, const What*>> result;
  for (const ObservationPart& part : set.parts) {
    if (const auto* own = dynamic_cast<const What*>(part.observation.get())) {
      result.emplace_back(&part, own);
    }
  }
  return result;
}

/// A mechanism with its values, and each sheet's placement.
struct MachineState {
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<SheetPlacement> sheets;

  /// Of two chains. \throws std::logic_error for another mechanism.
  const Machine& machine() const { return observation::View(mechanism).chains().machine(); }
  observation::View view(const ObservationPart& part) const {
    return {mechanism, part.sheet ? sheets.at(*part.sheet) : SheetPlacement{}};
  }
};
MachineState stated_state(const ObservationSet& set);
/// Zeros of other sessions and nuisances are 0 in every state: their effect is linear.
VectorXd setting_values(const ObservationSet& set, const MachineState& state);
/// \throws std::invalid_argument for values that such a mechanism cannot have.
[[nodiscard]] MachineState with_settings(const ObservationSet& set, MachineState state,
                                         const VectorXd& values);
/// The same, but returns a message for values that such a mechanism cannot have.
[[nodiscard]] tl::expected<MachineState, std::string> moved_to(const ObservationSet& set,
                                                               MachineState state,
                                                               const VectorXd& values);

/// Words for a unit.
std::string name_of(const ObservationSet& set, std::size_t unit);

}  // namespace chaintrue::grid::estimation
