// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in distance_choice.hpp.
#include "grid/planning/holes_plan.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/planning/distance_choice.hpp"
#include "grid/precondition.hpp"
#include "grid/raster.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid {
namespace {

using Holes = std::vector<const PlannedPlace*>;

/// Derivatives by the unknowns of a plan, kPlanUnknowns columns.
struct ToolError {
  /// L: L' L is the mean squared motion of the tool over the bed.
  MatrixXd root;
  /// The part common to all positions: shift in x, in y (mm) and rotation (rad).
  MatrixXd whole;
};

/// The places that the machine can reach, each with the derivative of its cut position on the sheet by the
/// unknowns.
std::vector<PlannedPlace> planned_places(const Machine& machine,
                                         const std::vector<MarkPoint>& places) {
  const ReadingModel model(machine);
  std::vector<PlannedPlace> result;
  for (const MarkPoint& place : places) {
    const auto reading = model.at(identity_placement(place));
    if (!reading) continue;
    Eigen::Matrix<double, 2, estimation::kMachineUnknowns> lengths;
    for (const auto i : each_index(kMachineSettings)) {
      lengths.col(as_index(i)) = model.sensitivity(*reading, kMachineSettings[i]);
    }
    lengths.rightCols<2>() = vector_of(reading->lengths).asDiagonal();
    PlannedPlace& planned = result.emplace_back();
    planned.place = place;
    planned.by_unknown << -reading->position_jacobian.inverse() * lengths,
        -SheetPlacement{}.sensitivity(place);
  }
  return result;
}

/// If the sheet's placement does not matter, `root` is without the common part (best placement of
/// the sheet).
ToolError tool_error(const Machine& machine, bool sheet_counts) {
  const std::vector<PlannedPlace> places =
      planned_places(machine, raster(area_of(machine.bed), 13, 7, RasterOf::cells));
  const auto count = std::ssize(places);
  if (count < kPlanUnknowns) {
    return {MatrixXd::Zero(kPlanUnknowns, kPlanUnknowns), MatrixXd::Zero(3, kPlanUnknowns)};
  }
  MatrixXd motion(2 * count, kPlanUnknowns);
  MatrixXd rigid(2 * count, 3);
  for (const Index i : each_below(count)) {
    const PlannedPlace& place = places[as_size(i)];
    motion.middleRows<2>(2 * i) = place.by_unknown;
    rigid.middleRows<2>(2 * i) = SheetPlacement{}.sensitivity(place.place);
  }
  ToolError error;
  error.whole = linear::least_squares(rigid, motion);
  if (!sheet_counts) linear::add_product(motion, -1.0, rigid, error.whole);
  error.root = linear::upper_triangle(motion) / std::sqrt(as_double(count));
  return error;
}

/// Closer holes weaken the sheet and carry little information; a small bed has room only for closer
/// ones.
constexpr double kLeastApartMm = 150.0;
/// The shorter side of the part of the bed where holes are planned.
double shorter_side_mm(const Machine& machine, double margin_mm) {
  return std::min(machine.bed.width_mm, machine.bed.height_mm) - 2.0 * margin_mm;
}
double least_apart_mm(const Machine& machine, double margin_mm) {
  return std::min(kLeastApartMm, 0.5 * shorter_side_mm(machine, margin_mm));
}

bool is_free(const Holes& holes, std::size_t moved, double apart_mm) {
  return none_of(holes, [&](const PlannedPlace* hole) {
    return hole != holes[moved] && distance_mm(hole->place, holes[moved]->place) < apart_mm;
  });
}

/// Spread out: each next hole as far as possible from those before, the first in a corner.
Holes spread(const std::vector<PlannedPlace>& places, std::size_t count) {
  Holes holes = {&places.front()};
  while (holes.size() < count) {
    constexpr double kSameWayMm = 1e-6;  // equally far except for rounding: the first one is kept
    const PlannedPlace* best = nullptr;
    double best_way = -1.0;
    for (const PlannedPlace& candidate : places) {
      double way = 1e9;
      for (const PlannedPlace* hole : holes) {
        way = std::min(way, distance_mm(hole->place, candidate.place));
      }
      if (way <= best_way + kSameWayMm) continue;
      best_way = way;
      best = &candidate;
    }
    holes.push_back(best);
  }
  return holes;
}

/// Moves single holes as long as a move is an improvement.
void move_holes(const DistanceChooser& chooser, const std::vector<PlannedPlace>& places,
                double apart_mm, const Progress& progress, Holes& holes) {
  Holes others;
  for (const PlannedPlace& place : places) others.push_back(&place);
  exchange({4, 1e-4, {"where the holes are cut", 1, 2}, progress}, others, holes,
           chooser.variance_mm2(holes), [&](std::size_t moved) {
             return is_free(holes, moved, apart_mm) ? chooser.variance_mm2(holes) : kInfinity;
           });
}

/// Holes in the order of a walk, row by row from the top left, named A, B, C, ...
MeasuredHoles set_of(const Machine& machine, const HolesPlanRequest& request, const Holes& holes,
                     const std::vector<HoleDistance>& distances) {
  auto order = numbers_below(holes.size());
  sort(order, [&](std::size_t a, std::size_t b) {
    const MarkPoint p = holes[a]->place;
    const MarkPoint q = holes[b]->place;
    return p.y_mm != q.y_mm ? p.y_mm > q.y_mm : p.x_mm < q.x_mm;
  });
  Indices number(holes.size());
  MeasuredHoles set = empty_set(machine, request);
  for (const auto i : each_index(order)) {
    number[order[i]] = i;
    set.holes.push_back(
        {std::string(1, static_cast<char>('A' + i)), identity_placement(holes[order[i]]->place)});
  }
  for (const HoleDistance& distance : distances) {
    if (distance.edge) {
      set.distances.push_back({.from = number[distance.from], .edge = distance.edge});
      continue;
    }
    const auto [from, to] = std::minmax(number[distance.from], number[distance.to]);
    set.distances.push_back({.from = from, .to = to});
  }
  // Edges last: the tape is held differently there.
  const auto key = [](const HoleDistance& one) { return std::tuple(one.edge, one.from, one.to); };
  sort(set.distances, ascending(key));
  for (HoleDistance& distance : set.distances) distance.distance_mm = commanded_mm(set, distance);
  return set;
}

void check(const Machine& machine, const HolesPlanRequest& request) {
  const bool sound =
      request.holes >= kFewestPlannedHoles && request.holes <= kMostPlannedHoles &&
      request.distances >= 0 &&
      (request.distances == 0 || request.distances >= fewest_distances(request.edges)) &&
      request.tape_sigma_mm > 0.0 && request.hole_sigma_mm >= 0.0 && request.margin_mm >= 0.0 &&
      shorter_side_mm(machine, request.margin_mm) >= kLeastPlannedSideMm &&
      request.longest_mm > 2.0 * kLeastApartMm;
  if (sound) return;
  throw precondition(
      "a plan of {} holes and {} distances, {} mm from the edges, with a tape of {} mm "
      "and sigmas of {} and {} mm",
      request.holes, request.distances, request.margin_mm, request.longest_mm,
      request.tape_sigma_mm, request.hole_sigma_mm);
}

/// Settings and scales, and the sheet's placement if it matters.
std::vector<PlannedKnowledge> knowledge_of(const MatrixXd& before, const MatrixXd& after,
                                           const std::optional<MatrixXd>& whole) {
  struct Known {
    const char* what;
    const char* unit;
    RowVectorXd combination;
  };
  const auto row = [](std::initializer_list<double> machine) {
    RowVectorXd combination = RowVectorXd::Zero(kPlanUnknowns);
    std::copy(machine.begin(), machine.end(), combination.begin());
    return combination;
  };
  // left x, left y, right x, right y, zero left, zero right, scale left, scale right
  std::vector<Known> rows = {
      {"motor spacing", "mm", row({-1, 0, 1, 0, 0, 0, 0, 0})},
      {"height of the motors", "mm", row({0, 0.5, 0, 0.5, 0, 0, 0, 0})},
      {"rise of the beam", "mm", row({0, -1, 0, 1, 0, 0, 0, 0})},
      {"both chain zeros together", "mm", row({0, 0, 0, 0, 0.5, 0.5, 0, 0})},
      {"left chain zero less right", "mm", row({0, 0, 0, 0, 1, -1, 0, 0})},
      {"left chain scale", "%", row({0, 0, 0, 0, 0, 0, 100, 0})},
      {"right chain scale", "%", row({0, 0, 0, 0, 0, 0, 0, 100})},
      {"left chain scale less right", "%", row({0, 0, 0, 0, 0, 0, 100, -100})},
  };
  if (whole) {
    constexpr double kMmPerMetre = 1e3;
    rows.push_back({"the whole job, sideways", "mm", whole->row(0)});
    rows.push_back({"the whole job, up or down", "mm", whole->row(1)});
    rows.push_back({"the whole job, turned", "mm per metre", kMmPerMetre * whole->row(2)});
  }
  std::vector<PlannedKnowledge> result;
  for (const Known& known : rows) {
    const auto sigma = [&known](const MatrixXd& covariance) {
      const RowVectorXd& c = known.combination;
      return std::sqrt(std::max(0.0, (c * covariance * c.transpose())(0)));
    };
    result.push_back({known.what, known.unit, sigma(before), sigma(after)});
  }
  return result;
}

/// The sheet's placement has no prior if it matters.
MatrixXd prior_of(const Machine& machine, bool edges) {
  MatrixXd prior = MatrixXd::Zero(kPlanUnknowns, kPlanUnknowns);
  prior.topLeftCorner<estimation::kMachineUnknowns, estimation::kMachineUnknowns>() =
      estimation::stated_knowledge(machine).covariance;
  if (edges) prior.diagonal().tail<3>() = observation::kSheetByEdges.sigma().cwiseAbs2();
  return prior;
}

/// cos 5 degrees: signatures nearer than this need hundreds of readings to be distinguished.
constexpr double kOneDirection = 0.9962;

struct Pattern {
  DetectableEffect found;
  VectorXd white;  ///< change of the distances at the effect's nominal size
};

bool shows_in_distances(const Effect& effect) {
  return effect.station != Station::paper && !depends_on_visit(effect);
}

/// Empty if the machine cannot cut the holes.
std::vector<Pattern> patterns_of(const MeasuredHoles& set) {
  if (!set.machine) throw std::invalid_argument("effects on distances need a machine");
  const auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) return {};
  // Distances between holes do not depend on the sheet's placement; in those to its edges, a shift
  // of the whole must not be mistaken for an effect.
  const observation::Columns columns{.parameters = true, .sheet = true};
  const auto line = distances->linearise({ReadingModel(*set.machine), {}}, columns);
  if (!line) return {};
  VectorXd prior(line->by_setting.cols());
  prior << estimation::stated_knowledge(*set.machine)
               .covariance.diagonal()
               .head(kMachineSettings.size()),
      observation::kSheetByEdges.sigma().cwiseAbs2();
  const linear::Cholesky covariance(
      observation::marginal_covariance(*line, distances->nuisance_sigma()) +
      line->by_setting * prior.asDiagonal() * line->by_setting.transpose());
  std::vector<Pattern> patterns;
  for (const Effect* effect : model::effects::effects_of(*set.machine)) {
    if (!shows_in_distances(*effect)) continue;
    for (const EffectSide side : effect->sides) {
      Machine machine = *set.machine;
      machine.effects.push_back(applied(*effect, side, nominal_values(*effect)));
      if (!model::effects::problems_of_effects(machine).empty()) continue;
      const auto with = distances->predicted({ReadingModel(machine), {}});
      if (!with) continue;
      Pattern& own = patterns.emplace_back();
      own.white = covariance.half_solve(VectorXd(*with - line->predicted));
      own.found.effect = effect->id;
      own.found.side = name(side);
      own.found.sigmas = own.white.norm();
    }
  }
  return patterns;
}

}  // namespace

