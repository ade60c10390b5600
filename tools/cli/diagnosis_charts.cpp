// SPDX-License-Identifier: GPL-3.0-or-later

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "grid/raster.hpp"
#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

constexpr const char* kChains[] = {"left", "right"};

std::vector<Arrow> arrows_of(const Diagnosis& found, Eigen::Vector2d PointPicture::*shift) {
  return mapped(found.points,
                [&](const PointPicture& point) { return arrow_of(point, point.*shift); });
}

struct Panel {
  std::string title;
  Eigen::Vector2d PointPicture::*residual;
};

/// Over the good points, both taken about their means.
double correlation(const Diagnosis& found, Eigen::Vector2d PointPicture::*first,
                   Eigen::Vector2d PointPicture::*second, int chain) {
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

double largest(const Diagnosis& found, Eigen::Vector2d PointPicture::*residual) {
  return summary_of_good(
             found.points,
             [&](const PointPicture& point) { return (point.*residual).lpNorm<Eigen::Infinity>(); })
      .maximum_mm;
}

std::vector<Panel> panels_of(const Diagnosis& found) {
  std::vector<Panel> panels = {{"Measured", &PointPicture::chain_before_mm}};
  panels.push_back({title_of_causes(found), &PointPicture::best_mm});
  if (found.causes.front().rival && largest(found, &PointPicture::rival_mm) > 0.0) {
    panels.push_back({title_of_rival(found), &PointPicture::rival_mm});
  }
  panels.push_back({"What is left", &PointPicture::chain_after_mm});
  return panels;
}

/// A rival that explains little may predict far more than was measured.
std::string clipped_in_words(const Diagnosis& found, double full_mm) {
  // As residual_strip.vg.json draws: an area of 1.6 times the largest, no more.
  constexpr double kLargestDrawn = 1.6;
  const double rival_mm =
      found.causes.front().rival ? largest(found, &PointPicture::rival_mm) : 0.0;
  if (rival_mm <= kLargestDrawn * full_mm) return {};
  return fmt::format(" The rival's reach {:.2f} mm and are drawn no larger than {:.2f} mm.",
                     rival_mm, kLargestDrawn * full_mm);
}

Chart strip_chart(const Diagnosis& found, const std::vector<Panel>& panels, int chain,
                  double full_mm) {
  Chart chart{
      .specification = "residual_strip",
      .title = fmt::format("The {} chain", kChains[chain]),
      .caption = fmt::format("Vermilion: more chain was read than expected; blue: less. All panels "
                             "have the same scale: the largest measured circle is {:.2f} mm.{}",
                             full_mm, clipped_in_words(found, full_mm))};
  DataTable heads{"heads", {"panel", "title", "note"}};
  DataTable points{"points", {"panel", "name", "x_mm", "y_mm", "value_mm", "is_bad"}};
  for (const auto k : each_index(panels)) {
    const Panel& panel = panels[k];
    const auto of_chain = [&](const PointPicture& p) { return (p.*panel.residual)[chain]; };
    std::string note = fmt::format("rms {:.2f} mm", summary_of_good(found.points, of_chain).rms_mm);
    if (panel.residual == &PointPicture::best_mm || panel.residual == &PointPicture::rival_mm) {
      note += fmt::format(
          ", the same to {}",
          fixed(correlation(found, &PointPicture::chain_before_mm, panel.residual, chain), 2));
    }
    heads.rows.push_back({as_double(k), panel.title, note});
    for (const PointPicture& point : found.points) {
      points.rows.push_back({as_double(k), point_name(point.index), point.mark.x_mm,
                             point.mark.y_mm, (point.*panel.residual)[chain], point.bad});
    }
  }
  chart.data = {std::move(heads), std::move(points)};
  chart.signals = bed_signals(bed_of(found), arrows_of(found, &PointPicture::before_mm));
  chart.signals.push_back({"largest_mm", std::max(full_mm, 1e-6)});
  chart.signals.push_back({"panels", as_double(panels.size())});
  return chart;
}

}  // namespace

