// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_measurements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/law_model.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/raster.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kTapeErrorSigmaMmPerM = 0.15;  // two metres to 0.3 mm, a good tape's tolerance

/// One observation of candidates; `rows` are its own.
struct CandidateReadings {
  FollowUp observation;
  std::vector<Candidate> all;
};

/// One more visit of a mark each: over the bed, as far as the sheet was measured and slightly beyond,
/// and of marks that were visited in a known order.
CandidateReadings candidate_points(const Analysis& a, std::size_t part) {
  const observation::Observation& own = *a.session.parts[part].observation;
  int next_visit = 1;
  for (const Place& p : own.places()) next_visit = std::max(next_visit, p.order + 1);
  std::vector<Place> places;
  std::vector<Candidate> all;
  const auto add = [&](MarkPoint mark, MeasurementKind kind, std::string what) {
    const auto row = 2 * std::ssize(places);
    places.push_back({0, "", mark, {}, next_visit});
    all.push_back({{kind, std::move(what), "", mark, 0.0}, {row, row + 1}, 2});
  };
  const observation::View view = a.state.view(a.session.parts[part]);
  const interp::Rectangle area = marked_area(a.session);
  const Bed& bed = a.session.stated.bed;
  const double x = std::min(1.1 * std::max(-area.x_min, area.x_max), 0.49 * bed.width_mm);
  const double y = std::min(1.1 * std::max(-area.y_min, area.y_max), 0.49 * bed.height_mm);
  for (const MarkPoint& place : raster({-x, x, -y, y}, 20, 12, RasterOf::nodes)) {
    // Whole millimetres: the list is for a person with a tape.
    const MarkPoint mark{std::round(place.x_mm), std::round(place.y_mm)};
    if (view.chains().at(view.sheet.to_bed(mark))) add(mark, MeasurementKind::point, "a new point");
  }
  if (own.ordered()) {
    const Place& first = own.places().front();
    add(first.mark, MeasurementKind::revisit,
        fmt::format("point {}, the first of the session, again", first.index + 1));
    const Place& middle = own.places()[own.places().size() / 2];
    add(middle.mark, MeasurementKind::revisit,
        fmt::format("point {} again, coming from the other side", middle.index + 1));
  }
  // Each is a next visit; their order is arbitrary.
  return {readings_at(a.session, part, std::move(places)), std::move(all)};
}

/// Readings of the machine that were not taken, with the sigma that careful work with usual tools
/// reaches.
std::optional<CandidateReadings> candidate_readings(const ObservationSet& session) {
  std::vector<ExtraReading> readings = {
      {ReadingOf::motor_spacing, "", 0.0, 1.0},
      {ReadingOf::beam_rise, "", 0.0, 1.0},
      {ReadingOf::ring_radius, "", 0.0, 0.5},
      {ReadingOf::link_pitch, "left", 0.0, kLinkPitchSigmaMm},
      {ReadingOf::link_pitch, "right", 0.0, kLinkPitchSigmaMm},
      {ReadingOf::chain_mass, "", 0.0, 0.002},
      {ReadingOf::tape_error, "x", 0.0, kTapeErrorSigmaMmPerM},
      {ReadingOf::tape_error, "y", 0.0, kTapeErrorSigmaMmPerM},
  };
  std::erase_if(readings, [&](const ExtraReading& own) {
    return !observation::is_predictable(session.stated, own) ||
           any_of(session.readings(), [&](const ExtraReading& taken) {
             return taken.what == own.what && taken.side == own.side;
           });
  });
  if (readings.empty()) return std::nullopt;
  const auto observation = std::make_shared<const observation::SingleReadings>(std::move(readings));
  std::vector<Candidate> all;
  for (const ExtraReading& own : observation->readings()) {
    NextMeasurement next{MeasurementKind::reading, "", own.side, std::nullopt, own.sigma};
    next.reading = own.what;
    all.push_back({std::move(next), {std::ssize(all)}, 1});
  }
  return CandidateReadings{{observation, 0}, std::move(all)};
}

constexpr double kApartMm = 200.0;  ///< neighbouring holes are redundant
/// A new hole is measured to this many others: two place it, the third checks it.
constexpr std::size_t kArms = 3;

