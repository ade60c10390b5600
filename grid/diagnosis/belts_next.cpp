// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/belts_analysis.hpp"

#include <fmt/format.h>

#include "grid/diagnosis/next_measurements.hpp"
#include "grid/raster.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// Share of the frame's width and height left out on each side: nearer to an anchor the arm is in
/// the way.
constexpr double kMargin = 0.14;
/// Rounded to multiples of ten, which are easy to type; a neighbouring place is as informative.
constexpr double kRasterMm = 10.0;
/// Places of the session that may be revisited, spread over it.
constexpr std::size_t kRevisits = 5;
/// Pull of a second pass over the first: the firmware's usual current can be raised by this much.
constexpr double kHarder = 1.6;
constexpr std::string_view kFurtherPlace = "a further place";
/// At most this many places are predicted in a full repeat, which takes a second.
constexpr std::size_t kMostOnceMore = 200;

/// Belts that are pulled on the way to a place, and that way in words.
struct Approach {
  std::string_view words;
  std::optional<std::vector<Belt>> pulled;
};
std::vector<Approach> approaches(model::Orientation orientation) {
  if (orientation != model::Orientation::flat) return {{"", std::nullopt}};
  return {{", coming from the left", {{Belt::tl, Belt::bl}}},
          {", coming from the right", {{Belt::tr, Belt::br}}},
          {", coming from above", {{Belt::tl, Belt::tr}}},
          {", coming from below", {{Belt::bl, Belt::br}}}};
}

/// Future places, one more visit each, with their proposed readings, and the state that predicts their
/// readings.
class NextPlaces {
 public:
  /// Belts are pulled `times` as hard as at the measured places.
  explicit NextPlaces(const BeltsAnalysis& a, double times = 1.0) : a_(a), times_(times) {
    belts.machine = with_anchors(a.belts.machine, a.frame.state.anchors);
    belts.reference_pull = reference_pull(a.belts).value_or(BeltPull{});
    state.anchors = a.frame.state.anchors;
    for (const BeltPoint& point : a.belts.points) {
      if (point.order) next_visit = std::max(next_visit.value_or(0), *point.order + 1);
    }
  }

  /// True if the machine reaches it. The default pull is the one that sizes refer to.
  bool add(FramePoint at, const std::optional<std::vector<Belt>>& pulled,
           const std::optional<BeltPull>& pull = std::nullopt) {
    const auto lengths = lengths_at(belts.machine, at);
    if (!lengths) return false;
    BeltPoint point;
    point.lengths_mm = *lengths;
    point.pulled = pulled;
    point.pull = pull.value_or(*belts.reference_pull);
    point.pull->value *= times_;
    point.order = next_visit;
    belts.points.push_back(std::move(point));
    state.places.push_back(at);
    return true;
  }

  /// The place added last; its rows are filled in by the prediction.
  void propose(MeasurementKind kind, std::string what, BedPoint command) {
    Candidate candidate{{kind, std::move(what), "", identity_placement(command), 0.0}, {}, 2};
    candidate.measurement.pulled = belts.points.back().pulled.value_or(std::vector<Belt>{});
    candidates.push_back(std::move(candidate));
  }

  /// Each alternative's prediction; sets the rows of the candidates.
  std::vector<Alternative> predicted() {
    const RegressorSystem system =
        system_of(belts, state, observations_of(belts, state, a_.sigma_mm));
    for (std::size_t u = 0; u < system.units.size() && !candidates.empty(); ++u) {
      const SystemUnit& unit = system.units[u];
      Rows& rows = candidates[system.places[u].place].rows;
      for (const Index row : each_below(unit.rows)) rows.push_back(unit.first_row + row);
    }
    return alternatives_about(a_, system, [&](const SizedCause& own) {
      return std::optional(column_of(belts, state, system, own));
    });
  }

  MeasuredBelts belts;  ///< the machine with the anchors of the state
  FrameState state;
  std::optional<int> next_visit;
  std::vector<Candidate> candidates;  ///< a point each, or none

 private:
  const BeltsAnalysis& a_;
  double times_;
};

