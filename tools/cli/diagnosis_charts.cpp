// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tools/cli/diagnosis_words.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::Hypothesis;
using grid::diagnosis::PointPicture;
using report::Arrow;
using report::Chart;
using report::DataTable;
using report::Outline;

constexpr const char* kPaidOutColor = "#009e73";
constexpr const char* kTakenInColor = "#cc79a7";
constexpr const char* kChains[] = {"left", "right"};

Outline sheet_of(const Diagnosis& found) {
  const model::Bed& bed = found.extended_machine.bed;
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

std::string name_of(const PointPicture& point) { return fmt::format("point {}", point.index + 1); }

std::vector<Arrow> arrows_of(const Diagnosis& found, Eigen::Vector2d PointPicture::*shift) {
  std::vector<Arrow> arrows;
  for (const PointPicture& point : found.points) {
    arrows.push_back({name_of(point),
                      point.mark.x_mm,
                      point.mark.y_mm,
                      (point.*shift).x(),
                      (point.*shift).y(),
                      point.bad,
                      point.noise_sigma_mm.x(),
                      point.noise_sigma_mm.y()});
  }
  return arrows;
}

/// A number of a point, for one of the chains (0 left, 1 right).
using OfChain = std::function<double(const PointPicture&, int chain)>;

struct Panel {
  std::string title;
  Eigen::Vector2d PointPicture::*residual;
};

/// Over the good points, both taken about their means.
double correlation(const Diagnosis& found,
                   Eigen::Vector2d PointPicture::*first,
                   Eigen::Vector2d PointPicture::*second,
                   int chain) {
  double n = 0.0, sum_a = 0.0, sum_b = 0.0, sum_aa = 0.0, sum_bb = 0.0, sum_ab = 0.0;
  for (const PointPicture& point : found.points) {
    if (point.bad) continue;
    const double a = (point.*first)[chain], b = (point.*second)[chain];
    n += 1.0;
    sum_a += a;
    sum_b += b;
    sum_aa += a * a;
    sum_bb += b * b;
    sum_ab += a * b;
  }
  const double spread = (n * sum_aa - sum_a * sum_a) * (n * sum_bb - sum_b * sum_b);
  return spread > 0.0 ? (n * sum_ab - sum_a * sum_b) / std::sqrt(spread) : 0.0;
}

double rms(const Diagnosis& found, Eigen::Vector2d PointPicture::*residual, int chain) {
  double squares = 0.0, count = 0.0;
  for (const PointPicture& point : found.points) {
    if (point.bad) continue;
    squares += (point.*residual)[chain] * (point.*residual)[chain];
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

double largest(const Diagnosis& found, Eigen::Vector2d PointPicture::*residual) {
  double value = 0.0;
  for (const PointPicture& point : found.points) {
    if (!point.bad) value = std::max(value, (point.*residual).cwiseAbs().maxCoeff());
  }
  return value;
}

std::vector<Panel> panels_of(const Diagnosis& found) {
  std::vector<Panel> panels = {{"Measured", &PointPicture::chain_before_mm}};
  panels.push_back({found.causes.size() > 1 && found.verdict != grid::diagnosis::Verdict::named_set
                        ? fmt::format("The {} causes named", found.causes.size())
                        : cause_title(found.causes.front().cause),
                    &PointPicture::best_mm});
  if (found.causes.front().rival && largest(found, &PointPicture::rival_mm) > 0.0) {
    panels.push_back({fmt::format("Rival: {}", cause_title(*found.causes.front().rival)),
                      &PointPicture::rival_mm});
  }
  panels.push_back({"What is left", &PointPicture::chain_after_mm});
  return panels;
}

Chart strip_chart(const Diagnosis& found,
                  const std::vector<Panel>& panels,
                  int chain,
                  double full_mm) {
  Chart chart{.specification = "residual_strip",
              .title = fmt::format("The {} chain", kChains[chain]),
              .caption = fmt::format(
                  "Vermilion: more chain was read than predicted; blue: less. The largest circles "
                  "are {:.2f} mm.",
                  full_mm)};
  DataTable heads{"heads", {"panel", "title", "note"}, {}};
  DataTable points{"points", {"panel", "name", "x_mm", "y_mm", "value_mm", "is_bad"}, {}};
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Panel& panel = panels[k];
    std::string note = fmt::format("rms {:.2f} mm", rms(found, panel.residual, chain));
    if (panel.residual == &PointPicture::best_mm || panel.residual == &PointPicture::rival_mm) {
      note += fmt::format(
          ", alike to {}",
          fixed(correlation(found, &PointPicture::chain_before_mm, panel.residual, chain), 2));
    }
    heads.rows.push_back({static_cast<double>(k), panel.title, note});
    for (const PointPicture& point : found.points) {
      points.rows.push_back({static_cast<double>(k),
                             name_of(point),
                             point.mark.x_mm,
                             point.mark.y_mm,
                             (point.*panel.residual)[chain],
                             point.bad});
    }
  }
  chart.data = {std::move(heads), std::move(points)};
  chart.signals = report::bed_signals(sheet_of(found), arrows_of(found, &PointPicture::before_mm));
  chart.signals.push_back({"largest_mm", std::max(full_mm, 1e-6)});
  chart.signals.push_back({"panels", static_cast<double>(panels.size())});
  return chart;
}

/// What a scatter plot shows: where a dot stands along x, and to which of two groups it belongs.
struct Scatter {
  std::string title;
  std::string caption;
  std::string x_title;
  OfChain x;
  int chain = 0;
  bool by_direction = false;
  /// Of the dots that the first colour bears.
  Eigen::Vector2d PointPicture::*first = &PointPicture::chain_before_mm;
};

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// With a margin, and never of no width.
  [[nodiscard]] Span widened(double share, double least) const {
    const double margin = std::max(share * (high - low), 0.5 * (least - (high - low)));
    return {low - margin, high + margin};
  }
};

/// Means of the good points in stretches of equal width along x.
DataTable means_of(const Diagnosis& found, const Scatter& scatter, const Span& span) {
  DataTable curve{"curve", {"x", "y_mm"}, {}};
  const std::size_t bins = found.points.size() >= 60 ? 10 : 6;
  std::vector<double> x(bins), y(bins), count(bins);
  for (const PointPicture& point : found.points) {
    if (point.bad) continue;
    const double at = scatter.x(point, scatter.chain);
    const double share = (at - span.low) / std::max(span.high - span.low, 1e-12);
    const auto bin = std::min(
        bins - 1, static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(bins)));
    x[bin] += at;
    y[bin] += point.chain_before_mm[scatter.chain];
    count[bin] += 1.0;
  }
  for (std::size_t i = 0; i < bins; ++i) {
    if (count[i] > 0.0) curve.rows.push_back({x[i] / count[i], y[i] / count[i]});
  }
  return curve;
}

