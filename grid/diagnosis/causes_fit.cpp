// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/causes_fit.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "grid/estimation/spatial_blocks.hpp"
#include "grid/map/larger_error.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::EffectParameter;
using model::effects::PlaceVariable;
using model::effects::Station;

/// Squared error of the tool at what one map left out, mm^2, and the block it was left out with.
struct HeldOutSquare {
  double plain_mm2 = 0.0;
  double with_causes_mm2 = 0.0;
  std::size_t block = 0;
};

double square_at_tool(const FittedPoint& point) {
  return (point.mark_jacobian.inverse() * point.blocked_residual_mm).squaredNorm();
}

/// Points by what they are known by in both fits: the file's number and their own.
using PointKey = std::pair<std::size_t, std::size_t>;

/// Points that the map with causes keeps, and distances where there are no points. What it rejects is
/// bad whatever acts; what the plain map alone rejects counts, since the causes explain it.
std::vector<HeldOutSquare> held_out_squares(const JointFit& plain, const JointFit& with_causes) {
  std::vector<HeldOutSquare> squares;
  std::map<PointKey, const FittedPoint*> own;
  std::map<std::size_t, std::vector<LengthPoint>> by_file;
  for (const FittedPoint& point : with_causes.points) {
    own[{point.file, point.point.index}] = &point;
    by_file[point.file].push_back(point.point);
  }
  std::map<PointKey, std::size_t> block_of;
  std::size_t blocks = 0;
  for (const auto& [file, points] : by_file) {
    for (const std::vector<std::size_t>& block : spatial_blocks(points)) {
      for (const std::size_t k : block) block_of[{file, points[k].index}] = blocks;
      ++blocks;
    }
  }
  for (const FittedPoint& point : plain.points) {
    const PointKey key{point.file, point.point.index};
    const FittedPoint& other = *own.at(key);
    if (!other.bad)
      squares.push_back({square_at_tool(point), square_at_tool(other), block_of[key]});
  }
  if (!squares.empty()) return squares;
  for (std::size_t f = 0; f < plain.distances.size(); ++f) {
    const auto& before = plain.distances[f].distances;
    const auto& after = with_causes.distances[f].distances;
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (after[k].rejected) continue;
      squares.push_back({before[k].left_out_mm * before[k].left_out_mm,
                         after[k].left_out_mm * after[k].left_out_mm,
                         squares.size()});
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
  const auto count = static_cast<double>(std::max<std::size_t>(squares.size(), 1));
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
  const auto b = static_cast<double>(blocks.size());
  if (b < 2.0) return false;
  const auto n = static_cast<double>(squares.size());
  const double mean = total / n;
  double sum = 0.0;
  for (const auto& [block, of] : blocks) sum += std::pow(of.first - of.second * mean, 2);
  return mean > std::sqrt(b / (b - 1.0) * sum) / n;
}

/// Each block's naming repeated without it, the map's own smooth correction in both.
bool naming_holds(const Diagnosis& found) {
  return found.improvement &&
         found.improvement->extended_and_surface.rms_mm < found.improvement->surface_only.rms_mm;
}

bool scale_was_read(const Measured& measured) {
  const auto decides = [](const ExtraReading& reading) {
    return reading.what == ReadingOf::link_pitch || reading.what == ReadingOf::tape_error;
  };
  return std::any_of(
      measured.files().begin(), measured.files().end(), [&](const MeasuredFile& file) {
        return std::visit(
            [&](const auto& own) {
              return std::any_of(own.readings.begin(), own.readings.end(), decides);
            },
            file.measured);
      });
}

bool is_of_the_paper(const CauseId& cause) { return cause.effect->station == Station::paper; }

/// Why a cause may not enter whatever it gains; empty where it may.
std::optional<OfferedCause::Reason> refusal(const Cause& cause, bool decided) {
  if (cause.probability < kSureOfCause) return OfferedCause::Reason::not_sure;
  if (is_of_the_paper(cause.cause)) return OfferedCause::Reason::is_paper;
  const bool may_be_paper =
      std::any_of(cause.same_as.begin(), cause.same_as.end(), [](const SameCause& same) {
        return is_of_the_paper(same.cause);
      });
  if (may_be_paper && !decided) return OfferedCause::Reason::may_be_paper;
  return std::nullopt;
}

bool has_order(const MeasuredFile& file) {
  const MeasuredGrid* grid = file.grid();
  return grid != nullptr &&
         std::all_of(grid->points.begin(), grid->points.end(), [](const MeasuredPoint& point) {
           return point.order.has_value();
         });
}

/// Its place, where a step or a bend depends on it and it is not sure; else null.
const ParameterEstimate* unsure_place(const Cause& cause) {
  const model::effects::Effect& effect = *cause.cause.effect;
  const EffectParameter* place = place_parameter(effect);
  if (place == nullptr || place->integer) return nullptr;
  const PlaceVariable of = variable_of_place(effect, *place);
  if (of == PlaceVariable::none || of == PlaceVariable::phase || of == PlaceVariable::visit) return nullptr;
  for (const ParameterEstimate& p : cause.parameters) {
    if (p.parameter == place->name) return p.sigma > 0.0 ? &p : nullptr;
  }
  return nullptr;
}

/// So much of the cause, its place so far from the likeliest.
model::AppliedEffect applied_at(const Cause& cause, const ParameterEstimate& place, double off, double share) {
  const EffectParameter& bounds = *place_parameter(*cause.cause.effect);
  const EffectParameter& size = cause.cause.effect->parameters.front();
  model::AppliedEffect effect = applied(cause);
  effect.parameters[place.parameter] = std::clamp(place.value + off, bounds.lower, bounds.upper);
  double& own = effect.parameters[std::string(size.name)];
  own = size.null + share * (own - size.null);
  return effect;
}

struct ActingCause {
  Cause cause;
  std::vector<model::AppliedEffect> effects;
};

std::vector<ActingCause> over_places(const std::vector<Cause>& causes) {
  std::vector<ActingCause> acting;
  for (const Cause& cause : causes) acting.push_back({cause, applied_over_places(cause)});
  return acting;
}

/// What happened at a visit happened in the one session whose visits were weighed: the first with an
/// order.
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
            if (has_visits || !model::effects::depends_on_visit(*acting.cause.cause.effect))
              effects.insert(effects.end(), acting.effects.begin(), acting.effects.end());
          }
        },
        file.measured);
    changed.add(std::move(file));
  }
  return changed;
}

