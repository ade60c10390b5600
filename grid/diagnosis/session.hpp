// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What was measured as a diagnosis sees it, in an order that does not depend on the file's: the
/// observations of one machine one below the other, the settings with what is stated of them, the
/// nuisances.
///
/// Columns stand in this order: the machine's settings, three of each sheet that somebody laid, the
/// nuisances of each observation. Units (observation.hpp) are numbered through; readings of the
/// machine itself, which never slip, come last and are no units.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/options.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/measured.hpp"
#include "grid/observation/single_readings.hpp"
#include "grid/observation/tape_distances.hpp"

namespace chaintrue::grid::diagnosis {

/// Where an observation stands among all.
struct SessionPart {
  std::shared_ptr<const observation::Observation> observation;
  Eigen::Index first_row = 0;
  std::size_t first_place = 0;
  std::size_t first_unit = 0;
  std::optional<std::size_t> sheet;            ///< which of the session's; none: the bed's frame
  std::vector<Eigen::Index> nuisance_columns;  ///< among all columns
  [[nodiscard]] bool reads_chains() const { return observation->kind().reads_chains; }
};

struct SessionPlace {
  std::size_t part = 0;
  std::size_t index = 0;  ///< into the points, or the holes, of all files in their order
  model::MarkPoint mark;
  model::ChainLengths lengths;
  int order = 0;
};

struct SessionUnit {
  std::size_t part = 0;
  std::size_t index = 0;  ///< into the points, or the distances, of all files in their order
  Eigen::Index first_row = 0;
  Eigen::Index rows = 1;
};

struct Session {
  model::Machine stated;
  std::vector<SessionPart> parts;
  std::vector<SessionPlace> places;
  std::vector<SessionUnit> units;
  std::vector<model::Setting> settings;  ///< those of a sheet once for each
  std::size_t sheets = 0;
  Eigen::VectorXd stated_value;  ///< q: of the settings, then of the nuisances, each in its unit
  Eigen::VectorXd stated_sigma;  ///< q, one sigma of these
  Eigen::Index rows = 0;
  Eigen::Index observed_rows = 0;  ///< those of units
  /// How well the noise is known; of several observations that of the one that knows least.
  double noise_dof = 15.0;
  bool noise_from_repeats = false;
  /// With fewer units left, none is set aside.
  std::size_t fewest_units = 0;

  [[nodiscard]] Eigen::Index nuisances() const {
    return stated_value.size() - static_cast<Eigen::Index>(settings.size());
  }
  [[nodiscard]] bool reads_chains() const;
  [[nodiscard]] bool has_distances() const;
  /// Chains were read, and the visits' order is known.
  [[nodiscard]] bool ordered() const;
  [[nodiscard]] bool ordered(const SessionPlace& place) const {
    return parts[place.part].observation->ordered();
  }
  /// The readings of the machine itself; none where there are none.
  [[nodiscard]] const std::vector<ExtraReading>& readings() const;
  /// Whether the readings know of the setting in this column at all.
  [[nodiscard]] bool knows(std::size_t column) const;
  /// The first of the three columns of a sheet.
  [[nodiscard]] static Eigen::Index sheet_column(std::size_t sheet);
  /// What these units are together: "points", "distances", "readings" where there are both.
  [[nodiscard]] std::string_view units_word() const;
};

/// The parts of one kind. `What` is ChainLengthReadings or TapeDistances.
template <class What>
[[nodiscard]] std::vector<std::pair<const SessionPart*, const What*>> parts_of(
    const Session& session) {
  std::vector<std::pair<const SessionPart*, const What*>> result;
  for (const SessionPart& part : session.parts) {
    if (const auto* own = dynamic_cast<const What*>(part.observation.get())) {
      result.emplace_back(&part, own);
    }
  }
  return result;
}

/// Fewer points leave nothing to judge a cause by once the settings have taken their share.
inline constexpr std::size_t kFewestPoints = 8;
/// Distances tell four of the six settings; two more for a cause, two to doubt it by.
inline constexpr std::size_t kFewestDistances = 8;
/// Of which so many must stay when bad ones are set aside.
inline constexpr std::size_t kFewestGoodDistances = 6;

/// Points and distances of one machine, in any mix; the machine is that of the first file. Fails in
/// words where there is no machine, too little was measured, or a command is out of reach.
[[nodiscard]] tl::expected<Session, DiagnosisFailure> make_session(const Measured& measured);

/// The same machine with other observations in place of the session's, each in the frame (sheet and
/// nuisances) of one of its parts; nuisances that it has beyond the part's come after all columns.
struct FollowUp {
  std::shared_ptr<const observation::Observation> observation;
  std::size_t in_place_of = 0;
};
[[nodiscard]] Session with_observations(const Session& session, std::vector<FollowUp> parts);

/// A machine with its settings somewhere, and where each sheet lies.
struct State {
  model::Machine machine;
  std::vector<model::SheetPlacement> sheets;
  [[nodiscard]] model::SheetPlacement sheet_of(const SessionPart& part) const {
    return part.sheet ? sheets.at(*part.sheet) : model::SheetPlacement{};
  }
  [[nodiscard]] observation::View view(const SessionPart& part) const {
    return {model::ReadingModel(machine), sheet_of(part)};
  }
};
[[nodiscard]] State stated_state(const Session& session);
/// Nuisances are nothing in every state.
[[nodiscard]] Eigen::VectorXd setting_values(const Session& session, const State& state);
[[nodiscard]] State with_settings(const Session& session,
                                  State state,
                                  const Eigen::VectorXd& values);

/// A unit in a workshop's words.
[[nodiscard]] std::string name_of(const Session& session, std::size_t unit);

}  // namespace chaintrue::grid::diagnosis