Chart scatter_chart(const Diagnosis& found, const Scatter& scatter) {
  constexpr double kLeastSpanMm = 0.2;
  Chart chart{
      .specification = "residual_scatter", .title = scatter.title, .caption = scatter.caption};
  const bool has_after = !scatter.by_direction && !found.causes.empty();
  Span along, up;
  up.take(0.0);
  for (const PointPicture& point : found.points) {
    along.take(scatter.x(point, scatter.chain));
    if (point.bad) continue;
    // Both chains at one scale, so that the noise of one does not look like the error of the other.
    for (int chain = 0; chain < 2; ++chain) {
      up.take((point.*scatter.first)[chain]);
      if (has_after) up.take(point.chain_after_mm[chain]);
    }
  }
  const Span x_window = along.widened(0.03, 1e-6), y_window = up.widened(0.08, kLeastSpanMm);
  DataTable points{"points", {"name", "x", "y_mm", "is_first", "is_bad"}, {}};
  const auto add = [&](const PointPicture& point, double residual_mm, bool is_first) {
    // Bad points stand at the rim, so that they do not flatten the rest.
    points.rows.push_back({name_of(point),
                           scatter.x(point, scatter.chain),
                           std::clamp(residual_mm, y_window.low, y_window.high),
                           is_first,
                           point.bad});
  };
  for (const PointPicture& point : found.points) {
    const int direction = scatter.chain == 0 ? point.direction_left : point.direction_right;
    add(point, (point.*scatter.first)[scatter.chain], !scatter.by_direction || direction > 0);
    if (has_after) add(point, point.chain_after_mm[scatter.chain], false);
  }
  DataTable curve{"curve", {"x", "y_mm"}, {}};
  if (!scatter.by_direction) curve = means_of(found, scatter, along);
  chart.data = {std::move(points), std::move(curve)};
  chart.signals = {
      {"x_title", scatter.x_title},
      {"x_min", x_window.low},
      {"x_max", x_window.high},
      {"bottom_mm", y_window.low},
      {"top_mm", y_window.high},
      {"first_label", std::string(scatter.by_direction ? "paid out to get there" : "calibrated")},
      {"second_label",
       std::string(scatter.by_direction ? "taken in"
                   : has_after          ? "with the cause"
                                        : "")},
      {"first_color", std::string(scatter.by_direction ? kPaidOutColor : report::kBeforeColor)},
      {"second_color", std::string(scatter.by_direction ? kTakenInColor : report::kAfterColor)}};
  return chart;
}