double tool_sigma_mm(const Machine& machine, const MatrixXd& covariance) {
  const MatrixXd root = tool_error(machine, false).root.leftCols(estimation::kMachineUnknowns);
  return std::sqrt(std::max(0.0, linear::carried(root, covariance).trace()));
}

int fewest_distances(bool edges) { return as_int(kFewestHoleDistances) + (edges ? 3 : 0); }

int most_distances(int holes, bool edges) { return holes * (holes - 1) / 2 + (edges ? holes : 0); }

int distances_of(const HolesPlanRequest& request) {
  const int usual = 2 * request.holes + (request.edges ? 6 : 2);
  return std::min(most_distances(request.holes, request.edges),
                  request.distances > 0 ? request.distances : usual);
}

tl::expected<HolesPlan, PlanFailure> plan_holes(const Machine& machine,
                                                const HolesPlanRequest& request) {
  check(machine, request);
  const std::vector<PlannedPlace> places = planned_places(
      machine,
      whole_mm(raster(area_of(machine.bed, -request.margin_mm), 9, 5, RasterOf::nodes)));
  if (places.size() < as_size(request.holes)) {
    return failed(PlanReason::too_few_places,
                  fmt::format("the machine can cut at only {} of the places tried; a wider "
                              "margin leaves out those it cannot reach",
                              places.size()));
  }
  const MatrixXd prior = prior_of(machine, request.edges);
  const ToolError error = tool_error(machine, request.edges);
  const DistanceChooser chooser(machine, request, prior, error.root);
  Holes holes = spread(places, as_size(request.holes));
  move_holes(chooser, places, least_apart_mm(machine, request.margin_mm), request.progress, holes);
  const DistanceChooser::Choice choice = chooser.choose(holes);
  const MatrixXd after = chooser.covariance(holes, choice.distances);
  HolesPlan plan;
  plan.set = set_of(machine, request, holes, choice.distances);
  plan.expected_rms_mm = std::sqrt(choice.variance_mm2);
  plan.expected_before_mm =
      tool_sigma_mm(machine, estimation::stated_knowledge(machine).covariance);
  plan.knowledge =
      knowledge_of(prior, after, request.edges ? std::optional(error.whole) : std::nullopt);
  plan.effects = detectable_effects(plan.set);
  return plan;
}

std::vector<DetectableEffect> detectable_effects(const MeasuredHoles& set) {
  std::vector<Pattern> patterns = patterns_of(set);
  stable_sort(patterns, descending([](const Pattern& one) { return one.found.sigmas; }));
  std::vector<DetectableEffect> found;
  for (const auto i : each_index(patterns)) {
    for (const auto j : each_index(patterns)) {
      if (i == j) continue;
      const double together = patterns[i].found.sigmas * patterns[j].found.sigmas;
      if (together > 0.0 &&
          std::abs(patterns[i].white.dot(patterns[j].white)) > kOneDirection * together)
        patterns[i].found.same_as.push_back(j);
    }
    found.push_back(patterns[i].found);
  }
  return found;
}

}  // namespace chaintrue::grid