class HoleCandidates {
 public:
  HoleCandidates(const Analysis& a, const TapeDistances& tape, std::size_t part)
      : a_(a), part_(part), measured_(tape.set()), set_(measured_) {
    set_.distances.clear();
    add_pairs();
    add_edges();
    add_holes();
  }

  std::optional<CandidateReadings> take() {
    if (candidates_.empty()) return std::nullopt;
    auto tape = TapeDistances::in_given_order(std::move(set_));
    if (!tape) return std::nullopt;
    return CandidateReadings{{std::make_shared<const TapeDistances>(*std::move(tape)), part_},
                             std::move(candidates_)};
  }

 private:
  void add(HoleDistance distance) {
    if (is_measured(measured_, distance)) return;
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
    for (const auto i : each_index(measured_.holes)) {
      for (std::size_t j = i + 1; j < measured_.holes.size(); ++j) add({.from = i, .to = j});
    }
  }

  /// To edges only if some were measured before: a first one only places the sheet.
  void add_edges() {
    const bool edged = any_of(measured_.distances, &HoleDistance::edge);
    if (!edged) return;
    for (const auto i : each_index(measured_.holes)) {
      for (const SheetEdge edge : kSheetEdges) add({.from = i, .edge = edge});
    }
  }

  /// The existing holes, the farthest from a place first.
  Indices by_distance(const BedPoint& place) const {
    Indices order = numbers_below(measured_.holes.size());
    stable_sort(order, descending([&](std::size_t i) {
                  return distance_mm(measured_.holes[i].commanded, place);
                }));
    return order;
  }

  bool can_be_cut(const Hole& hole) const {
    MeasuredHoles alone = measured_;
    alone.holes = {hole};
    alone.distances.clear();
    const auto one = TapeDistances::in_given_order(std::move(alone));
    return one && one->placed(a_.state.view(a_.session.parts[part_]));
  }

