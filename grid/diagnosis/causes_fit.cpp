// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/causes_fit.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/held_out_improvement.hpp"
#include "grid/diagnosis/naming.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/failed.hpp"
#include "grid/map/largest_error.hpp"
#include "grid/parallel.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Squared error of the tool at what one map left out, mm^2, and the block it was left out with.
struct HeldOutSquare {
  double plain_mm2 = 0.0;
  double with_causes_mm2 = 0.0;
  std::size_t block = 0;
};

double square_at_tool(const FittedPoint& point) {
  return (point.mark_jacobian.inverse() * point.left_out_with_group).squaredNorm();
}

/// Keys of points in both fits: the file's number and their own.
using PointKey = std::pair<std::size_t, std::size_t>;

/// Points that the map with causes keeps, and distances where there are no points. Points that it
/// rejects are bad in any case; points that only the plain map rejects count, since the causes
/// explain them.
std::vector<HeldOutSquare> held_out_squares(const JointFit& plain, const JointFit& with_causes) {
  std::vector<HeldOutSquare> squares;
  std::map<PointKey, const FittedPoint*> own;
  std::map<std::size_t, std::vector<LengthPoint>> by_file;
  for (const FittedPoint& point : with_causes.points) {
    own[{point.observation, point.point.index}] = &point;
    by_file[point.observation].push_back(point.point);
  }
  std::map<PointKey, std::size_t> block_of;
  std::size_t blocks = 0;
  for (const auto& [file, points] : by_file) {
    for (const Indices& block : spatial_blocks(points)) {
      for (const std::size_t k : block) block_of[{file, points[k].index}] = blocks;
      ++blocks;
    }
  }
  for (const FittedPoint& point : plain.points) {
    const PointKey key{point.observation, point.point.index};
    const FittedPoint& other = *own.at(key);
    if (!other.is_rejected())
      squares.push_back({square_at_tool(point), square_at_tool(other), block_of[key]});
  }
  if (!squares.empty()) return squares;
  for (const auto f : each_index(plain.distances)) {
    const auto& before = plain.distances[f].distances;
    const auto& after = with_causes.distances[f].distances;
    for (const auto k : each_index(before)) {
      if (after[k].rejected) continue;
      squares.push_back({before[k].left_out_mm * before[k].left_out_mm,
                         after[k].left_out_mm * after[k].left_out_mm, squares.size()});
    }
  }
  return squares;
}

HeldOutBlocksError error_of(const std::vector<HeldOutSquare>& squares) {
  HeldOutBlocksError sum;
  for (const HeldOutSquare& one : squares) {
    sum.plain_mm += one.plain_mm2;
    sum.with_causes_mm += one.with_causes_mm2;
  }
  const auto count = as_double(std::max<std::size_t>(squares.size(), 1));
  return {std::sqrt(sum.plain_mm / count), std::sqrt(sum.with_causes_mm / count)};
}

/// D of (1) exceeds its standard error.
bool falls_beyond_its_error(const std::vector<HeldOutSquare>& squares) {
  std::map<std::size_t, std::pair<double, double>> blocks;  // d_b and n_b
  double total = 0.0;
  for (const HeldOutSquare& one : squares) {
    auto& [difference, count] = blocks[one.block];
    difference += one.plain_mm2 - one.with_causes_mm2;
    count += 1.0;
    total += one.plain_mm2 - one.with_causes_mm2;
  }
  const auto b = as_double(blocks.size());
  if (b < 2.0) return false;
  const auto n = as_double(squares.size());
  const double mean = total / n;
  double sum = 0.0;
  for (const auto& [block, of] : blocks) sum += std::pow(of.first - of.second * mean, 2);
  return mean > std::sqrt(b / (b - 1.0) * sum) / n;
}

struct ActingCause {
  Cause cause;
  std::vector<AppliedEffect> effects;
};

bool has_order(const MeasuredFile& file) {
  const MeasuredGrid* grid = file.grid();
  return grid != nullptr && all_of(grid->points, &MeasuredPoint::order);
}

