// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/containers.hpp"
#include "grid/input_checks/findings.hpp"
#include "grid/input_checks/number_checks.hpp"
#include "grid/input_checks/robust_trend.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid {

const std::array<std::vector<BeltPair>, 9>& belt_swaps() {
  using enum Belt;
  static const std::array<std::vector<BeltPair>, 9> kSwaps = {{{{tl, tr}},
                                                               {{bl, br}},
                                                               {{tl, bl}},
                                                               {{tr, br}},
                                                               {{tl, br}},
                                                               {{tr, bl}},
                                                               {{tl, tr}, {bl, br}},
                                                               {{tl, bl}, {tr, br}},
                                                               {{tl, br}, {tr, bl}}}};
  return kSwaps;
}

std::string words_of(const std::vector<BeltPair>& swapped) {
  std::string text;
  for (const BeltPair& pair : swapped) {
    const std::string both = fmt::format("{} and {}", name(pair.first), name(pair.second));
    text += text.empty() ? both + " swapped" : " and " + both + " as well";
  }
  return text;
}

namespace {

/// Real frames have residuals of at most 3 mm, even if the arms are ignored; swapped belts give
/// tens to hundreds.
constexpr double kSoundMm = 15.0;
/// A swap must be better by this much to be suspected.
constexpr double kBetter = 4.0;
/// Stated anchors are accurate to a decimetre or two; a mirror image is off by a side of the frame.
constexpr double kFarMm = 400.0;
/// Far above the convergence error and far below the noise.
constexpr double kRoundingMm = 1e-6;
/// This many points reveal a swap as well as all of them.
constexpr std::size_t kMostLookedAt = 16;

using BeltPairs = std::vector<BeltPair>;

constexpr std::size_t kSinglePairs = 6;

MeasuredBelts looked_at(const MeasuredBelts& belts) {
  MeasuredBelts few = belts;
  few.distances.clear();
  few.points.clear();
  const std::size_t count = std::min(belts.points.size(), kMostLookedAt);
  for (const std::size_t i : each_below(count)) {
    few.points.push_back(belts.points[i * belts.points.size() / count]);
  }
  return few;
}

MeasuredBelts swapped(MeasuredBelts belts, const BeltPairs& pairs) {
  for (BeltPoint& point : belts.points) {
    for (const BeltPair& pair : pairs)
      std::swap(point.lengths_mm[pair.first], point.lengths_mm[pair.second]);
  }
  return belts;
}

struct Frame {
  double residual_sigma_mm = kInfinity;
  /// From the stated anchors or commands; 0 if the file has neither.
  double far_mm = 0.0;
  double far_from_commands_mm = 0.0;
};

double far_from_commands(const MeasuredBelts& belts, const std::vector<FramePoint>& places) {
  Vector2d sum = Vector2d::Zero();
  std::vector<Vector2d> off;
  for (const auto k : each_index(places)) {
    if (!belts.points[k].commanded) continue;
    off.push_back(difference(places[k], *belts.points[k].commanded));
    sum += off.back();
  }
  for (Vector2d& one : off) one -= sum / as_double(off.size());
  return rms_length(off);
}

/// A share of the extent of the commands: mirrored ones are off by as much as that.
bool are_commands_far(const MeasuredBelts& belts, double far_mm) {
  std::vector<FramePoint> origin(belts.points.size());
  const double reach_mm = far_from_commands(belts, origin);
  return reach_mm > 0.0 && far_mm > 0.5 * reach_mm;
}

Frame frame_of(const MeasuredBelts& belts) {
  Frame frame;
  const auto fitted = belts::fit_anchors(belts);
  // Places on a line fit any lengths with some anchors.
  if (!fitted || !fitted->is_sound || belts::are_on_a_line(fitted->state.places)) return frame;
  frame.residual_sigma_mm = fitted->residual_sigma_mm;
  frame.far_from_commands_mm = far_from_commands(belts, fitted->state.places);
  if (belts.machine.anchors_known) {
    frame.far_mm = (fitted->state.anchors - anchors_of(belts.machine)).lpNorm<Eigen::Infinity>();
  } else {
    frame.far_mm = frame.far_from_commands_mm;
  }
  return frame;
}

bool is_far(const MeasuredBelts& belts, const Frame& frame) {
  return (belts.machine.anchors_known && frame.far_mm > kFarMm) ||
         are_commands_far(belts, frame.far_from_commands_mm);
}

}  // namespace

