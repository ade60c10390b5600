// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Hypothesis;
using grid::diagnosis::MeasurementKind;
using grid::diagnosis::NextMeasurement;
using grid::diagnosis::ParameterEstimate;

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

struct ParameterWords {
  std::string_view parameter;
  std::string_view what;  ///< before the value, where the effect's name does not say it
  double factor;
  std::string_view unit;
  int digits;
};

constexpr ParameterWords kParameterWords[] = {
    {"elongation", "", 1000.0, "mm on a metre", 2},
    {"scale", "", 1000.0, "mm on a metre", 2},
    {"angle_rad", "", 1000.0, "mm on a metre", 2},
    {"offset_mm", "", 1.0, "mm", 2},
    {"relative_weight", "", 100.0, "% of its weight", 1},
    {"compliance_per_n", "", 1e5, "mm on a metre at 100 N", 3},
    {"flexibility_mm_per_n", "", 100.0, "mm at 100 N", 2},
    {"force_n", "", 1.0, "N", 2},
    {"distance_mm", "", 1.0, "mm", 1},
    {"amplitude_mm", "", 1.0, "mm", 3},
    {"phase_rad", "phase", kDegreesPerRad, "degrees", 0},
    {"slope_mm_per_rad", "", 10.0 / kDegreesPerRad, "mm per 10 degrees", 2},
    {"knee_rad", "from", kDegreesPerRad, "degrees below the horizontal on", 0},
    {"half_width_mm", "\u00b1", 1.0, "mm", 3},
    {"rate_mm_per_visit", "", 1.0, "mm a visit", 4},
    {"links", "", 1.0, "links", 0},
    {"first_visit", "from visit", 1.0, "on", 0},
    {"visit", "at visit", 1.0, "", 0},
};

const ParameterWords* find_words(std::string_view parameter) {
  for (const ParameterWords& words : kParameterWords) {
    if (words.parameter == parameter) return &words;
  }
  return nullptr;
}

struct Words {
  std::string_view word;
  std::string_view words;
};

constexpr Words kHypotheses[] = {{"nothing", "nothing hidden"},
                                 {"unknown", "a pattern that no cause of the catalogue explains"},
                                 {"noise", "noise larger than stated"},
                                 {"bad_points", "bad points alone"}};

constexpr Words kCoordinates[] = {{"angle_left", "the left chain's angle at its sprocket"},
                                  {"angle_right", "the right chain's angle at its sprocket"},
                                  {"length_left", "the left chain's length"},
                                  {"length_right", "the right chain's length"},
                                  {"tension_left", "the left chain's tension"},
                                  {"tension_right", "the right chain's tension"},
                                  {"turn_left", "the left sprocket's turn"},
                                  {"turn_right", "the right sprocket's turn"},
                                  {"order", "the order of the visits"},
                                  {"x", "the place across the sheet (x)"},
                                  {"y", "the height on the sheet (y)"}};

struct ReadingWords {
  std::string_view what;
  std::string_view words;
  std::string_view unit;
};

constexpr ReadingWords kReadings[] = {
    {"motor_spacing_mm", "Tape the distance between the motors' axes", "mm"},
    {"beam_rise_mm",
     "Level the beam: how much higher the right motor's axis is than the left",
     "mm"},
    {"ring_radius_mm", "Measure the ring from the bit to the chain's pin", "mm"},
    {"sled_mass_kg", "Weigh the sled with the router in it", "kg"},
    {"link_pitch_mm", "Measure 100 links of the chain under load and divide by 100", "mm"},
    {"chain_mass_kg_per_m", "Weigh a metre of chain", "kg/m"}};

std::string spaced(std::string_view id) {
  std::string text(id);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string title(std::string_view id, std::string_view side) {
  return side.empty() ? spaced(id) : fmt::format("{}, {}", spaced(id), side);
}

std::string one_size(const ParameterWords* words,
                     std::string_view parameter,
                     const WorkshopSize& size) {
  std::string text;
  if (words == nullptr) text = spaced(parameter) + " ";
  if (words != nullptr && !words->what.empty()) text = fmt::format("{} ", words->what);
  text += fixed(size.value, size.digits);
  if (size.sigma > 0.0) text += fmt::format(" \u00b1 {}", fixed(size.sigma, size.digits));
  if (!size.unit.empty()) text += fmt::format(" {}", size.unit);
  return text;
}

}  // namespace

std::string cause_title(const grid::diagnosis::CauseId& cause) {
  return title(cause.effect->id, name(cause.side));
}

std::string cause_title(const model::AppliedEffect& effect) {
  return title(effect.effect, effect.side);
}

std::string hypothesis_title(const Hypothesis& hypothesis) {
  for (const Words& known : kHypotheses) {
    if (known.word == hypothesis.effect) return std::string(known.words);
  }
  return title(hypothesis.effect, hypothesis.side);
}