/// Beyond the measured part the larger of the two errors is stated: of all places there the largest
/// ratio of the plain map's error to this one's, at least 1.
double factor_beyond(const CompensationMap& plain, const CompensationMap& own) {
  constexpr int kColumns = 25;
  constexpr int kRows = 13;
  const interp::Rectangle& domain = own.contents().domain;
  double factor = 1.0;
  for (int iy = 0; iy < kRows; ++iy) {
    for (int ix = 0; ix < kColumns; ++ix) {
      const model::MarkPoint mark{domain.x_min + domain.width() * ix / (kColumns - 1),
                                  domain.y_min + domain.height() * iy / (kRows - 1)};
      if (own.status(mark) != MapStatus::extrapolated) continue;
      const auto before = plain.query(mark);
      const auto after = own.query(mark);
      if (before && after && after->tool_sigma_mm > 0.0)
        factor = std::max(factor, before->tool_sigma_mm / after->tool_sigma_mm);
    }
  }
  return factor;
}

/// Before is before: what the tool missed on the machine as its owner states it.
CompensationMap with_errors_before(const CompensationMap& own, const CompensationMap& plain) {
  MapContents contents = own.contents();
  const std::vector<MapPoint>& before = plain.contents().points;
  if (before.size() != contents.points.size()) return own;
  for (std::size_t k = 0; k < before.size(); ++k) {
    contents.points[k].as_stated_mm = before[k].as_stated_mm;
    contents.points[k].sheet_placed_mm = before[k].sheet_placed_mm;
  }
  return CompensationMap(std::move(contents));
}

/// The tool's mean square by which one map differs from the other over the measured part, and what
/// the latter expects there, mm^2.
struct Apart {
  double difference_mm2 = 0.0;
  double expected_mm2 = 0.0;
};

