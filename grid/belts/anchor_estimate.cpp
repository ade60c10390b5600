// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/anchor_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grid/belts/belts_fit.hpp"
#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "model/belts/belt_mechanism.hpp"

namespace chaintrue::grid::belts {

namespace {

/// A frame with larger residuals is a wrong minimum or has gross errors, so other starts are tried too.
constexpr double kPlausibleSpreadMm = 10.0;

double least_spread_mm(const MeasuredBelts& belts) {
  std::vector<double> lengths;
  for (const BeltPoint& point : belts.points) {
    for (const Belt belt : kBelts) lengths.push_back(point.lengths_mm[belt]);
  }
  return std::max(kLeastSpreadMm, rounding_sigma_mm(lengths));
}

/// Copies the anchors. The fit is sound if it converged with the right anchors right of the left ones and the
/// upper ones above the lower ones.
void take_anchors(const estimation::Estimate& estimate, AnchorFit& fit) {
  const AnchorVector a = estimate.mechanism->values().head<kAnchorUnknowns>();
  fit.state.anchors = a;
  fit.is_sound = estimate.converged && a[4] > 0.0 && a[2] > a[0] && a[1] > 0.0 && a[3] > 0.0;
}

/// The end of a taped distance, for any mechanism.
observation::TapeEnd end_of(const BeltMachine& machine, const BeltEnd& end) {
  if (const auto* index = std::get_if<std::size_t>(&end)) return observation::AtPlace{*index};
  if (const auto* belt = std::get_if<Belt>(&end)) return observation::AtFixedPoint{as_size(*belt)};
  return hole_at(machine, std::get<CutHole>(end).commanded);
}

observation::TapedDistance taped_between(const BeltMachine& machine, const BeltDistance& distance) {
  return {end_of(machine, distance.from), end_of(machine, distance.to), distance.distance_mm,
          distance.sigma_mm};
}

}  // namespace

observation::AtHole hole_at(const BeltMachine& in_force, BedPoint command) {
  FramePoint meant;
  if (in_force.anchors_known) meant = to_frame(in_force, command);
  const ToolPosition at{meant.x_mm, meant.y_mm};
  const auto paid_out =
      make_belt_mechanism(in_force)->predict(at, {}, model::Derivatives::by_position);
  constexpr double kNoLength = std::numeric_limits<double>::quiet_NaN();
  return {paid_out ? paid_out->lengths_mm : VectorXd::Constant(4, kNoLength),
          {true, true, false, false},
          at};
}

void place_all(const MeasuredBelts& belts, AnchorFit& fit) {
  const BeltMachine machine = with_anchors(belts.machine, fit.state.anchors);
  const auto readings = readings_of(belts, fit.counting, fit.residual_sigma_mm);
  const observation::View view(mechanism_at(belts, fit.state));
  fit.state.places = mapped(belts.points, [&](const BeltPoint& point) {
    return nearest_place(machine, point, kAllBelts);
  });
  for (const auto& block : readings.blocks()) {
    const auto line = readings.block_line(view, block, false);
    for (std::size_t p = 0; line && p < block.places.size(); ++p) {
      const std::size_t point = readings.readings()[block.places[p]].index;
      fit.state.places[point] = {line->positions[p].x_mm, line->positions[p].y_mm};
    }
  }
}

namespace {

/// Drops the few points whose lengths do not intersect: one reading with a lost
/// digit would end the estimate before it begins.
Counting without_nowhere_points(const MeasuredBelts& belts, const AnchorVector& start,
                                const Counting& counting) {
  const auto mechanism = mechanism_at(belts, {start, 0.0, {}});
  const observation::BeltLengthReadings readings = readings_of(belts, counting);
  Counting fewer = counting;
  std::size_t out = 0;
  for (const auto& block : readings.blocks()) {
    if (readings.block_line(observation::View(mechanism), block, false)) continue;
    for (const std::size_t place : block.places) {
      fewer[readings.readings()[place].index] = {};
      ++out;
    }
  }
  const bool are_few = as_double(out) <= kMostBadReadings * as_double(belts.points.size());
  return are_few ? fewer : counting;
}

/// Readings are rejected only if the fit's noise is at most this; if empty, never.
using MostNoise = std::optional<double>;

/// Without distances.
std::optional<AnchorFit> fit_alone(const MeasuredBelts& belts, const AnchorVector& start,
                                   Counting counting, MostNoise most_noise_mm = {}) {
  if (most_noise_mm) counting = without_nowhere_points(belts, start, counting);
  AnchorFit fit{
      .state = {start, 0.0, {}}, .counting = std::move(counting), .residual_sigma_mm = 1.0};
  estimation::EstimationInput input = anchor_input(belts, fit);
  if (most_noise_mm)
    input.reading_limits =
        estimation::ReadingLimits{kBadReadingSigmas, kMostBadReadings, *most_noise_mm};
  const auto estimate = estimation::estimate(input);
  if (!estimate) return std::nullopt;
  const auto& readings =
      dynamic_cast<const observation::BeltLengthReadings&>(*input.observations.front());
  for (const estimation::ReadingEstimate& one : estimate->rejected_readings) {
    const std::size_t point = readings.readings()[readings.place_of(one.reading.unit)].index;
    fit.counting[point][kBelts.at(as_size(one.reading.reading))] = false;
  }
  take_anchors(*estimate, fit);
  fit.checks = checks_of(fit.counting);
  if (fit.checks > 0)
    fit.residual_sigma_mm = std::max(estimate->noise_factor, least_spread_mm(belts));
  return fit;
}

/// With the distances, if there are any, and with the places; the noise is kept.
std::optional<AnchorFit> with_tape(const MeasuredBelts& belts, std::optional<AnchorFit> fit) {
  if (fit && !belts.distances.empty()) {
    estimation::EstimationInput input = anchor_input(belts, *fit);
    input.noise.knowledge = interp::NoiseKnowledge::exact;
    const auto estimate = estimation::estimate(input);
    if (!estimate) return std::nullopt;
    take_anchors(*estimate, *fit);
    fit->state.log_scale = estimate->mechanism->values()[kAnchorUnknowns];
  }
  if (fit) place_all(belts, *fit);
  return fit;
}

/// A point from another frame, or with lost digits, distorts the fit of all others, and its four
/// readings mask one another. Whole points are left out, the worst first, as long as that turns an
/// unsound frame into a sound one.
AnchorFit without_gross_points(const MeasuredBelts& belts, AnchorFit frame) {
  // Among more points one cannot bend the frame enough to hide its own readings.
  constexpr std::size_t kMostPoints = 100;
  constexpr double kMuchBetter = 3.0;
  const std::size_t count = belts.points.size();
  if (count > kMostPoints) return frame;
  const auto most = static_cast<std::size_t>(std::ceil(kMostBadReadings * as_double(count)));
  for (std::size_t out = 0; out < most; ++out) {
    if (frame.is_sound && frame.residual_sigma_mm < kPlausibleSpreadMm) break;
    std::optional<AnchorFit> best;
    for (const std::size_t k : each_below(count)) {
      if (!frame.counting[k].tl) continue;
      Counting fewer = frame.counting;
      fewer[k] = {};
      auto without = fit_alone(belts, frame.state.anchors, std::move(fewer));
      if (!without || without->checks < 1 || !without->is_sound) continue;
      if (!best || without->residual_sigma_mm < best->residual_sigma_mm) best = std::move(without);
    }
    if (!best || kMuchBetter * best->residual_sigma_mm > frame.residual_sigma_mm) break;
    frame = *std::move(best);
  }
  return frame;
}

/// Starting anchors, the likeliest first: the known ones, and rectangles of sizes consistent with
/// the lengths.
std::vector<AnchorVector> first_frames(const MeasuredBelts& belts) {
  std::vector<AnchorVector> frames;
  if (belts.machine.anchors_known) frames.push_back(anchors_of(belts.machine));
  // Two belts from opposite sides are together at least as long as their side of the frame. The
  // other points reveal a lost digit.
  std::vector<double> widths;
  std::vector<double> heights;
  for (const BeltPoint& point : belts.points) {
    const auto& l = point.lengths_mm;
    widths.push_back(std::min(l.tl + l.tr, l.bl + l.br));
    heights.push_back(std::min(l.tl + l.bl, l.tr + l.br));
  }
  sort(widths);
  sort(heights);
  const double arms_mm =
      belts.machine.lengths == model::BeltLengths::belt ? 2.0 * reach_mm(belts.machine) : 0.0;
  for (const std::size_t least : each_below(std::min<std::size_t>(widths.size(), 2))) {
    for (const double share : {0.9, 0.75, 0.97}) {
      for (const double other : {share, 0.6}) {
        const double w = share * (widths[least] + arms_mm);
        const double h = other * (heights[least] + arms_mm);
        frames.emplace_back(AnchorVector{0.0, h, w, h, w});
      }
    }
  }
  return frames;
}

/// From the likeliest start, without a tape. In an implausible fit every reading counts.
std::optional<AnchorFit> first_fit(const MeasuredBelts& belts, MostNoise most_noise_mm = {}) {
  const Counting all(belts.points.size(), kAllBelts);
  std::optional<AnchorFit> best;
  for (const AnchorVector& start : first_frames(belts)) {
    auto fit = fit_alone(belts, start, all, most_noise_mm);
    if (!fit) continue;
    if (!best || std::pair(!fit->is_sound, fit->residual_sigma_mm) <
                     std::pair(!best->is_sound, best->residual_sigma_mm)) {
      best = std::move(fit);
    }
    if (best->is_sound && best->residual_sigma_mm < kPlausibleSpreadMm) break;
  }
  return best;
}

}  // namespace

observation::BeltLengthReadings readings_of(const MeasuredBelts& belts, const Counting& counting,
                                            double sigma_mm, const std::vector<FramePoint>& about) {
  std::vector<observation::LengthsAtPlace> places;
  bool ordered = !belts.points.empty();
  const std::optional<BeltPull> reference = reference_pull(belts);
  for (const auto k : each_index(belts.points)) {
    const BeltPoint& point = belts.points[k];
    observation::LengthsAtPlace place;
    place.index = k;
    place.name = std::to_string(k + 1);
    place.lengths_mm.resize(std::ssize(kBelts));
    const bool all_count = readings_counting(counting.at(k)) == 4;
    for (const Belt belt : kBelts) {
      place.lengths_mm[as_index(belt)] = point.lengths_mm[belt];
      if (!all_count) place.counting.push_back(counting[k][belt]);
      place.visit.pulled.push_back(is_pulled(point, belt));
    }
    place.visit.order = point.order.value_or(0);
    place.visit.pull = pull_over(reference, point);
    if (!about.empty()) place.about = ToolPosition{about.at(k).x_mm, about.at(k).y_mm};
    ordered = ordered && point.order.has_value();
    places.push_back(std::move(place));
  }
  std::vector<observation::TapedDistance> distances;
  for (const BeltDistance& distance : belts.distances)
    distances.push_back(taped_between(belts.machine, distance));
  return {std::move(places), ordered, {.length_mm = sigma_mm}, 0.0, std::move(distances)};
}

std::shared_ptr<const Mechanism> mechanism_at(const MeasuredBelts& belts, const FrameState& state) {
  BeltMachine unknown = belts.machine;
  unknown.anchors_known = false;
  VectorXd values = state.anchors;
  if (belts.distances.empty()) return make_belt_mechanism(unknown)->with_values(values);
  values.conservativeResize(kAnchorUnknowns + 1);
  values[kAnchorUnknowns] = state.log_scale;
  return make_belt_mechanism(unknown, std::nullopt, model::BeltScaleKnowledge{})
      ->with_values(values);
}

std::optional<observation::DistanceLine> distance_at(const MeasuredBelts& belts,
                                                     const Mechanism& mechanism,
                                                     const FrameState& state,
                                                     const BeltDistance& distance) {
  const auto place_of = [&state](const BeltEnd& end) -> ToolPosition {
    const auto* index = std::get_if<std::size_t>(&end);
    if (index == nullptr) return {};
    return {state.places.at(*index).x_mm, state.places.at(*index).y_mm};
  };
  const auto line = observation::distance_line(mechanism, taped_between(belts.machine, distance),
                                               {place_of(distance.from), place_of(distance.to)});
  return line ? std::optional(*line) : std::nullopt;
}

estimation::EstimationInput anchor_input(const MeasuredBelts& belts, const AnchorFit& from) {
  auto readings = std::make_shared<const observation::BeltLengthReadings>(
      readings_of(belts, from.counting, from.residual_sigma_mm));
  estimation::EstimationInput input;
  input.mechanism = mechanism_at(belts, from.state);
  input.fixed_weights = VectorXd::Ones(std::ssize(readings->units()));
  input.observations.push_back(std::move(readings));
  input.noise.knowledge = interp::NoiseKnowledge::unknown;
  input.noise_prior = interp::SmoothingPrior::none;
  input.surface = estimation::SurfaceUse::none;
  input.domain = {0.0, 1.0, 0.0, 1.0};  // for a surface; there is none
  // With a tape that contradicts the belts, each pass gains only a tenth.
  input.most_passes = 40;
  return input;
}

std::optional<AnchorFit> fit_anchors_from(const MeasuredBelts& belts, const FrameState& state,
                                          const Counting& counting) {
  return with_tape(belts, fit_alone(without_distances(belts), state.anchors, counting));
}

std::optional<AnchorFit> fit_anchors(const MeasuredBelts& belts) {
  return with_tape(belts, first_fit(without_distances(belts)));
}

std::optional<AnchorFit> fit_anchors_robustly(const MeasuredBelts& belts) {
  const MeasuredBelts untaped = without_distances(belts);
  const auto is_plausible = [](const AnchorFit& fit) {
    return fit.is_sound && fit.residual_sigma_mm <= kPlausibleSpreadMm;
  };
  auto fit = first_fit(untaped, kPlausibleSpreadMm);
  if (!fit || is_plausible(*fit)) return with_tape(belts, std::move(fit));
  // If rejecting single readings does not make the frame plausible, reject whole points.
  const auto robust = [&untaped](const AnchorFit& from) {
    if (!from.is_sound) return from;
    return fit_alone(untaped, from.state.anchors, from.counting, kInfinity).value_or(from);
  };
  AnchorFit less = robust(*fit);
  if (!is_plausible(less)) less = robust(without_gross_points(untaped, *fit));
  return with_tape(belts, std::move(less));
}

FramePoint nearest_place(const BeltMachine& machine, const BeltPoint& point,
                         const PerBelt<bool>& counting) {
  PerBelt<double> spans;
  for (const Belt belt : kBelts) {
    spans[belt] = span_of(machine, belt, point.lengths_mm[belt])
                      .value_or(point.lengths_mm[belt] + reach_mm(machine));
  }
  const auto& a = machine.anchors;
  const auto square_at = [&](FramePoint at) {
    double square = 0.0;
    for (const Belt belt : kBelts) {
      if (!counting[belt]) continue;
      const double off = distance_mm(at, a[belt]) - spans[belt];
      square += off * off;
    }
    return square;
  };
  // The crossing of any two counting belts; the middle of the frame if none cross.
  FramePoint best{0.5 * a.br.x_mm, 0.5 * std::max(a.tl.y_mm, a.tr.y_mm)};
  double least = square_at(best);
  for (const Belt first : kBelts) {
    for (const Belt second : kBelts) {
      if (first == second || !counting[first] || !counting[second]) continue;
      const auto at = model::crossing({a[first].x_mm, a[first].y_mm}, spans[first],
                                      {a[second].x_mm, a[second].y_mm}, spans[second]);
      if (!at || square_at(*at) >= least) continue;
      best = *at;
      least = square_at(best);
    }
  }
  return best;
}

}  // namespace chaintrue::grid::belts