/// Its place, if a step or bend depends on it and it is uncertain; else null.
const ParameterEstimate* unsure_place(const Cause& cause) {
  const Effect& effect = *cause.cause.effect;
  const EffectParameter* place = place_parameter(effect);
  if (place == nullptr || place->integer) return nullptr;
  const PlaceVariable of = variable_of_place(effect, *place);
  if (of == PlaceVariable::none || of == PlaceVariable::phase || of == PlaceVariable::visit)
    return nullptr;
  for (const ParameterEstimate& p : cause.parameters) {
    if (p.parameter == place->name) return p.sigma > 0.0 ? &p : nullptr;
  }
  return nullptr;
}

/// A share of the cause, and the distance of its place from the likeliest.
AppliedEffect applied_at(const Cause& cause, const ParameterEstimate& place, double off,
                         double share) {
  const EffectParameter& bounds = *place_parameter(*cause.cause.effect);
  const EffectParameter& size = cause.cause.effect->parameters.front();
  AppliedEffect effect = applied(cause);
  effect.parameters[place.parameter] = std::clamp(place.value + off, bounds.lower, bounds.upper);
  double& own = effect.parameters[std::string(size.name)];
  own = size.null + share * (own - size.null);
  return effect;
}

std::vector<ActingCause> over_places(const std::vector<Cause>& causes) {
  std::vector<ActingCause> acting;
  for (const Cause& cause : causes) acting.push_back({cause, applied_over_places(cause)});
  return acting;
}

/// Readings of machines on which the causes act. Effects at a visit apply to the session whose
/// visits were analysed: the first with an order.
Measured with_effects(const Measured& measured, const std::vector<ActingCause>& causes) {
  Measured changed;
  bool is_before_visits = true;
  for (MeasuredFile file : measured.files()) {
    const bool has_visits = is_before_visits && has_order(file);
    is_before_visits = is_before_visits && !has_visits;
    std::visit(
        [&](auto& own) {
          if (!own.machine) return;
          auto& effects = own.machine->effects;
          for (const ActingCause& acting : causes) {
            if (has_visits || !depends_on_visit(*acting.cause.cause.effect))
              append_all(effects, acting.effects);
          }
        },
        file.measured);
    changed.add(std::move(file));
  }
  return changed;
}

/// A comparison of these takes half a minute (docs/reliability.md).
constexpr std::size_t kMostWeighed = 1200;

/// Points and distances.
std::size_t readings_of(const Measured& measured) {
  std::size_t count = 0;
  for (const MeasuredFile& file : measured.files())
    count += file.grid() != nullptr ? file.grid()->points.size() : file.holes()->distances.size();
  return count;
}

bool scale_was_read(const Measured& measured) {
  return any_of(measured.files(), [](const MeasuredFile& file) {
    return std::visit([](const auto& own) { return any_of(own.readings, shows_scale); },
                      file.measured);
  });
}

bool is_of_the_paper(const CauseId& cause) { return cause.effect->station == Station::paper; }

/// Why a cause may not enter regardless of its gain; empty if it may.
std::optional<OfferedCause::Reason> refusal(const Cause& cause, bool decided) {
  if (cause.probability < kSureOfCause) return OfferedCause::Reason::not_sure;
  if (is_of_the_paper(cause.cause)) return OfferedCause::Reason::is_paper;
  const bool may_be_paper =
      any_of(cause.same_as, [](const SameCause& same) { return is_of_the_paper(same.cause); });
  if (may_be_paper && !decided) return OfferedCause::Reason::may_be_paper;
  return std::nullopt;
}

/// Beyond the measured part the larger of the two errors is stated: of all places there the largest
/// ratio of the plain map's error to this one's, at least 1.
double factor_beyond(const CompensationMap& plain, const CompensationMap& own) {
  double factor = 1.0;
  for (const MarkPoint& mark : raster(own.contents().domain, 25, 13, RasterOf::nodes)) {
    if (own.status(mark) != MapStatus::extrapolated) continue;
    const auto before = plain.query(mark);
    const auto after = own.query(mark);
    if (before && after && after->tool_sigma_mm > 0.0)
      factor = std::max(factor, before->tool_sigma_mm / after->tool_sigma_mm);
  }
  return factor;
}

/// The error before is that of the machine as its owner states it.
CompensationMap with_errors_before(const CompensationMap& own, const CompensationMap& plain) {
  MapContents contents = own.contents();
  const std::vector<MapPoint>& before = plain.contents().points;
  if (before.size() != contents.points.size()) return own;
  for (const auto k : each_index(before)) {
    contents.points[k].as_stated_mm = before[k].as_stated_mm;
    contents.points[k].sheet_placed_mm = before[k].sheet_placed_mm;
  }
  return CompensationMap(std::move(contents));
}