Apart apart(const CompensationMap& map, const CompensationMap& other) {
  constexpr int kColumns = 25;
  constexpr int kRows = 13;
  const interp::Rectangle& domain = map.contents().domain;
  Apart sum;
  int count = 0;
  for (int iy = 0; iy < kRows; ++iy) {
    for (int ix = 0; ix < kColumns; ++ix) {
      const model::MarkPoint mark{domain.x_min + domain.width() * ix / (kColumns - 1),
                                  domain.y_min + domain.height() * iy / (kRows - 1)};
      if (map.status(mark) != MapStatus::inside) continue;
      const auto here = map.query(mark);
      const auto there = other.query(mark);
      if (!here || !there) continue;
      const Eigen::Vector2d chains(there->lengths.left_mm - here->lengths.left_mm,
                                   there->lengths.right_mm - here->lengths.right_mm);
      sum.difference_mm2 += (here->mark_jacobian.inverse() * chains).squaredNorm();
      sum.expected_mm2 += here->tool_sigma_mm * here->tool_sigma_mm;
      ++count;
    }
  }
  const double n = std::max(count, 1);
  return {sum.difference_mm2 / n, sum.expected_mm2 / n};
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

/// A quarter of the square by which the maps differ that have an unsure place one sigma to either side.
double square_of_places(const Measured& measured,
                        const CausesFitOptions& options,
                        const std::vector<Cause>& built_on) {
  double sum = 0.0;
  for (std::size_t k = 0; k < built_on.size(); ++k) {
    const ParameterEstimate* place = unsure_place(built_on[k]);
    if (place == nullptr) continue;
    const auto map_at = [&](double off) {
      std::vector<ActingCause> acting = over_places(built_on);
      acting[k].effects = {applied_at(built_on[k], *place, off, 1.0)};
      return joint_fit(with_effects(measured, acting), options.fit);
    };
    const auto low = map_at(-place->sigma);
    const auto high = map_at(place->sigma);
    if (low && high) sum += 0.25 * apart(low->map, high->map).difference_mm2;
  }
  return sum;
}

/// (2), of the likeliest of those that are offered and not of the paper, which moves no tool.
void count_what_is_left_open(const Measured& measured,
                             const CausesFitOptions& options,
                             const CompensationMap& plain,
                             CausesFit& result) {
  constexpr double kLeastProbability = 0.05;
  constexpr int kMostMaps = 4;
  constexpr double kLeastFactor = 1.05;
  std::vector<const Cause*> open;
  for (const OfferedCause& offered : result.offered) {
    const bool is_of_machine = offered.reason == OfferedCause::Reason::not_sure ||
                               offered.reason == OfferedCause::Reason::gains_nothing;
    if (is_of_machine && !is_of_the_paper(offered.cause.cause) &&
        offered.cause.probability >= kLeastProbability)
      open.push_back(&offered.cause);
  }
  std::stable_sort(open.begin(), open.end(), [](const Cause* a, const Cause* b) {
    return a->probability > b->probability;
  });
  if (open.size() > kMostMaps) open.resize(kMostMaps);
  const Apart built = apart(result.fit.map, plain);
  const double expected_mm2 = built.expected_mm2;
  double variance_mm2 = std::pow(least_known_size(result.built_on), 2) * built.difference_mm2 +
                        square_of_places(measured, options, result.built_on);
  for (const Cause* cause : open) {
    std::vector<Cause> acting = result.built_on;
    acting.push_back(*cause);
    const auto other = joint_fit(with_effects(measured, over_places(acting)), options.fit);
    if (!other) continue;
    variance_mm2 += cause->probability * apart(result.fit.map, other->map).difference_mm2;
  }
  if (!(expected_mm2 > 0.0)) return;
  const double factor = std::sqrt(1.0 + variance_mm2 / expected_mm2);
  if (factor < kLeastFactor) return;
  result.left_open_mm = std::sqrt(variance_mm2);
  result.fit.map = with_larger_error(result.fit.map, factor);
}

/// The sentences stand in the map's file as well.
CausesFit noted(CausesFit fit) {
  fit.fit.map = fit.fit.map.with_notes_first(in_words(fit));
  return fit;
}

void offer(const std::vector<Cause>& causes, OfferedCause::Reason reason, CausesFit& result) {
  for (const Cause& cause : causes) result.offered.push_back({cause, reason});
}

std::string why(OfferedCause::Reason reason) {
  switch (reason) {
    case OfferedCause::Reason::not_sure:
      return "it is not sure enough: chaintrue diagnose says what to measure next";
    case OfferedCause::Reason::may_be_paper:
      return "it may be the tape that set out the marks instead, and marks cannot tell which. "
             "Measure a hundred links, or the tape, and give the reading; or say --accept-class if "
             "you know that it is the chain";
    case OfferedCause::Reason::is_paper:
      return "the marks themselves are off: correct them, or set them out anew";
    case OfferedCause::Reason::gains_nothing:
      break;
  }
  return "the map corrects it as well without a name for it";
}

}  // namespace

model::AppliedEffect applied(const Cause& cause) {
  model::AppliedEffect effect{
      std::string(cause.cause.effect->id), std::string(model::effects::name(cause.cause.side)), {}};
  for (const ParameterEstimate& p : cause.parameters) effect.parameters[p.parameter] = p.value;
  return effect;
}