  void add_hole(const BedPoint& place) {
    const Indices others = by_distance(place);
    if (distance_mm(measured_.holes[others.back()].commanded, place) < kApartMm) return;
    const Hole hole{fmt::format("({:.0f}, {:.0f})", place.x_mm + 0.0, place.y_mm + 0.0), place};
    if (!can_be_cut(hole)) return;
    Candidate candidate{
        {MeasurementKind::distance, "", "", identity_placement(place), measured_.tape.sigma_mm},
        {},
        1};
    for (const std::size_t k : each_below(std::min(kArms, others.size()))) {
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
    for (const MarkPoint& place : raster({-x, x, -y, y}, 7, 4, RasterOf::nodes))
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
  for (const auto part : each_index(a.session.parts)) {
    const ObservationPart& own = a.session.parts[part];
    // Another point is set out on the first sheet.
    if (own.reads_chains() && !chains_read) {
      take(candidate_points(a, part));
      chains_read = true;
    }
    const auto* tape = dynamic_cast<const TapeDistances*>(own.observation.get());
    if (tape != nullptr) take(HoleCandidates(a, *tape, part).take());
  }
  take(candidate_readings(a.session));
  return {with_observations(a.session, std::move(observations)), std::move(all)};
}

namespace {

/// Above this probability of no cause, no more measurements are needed: the median session of 28
/// points without a cause gives 0.93.
constexpr double kLeftAlone = 0.9;
constexpr double kPays = 0.002;  // a measurement that helps less is not worth the effort

/// The reading that separates members of one class, which no points can: a chain's links.
void add_link_reading(const Analysis& a, std::vector<NextMeasurement>& list) {
  if (a.decision.listed.empty() || list.size() >= kMostNextMeasurements) return;
  const CauseClass& members = a.decision.classes[a.decision.listed.front()];
  const bool pitch = any_of(members, [](const CauseId& c) {
    return c.effect->elongation != nullptr && c.effect->law == nullptr;
  });
  if (members.size() < 2 || !pitch ||
      any_of(list, having(&NextMeasurement::reading, ReadingOf::link_pitch)) ||
      any_of(a.session.readings(), having(&ExtraReading::what, ReadingOf::link_pitch))) {
    return;
  }
  NextMeasurement reading{MeasurementKind::reading, "", "left", std::nullopt, kLinkPitchSigmaMm};
  reading.reading = ReadingOf::link_pitch;
  reading.raises_probability_to = list.empty()
                                      ? a.decision.probability_of(a.decision.listed.front())
                                      : list.back().raises_probability_to;
  list.push_back(std::move(reading));
}

/// For the most probable group.
double share_of_best(const std::vector<Alternative>& alternatives) {
  double sum = 0.0;
  for (const Alternative& one : alternatives) sum += one.group == 0 ? one.probability : 0.0;
  return sum;
}

}  // namespace

bool is_left_alone(const Analysis& a, const std::vector<Alternative>& alternatives) {
  return alternatives.empty() ||
         (a.decision.listed.empty() && share_of_best(alternatives) > kLeftAlone);
}

std::vector<NextMeasurement> most_telling(const std::vector<Alternative>& alternatives,
                                          std::vector<Candidate> options) {
  std::vector<NextMeasurement> result;
  Rows chosen;
  ExpectedDiscrimination now = expected_discrimination(alternatives, chosen);
  double reached = now.named_alone;
  while (result.size() < kMostNextMeasurements && reached < kEnough) {
    std::size_t best = options.size();
    ExpectedDiscrimination then = now;
    for (const auto c : each_index(options)) {
      if (options[c].times == 0) continue;
      Rows more = chosen;
      append_all(more, options[c].rows);
      const ExpectedDiscrimination tried = expected_discrimination(alternatives, more);
      if (tried.confusion < then.confusion) {
        then = tried;
        best = c;
      }
    }
    if (best == options.size() || now.confusion - then.confusion < kPays * now.confusion) break;
    options[best].times -= 1;
    append_all(chosen, options[best].rows);
    // The Gaussian approximation may dip when the first points only raise doubts; on average more
    // data never make the right name less likely.
    reached = std::max(reached, then.named_alone);
    result.push_back(options[best].measurement);
    result.back().raises_probability_to = reached;
    now = then;
  }
  return result;
}

std::vector<NextMeasurement> next_measurements(const Analysis& a) {
  if (is_left_alone(a, alternatives_of_best(a))) return {};
  std::vector<NextMeasurement> result;
  if (a.decision.verdict != Verdict::named) {
    NextCandidates next = next_candidates(a);
    const auto alternatives = alternatives_about(a, next.session);
    if (!alternatives) return {};
    result = most_telling(*alternatives, std::move(next.all));
  }
  add_link_reading(a, result);
  return result;
}

std::vector<NextMeasurement> next_for_laws(const Analysis& a, const LawsFound& found) {
  if (found.laws.empty() || found.laws.front().probability >= kEnough) return {};
  NextCandidates next = next_candidates(a);
  const auto system = linearise(next.session, a.state);
  if (!system) return {};
  std::vector<Alternative> alternatives;
  // The prediction by a model of these causes and a law's amplitudes, with its columns there.
  const auto add = [&](const LawModel& model, const RegressorSet& causes, const MatrixXd& law,
                       double probability) {
    MatrixXd columns = MatrixXd::Zero(system->e.size(), std::ssize(causes) + law.cols());
    for (const auto k : each_index(causes)) {
      if (const auto g = signature(next.session, a.state, *system, regressor(a, causes[k])))
        columns.col(as_index(k)) = *g;
    }
    columns.rightCols(law.cols()) = law;
    Alternative one = model.expected_of(*system, columns);
    one.group = alternatives.size();
    one.probability = probability;
    alternatives.push_back(std::move(one));
  };
  double none = 1.0;
  for (const auto k : each_index(found.laws)) {
    const WeighedLaw& law = found.heaviest[k];
    add(model_with(a, law), law.with.causes, law.columns(*system), found.laws[k].probability);
    none -= found.laws[k].probability;
  }
  // Averaging over parts of the bed may leave almost no weight for the rest.
  constexpr double kLeastOfNone = 0.01;
  const WeighedLaw& first = found.heaviest.front();
  add(model_without(a, first), first.without.causes, MatrixXd(system->e.size(), 0),
      std::max(none, kLeastOfNone));
  normalise(alternatives);
  return most_telling(alternatives, std::move(next.all));
}

}  // namespace chaintrue::grid::diagnosis