std::optional<SwappedBelts> suspected_swap(const MeasuredBelts& belts) {
  const MeasuredBelts few = looked_at(belts);
  if (few.points.size() < kFewestBeltPoints) return std::nullopt;
  const Frame as_stated = frame_of(few);
  const bool is_frame = as_stated.residual_sigma_mm < kSoundMm;
  if (is_frame && !is_far(few, as_stated)) return std::nullopt;
  std::vector<Frame> frames;
  for (const BeltPairs& pairs : belt_swaps()) frames.push_back(frame_of(swapped(few, pairs)));
  const auto is_better = [&](const Frame& frame) {
    if (frame.residual_sigma_mm > kSoundMm || is_far(few, frame)) return false;
    return is_frame || kBetter * frame.residual_sigma_mm < as_stated.residual_sigma_mm;
  };
  // Take the first of two mirror-image pairs: they differ only by rounding.
  const auto is_nearer = [](const Frame& a, const Frame& b) {
    if (std::abs(a.far_mm - b.far_mm) > kRoundingMm) return a.far_mm < b.far_mm;
    return a.residual_sigma_mm < b.residual_sigma_mm - kRoundingMm;
  };
  std::optional<std::size_t> best;
  for (const auto i : each_index(frames)) {
    // If exchanging one pair fixes it, two pairs are not considered.
    if (i == kSinglePairs && best) break;
    if (is_better(frames[i]) && (!best || is_nearer(frames[i], frames[*best]))) best = i;
  }
  if (!best) return std::nullopt;
  SwappedBelts result{belt_swaps()[*best], std::nullopt, as_stated.residual_sigma_mm,
                      frames[*best].residual_sigma_mm};
  if (*best >= kSinglePairs) return result;
  const std::size_t mirrored = *best % 2 == 0 ? *best + 1 : *best - 1;
  if (frames[*best].far_mm == 0.0 && is_better(frames[mirrored]))
    result.or_else = belt_swaps()[mirrored].front();
  return result;
}

std::optional<AnchorFit> frame_of_lengths(const MeasuredBelts& belts) {
  const MeasuredBelts untaped = without_distances(belts);
  auto frame = belts::fit_anchors_robustly(untaped);
  if (!frame || !frame->is_sound) return std::nullopt;
  return frame;
}

std::vector<NowherePoint> points_nowhere(const MeasuredBelts& belts, const AnchorFit& frame) {
  // A lost digit or another frame; smaller errors are left to the fit.
  constexpr double kNowhereMm = 100.0;
  std::vector<NowherePoint> result;
  const BeltMachine machine = with_anchors(belts.machine, frame.state.anchors);
  for (const auto k : each_index(belts.points)) {
    if (belts::readings_counting(frame.counting[k]) > 2) continue;
    const auto place = belts::nearest_place(machine, belts.points[k], kAllBelts);
    double residual_mm = 0.0;
    for (const Belt belt : kBelts) {
      const auto reading = reading_at(machine, belt, place);
      if (reading)
        residual_mm =
            std::max(residual_mm, std::abs(belts.points[k].lengths_mm[belt] - reading->length_mm));
    }
    if (residual_mm > kNowhereMm) result.push_back({k, residual_mm});
  }
  return result;
}

std::vector<BeltQuestion> suspected_readings(const MeasuredBelts& belts, const AnchorFit& frame) {
  std::vector<BeltQuestion> result;
  const BeltMachine machine = with_anchors(belts.machine, frame.state.anchors);
  const double scale_mm = std::max(frame.residual_sigma_mm, 0.5);
  const double gross_mm = std::max(input_checks::kGrossMm, input_checks::kGrossScales * scale_mm);
  for (const auto k : each_index(belts.points)) {
    for (const Belt belt : kBelts) {
      if (frame.counting[k][belt]) continue;
      PerBelt<bool> others = kAllBelts;
      others[belt] = false;
      const auto place = belts::nearest_place(machine, belts.points[k], others);
      const auto reading = reading_at(machine, belt, place);
      const double read_mm = belts.points[k].lengths_mm[belt];
      if (!reading || std::abs(reading->length_mm - read_mm) < gross_mm) continue;
      double most = input_checks::log_density_of(reading->length_mm - read_mm, scale_mm, 1) +
                    input_checks::kThreeTimes;
      // The other belts show which of the four numbers is wrong.
      const double kOneOfFour = std::log(4.0);
      std::string question;
      for (const input_checks::NumberError& slip : input_checks::number_errors(read_mm, false)) {
        const double likely =
            input_checks::log_density_of(reading->length_mm - slip.value, scale_mm, 1) -
            (slip.penalty - kOneOfFour);
        if (likely <= most) continue;
        most = likely;
        question = slip.question;
      }
      if (question.empty()) continue;
      result.push_back(
          {k, belt,
           fmt::format("{} is {} off the prediction by the other belts: {}", name(belt),
                       input_checks::length_in_words(std::abs(reading->length_mm - read_mm)),
                       question)});
    }
  }
  return result;
}

