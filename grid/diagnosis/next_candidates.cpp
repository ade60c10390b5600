// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_candidates.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "grid/eigen.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Readings of the machine, with the sigma that careful work with usual tools reaches.
struct MachineReading {
  ReadingOf what;
  const char* side;
  double sigma;
};
constexpr double kTapeErrorSigmaMmPerM = 0.15;  // two metres to 0.3 mm, a good tape's tolerance
constexpr MachineReading kReadings[] = {
    {ReadingOf::motor_spacing, "", 1.0},
    {ReadingOf::beam_rise, "", 1.0},
    {ReadingOf::ring_radius, "", 0.5},
    {ReadingOf::link_pitch, "left", kLinkPitchSigmaMm},
    {ReadingOf::link_pitch, "right", kLinkPitchSigmaMm},
    {ReadingOf::chain_mass, "", 0.002},
    {ReadingOf::tape_error, "x", kTapeErrorSigmaMmPerM},
    {ReadingOf::tape_error, "y", kTapeErrorSigmaMmPerM},
};

/// All measurements at a mark, one more visit each.
class PointCandidates {
 public:
  PointCandidates(const Analysis& a, std::size_t part)
      : session_(a.session),
        part_(part),
        own_(dynamic_cast<const observation::ChainLengthReadings&>(
            *a.session.parts[part].observation)),
        model_(a.state.machine),
        sheet_(a.state.sheet_of(a.session.parts[part])) {
    for (const observation::Place& p : own_.places()) next_visit_ = std::max(next_visit_, p.order);
    ++next_visit_;
    add_points();
    add_revisits();
  }

  CandidateReadings take() {
    // Each is a next visit; their order is arbitrary.
    return {{std::make_shared<const observation::ChainLengthReadings>(
                 observation::ChainLengthReadings::in_given_order(
                     std::move(places_), false, own_.noise(), own_.noise_dof(), own_.sheet())),
             part_},
            std::move(candidates_)};
  }

 private:
  void add(model::MarkPoint mark, MeasurementKind kind, std::string what) {
    const auto row = 2 * std::ssize(places_);
    places_.push_back({0, "", mark, {}, next_visit_});
    candidates_.push_back({{kind, std::move(what), "", mark, 0.0}, {row, row + 1}, 2});
  }

  /// Over the bed, as far as the sheet was measured and slightly beyond.
  void add_points() {
    double x = 0.0;
    double y = 0.0;
    for (const observation::Place& p : own_.places()) {
      x = std::max(x, std::abs(p.mark.x_mm));
      y = std::max(y, std::abs(p.mark.y_mm));
    }
    x = std::min(1.1 * x, 0.49 * session_.stated.bed.width_mm);
    y = std::min(1.1 * y, 0.49 * session_.stated.bed.height_mm);
    for (const model::MarkPoint& place : raster({-x, x, -y, y}, 20, 12, RasterOf::nodes)) {
      // Whole millimetres: the list is for a person with a tape.
      const model::MarkPoint mark{std::round(place.x_mm), std::round(place.y_mm)};
      if (model_.at(sheet_.to_bed(mark))) add(mark, MeasurementKind::point, "a new point");
    }
  }

  void add_revisits() {
    if (!own_.ordered()) return;
    const observation::Place& first = own_.places().front();
    add(first.mark, MeasurementKind::revisit,
        fmt::format("point {}, the first of the session, again", first.index + 1));
    const observation::Place& middle = own_.places()[own_.places().size() / 2];
    add(middle.mark, MeasurementKind::revisit,
        fmt::format("point {} again, coming from the other side", middle.index + 1));
  }

  const ObservationSet& session_;
  std::size_t part_;
  const observation::ChainLengthReadings& own_;
  model::ReadingModel model_;
  model::SheetPlacement sheet_;
  int next_visit_ = 0;
  std::vector<observation::Place> places_;
  std::vector<Candidate> candidates_;
};

/// Readings of the machine that were not taken.
std::optional<CandidateReadings> candidate_readings(const ObservationSet& session) {
  const std::vector<ExtraReading>& taken = session.readings();
  std::vector<ExtraReading> readings;
  for (const MachineReading& r : kReadings) {
    const bool done =
        any_of(taken, [&](const ExtraReading& x) { return x.what == r.what && x.side == r.side; });
    const ExtraReading reading{r.what, r.side, 0.0, r.sigma};
    if (!done && observation::is_predictable(session.stated, reading)) readings.push_back(reading);
  }
  if (readings.empty()) return std::nullopt;
  const auto observation =
      std::make_shared<const observation::SingleReadings>(observation::SingleReadings(readings));
  std::vector<Candidate> candidates;
  for (const ExtraReading& r : readings) {
    const auto& sorted = observation->readings();
    const auto at = std::find_if(sorted.begin(), sorted.end(), [&](const ExtraReading& x) {
      return x.what == r.what && x.side == r.side;
    });
    NextMeasurement next{MeasurementKind::reading, "", r.side, std::nullopt, r.sigma};
    next.reading = r.what;
    candidates.push_back({std::move(next), {at - sorted.begin()}, 1});
  }
  return CandidateReadings{{observation, 0}, std::move(candidates)};
}