std::vector<model::AppliedEffect> applied_over_places(const Cause& cause) {
  const ParameterEstimate* place = unsure_place(cause);
  if (place == nullptr) return {applied(cause)};
  constexpr int kPlaces = 9;  // a ninth of a gap between marks: less than a surface of these marks can show
  std::vector<model::AppliedEffect> effects;
  for (int k = 0; k < kPlaces; ++k) {
    const double off = std::sqrt(3.0) * place->sigma * ((2.0 * k + 1.0) / kPlaces - 1.0);
    effects.push_back(applied_at(cause, *place, off, 1.0 / kPlaces));
  }
  return effects;
}

tl::expected<CausesFit, FitFailure> fit_with_causes(const Measured& measured,
                                                    const CausesFitOptions& options) {
  auto plain = joint_fit(measured, options.fit);
  if (!plain) return tl::unexpected(plain.error());
  CausesFit result{*std::move(plain), {}, {}, std::nullopt, 0.0, {}};
  DiagnosisOptions weighed;
  weighed.seed = options.seed;
  weighed.accept_class = options.accept_class;
  weighed.next_measurements = false;
  weighed.progress = options.fit.progress;
  const auto found = diagnose(measured, weighed);
  if (!found) {
    result.not_weighed = found.error().sentence();
    return noted(std::move(result));
  }
  // What depends on the visit is taken out in the order that was found.
  const Measured ordered = found->visiting_order
                               ? visited_in(measured, found->visiting_order->order).value_or(measured)
                               : measured;
  const bool decided = options.accept_class || scale_was_read(measured);
  std::vector<Cause> sure;
  for (const Cause& cause : found->causes) {
    if (const auto reason = refusal(cause, decided))
      result.offered.push_back({cause, *reason});
    else
      sure.push_back(cause);
  }
  const CompensationMap plain_map = result.fit.map;
  const auto with_open = [&] {
    count_what_is_left_open(ordered, options, plain_map, result);
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
  if (!naming_holds(*found) || !falls_beyond_its_error(squares)) {
    offer(sure, OfferedCause::Reason::gains_nothing, result);
    return with_open();
  }
  with_causes->map = with_errors_before(with_causes->map, result.fit.map)
                         .with_sigma_beyond(factor_beyond(result.fit.map, with_causes->map));
  result.fit = *std::move(with_causes);
  result.built_on = std::move(sure);
  return with_open();
}

std::vector<std::string> in_words(const CausesFit& fit) {
  std::vector<std::string> sentences;
  const auto sized = [](const Cause& cause) {
    std::string same;
    for (const SameCause& other : cause.same_as) {
      same += fmt::format(", or else {}{}: {}",
                          other.cause.effect->cause,
                          side_words(other.cause),
                          in_workshop_units(other.cause, other.parameters.front()));
    }
    return fmt::format("{}{} ({}; {}{})",
                       cause.cause.effect->cause,
                       side_words(cause.cause),
                       in_workshop_units(cause.cause, cause.parameters.front()),
                       percent(cause.probability),
                       same);
  };
  if (!fit.not_weighed.empty())
    sentences.push_back("No cause was looked for: " + fit.not_weighed + ".");
  if (!fit.built_on.empty()) {
    std::vector<std::string> parts;
    for (const Cause& cause : fit.built_on) parts.push_back(sized(cause));
    sentences.push_back(
        fmt::format("Found, and used in the map: {}. In parts of the bed that it was not made from, the map "
                    "is right within {:.2f} mm; without {} it would be {:.2f} mm.",
                    joined(parts, "and"),
                    fit.held_out->with_causes_mm,
                    fit.built_on.size() == 1 ? "this cause" : "these causes",
                    fit.held_out->plain_mm));
  }
  if (sentences.empty() && fit.offered.empty())
    sentences.emplace_back("No single cause stands out, and the map needs none.");
  for (const OfferedCause& offered : fit.offered) {
    sentences.push_back(fmt::format(
        "Found, not used in the map: {}; {}.", sized(offered.cause), why(offered.reason)));
  }
  if (fit.left_open_mm > 0.0) {
    sentences.push_back(
        fmt::format("{}: so the tool may be {:.2f} mm rms off, which the expected error counts.",
                    fit.offered.empty() ? "The sizes and places of the causes are not known exactly"
                                        : "What was found but is not in the map may still act",
                    fit.left_open_mm));
  }
  return sentences;
}

}  // namespace chaintrue::grid::diagnosis