report::Outline bed_of(const Diagnosis& found) {
  const Rectangle bed = grid::area_of(found.extended_machine.bed);
  return {bed.x_min, bed.x_max, bed.y_min, bed.y_max};
}

Arrow arrow_of(const PointPicture& point, const Eigen::Vector2d& shift_mm) {
  return {point_name(point.index),
          point.mark.x_mm,
          point.mark.y_mm,
          shift_mm.x(),
          shift_mm.y(),
          point.bad,
          point.noise_sigma_mm.x(),
          point.noise_sigma_mm.y()};
}

std::string title_of_causes(const Diagnosis& found) {
  const bool act_together = found.causes.size() > 1 && found.verdict != Verdict::named_set;
  return act_together ? fmt::format("The {} causes named", found.causes.size())
                      : cause_title(found.causes.front().cause);
}

std::string title_of_rival(const Diagnosis& found) {
  return fmt::format("Rival: {}", cause_title(*found.causes.front().rival));
}

namespace {

std::vector<ChartRow> arrow_charts(const Diagnosis& found) {
  return arrow_rows(
      bed_of(found), arrows_of(found, &PointPicture::before_mm),
      found.causes.empty() ? std::vector<Arrow>{} : arrows_of(found, &PointPicture::after_mm),
      {"Before: the machine calibrated",
       "Arrows from the intended to the actual position of the tool. Grey: one sigma of the noise "
       "at that mark. Ringed: bad points.",
       "After: with what was named, same scale",
       "Arrows within their grey ellipse, in random directions, are noise; neighbours pointing the "
       "same way show an unexplained error."});
}

std::vector<Chart> strip_charts(const Diagnosis& found) {
  if (found.causes.empty() || found.points.empty()) return {};
  const std::vector<Panel> panels = panels_of(found);
  // Measurement and remainder are compared; a rival may be larger than either.
  const double full_mm = largest(found, &PointPicture::chain_before_mm);
  std::vector<Chart> charts;
  for (int chain = 0; chain < 2; ++chain)
    charts.push_back(strip_chart(found, panels, chain, full_mm));
  return charts;
}

}  // namespace

Section arrows_section(const Diagnosis& found) {
  if (is_of_distances(found)) return {"What it does to the distances", {distance_chart(found)}};
  Section section{"What it does to the tool"};
  append_all(section.blocks, arrow_charts(found));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_chart(found));
  return section;
}

Section signature_section(const Diagnosis& found) {
  Section section{"Why this cause"};
  section.say(
      "Measured errors next to the effect of the cause, both after refitting the "
      "settings. The cause is right if both pictures agree and only noise remains.");
  append_all(section.blocks, strip_charts(found));
  if (!found.distances.empty()) section.blocks.emplace_back(distance_strip_chart(found));
  return section;
}

Chart next_points_chart(const Diagnosis& found) {
  Chart chart{.specification = "next_points",
              .title = "On the bed",
              .caption = "Crosses: to be measured, in this order. Grey: already measured."};
  DataTable measured{"measured", {"name", "x_mm", "y_mm"}};
  for (const PointPicture& point : found.points)
    measured.rows.push_back({point_name(point.index), point.mark.x_mm, point.mark.y_mm});
  DataTable next{"next", {"number", "what", "x_mm", "y_mm", "text"}};
  std::vector<Arrow> marks = arrows_of(found, &PointPicture::before_mm);
  for (const FollowUpPlace& place : follow_up_places(found)) {
    marks.push_back({.x_mm = place.mark.x_mm, .y_mm = place.mark.y_mm});
    next.rows.push_back({place.numbers, place.what, place.mark.x_mm, place.mark.y_mm,
                         percent(place.raises_probability_to)});
  }
  chart.data = {std::move(measured), std::move(next)};
  chart.signals = bed_signals(bed_of(found), marks);
  return chart;
}

}  // namespace chaintrue::cli