namespace {

/// One sigma of a predicted distance, mm.
double sigma_of(const MeasuredBelts& belts, const FitDiagnostics& view,
                const BeltDistance& distance) {
  const auto expected = view.expected(belts, distance);
  return expected && expected->variance_mm2 > 0.0 ? std::sqrt(expected->variance_mm2) : kInfinity;
}

/// The question that explains a distance best.
std::string question_of(double distance_mm, double by_belts_mm) {
  constexpr double kNear = 0.06;
  const double d = distance_mm;
  std::vector<input_checks::NumberError> slips = {
      {0.5 * d, fmt::format("is it double the true {:.10g} mm?", 0.5 * d), 0.0},
      {2.0 * d, fmt::format("is it half of the true {:.10g} mm?", 2.0 * d), 0.0},
      {10.0 * d, fmt::format("is it in centimetres, {:.10g} mm?", 10.0 * d), 0.0}};
  append_all(slips, input_checks::number_errors(d, false));
  std::string question = "was it misread?";
  double least = kInfinity;
  for (const input_checks::NumberError& slip : slips) {
    const double off = std::abs(slip.value / by_belts_mm - 1.0);
    const double cost = slip.penalty + off / kNear;
    if (off > kNear || cost >= least) continue;
    least = cost;
    question = slip.question;
  }
  // Tapes are often held at the 100 mm mark because the hook is loose.
  constexpr double kHeldAtMm = 100.0;
  constexpr double kHeldNearMm = 20.0;
  const double longer_mm = distance_mm - by_belts_mm;
  if (std::abs(std::abs(longer_mm) - kHeldAtMm) < kHeldNearMm) {
    question = fmt::format("it is {:.0f} mm too {}: was the tape held at its 100 mm mark?",
                           std::abs(longer_mm), longer_mm > 0.0 ? "long" : "short");
  }
  return question;
}

}  // namespace

std::vector<DistanceQuestion> suspected_distances(const MeasuredBelts& belts,
                                                  const AnchorFit& frame) {
  // Belt lengths of all known machines are accurate to half a per cent (scales of 0.1 to 0.3 %), so
  // a single tape that differs by three times that is wrong. Several tapes that agree may show a
  // true scale.
  constexpr double kFarOff = 0.015;
  constexpr double kFarForAll = 0.12;
  constexpr double kSigmas = 5.0;
  if (belts.distances.empty()) return {};
  const MeasuredBelts untaped = without_distances(belts);
  const FitDiagnostics view(untaped, frame);
  const auto mechanism = belts::mechanism_at(untaped, frame.state);
  // In the frame that the lengths alone make; empty if an end has no position.
  const auto by_belts_mm =
      mapped(belts.distances, [&](const BeltDistance& distance) -> std::optional<double> {
        const auto line = belts::distance_at(untaped, *mechanism, frame.state, distance);
        if (!line) return std::nullopt;
        return line->predicted_mm;
      });
  std::vector<DistanceQuestion> result;
  for (const auto i : each_index(belts.distances)) {
    const double taped_mm = belts.distances[i].distance_mm;
    if (!by_belts_mm[i] || *by_belts_mm[i] < input_checks::kGrossMm) continue;
    const double factor = taped_mm / *by_belts_mm[i];
    std::vector<double> others;
    for (const auto j : each_index(by_belts_mm)) {
      if (j != i && by_belts_mm[j] && *by_belts_mm[j] >= input_checks::kGrossMm)
        others.push_back(belts.distances[j].distance_mm / *by_belts_mm[j]);
    }
    const bool has_company = !others.empty() && std::abs(factor / median(others) - 1.0) < kFarOff;
    const double far_mm = std::max((has_company ? kFarForAll : kFarOff) * *by_belts_mm[i],
                                   kSigmas * sigma_of(untaped, view, belts.distances[i]));
    const double gross_mm = kFarForAll * *by_belts_mm[i];
    const double difference_mm = std::abs(taped_mm - *by_belts_mm[i]);
    if (difference_mm < std::min(far_mm, gross_mm)) continue;
    result.push_back({i, *by_belts_mm[i], question_of(taped_mm, *by_belts_mm[i])});
  }
  return result;
}

std::optional<OtherUnit> suspected_unit(const MeasuredBelts& belts) {
  std::vector<double> lengths;
  for (const BeltPoint& point : belts.points) {
    for (const Belt belt : kBelts) lengths.push_back(point.lengths_mm[belt]);
  }
  // Frames are two to five metres across, belts one to three metres long.
  constexpr double kShortestMm = 500.0;
  constexpr double kUsualMm = 1700.0;
  if (lengths.empty() || median(lengths) > kShortestMm) return std::nullopt;
  const double middle = median(lengths);
  double usual_mm = kUsualMm;
  if (belts.machine.anchors_known) {
    const auto& a = belts.machine.anchors;
    usual_mm = 0.5 * distance_mm(a.tr, a.bl);
  }
  const auto off = [&](const input_checks::WrittenUnit& unit) {
    return std::abs(std::log(unit.mm * middle / usual_mm));
  };
  const input_checks::WrittenUnit& unit = *min_element(input_checks::kWrittenUnits, ascending(off));
  return OtherUnit{unit.word, unit.mm, middle};
}

}  // namespace chaintrue::grid