/// The largest sigma of a cause's size over that size.
double least_known_size(const std::vector<Cause>& causes) {
  double largest = 0.0;
  for (const Cause& cause : causes) {
    const ParameterEstimate& size = cause.parameters.front();
    if (size.value != 0.0) largest = std::max(largest, size.sigma / std::abs(size.value));
  }
  return largest;
}

/// A map for each set of causes that may act on the readings instead; empty if the fit fails.
std::vector<std::optional<CompensationMap>> other_maps(
    const Measured& measured, const JointFitOptions& options,
    const std::vector<std::vector<ActingCause>>& sets) {
  std::vector<std::optional<CompensationMap>> maps(sets.size());
  for_each_index(sets.size(), [&](std::size_t k) {
    if (auto fit = joint_fit(with_effects(measured, sets[k]), options))
      maps[k] = std::move(fit->map);
  });
  return maps;
}

/// The offered causes that move the tool, most probable first.
std::vector<const Cause*> open_causes(const std::vector<OfferedCause>& offered) {
  constexpr double kLeastProbability = 0.05;
  constexpr std::size_t kMostMaps = 4;
  std::vector<const Cause*> open;
  for (const OfferedCause& one : offered) {
    const bool is_of_machine = one.reason == OfferedCause::Reason::not_sure ||
                               one.reason == OfferedCause::Reason::gains_nothing;
    if (is_of_machine && !is_of_the_paper(one.cause.cause) &&
        one.cause.probability >= kLeastProbability)
      open.push_back(&one.cause);
  }
  stable_sort(open, descending(&Cause::probability));
  if (open.size() > kMostMaps) open.resize(kMostMaps);
  return open;
}

/// (2)
void add_open_causes(const Measured& measured, const CausesFitOptions& options,
                     const CompensationMap& plain, CausesFit& result) {
  constexpr double kLeastFactor = 1.05;
  const CompensationMap map = result.fit.map;
  const std::vector<Cause>& built_on = result.built_on;
  // Two for each uncertain place, one sigma to either side, and one for each undecided cause.
  std::vector<std::vector<ActingCause>> sets;
  for (const auto k : each_index(built_on)) {
    const ParameterEstimate* place = unsure_place(built_on[k]);
    if (place == nullptr) continue;
    for (const double off : {-place->sigma, place->sigma}) {
      sets.push_back(over_places(built_on));
      sets.back()[k].effects = {applied_at(built_on[k], *place, off, 1.0)};
    }
  }
  const std::size_t of_places = sets.size();
  const std::vector<const Cause*> open_now = open_causes(result.offered);
  for (const Cause* cause : open_now) {
    std::vector<Cause> acting = built_on;
    acting.push_back(*cause);
    sets.push_back(over_places(acting));
  }
  JointFitOptions quiet = options.fit;
  quiet.progress = {};
  const auto others = other_maps(measured, quiet, sets);
  std::vector<MapDifference> differences;
  if (!built_on.empty()) differences.push_back({plain, map, least_known_size(built_on)});
  for (std::size_t k = 0; k < of_places; k += 2)
    if (others[k] && others[k + 1]) differences.push_back({*others[k], *others[k + 1], 0.5});
  for (const auto k : each_index(open_now)) {
    const auto& other = others[of_places + k];
    if (other) differences.push_back({map, *other, std::sqrt(open_now[k]->probability)});
  }
  if (differences.empty()) return;
  CompensationMap open = with_differences(map, differences);
  const double known_mm = map.contents().accuracy.expected_tool.rms_mm;
  const double open_mm = open.contents().accuracy.expected_tool.rms_mm;
  if (open_mm < kLeastFactor * known_mm) return;
  result.left_open_mm = std::sqrt(open_mm * open_mm - known_mm * known_mm);
  result.fit.map = std::move(open);
}

/// The map's file contains the sentences too.
CausesFit noted(CausesFit fit) {
  fit.fit.map = fit.fit.map.with_notes_first(in_words(fit));
  return fit;
}

