// SPDX-License-Identifier: GPL-3.0-or-later
// diagnosis_in_words: the whole answer as some fifty lines for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tools/cli/belts_words.hpp"
#include "tools/cli/diagnosis_budget.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Cause;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::SameCause;

/// Hypotheses that are hardly possible fill no line.
constexpr double kWorthALine = 0.001;

class Text {
 public:
  template <class... Args>
  void line(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  void heading(std::string_view words) { line("\n{}", words); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void write_causes(Text& text, const Diagnosis& found) {
  if (found.causes.empty()) return;
  text.heading(found.verdict == grid::diagnosis::Verdict::named_set ? "One of these causes"
               : found.causes.size() > 1                            ? "Causes"
                                                                    : "Cause");
  for (const Cause& cause : found.causes) {
    text.line("  {}: {}  (probability {}{})",
              cause_title(cause.cause),
              sizes_in_words(cause.cause, cause.parameters),
              percent(cause.probability),
              cause.order_assumed ? ", the visiting order being assumed" : "");
    text.line("    {}", cause.cause.effect->cause);
    text.line("    remedy: {}", cause.cause.effect->remedy);
    for (const SameCause& same : cause.same_as) {
      text.line("    no {} can tell it from {}: {}",
                name(found.observations),
                cause_title(same.cause),
                sizes_in_words(same.cause, same.parameters));
      text.line("      remedy: {}", same.cause.effect->remedy);
    }
  }
}

void write_budget(Text& text, const Diagnosis& found) {
  const std::vector<BudgetRow> rows = budget_rows(found);
  if (rows.empty()) return;
  text.heading("What the error is made of");
  text.line("  {:<38}{:>8}{:>7}{:>16}   {}",
            "",
            "rms, mm",
            "share",
            "part of 100 mm",
            "changes with");
  for (const BudgetRow& row : rows) {
    text.line("  {:<38}{:>8}{:>7}{:>16}   {}",
              row.what,
              row.rms_mm,
              row.share,
              row.part_mm,
              row.changes_with);
  }
  text.line("  {}", budget_words(found));
}

void write_trend(Text& text, const Diagnosis& found) {
  if (!found.trend) return;
  text.heading(fmt::format("What changed since {}", found.trend->since));
  for (const std::string& line : trend_in_words(found)) text.line("  {}", line);
}

void write_hypotheses(Text& text, const Diagnosis& found) {
  text.heading("Probabilities, each for itself: causes can act together");
  for (const auto& hypothesis : found.hypotheses) {
    if (hypothesis.probability < kWorthALine) continue;
    text.line("  {:>13}  {}", percent(hypothesis.probability), hypothesis_title(hypothesis));
  }
  if (!found.belts) text.line("  {}", left_over_sentence(found.left_over));
}

void write_errors(Text& text, const std::vector<GainRow>& rows, double floor_mm) {
  const bool has_border =
      std::any_of(rows.begin(), rows.end(), [](const GainRow& row) { return row.border_mm; });
  text.line("  {:<32}{:>7}{:>15}{:>9}{}",
            "",
            "rms",
            "90 % interval",
            "95 % of",
            has_border ? fmt::format("{:>9}", "border") : "");
  for (const GainRow& row : rows) {
    text.line("  {:<32}{:>7.2f}{:>15}{:>9.2f}{}",
              row.what,
              row.held_out->rms_mm,
              fmt::format("{:.2f} to {:.2f}", row.held_out->low_mm, row.held_out->high_mm),
              row.held_out->percentile_95_mm,
              !has_border     ? ""
              : row.border_mm ? fmt::format("{:>9.2f}", *row.border_mm)
                              : fmt::format("{:>9}", ""));
  }
  text.line("  {:<32}{:>7.2f}", "noise of the readings", floor_mm);
}

void write_gain(Text& text, const Diagnosis& found) {
  if (found.gain) {
    text.heading(is_gain_of_distances(*found.gain) ? "Error of distances held out, mm"
                                                   : "Error of the tool at points held out, mm");
    write_errors(text, gain_rows(found), found.gain->noise_floor_mm);
    text.line("  {}; the same cause was named in {} of {} folds.",
              found.gain->scheme,
              found.gain->folds_agree,
              found.gain->folds);
    if (!(found.gain->border.calibrated_mm > 0.0)) text.line("  {}", border_sentence(*found.gain));
  }
  if (found.transferred) {
    text.heading(fmt::format("Error of the tool on \"{}\", {} points that had no part in this, mm",
                             found.transferred->to,
                             found.transferred->points));
    write_errors(text, transfer_rows(found), found.transferred->noise_floor_mm);
  }
}

void write_follow_up(Text& text, const Diagnosis& found) {
  if (found.next_measurements.empty()) return;
  text.heading(fmt::format("What to measure next (chaintrue plan {} --after diagnosis.json)",
                           files_in_words(found)));
  const std::vector<std::string> sentences = follow_ups_in_words(found);
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    text.line("  {:>2}. {}{}", i + 1, sentences[i], chance_then(found, i));
  }
}

void write_settings(Text& text, const Diagnosis& found) {
  if (found.settings.empty()) return;
  text.heading("Settings                           stated  calibrated   +- sigma");
  for (const auto& result : found.settings) {
    text.line("  {:<26}{:>14.2f}{:>12.2f}{:>11.2f} {}{}",
              setting_in_words(result.setting),
              in_unit(result.setting, result.stated),
              in_unit(result.setting, result.calibrated),
              in_unit(result.setting, result.sigma),
              unit_of(result.setting),
              result.off ? "  off: further than its stated uncertainty allows" : "");
  }
}

void write_rest(Text& text, const Diagnosis& found) {
  if (!found.outliers.empty()) {
    text.heading(fmt::format("Bad {}, to be measured again",
                             found.belts ? "readings" : name(found.observations)));
    for (const auto& bad : found.outliers) {
      if (bad.of == grid::diagnosis::Observations::belts) {
        text.line("  {}", capitalised(bad_belt_in_words(bad)));
        continue;
      }
      if (is_distance(found, bad)) {
        text.line("  {}: read {} ({:.1f} sigmas)",
                  distance_name(found, bad.index),
                  off_in_words(bad.off_mm),
                  bad.distance);
        continue;
      }
      text.line(
          "  point {}: the tool would have to have been {} mm right and {} mm up of its mark "
          "({:.1f} sigmas)",
          bad.index + 1,
          fixed(bad.shift_mm.x(), 2),
          fixed(bad.shift_mm.y(), 2),
          bad.distance);
    }
  }
  if (!found.bounds.empty()) {
    text.heading("Looked for and absent: larger than this it would have shown");
    for (const auto& bound : found.bounds) {
      text.line("  {:<34}{}", cause_title(bound.cause), bound_in_words(bound));
    }
  }
  if (!found.not_testable.empty()) {
    text.heading("Not testable with these data");
    for (const auto& missing : found.not_testable)
      text.line("  {:<34}{}", cause_title(missing.cause), missing.reason);
  }
}

}  // namespace

std::string diagnosis_in_words(const Diagnosis& found) {
  Text text;
  text.line("{}", found.sentence);
  if (!found.what_to_do.empty()) {
    text.heading("What to do now");
    for (const std::string& line : found.what_to_do) text.line("  - {}", capitalised(line));
  }
  if (!found.not_proved.empty()) text.line("\nWhat this does not prove: {}", found.not_proved);
  for (const std::string& note : found.notes) text.line("Note: {}", note);
  write_budget(text, found);
  write_trend(text, found);
  write_causes(text, found);
  if (found.belts) text.line("\n{}", diagnosed_belts_in_words(*found.belts));
  write_gain(text, found);
  write_follow_up(text, found);
  write_hypotheses(text, found);
  write_settings(text, found);
  write_rest(text, found);
  return text.take();
}

}  // namespace chaintrue::cli
