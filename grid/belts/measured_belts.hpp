// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The measurements of a four-belt router: the lengths of all four belts at unknown places, and
/// distances taped by hand. The places are estimated with the anchors.
///
/// \code
///   MeasuredBelts belts;
///   belts.machine = machine;  // arm, extension, heights; the anchors where they are known
///   belts.points.push_back({.lengths_mm = {998.65, 2400.60, 1631.15, 2729.87}});
///   belts.distances.push_back({.from = Belt::bl, .to = Belt::br, .distance_mm = 3030.0});
/// \endcode
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grid/containers.hpp"
#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid {

/// How hard the pulled belts were pulled at a place. A motor's current measures its force, net of
/// the idle current.
struct BeltPull {
  enum class Unit { relative, newton, milliampere };
  double value = 1.0;  ///< above 0
  Unit unit = Unit::relative;
  friend bool operator==(const BeltPull&, const BeltPull&) = default;
};

struct BeltPoint {
  /// As the controller prints them; BeltMachine::lengths defines what they count.
  PerBelt<double> lengths_mm;
  std::optional<BedPoint> commanded = std::nullopt;
  /// Number of the visit; all points have it, distinct, or none.
  std::optional<int> order = std::nullopt;
  /// Belts that a motor pulled tight at the reading while the others held; absent: those of the
  /// frame's orientation, the lower two.
  std::optional<std::vector<Belt>> pulled = std::nullopt;
  /// All points have it, in one unit, or none: then all were pulled equally.
  std::optional<BeltPull> pull = std::nullopt;
  /// Single readings in the log that the controller discarded at this place because they did not
  /// agree.
  PerBelt<std::vector<double>> thrown_away_mm{};
};

/// A hole that the machine cut at a commanded place, with the anchors and scales in force.
struct CutHole {
  BedPoint commanded;
};
/// An end of a taped distance: a point of the file, an anchor, or a hole.
using BeltEnd = std::variant<std::size_t, Belt, CutHole>;

struct BeltDistance {
  BeltEnd from;
  BeltEnd to;
  double distance_mm = 0.0;
  double sigma_mm = 1.0;  ///< one sigma, of the tape and its ends
};

/// The machine's message about its fit ("Find Anchors fit: rms=..mm max=..mm").
struct FirmwareFit {
  double rms_mm = 0.0;
  double max_mm = 0.0;
};

struct MeasuredBelts {
  std::string name;
  BeltMachine machine;
  std::vector<BeltPoint> points;
  std::vector<BeltDistance> distances;
  std::optional<FirmwareFit> firmware_fit = std::nullopt;
  /// The pull that sizes of effects refer to; absent: the least of the points.
  std::optional<BeltPull> reference_pull = std::nullopt;
};

/// N places give 2 N - 5 checks: with fewer places there are none.
inline constexpr std::size_t kFewestBeltPoints = 5;
/// A fit or check of this many takes some seconds (docs/reliability.md).
inline constexpr std::size_t kMostBeltPoints = 20000;

/// Belts that the firmware pulls at a place: on an upright frame the lower two; on a flat one those
/// behind the last move, and at the first six places the lower two. `visit` counts from 0.
std::vector<Belt> pulled_after(model::Orientation orientation, BedPoint from, BedPoint to,
                               std::size_t visit);
/// The lengths alone.
[[nodiscard]] MeasuredBelts without_distances(MeasuredBelts belts);

/// Whether a motor pulled this belt at the reading.
bool is_pulled(const BeltPoint& point, Belt belt);
/// For all four belts.
PerBelt<bool> pulled_belts(const BeltPoint& point);
/// The pull that sizes of effects refer to; empty if no point has one.
std::optional<BeltPull> reference_pull(const MeasuredBelts& belts);
/// Over `reference`; 1 where either is not known.
double pull_over(const std::optional<BeltPull>& reference, const BeltPoint& point);
/// The different pulls of a session over the reference, in order; {1} where all are equal.
std::vector<double> different_pulls(const MeasuredBelts& belts);
/// "1200 mA", "150 N", "1.6 times".
std::string words_of(const BeltPull& pull);
/// "point 3", "the top left anchor", "the hole at (-900, 300)".
std::string words_of(const BeltEnd& end);

// Numbers of points in their file when others were left out by hand: messages and files keep the
// file's numbers.

/// Each point's index in the file, from 0; empty: none was left out.
using PointIndices = Indices;

inline std::size_t index_in_file(const PointIndices& indices, std::size_t point) {
  return point < indices.size() ? indices[point] : point;
}
/// "point 3" as the file counts, from 1; an anchor, or a hole.
inline std::string words_of(const BeltEnd& end, const PointIndices& indices) {
  const auto* point = std::get_if<std::size_t>(&end);
  return words_of(point != nullptr ? BeltEnd(index_in_file(indices, *point)) : end);
}

}  // namespace chaintrue::grid
