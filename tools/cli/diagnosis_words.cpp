// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Hypothesis;
using grid::diagnosis::MeasurementKind;
using grid::diagnosis::NextMeasurement;
using grid::diagnosis::ParameterEstimate;

struct Words {
  std::string_view word;
  std::string_view words;
};

constexpr Words kHypotheses[] = {{"nothing", "nothing hidden"},
                                 {"unknown", "an unknown pattern"},
                                 {"noise", "noise larger than stated"},
                                 {"bad_points", "bad points alone"}};

struct UnitEnding {
  std::string_view ending;
  std::string_view unit;
};
constexpr UnitEnding kUnitEndings[] = {{"_kg_per_m", "kg/m"}, {"_kg", "kg"}, {"_mm", "mm"}};

std::string spaced(std::string_view id) {
  std::string text(id);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string title(std::string_view id, std::string_view side) {
  return side.empty() ? spaced(id) : fmt::format("{}, {}", spaced(id), side);
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

std::string size_in_words(std::string_view parameter, double value, double sigma) {
  return grid::diagnosis::in_workshop_units({std::string(parameter), value, sigma});
}

std::string bound_in_words(const grid::diagnosis::Bound& bound) {
  if (bound.parameter == "links" && bound.upper_95 == 0.0) return "not one link";
  return size_in_words(bound.parameter, bound.upper_95, 0.0);
}

std::string sizes_in_words(const std::vector<ParameterEstimate>& parameters) {
  std::string text;
  for (const ParameterEstimate& estimate : parameters) {
    if (!text.empty()) text += ", ";
    text += grid::diagnosis::in_workshop_units(estimate);
  }
  return text;
}

bool is_surprising(const grid::diagnosis::LeftOver& left_over) {
  constexpr double kSurprising = 0.01;
  return left_over.p_value < kSurprising;
}

std::string left_over_sentence(const grid::diagnosis::LeftOver& left_over) {
  if (!is_surprising(left_over)) {
    return fmt::format(
        "What is left over looks like noise: noise alone leaves as much in {} of cases.",
        share_percent(left_over.p_value));
  }
  std::string text = fmt::format(
      "Something is left over that noise does not explain: its strength is {:.1f} in units of "
      "noise, and noise alone leaves as much in {} of cases.",
      left_over.delta,
      share_percent(left_over.p_value));
  if (!left_over.follows.empty()) {
    text += fmt::format(" It follows {} best ({} of its square): look there.",
                        grid::diagnosis::coordinate_words(left_over.follows),
                        share_percent(left_over.share));
  }
  return text;
}

std::string follow_up_in_words(const NextMeasurement& next) {
  if (next.kind != MeasurementKind::reading) {
    std::string text = next.what;
    if (text.empty() || text.back() != '.') text += '.';
    if (!next.mark) return text;
    const std::string place =
        fmt::format("({:.0f}, {:.0f})", next.mark->x_mm + 0.0, next.mark->y_mm + 0.0);
    return text.find(place) != std::string::npos ? text : fmt::format("{}: {}", place, text);
  }
  std::string text =
      fmt::format("Measure {}", grid::diagnosis::reading_words(next.what, next.side));
  const auto* unit =
      std::find_if(std::begin(kUnitEndings), std::end(kUnitEndings), [&](const auto& known) {
        return next.what.ends_with(known.ending);
      });
  if (next.sigma > 0.0 && unit != std::end(kUnitEndings))
    text += fmt::format(", to {:g} {}", next.sigma, unit->unit);
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

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string typeset(std::string text) {
  constexpr std::string_view kTyped = " +- ", kSet = "\u00a0\u00b1\u00a0";
  for (std::size_t at = text.find(kTyped); at != std::string::npos; at = text.find(kTyped, at))
    text.replace(at, kTyped.size(), kSet);
  return capitalised(std::move(text));
}

std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.front() != '-') return text;
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero ? text.substr(1) : "\u2212" + text.substr(1);
}

std::vector<GainRow> gain_rows(const grid::diagnosis::Diagnosis& diagnosis) {
  const grid::diagnosis::Gain& gain = *diagnosis.gain;
  std::vector<GainRow> rows = {{"as delivered", &gain.as_delivered, {}}};
  if (gain.placed) rows.push_back({"sheet placed, machine as stated", &*gain.placed, {}});
  rows.push_back({"calibrated", &gain.calibrated, gain.border.calibrated_mm});
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &gain.extended, gain.border.extended_mm});
    rows.push_back({"with the cause and a surface",
                    &gain.extended_and_surface,
                    gain.border.extended_and_surface_mm});
  }
  rows.push_back({"a surface only", &gain.surface_only, gain.border.surface_only_mm});
  return rows;
}

std::vector<GainRow> transfer_rows(const grid::diagnosis::Diagnosis& diagnosis) {
  const grid::diagnosis::Transfer& transfer = *diagnosis.transferred;
  std::vector<GainRow> rows = {{"as delivered", &transfer.as_delivered, {}},
                               {"calibrated", &transfer.calibrated, {}}};
  if (!diagnosis.causes.empty()) {
    rows.push_back({"with the cause", &transfer.extended, {}});
    rows.push_back({"with the cause and a surface", &transfer.extended_and_surface, {}});
  } else {
    rows.push_back({"with a surface", &transfer.extended_and_surface, {}});
  }
  return rows;
}

}  // namespace chaintrue::cli
