// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/drawing_slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "grid/input_checks/transformation_search.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

using input_checks::Transformation;
using input_checks::TrendRows;
using observation::DrawnMeasure;
using Kind = DrawnMeasure::Kind;

// No line that a cord can draw bows by a fifth of its length.
constexpr double kMostBowShare = 0.2;
constexpr double kMmPerInch = 25.4;
// Settings that are off by up to seven sigmas each are not a slip.
constexpr double kOddDrawing = 300.0;
// A page scaled to its sheet is smaller by more; pins and pulleys are known better.
constexpr double kFittedToSheet = 0.012;
// An estimated factor: a drawing distinguishes some hundred values.
constexpr double kOfAFactor = 4.6;

/// Measured over drawn by the machine as set, of all lengths.
double median_share(const TestDrawing& drawing, const VectorXd& as_set) {
  std::vector<double> shares;
  for (const auto i : each_index(drawing.measures)) {
    if (drawing.measures[i].kind == Kind::length)
      shares.push_back(drawing.measures[i].value_mm / as_set[as_index(i)]);
  }
  return shares.empty() ? 1.0 : median(std::move(shares));
}

/// A possible slip in lengths, bows or all. `rows` is the trend's input from a drawing.
std::vector<Transformation> drawing_transformations(
    const TestDrawing& drawing, const VectorXd& as_set,
    const std::function<TrendRows(const TestDrawing&)>& rows) {
  input_checks::Transformations<TestDrawing> list(drawing, rows);
  const auto scale = [&](ProblemKind kind, std::string sentence, auto takes,
                         double factor) -> Transformation& {
    return list.add(kind, std::move(sentence),
                    [takes, factor](TestDrawing& meant, std::size_t row) {
                      if (takes(meant.measures[row])) meant.measures[row].value_mm *= factor;
                    });
  };
  const auto all = [](const DrawnMeasure&) { return true; };
  const auto lengths = having(&DrawnMeasure::kind, Kind::length);
  const auto bows = having(&DrawnMeasure::kind, Kind::bow);
  for (const auto& [unit, mm] : {std::pair("inches", kMmPerInch), std::pair("centimetres", 10.0)}) {
    const auto sentence = [&, unit = unit, mm = mm](const char* what) {
      return fmt::format("{} look like {}: write millimetres ({} times {:g})", what, unit, unit,
                         mm);
    };
    scale(ProblemKind::other_unit, sentence("the lengths"), lengths, mm);
    scale(ProblemKind::other_unit, sentence("the bows"), bows, mm);
    scale(ProblemKind::other_unit, sentence("the lengths and the bows"), all, mm);
  }
  scale(ProblemKind::minus_signs,
        "the signs of the bows look reversed: count them as shown on the sheet, with a minus on "
        "the other side",
        bows, -1.0);
  const double share = median_share(drawing, as_set);
  if (std::abs(share - 1.0) > kFittedToSheet) {
    Transformation& page = scale(
        ProblemKind::other_sheet,
        fmt::format("all lengths are {:.3f} times the commanded ones, in every direction: the page "
                    "was scaled when it was printed or sent to the plotter. Draw it at 100 % and "
                    "measure again",
                    share),
        all, 1.0 / share);
    page.of = Transformation::Of::all;
    page.penalty = kOfAFactor;
  }
  return list.take();
}

DrawingReason reason_of(ProblemKind kind) {
  if (kind == ProblemKind::other_unit) return DrawingReason::inches;
  if (kind == ProblemKind::minus_signs) return DrawingReason::bows_turned;
  return DrawingReason::scaled_when_printed;
}

std::optional<DrawingFailure> bow_along_its_line(const TestDrawing& drawing) {
  for (const auto i : each_index(drawing.measures)) {
    const DrawnMeasure& own = drawing.measures[i];
    if (own.kind != Kind::bow) continue;
    const BedPoint a = drawing.crosses.at(own.from).commanded;
    const BedPoint b = drawing.crosses.at(own.to).commanded;
    const double length = distance_mm(b, a);
    if (std::abs(own.value_mm) <= kMostBowShare * length) continue;
    return DrawingFailure{
        DrawingFailure::Reason::bow_is_a_length,
        fmt::format("{} is {:.1f} mm, and the line is {:.0f} mm long: that is a length along the "
                    "line. Hold a string from one end to the other and measure across from the "
                    "string to the line at its middle",
                    words_of(drawing, i), own.value_mm, length)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<DrawingFailure> slip_of_drawing(const TestDrawing& drawing, const VectorXd& as_set,
                                              const MatrixXd& by_parameter,
                                              const Mechanism& machine) {
  if (auto slip = bow_along_its_line(drawing)) return slip;
  VectorXd sigma(by_parameter.cols());
  for (const Index k : each_below(sigma.size()))
    sigma[k] = std::max(1e-3, machine.parameters()[as_size(k)].prior_sigma.value_or(1e3));
  const std::function<TrendRows(const TestDrawing&)> rows = [&](const TestDrawing& meant) {
    TrendRows own{by_parameter, MatrixXd(as_set.size(), 1)};
    for (const auto i : each_index(meant.measures)) {
      const auto row = as_index(i);
      own.off_mm(row, 0) = meant.measures[i].value_mm - as_set[row];
    }
    return own;
  };
  const TrendRows written = rows(drawing);
  const auto plain = input_checks::account_of(input_checks::robust_trend(written, sigma));
  std::vector<input_checks::Candidate> candidates =
      input_checks::searched(sigma, written, drawing_transformations(drawing, as_set, rows),
                             [&](std::size_t row) { return words_of(drawing, row); });
  const auto found = input_checks::whole_finding(
      std::move(candidates), plain, 0, kOddDrawing,
      fmt::format("half of the measures are more than {} off the prediction by the settings",
                  input_checks::length_in_words(plain.median_mm)));
  if (!found) return std::nullopt;
  return DrawingFailure{reason_of(found->kind), found->sentence()};
}

std::optional<DrawingFailure> exchanged_rows(const TestDrawing& drawing, const VectorXd& found,
                                             const Flags& rejected) {
  // Both then within what 4.5 sigmas of a reading and the estimate allow.
  constexpr double kFitsSigmas = 8.0;
  for (const auto i : each_index(rejected)) {
    for (std::size_t j = i + 1; j < rejected.size(); ++j) {
      if (!rejected[i] || !rejected[j]) continue;
      const DrawnMeasure &a = drawing.measures[i], &b = drawing.measures[j];
      const double sigma = kFitsSigmas * std::max(a.sigma_mm, b.sigma_mm);
      if (std::abs(a.value_mm - found[as_index(j)]) > sigma ||
          std::abs(b.value_mm - found[as_index(i)]) > sigma)
        continue;
      return DrawingFailure{
          DrawingFailure::Reason::rows_exchanged,
          fmt::format("{} ({:.1f} mm) and {} ({:.1f} mm) fit if they are exchanged: each was typed "
                      "into the other's row. Check the sheet and correct them",
                      words_of(drawing, i), a.value_mm, words_of(drawing, j), b.value_mm)};
    }
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid
