// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/map/check_decision.hpp"
#include "grid/map/check_evidence.hpp"

namespace chaintrue::grid {
namespace {

using model::Side;

std::string side_words(const std::string& side) {
  return side == "both" ? std::string("both chains") : fmt::format("the {} chain", side);
}

std::string in_words(const CheckHypothesis& h, const CheckReadings& readings) {
  if (h.what == "nothing") return "nothing has changed";
  if (h.what == "zero" && h.side == "both") {
    return fmt::format("the zeros have shifted, the left by {:+.2f} mm and the right by {:+.2f} mm",
                       h.zero_mm.left,
                       h.zero_mm.right);
  }
  if (h.what == "zero") {
    const Side side = h.side == "left" ? Side::left : Side::right;
    return fmt::format(
        "the zero of {} has shifted by {:+.2f} mm", side_words(h.side), h.zero_mm[side]);
  }
  if (h.what == "tooth") {
    return fmt::format("{} skipped {} {}: it reads {:.2f} mm too {}",
                       side_words(h.side),
                       std::abs(h.count) == 1 ? "one" : "two",
                       std::abs(h.count) == 1 ? "tooth" : "teeth",
                       std::abs(h.count) * readings.pitch_mm,
                       h.count > 0 ? "much" : "little");
  }
  if (h.what == "pitch" || h.what == "zeros_and_pitch") {
    const double growth = h.side == "right" ? h.elongation.right : h.elongation.left;
    return fmt::format("the links of {} have grown by {:.3f} %{}",
                       side_words(h.side),
                       100.0 * growth,
                       h.what == "pitch" ? "" : ", and the zeros have shifted");
  }
  if (h.what == "motors") return "a motor has moved";
  if (h.what == "bad_point") {
    return fmt::format("{} is wrong by itself",
                       readings.unit_names[static_cast<std::size_t>(h.count)]);
  }
  return "something has changed that follows no known pattern";
}

void tell(MapCheck& check, const CheckReadings& readings) {
  const CheckHypothesis& first = check.hypotheses.front();
  const auto at = static_cast<std::size_t>(check.verdict);
  const double percent = 100.0 * check.probability[at];
  const std::string why = in_words(first, readings);
  switch (check.verdict) {
    case CheckVerdict::valid:
      check.sentence = fmt::format("The map is still valid ({:.0f} %): {}.", percent, why);
      break;
    case CheckVerdict::valid_after_rezeroing:
      check.sentence = fmt::format(
          "The map is valid after re-zeroing ({:.0f} %): {}. New zeros: left {:.2f} mm, right "
          "{:.2f} "
          "mm.",
          percent,
          why,
          check.new_zero.left_mm,
          check.new_zero.right_mm);
      break;
    case CheckVerdict::measure_again:
      check.sentence =
          first.what == "bad_point"
              ? fmt::format(
                    "Measure {} again ({:.0f} %): it is wrong by itself, and "
                    "says nothing of the map.",
                    readings.unit_names[static_cast<std::size_t>(first.count)],
                    percent)
              : fmt::format("The map is to be measured again ({:.0f} %): {}.", percent, why);
      break;
  }
  decide_not_told_apart(
      check, [&](const CheckHypothesis& h) { return in_words(h, readings); }, "points");
}

MapCheck judge(const CheckReadings& readings) {
  MapCheck check;
  check.hypotheses = weighed_hypotheses(readings);
  decide_verdict(check);
  const CheckHypothesis& told = check.hypotheses.front();
  check.new_zero = {readings.zero.left_mm + told.zero_mm.left,
                    readings.zero.right_mm + told.zero_mm.right};
  const Eigen::VectorXd variance = readings.covariance.diagonal();
  for (Eigen::Index k = 0; k < readings.residual_mm.size(); ++k) {
    check.residuals.push_back({readings.names[static_cast<std::size_t>(k)],
                               readings.residual_mm[k],
                               std::sqrt(variance[k])});
  }
  tell(check, readings);
  check.notes = readings.notes;
  return check;
}

}  // namespace

std::string_view name(CheckVerdict verdict) {
  switch (verdict) {
    case CheckVerdict::valid:
      return "valid";
    case CheckVerdict::valid_after_rezeroing:
      return "valid_after_rezeroing";
    case CheckVerdict::measure_again:
      break;
  }
  return "measure_again";
}

tl::expected<MapCheck, CheckFailure> check_map(const CompensationMap& map,
                                               const Measured& measured,
                                               const Progress& progress) {
  return check_readings(map, measured, progress).map([&](const CheckReadings& readings) {
    tell(progress, {"what may have changed", 2, 2});
    return judge(readings);
  });
}

}  // namespace chaintrue::grid
