// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace chaintrue::cli {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using model::Belt;
using model::kBelts;

namespace {

/// From Okabe and Ito's palette, distinguishable with every colour vision.
constexpr model::PerBelt<const char*> kColors = {report::kBeforeColor, report::kAfterColor,
                                                 report::kFourthColor, report::kThirdColor};

/// The longest stroke of a good reading, as a share of the frame's width.
constexpr double kLongestStroke = 0.06;
/// The largest ellipse.
constexpr double kLargestEllipse = 0.05;

double width_mm(const BeltsFindings& found) {
  const auto& a = found.machine.anchors;
  return std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm);
}

/// One magnification for the residuals with the anchors alone and with the causes.
double magnification(const BeltsFindings& found) {
  double most = 0.0;
  for (const BeltPlacePicture& place : found.places) {
    for (const Belt belt : kBelts) {
      if (!place.bad[belt]) most = std::max(most, std::abs(place.before_mm[belt]));
    }
  }
  return most > 0.0 ? report::round_down_125(kLongestStroke * width_mm(found) / most) : 1.0;
}

double sigma_mm(const BeltsFindings& found, Belt belt, char axis) {
  const std::string wanted = fmt::format("{}_{}_mm", name(belt), axis);
  for (const auto& c : found.coordinates) {
    if (c.name == wanted) return c.sigma_mm;
  }
  return 0.0;
}

double ellipse_magnification(const BeltsFindings& found) {
  double most = 0.0;
  for (const auto& c : found.coordinates) most = std::max(most, c.sigma_mm);
  return most > 0.0
             ? std::max(1.0, report::round_down_125(kLargestEllipse * width_mm(found) / most))
             : 1.0;
}

DataTable anchors_table(const BeltsFindings& found) {
  DataTable table{
      "anchors",
      {"words", "x_mm", "y_mm", "sigma_x_mm", "sigma_y_mm", "color", "is_left", "is_upper"}};
  for (const Belt belt : kBelts) {
    const model::Anchor& anchor = found.machine.anchors[belt];
    table.rows.push_back({std::string(model::words(belt)), anchor.x_mm, anchor.y_mm,
                          sigma_mm(found, belt, 'x'), sigma_mm(found, belt, 'y'),
                          std::string(kColors[belt]), belt == Belt::tl || belt == Belt::bl,
                          model::is_upper(belt)});
  }
  return table;
}

DataTable strokes_table(const BeltsFindings& found,
                        model::PerBelt<double> BeltPlacePicture::*which) {
  DataTable table{"strokes",
                  {"name", "x_mm", "y_mm", "way_x", "way_y", "off_mm", "words", "color", "is_bad"}};
  for (std::size_t k = 0; k < found.places.size(); ++k) {
    const BeltPlacePicture& place = found.places[k];
    for (const Belt belt : kBelts) {
      const model::Anchor& anchor = found.machine.anchors[belt];
      const double x = anchor.x_mm - place.at.x_mm;
      const double y = anchor.y_mm - place.at.y_mm;
      const double away = std::max(std::hypot(x, y), 1e-9);
      const double off = (place.*which)[belt];
      // A bad reading's stroke would leave the picture.
      const double longest = 4.0 * kLongestStroke * width_mm(found) / magnification(found);
      table.rows.push_back({fmt::format("point {}", k + 1), place.at.x_mm, place.at.y_mm, x / away,
                            y / away, place.bad[belt] ? std::clamp(off, -longest, longest) : off,
                            std::string(model::words(belt)), std::string(kColors[belt]),
                            place.bad[belt]});
    }
  }
  return table;
}

}  // namespace

Chart frame_chart(const BeltsFindings& found, std::string title,
                  model::PerBelt<double> BeltPlacePicture::*which) {
  Chart chart{.specification = "belt_frame", .title = std::move(title)};
  DataTable frame{"frame", {"x_mm", "y_mm"}};
  const auto& a = found.machine.anchors;
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;
  for (const model::Anchor& corner : {a.bl, a.tl, a.tr, a.br, a.bl}) {
    frame.rows.push_back({corner.x_mm, corner.y_mm});
    x_min = std::min(x_min, corner.x_mm);
    x_max = std::max(x_max, corner.x_mm);
    y_min = std::min(y_min, corner.y_mm);
    y_max = std::max(y_max, corner.y_mm);
  }
  const double margin = 0.05 * (x_max - x_min);
  const double drawn = magnification(found);
  const double ellipses = ellipse_magnification(found);
  const double key_mm = report::round_down_125(kLongestStroke * width_mm(found) / drawn);
  chart.data = {std::move(frame), anchors_table(found), strokes_table(found, which)};
  chart.signals = {
      {"x_min_mm", x_min - margin},
      {"x_max_mm", x_max + margin},
      {"y_min_mm", y_min - margin},
      {"y_max_mm", y_max + margin},
      {"magnification", drawn},
      {"key_mm", key_mm},
      {"key_text", fmt::format("{:g} mm, drawn {:g} times as long", key_mm, drawn)},
      {"ellipses", ellipses},
      {"ellipses_text", fmt::format("anchors: one sigma, {:g} times as large", ellipses)}};
  return chart;
}

}  // namespace chaintrue::cli
