// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/next_candidates.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kApartMm = 200.0;  ///< neighbouring holes are redundant
/// A new hole is measured to this many others: two place it, the third checks it.
constexpr std::size_t kArms = 3;

class HoleCandidates {
 public:
  HoleCandidates(const Analysis& a, const observation::TapeDistances& tape, std::size_t part)
      : a_(a),
        part_(part),
        measured_(tape.set()),
        set_(measured_) {
    set_.distances.clear();
    add_pairs();
    add_edges();
    add_holes();
  }

  [[nodiscard]] std::optional<CandidateReadings> take() {
    if (candidates_.empty()) return std::nullopt;
    auto tape = observation::TapeDistances::in_given_order(std::move(set_));
    if (!tape) return std::nullopt;
    return CandidateReadings{
        {std::make_shared<const observation::TapeDistances>(*std::move(tape)), part_},
        std::move(candidates_)};
  }

 private:
  [[nodiscard]] bool is_measured(const HoleDistance& wanted) const {
    return any_of(measured_.distances, [&](const HoleDistance& d) {
      if (d.edge != wanted.edge) return false;
      if (d.edge) return d.from == wanted.from;
      return std::minmax(d.from, d.to) == std::minmax(wanted.from, wanted.to);
    });
  }

  void add(HoleDistance distance) {
    if (is_measured(distance)) return;
    NextMeasurement next{MeasurementKind::distance,
                         fmt::format("the distance {}", words_of(measured_, distance)),
                         "",
                         std::nullopt,
                         measured_.tape.sigma_mm};
    next.from = measured_.holes[distance.from].name;
    next.to = {distance.edge ? std::string(grid::name(*distance.edge))
                             : measured_.holes[distance.to].name};
    candidates_.push_back({std::move(next), {std::ssize(set_.distances)}, 1});
    set_.distances.push_back(distance);
  }

  void add_pairs() {
    for (std::size_t i = 0; i < measured_.holes.size(); ++i) {
      for (std::size_t j = i + 1; j < measured_.holes.size(); ++j) add({.from = i, .to = j});
    }
  }

  /// To edges only if some were measured before: a first one only places the sheet.
  void add_edges() {
    const bool edged =
        any_of(measured_.distances, [](const HoleDistance& d) { return d.edge.has_value(); });
    if (!edged) return;
    for (std::size_t i = 0; i < measured_.holes.size(); ++i) {
      for (const SheetEdge edge : kSheetEdges) add({.from = i, .edge = edge});
    }
  }

  /// The existing holes, the farthest from a place first.
  [[nodiscard]] std::vector<std::size_t> by_distance(const model::BedPoint& place) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < measured_.holes.size(); ++i) order.push_back(i);
    const auto squared = [&](std::size_t i) {
      const model::BedPoint& hole = measured_.holes[i].commanded;
      return std::pow(hole.x_mm - place.x_mm, 2) + std::pow(hole.y_mm - place.y_mm, 2);
    };
    stable_sort(order, descending(squared));
    return order;
  }

  [[nodiscard]] bool can_be_cut(const Hole& hole) const {
    MeasuredHoles alone = measured_;
    alone.holes = {hole};
    alone.distances.clear();
    const auto one = observation::TapeDistances::in_given_order(std::move(alone));
    return one && one->placed(a_.state.view(a_.session.parts[part_]));
  }

  void add_hole(const model::BedPoint& place) {
    const std::vector<std::size_t> others = by_distance(place);
    const model::BedPoint& nearest = measured_.holes[others.back()].commanded;
    if (std::hypot(nearest.x_mm - place.x_mm, nearest.y_mm - place.y_mm) < kApartMm) return;
    const Hole hole{fmt::format("({:.0f}, {:.0f})", place.x_mm + 0.0, place.y_mm + 0.0), place};
    if (!can_be_cut(hole)) return;
    Candidate candidate{{MeasurementKind::distance,
                         "",
                         "",
                         model::identity_placement(place),
                         measured_.tape.sigma_mm},
                        {},
                        1};
    for (std::size_t k = 0; k < std::min(kArms, others.size()); ++k) {
      candidate.rows.push_back(std::ssize(set_.distances));
      set_.distances.push_back({.from = set_.holes.size(), .to = others[k]});
      candidate.measurement.to.push_back(measured_.holes[others[k]].name);
    }
    candidate.measurement.words = fmt::format(
        "a new hole at {}, measured to {}", hole.name, fmt::join(candidate.measurement.to, ", "));
    candidates_.push_back(std::move(candidate));
    set_.holes.push_back(hole);
  }

  void add_holes() {
    double x = 0.0;
    double y = 0.0;
    for (const Hole& hole : measured_.holes) {
      x = std::max(x, std::abs(hole.commanded.x_mm));
      y = std::max(y, std::abs(hole.commanded.y_mm));
    }
    for (const model::MarkPoint& place : raster({-x, x, -y, y}, 7, 4, RasterOf::nodes))
      add_hole({std::round(place.x_mm), std::round(place.y_mm)});
  }

  const Analysis& a_;
  std::size_t part_;
  const MeasuredHoles& measured_;
  MeasuredHoles set_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::optional<CandidateReadings> candidate_distances(const Analysis& a, std::size_t part) {
  const auto* tape =
      dynamic_cast<const observation::TapeDistances*>(a.session.parts[part].observation.get());
  if (tape == nullptr) return std::nullopt;
  return HoleCandidates(a, *tape, part).take();
}

}  // namespace chaintrue::grid::diagnosis