void offer(const std::vector<Cause>& causes, OfferedCause::Reason reason, CausesFit& result) {
  for (const Cause& cause : causes) result.offered.push_back({cause, reason});
}

}  // namespace

bool shows_scale(const ExtraReading& reading) {
  return reading.what == ReadingOf::link_pitch || reading.what == ReadingOf::tape_error;
}

AppliedEffect applied(const Cause& cause) {
  AppliedEffect effect{
      std::string(cause.cause.effect->id), std::string(name(cause.cause.side)), {}};
  for (const ParameterEstimate& p : cause.parameters) effect.parameters[p.parameter] = p.value;
  return effect;
}

std::vector<AppliedEffect> applied_over_places(const Cause& cause) {
  const ParameterEstimate* place = unsure_place(cause);
  if (place == nullptr) return {applied(cause)};
  // A ninth of a gap between marks: less than a surface of these marks can show.
  constexpr int kPlaces = 9;
  std::vector<AppliedEffect> effects;
  for (const int k : each_below(kPlaces)) {
    const double off = std::sqrt(3.0) * place->sigma * ((2.0 * k + 1.0) / kPlaces - 1.0);
    effects.push_back(applied_at(cause, *place, off, 1.0 / kPlaces));
  }
  return effects;
}

tl::expected<CausesFit, FitFailure> fit_with_causes(const Measured& measured,
                                                    const CausesFitOptions& options) {
  const auto without_causes = [](tl::expected<JointFit, FitFailure> plain,
                                 std::string why) -> tl::expected<CausesFit, FitFailure> {
    if (!plain) return failed(plain);
    return noted({*std::move(plain), {}, {}, std::nullopt, 0.0, std::move(why)});
  };
  if (const std::size_t count = readings_of(measured); count > kMostWeighed)
    return without_causes(joint_fit(measured, options.fit),
                          fmt::format("{} readings are too many for the comparison (at most {})",
                                      count, kMostWeighed));
  DiagnosisOptions weighed;
  weighed.seed = options.seed;
  weighed.accept_class = options.accept_class;
  weighed.progress = options.fit.progress;
  NamingAndPlainFit made = name_and_fit(measured, weighed, NamingFor::causes, options.fit);
  if (!made.naming) return without_causes(std::move(made.plain), made.naming.error().sentence());
  if (!made.plain) return failed(made.plain);
  return fit_on_causes(measured, *made.naming, *std::move(made.plain), options,
                       [&] { return naming_improves_the_map(made.naming->analysis); });
}

CausesFit fit_on_causes(const Measured& measured, const Naming& naming, JointFit plain,
                        const CausesFitOptions& options,
                        const std::function<bool()>& naming_helps) {
  CausesFit result{std::move(plain), {}, {}, std::nullopt, 0.0, {}};
  // Effects of the visit are removed in the order that was found.
  const Measured ordered =
      naming.order ? visited_in(measured, naming.order->order).value_or(measured) : measured;
  const bool decided = options.accept_class || scale_was_read(measured);
  std::vector<Cause> sure;
  for (const Cause& cause : causes_found(naming.analysis)) {
    if (const auto reason = refusal(cause, decided))
      result.offered.push_back({cause, *reason});
    else
      sure.push_back(cause);
  }
  const CompensationMap plain_map = result.fit.map;
  const auto with_open = [&] {
    add_open_causes(ordered, options, plain_map, result);
    return noted(std::move(result));
  };
  if (sure.empty()) return with_open();
  auto with_causes = joint_fit(with_effects(ordered, over_places(sure)), options.fit);
  if (!with_causes) {
    offer(sure, OfferedCause::Reason::gains_nothing, result);
    return with_open();
  }
  const std::vector<HeldOutSquare> squares = held_out_squares(result.fit, *with_causes);
  result.held_out = error_of(squares);
  if (!falls_beyond_its_error(squares) || !naming_helps()) {
    offer(sure, OfferedCause::Reason::gains_nothing, result);
    return with_open();
  }
  with_causes->map = with_errors_before(with_causes->map, result.fit.map)
                         .with_sigma_beyond(factor_beyond(result.fit.map, with_causes->map));
  result.fit = *std::move(with_causes);
  result.built_on = std::move(sure);
  return with_open();
}

}  // namespace chaintrue::grid::diagnosis