/// On a raster over the frame; coarser if each place can be reached in four ways.
void add_places(NextPlaces& next) {
  const BeltMachine& machine = next.belts.machine;
  const FramePoint centre = centre_of(machine);
  const auto& anchors = machine.anchors;
  const double left = 0.5 * (anchors.tl.x_mm + anchors.bl.x_mm);
  const double right = 0.5 * (anchors.tr.x_mm + anchors.br.x_mm);
  const double top = 0.5 * (anchors.tl.y_mm + anchors.tr.y_mm);
  const double aside = kMargin * (right - left);
  const interp::Rectangle area{left + aside, right - aside, kMargin * top, top - kMargin * top};
  const bool flat = machine.orientation == model::Orientation::flat;
  for (const MarkPoint& at : raster(area, flat ? 5 : 9, flat ? 4 : 7, RasterOf::nodes)) {
    const auto whole = [](double mm) { return kRasterMm * std::round(mm / kRasterMm) + 0.0; };
    const BedPoint command{whole(at.x_mm - centre.x_mm), whole(at.y_mm - centre.y_mm)};
    for (const Approach& way : approaches(machine.orientation)) {
      if (next.add({centre.x_mm + command.x_mm, centre.y_mm + command.y_mm}, way.pulled))
        next.propose(MeasurementKind::point, fmt::format("{}{}", kFurtherPlace, way.words),
                     command);
    }
  }
}

void add_revisits(const BeltsAnalysis& a, const PointIndices& indices, NextPlaces& next) {
  if (!next.next_visit) return;
  const FramePoint centre = centre_of(next.belts.machine);
  const std::size_t count = a.belts.points.size();
  for (const std::size_t i : each_below(kRevisits)) {
    const std::size_t k = i * (count - 1) / (kRevisits - 1);
    const FramePoint at = a.frame.state.places[k];
    const BeltPoint& point = a.belts.points[k];
    if (!next.add(at, point.pulled, point.pull)) continue;
    next.propose(MeasurementKind::revisit,
                 fmt::format("point {} again", index_in_file(indices, k) + 1),
                 point.commanded.value_or(BedPoint{std::round(at.x_mm - centre.x_mm) + 0.0,
                                                   std::round(at.y_mm - centre.y_mm) + 0.0}));
  }
}

/// For every place again, the last one first, with `times` the pull.
std::optional<double> all_once_more(const BeltsAnalysis& a, double times = 1.0) {
  if (a.belts.points.size() > kMostOnceMore) return std::nullopt;
  NextPlaces next(a, times);
  for (std::size_t k = a.belts.points.size(); k-- > 0;)
    next.add(a.frame.state.places[k], a.belts.points[k].pulled, a.belts.points[k].pull);
  for (BeltPoint& point : next.belts.points) {
    if (next.next_visit) point.order = (*next.next_visit)++;
  }
  const std::vector<Alternative> alternatives = next.predicted();
  auto rows = numbers_below<Index>(alternatives.front().mean.size());
  return expected_discrimination(alternatives, rows).named_alone;
}

/// A place that is proposed twice has to be measured twice.
void mark_repeats(std::vector<NextMeasurement>& proposed) {
  for (auto own = proposed.begin(); own != proposed.end(); ++own) {
    const bool repeats = std::any_of(proposed.begin(), own, [own](const NextMeasurement& other) {
      return own->kind == MeasurementKind::point && other.kind == own->kind &&
             other.mark->x_mm == own->mark->x_mm && other.mark->y_mm == own->mark->y_mm;
    });
    if (repeats) own->words.replace(0, kFurtherPlace.size(), "the same place again");
  }
}

std::optional<SecondPass> second_pass(const BeltsAnalysis& a, const BeltsNext& others) {
  if (different_pulls(a.belts).size() > 1) return std::nullopt;
  const auto named_alone = all_once_more(a, kHarder);
  double by_others = others.all_once_more.value_or(0.0);
  if (!others.measurements.empty())
    by_others = std::max(by_others, others.measurements.back().raises_probability_to);
  if (!named_alone || *named_alone < kWorthMeasuring || *named_alone <= by_others + kWorthASession)
    return std::nullopt;
  return SecondPass{kHarder, *named_alone};
}

}  // namespace

BeltsNext next_measurements(const BeltsAnalysis& a, const PointIndices& indices) {
  BeltsNext result;
  const std::vector<Alternative> alternatives = alternatives_of_best(a);
  if (is_left_alone(a, alternatives) || alternatives.back().group == 0 ||
      a.decision.verdict == Verdict::named) {
    return result;
  }
  result.is_open = true;
  NextPlaces next(a);
  add_places(next);
  add_revisits(a, indices, next);
  const std::vector<Alternative> predicted = next.predicted();
  result.measurements = most_telling(predicted, std::move(next.candidates));
  mark_repeats(result.measurements);
  result.all_once_more = all_once_more(a);
  result.second_pass = second_pass(a, result);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