double length_mm(const PointPicture& point, int chain) {
  return chain == 0 ? point.lengths.left_mm : point.lengths.right_mm;
}

}  // namespace

std::vector<report::ChartRow> arrow_charts(const Diagnosis& found) {
  const std::vector<Arrow> before = arrows_of(found, &PointPicture::before_mm);
  const std::vector<Arrow> after = arrows_of(found, &PointPicture::after_mm);
  const Outline sheet = sheet_of(found);
  const double coarse = report::magnification_of(sheet, before);
  const double fine = report::magnification_of(sheet, after);
  Chart first = report::arrows_chart(sheet, before, coarse, report::kBeforeColor);
  first.title = "Before: the machine calibrated";
  first.caption =
      "From where the tool should be to where it was. Grey: one sigma of the noise at that mark. "
      "Ringed: bad points.";
  if (found.causes.empty()) return {{{std::move(first)}}};
  Chart second = report::arrows_chart(sheet, after, coarse, report::kAfterColor);
  second.title = "After: with what was named, same scale";
  second.caption =
      "Arrows of the size of their grey ellipse, in all directions, are noise; neighbours that "
      "point the same way are something not explained.";
  std::vector<report::ChartRow> rows = {{{std::move(first), std::move(second)}}};
  if (fine >= 2.0 * coarse) {
    Chart close = report::arrows_chart(sheet, after, fine, report::kAfterColor);
    close.title = "After, under the magnifying glass";
    close.caption = fmt::format("The same arrows, {:g} times larger.", fine / coarse);
    rows.push_back({{std::move(close)}});
  }
  return rows;
}

std::vector<Chart> strip_charts(const Diagnosis& found) {
  if (found.causes.empty()) return {};
  const std::vector<Panel> panels = panels_of(found);
  double full_mm = 0.0;
  for (const Panel& panel : panels) full_mm = std::max(full_mm, largest(found, panel.residual));
  std::vector<Chart> charts;
  for (int chain = 0; chain < 2; ++chain)
    charts.push_back(strip_chart(found, panels, chain, full_mm));
  return charts;
}