constexpr double kApartMm = 200.0;  ///< neighbouring holes are redundant
/// A new hole is measured to this many others: two place it, the third checks it.
constexpr std::size_t kArms = 3;

class HoleCandidates {
 public:
  HoleCandidates(const Analysis& a, const observation::TapeDistances& tape, std::size_t part)
      : a_(a), part_(part), measured_(tape.set()), set_(measured_) {
    set_.distances.clear();
    add_pairs();
    add_edges();
    add_holes();
  }

  std::optional<CandidateReadings> take() {
    if (candidates_.empty()) return std::nullopt;
    auto tape = observation::TapeDistances::in_given_order(std::move(set_));
    if (!tape) return std::nullopt;
    return CandidateReadings{
        {std::make_shared<const observation::TapeDistances>(*std::move(tape)), part_},
        std::move(candidates_)};
  }

 private:
  bool is_measured(const HoleDistance& wanted) const {
    return any_of(measured_.distances, [&](const HoleDistance& d) {
      if (d.edge != wanted.edge) return false;
      if (d.edge) return d.from == wanted.from;
      return std::minmax(d.from, d.to) == std::minmax(wanted.from, wanted.to);
    });
  }

  void add(HoleDistance distance) {
    if (is_measured(distance)) return;
    NextMeasurement next{MeasurementKind::distance,
                         fmt::format("the distance {}", words_of(measured_, distance)), "",
                         std::nullopt, measured_.tape.sigma_mm};
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
  Indices by_distance(const model::BedPoint& place) const {
    Indices order;
    for (std::size_t i = 0; i < measured_.holes.size(); ++i) order.push_back(i);
    const auto squared = [&](std::size_t i) {
      const model::BedPoint& hole = measured_.holes[i].commanded;
      return std::pow(hole.x_mm - place.x_mm, 2) + std::pow(hole.y_mm - place.y_mm, 2);
    };
    stable_sort(order, descending(squared));
    return order;
  }

  bool can_be_cut(const Hole& hole) const {
    MeasuredHoles alone = measured_;
    alone.holes = {hole};
    alone.distances.clear();
    const auto one = observation::TapeDistances::in_given_order(std::move(alone));
    return one && one->placed(a_.state.view(a_.session.parts[part_]));
  }

  void add_hole(const model::BedPoint& place) {
    const Indices others = by_distance(place);
    const model::BedPoint& nearest = measured_.holes[others.back()].commanded;
    if (std::hypot(nearest.x_mm - place.x_mm, nearest.y_mm - place.y_mm) < kApartMm) return;
    const Hole hole{fmt::format("({:.0f}, {:.0f})", place.x_mm + 0.0, place.y_mm + 0.0), place};
    if (!can_be_cut(hole)) return;
    Candidate candidate{{MeasurementKind::distance, "", "", model::identity_placement(place),
                         measured_.tape.sigma_mm},
                        {},
                        1};
    for (std::size_t k = 0; k < std::min(kArms, others.size()); ++k) {
      candidate.rows.push_back(std::ssize(set_.distances));
      set_.distances.push_back({.from = set_.holes.size(), .to = others[k]});
      candidate.measurement.to.push_back(measured_.holes[others[k]].name);
    }
    candidate.measurement.words = fmt::format("a new hole at {}, measured to {}", hole.name,
                                              fmt::join(candidate.measurement.to, ", "));
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

NextCandidates next_candidates(const Analysis& a) {
  std::vector<FollowUp> observations;
  std::vector<Candidate> all;
  Index rows = 0;
  const auto take = [&](std::optional<CandidateReadings> more) {
    if (!more) return;
    for (Candidate& candidate : more->all) {
      for (Index& row : candidate.rows) row += rows;
      all.push_back(std::move(candidate));
    }
    rows += more->observation.observation->rows();
    observations.push_back(std::move(more->observation));
  };
  bool chains_read = false;
  for (std::size_t part = 0; part < a.session.parts.size(); ++part) {
    // Another point is set out on the first sheet.
    if (a.session.parts[part].reads_chains() && !chains_read) {
      take(PointCandidates(a, part).take());
      chains_read = true;
    }
    if (!a.session.parts[part].reads_chains()) take(candidate_distances(a, part));
  }
  take(candidate_readings(a.session));
  return {with_observations(a.session, std::move(observations)), std::move(all)};
}

std::optional<CandidateReadings> candidate_distances(const Analysis& a, std::size_t part) {
  const auto* tape =
      dynamic_cast<const observation::TapeDistances*>(a.session.parts[part].observation.get());
  if (tape == nullptr) return std::nullopt;
  return HoleCandidates(a, *tape, part).take();
}

}  // namespace chaintrue::grid::diagnosis
