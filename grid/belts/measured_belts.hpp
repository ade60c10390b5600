// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a router on four belts measures by itself: the lengths of all four at places that nobody
/// measured, and distances that a person taped. The places are unknown and found with the anchors.
///
/// \code
///   MeasuredBelts belts;
///   belts.machine = machine;  // arm, extension, heights; the anchors where they are known
///   belts.points.push_back({.lengths_mm = {998.65, 2400.60, 1631.15, 2729.87}});
///   belts.distances.push_back({.from = Belt::bl, .to = Belt::br, .distance_mm = 3030.0});
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid {

/// How hard the pulled belts were pulled at a place. A motor's current stands for its force: what it
/// takes to turn the motor alone is left out of it.
struct BeltPull {
  enum class Unit { relative, newton, milliampere };
  double value = 1.0;  ///< above 0
  Unit unit = Unit::relative;
  friend bool operator==(const BeltPull&, const BeltPull&) = default;
};

struct BeltPoint {
  /// As the controller prints them, BeltMachine::lengths says what they count.
  model::PerBelt<double> lengths_mm;
  std::optional<model::BedPoint> commanded = std::nullopt;
  /// Number of the visit; all points have it, distinct, or none.
  std::optional<int> order = std::nullopt;
  /// Belts that a motor pulled tight at the reading while the others held; absent: those of the
  /// frame's orientation, the lower two.
  std::optional<std::vector<model::Belt>> pulled = std::nullopt;
  /// All points have it, in one unit, or none: then all were pulled equally.
  std::optional<BeltPull> pull = std::nullopt;
  /// What the log holds of single readings that the controller threw away at this place because
  /// they did not agree.
  model::PerBelt<std::vector<double>> thrown_away_mm{};
};

/// A hole that the machine cut at a commanded place, with the anchors and scales in force.
struct CutHole {
  model::BedPoint commanded;
};
/// An end of a taped distance: a point of the file, an anchor, or a hole.
using BeltEnd = std::variant<std::size_t, model::Belt, CutHole>;

struct BeltDistance {
  BeltEnd from;
  BeltEnd to;
  double distance_mm = 0.0;
  double sigma_mm = 1.0;  ///< one sigma, of the tape and of what its ends stand for
};

/// What the machine's own message said of its fit ("Find Anchors fit: rms=..mm max=..mm").
struct FirmwareFit {
  double rms_mm = 0.0;
  double max_mm = 0.0;
};

struct MeasuredBelts {
  std::string name;
  model::BeltMachine machine;
  std::vector<BeltPoint> points;
  std::vector<BeltDistance> distances;
  std::optional<FirmwareFit> firmware_fit = std::nullopt;
  /// Sizes of effects refer to this pull; absent: to the least of the points.
  std::optional<BeltPull> reference_pull = std::nullopt;
};

/// 2 N - 5 checks of N places: fewer than these leave none to judge by.
inline constexpr std::size_t kFewestBeltPoints = 5;
/// A fit or a check of so many takes some seconds (docs/reliability.md).
inline constexpr std::size_t kMostBeltPoints = 20000;

/// Belts that the firmware pulls at a place: of an upright frame the lower two; of a flat one those
/// behind the last move, at the first six places the lower two. `visit` counts from 0.
[[nodiscard]] std::vector<model::Belt> pulled_after(model::Orientation orientation,
                                                    model::BedPoint from,
                                                    model::BedPoint to,
                                                    std::size_t visit);
/// The lengths alone.
[[nodiscard]] MeasuredBelts without_distances(MeasuredBelts belts);

/// Whether a motor pulled this belt at the reading.
[[nodiscard]] bool is_pulled(const BeltPoint& point, model::Belt belt);
/// The same of all four.
[[nodiscard]] model::PerBelt<bool> pulled_belts(const BeltPoint& point);
/// The pull that sizes of effects refer to; empty where no point has one.
[[nodiscard]] std::optional<BeltPull> reference_pull(const MeasuredBelts& belts);
/// Over `reference`; 1 where either is not known.
[[nodiscard]] double pull_over(const std::optional<BeltPull>& reference, const BeltPoint& point);
/// The different pulls of a session over the reference, in order; {1} where all are equal.
[[nodiscard]] std::vector<double> different_pulls(const MeasuredBelts& belts);
/// "1200 mA", "150 N", "1.6 times".
[[nodiscard]] std::string words_of(const BeltPull& pull);
/// "point 3", "the top left anchor", "the hole at (-900, 300)".
[[nodiscard]] std::string words_of(const BeltEnd& end);

}  // namespace chaintrue::grid