std::vector<report::ChartRow> length_charts(const Diagnosis& found) {
  const model::Sprocket& sprocket = found.extended_machine.sprocket;
  const double turn_mm = sprocket.teeth * sprocket.pitch_mm;
  std::vector<report::ChartRow> rows;
  for (int chain = 0; chain < 2; ++chain) {
    Scatter plain{.title = fmt::format("Against the {} chain's length", kChains[chain]),
                  .caption = "",
                  .x_title = "chain length, mm",
                  .x = length_mm,
                  .chain = chain};
    Scatter folded{.title = fmt::format("Folded at one sprocket turn ({:g} mm)", turn_mm),
                   .caption = "",
                   .x_title = "mm past a full turn",
                   .x =
                       [turn_mm](const PointPicture& point, int side) {
                         const double length = length_mm(point, side);
                         return length - turn_mm * std::floor(length / turn_mm);
                       },
                   .chain = chain};
    if (chain == 1) {
      plain.caption =
          "A slope is a chain too long or short; a step is a skipped link. The line runs through "
          "the means of the dots before.";
      folded.caption = "A wave is a sprocket that runs out of true.";
    }
    rows.push_back({{scatter_chart(found, plain), scatter_chart(found, folded)}});
  }
  return rows;
}

report::ChartRow angle_charts(const Diagnosis& found) {
  report::ChartRow row;
  for (int chain = 0; chain < 2; ++chain) {
    row.charts.push_back(scatter_chart(
        found,
        {.title = fmt::format("Against the {} chain's angle", kChains[chain]),
         .caption =
             chain == 0 ? "A bend at some angle is a chain that touches something below it." : "",
         .x_title = "degrees below the horizontal at the sprocket",
         .x =
             [](const PointPicture& point, int side) {
               return (side == 0 ? point.angle_left_rad : point.angle_right_rad) * 180.0 /
                      std::numbers::pi;
             },
         .chain = chain}));
  }
  return row;
}

bool has_order(const Diagnosis& found) {
  return !found.points.empty() &&
         std::all_of(found.points.begin(), found.points.end(), [](const PointPicture& point) {
           return point.order.has_value();
         });
}

report::ChartRow order_charts(const Diagnosis& found) {
  // A cause of the visit shows before it is taken out; where there is none, what other causes do
  // would only hide what may be left.
  const bool of_the_visit =
      std::any_of(found.causes.begin(), found.causes.end(), [](const auto& cause) {
        return model::effects::depends_on_visit(*cause.cause.effect);
      });
  const bool shows_rest = !of_the_visit && !found.causes.empty();
  report::ChartRow row;
  for (int chain = 0; chain < 2; ++chain) {
    row.charts.push_back(scatter_chart(
        found,
        {.title = fmt::format(
             "The {} chain, visit by visit{}", kChains[chain], shows_rest ? ": what is left" : ""),
         .caption = chain == 0 ? "Two layers of colour are friction or play; a slope is drift; a "
                                 "step is a skipped link."
                               : "",
         .x_title = "number of the visit",
         .x = [](const PointPicture& point, int) { return static_cast<double>(*point.order); },
         .chain = chain,
         .by_direction = true,
         .first = shows_rest ? &PointPicture::chain_after_mm : &PointPicture::chain_before_mm}));
  }
  return row;
}

std::vector<Hypothesis> leading_hypotheses(const Diagnosis& found) {
  constexpr double kLeast = 0.002;
  constexpr std::size_t kMost = 12;
  std::vector<Hypothesis> leading;
  for (const Hypothesis& hypothesis : found.hypotheses) {
    if (leading.size() < kMost && (hypothesis.probability >= kLeast || leading.empty()))
      leading.push_back(hypothesis);
  }
  return leading;
}

Chart probability_chart(const Diagnosis& found) {
  Chart chart{.specification = "probability_bars",
              .title = "How probable each explanation is",
              .caption =
                  "Each for itself: causes can act together, so these need not add up to 100 %. "
                  "Below 0.2 % is left out. Blue: what the verdict names."};
  DataTable table{"hypotheses", {"what", "probability", "text", "is_named"}, {}};
  for (const Hypothesis& hypothesis : leading_hypotheses(found)) {
    std::string what = hypothesis_title(hypothesis);
    bool is_named = false;
    for (const auto& cause : found.causes) {
      if (cause.cause.effect->id != hypothesis.effect || name(cause.cause.side) != hypothesis.side)
        continue;
      is_named = true;
      for (const auto& same : cause.same_as) what += fmt::format(" = {}", cause_title(same.cause));
    }
    table.rows.push_back({what, hypothesis.probability, percent(hypothesis.probability), is_named});
  }
  chart.data.push_back(std::move(table));
  return chart;
}