WorkshopSize workshop_size(std::string_view parameter, double value, double sigma) {
  const ParameterWords* words = find_words(parameter);
  if (words == nullptr) return {value, sigma, "", 4};
  WorkshopSize size{words->factor * value, words->factor * sigma, words->unit, words->digits};
  // A sigma that would read as zero gets the digits that show it.
  for (int more = 0;
       more < 3 && size.sigma > 0.0 && std::pow(10.0, -size.digits) > 2.0 * size.sigma;
       ++more) {
    ++size.digits;
  }
  return size;
}

std::string size_in_words(std::string_view parameter, double value, double sigma) {
  return one_size(find_words(parameter), parameter, workshop_size(parameter, value, sigma));
}

std::string sizes_in_words(const std::vector<ParameterEstimate>& parameters) {
  std::string text;
  for (const ParameterEstimate& estimate : parameters) {
    if (!text.empty()) text += ", ";
    text += size_in_words(estimate.parameter, estimate.value, estimate.sigma);
  }
  return text;
}

std::string coordinate_in_words(std::string_view coordinate) {
  for (const Words& known : kCoordinates) {
    if (known.word == coordinate) return std::string(known.words);
  }
  return spaced(coordinate);
}

std::string left_over_sentence(const grid::diagnosis::LeftOver& left_over) {
  constexpr double kSurprising = 0.01;
  if (left_over.p_value >= kSurprising) {
    return fmt::format(
        "What is left over looks like noise: noise alone leaves as much in {} of cases.",
        share_percent(left_over.p_value));
  }
  std::string text = fmt::format(
      "Something is left over that noise does not explain: it is {:.1f} times as large as the "
      "noise "
      "allows for, which noise alone would do in {} of cases.",
      left_over.delta,
      share_percent(left_over.p_value));
  if (!left_over.follows.empty()) {
    text += fmt::format(" It follows {} best ({} of its square): look there.",
                        coordinate_in_words(left_over.follows),
                        share_percent(left_over.share));
  }
  return text;
}

std::string follow_up_in_words(const NextMeasurement& next) {
  if (next.kind != MeasurementKind::reading) {
    // The sentence says the place where it matters; a place that it does not say is added.
    const std::string place =
        next.mark ? fmt::format("({:.0f}, {:.0f})", next.mark->x_mm + 0.0, next.mark->y_mm + 0.0)
                  : std::string();
    if (place.empty() || next.what.find(place) != std::string::npos) return next.what;
    return fmt::format("{}: {}", place, next.what);
  }
  std::string text = spaced(next.what);
  std::string_view unit;
  for (const ReadingWords& known : kReadings) {
    if (known.what != next.what) continue;
    text = known.words;
    unit = known.unit;
  }
  if (!next.side.empty()) text += fmt::format(", {}", next.side);
  if (next.sigma > 0.0) text += fmt::format(", to {:g} {}", next.sigma, unit);
  return text + ".";
}

std::string percent(double probability) {
  const double in_percent = 100.0 * probability;
  if (in_percent > 99.9) return "above 99.9 %";
  if (in_percent < 0.1) return "below 0.1 %";
  return in_percent > 99.0 || in_percent < 1.0 ? fmt::format("{:.1f} %", in_percent)
                                               : fmt::format("{:.0f} %", in_percent);
}

std::string share_percent(double share) {
  if (share > 0.0 && share < 0.001) return "below 0.1 %";
  const double in_percent = 100.0 * share;
  return fmt::format("{:.{}f} %", in_percent, in_percent < 9.95 ? 1 : 0);
}

std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.front() != '-') return text;
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero ? text.substr(1) : "\u2212" + text.substr(1);
}

std::vector<GainRow> gain_rows(const grid::diagnosis::Gain& gain) {
  std::vector<GainRow> rows = {{"as delivered", &gain.as_delivered, {}}};
  if (gain.placed) rows.push_back({"sheet placed, machine as stated", &*gain.placed, {}});
  rows.push_back({"calibrated", &gain.calibrated, gain.border.calibrated_mm});
  rows.push_back({"with the cause", &gain.extended, gain.border.extended_mm});
  rows.push_back({"with the cause and a surface",
                  &gain.extended_and_surface,
                  gain.border.extended_and_surface_mm});
  rows.push_back({"a surface only", &gain.surface_only, gain.border.surface_only_mm});
  return rows;
}

std::vector<GainRow> gain_rows(const grid::diagnosis::Transfer& transfer) {
  return {{"as delivered", &transfer.as_delivered, {}},
          {"calibrated", &transfer.calibrated, {}},
          {"with the cause", &transfer.extended, {}},
          {"with the cause and a surface", &transfer.extended_and_surface, {}}};
}

}  // namespace chaintrue::cli