Chart gain_chart(const Diagnosis& found) {
  Chart chart{.specification = "gain_bars",
              .title = "Error of the tool at points held out, rms",
              .caption = "The thin line on a bar is its 90 % interval. Held out: " +
                         found.gain->scheme + "."};
  DataTable table{"rows", {"what", "rms_mm", "low_mm", "high_mm", "most_mm", "color"}, {}};
  const auto color_of = [&](const grid::diagnosis::HeldOut* row) {
    if (row == &found.gain->extended || row == &found.gain->extended_and_surface)
      return report::kAfterColor;
    return row == &found.gain->surface_only ? report::kNeutralColor : report::kBeforeColor;
  };
  for (const GainRow& row : gain_rows(found)) {
    table.rows.push_back({std::string(row.what),
                          row.held_out->rms_mm,
                          row.held_out->low_mm,
                          row.held_out->high_mm,
                          row.held_out->percentile_95_mm,
                          std::string(color_of(row.held_out))});
  }
  chart.data.push_back(std::move(table));
  chart.signals = {{"floor_mm", found.gain->noise_floor_mm}};
  return chart;
}

Chart separation_chart(const Diagnosis& found) {
  Chart chart{
      .specification = "separation_matrix",
      .title = "How alike two causes look to these points",
      .caption = "0: nothing in common; 1: no such points tell them apart, whatever their number."};
  std::vector<std::string> names;
  const auto number_of = [&names](const std::string& what) {
    const auto at = std::find(names.begin(), names.end(), what);
    if (at != names.end()) return static_cast<double>(at - names.begin() + 1);
    names.push_back(what);
    return static_cast<double>(names.size());
  };
  DataTable cells{"cells", {"row", "column", "first", "second", "rho", "needed"}, {}};
  for (const auto& pair : found.separations) {
    const std::string first = cause_title(pair.first), second = cause_title(pair.second);
    const double a = number_of(first), b = number_of(second);
    const std::string needed =
        std::isfinite(pair.delta_needed) ? fmt::format("{:.1f}", pair.delta_needed) : "never";
    cells.rows.push_back({a, b, first, second, pair.rho, needed});
    cells.rows.push_back({b, a, second, first, pair.rho, needed});
  }
  DataTable list{"names", {"number", "what"}, {}};
  for (std::size_t i = 0; i < names.size(); ++i)
    list.rows.push_back({static_cast<double>(i + 1), names[i]});
  chart.data = {std::move(list), std::move(cells)};
  return chart;
}

Chart next_points_chart(const Diagnosis& found) {
  Chart chart{.specification = "next_points",
              .title = "On the bed",
              .caption = "Crosses: to be measured, in this order. Grey: measured already."};
  DataTable measured{"measured", {"name", "x_mm", "y_mm"}, {}};
  for (const PointPicture& point : found.points)
    measured.rows.push_back({name_of(point), point.mark.x_mm, point.mark.y_mm});
  DataTable next{"next", {"number", "what", "x_mm", "y_mm", "text"}, {}};
  std::vector<Arrow> marks = arrows_of(found, &PointPicture::before_mm);
  for (const FollowUpPlace& place : follow_up_places(found)) {
    marks.push_back({.x_mm = place.mark.x_mm, .y_mm = place.mark.y_mm});
    next.rows.push_back({place.numbers,
                         place.what,
                         place.mark.x_mm,
                         place.mark.y_mm,
                         percent(place.raises_probability_to)});
  }
  chart.data = {std::move(measured), std::move(next)};
  chart.signals = report::bed_signals(sheet_of(found), marks);
  return chart;
}

}  // namespace chaintrue::cli
