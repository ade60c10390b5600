// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include "tools/cli/diagnosis_sections.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using report::signed_column;

/// A fit as a diagnosis without causes: the same picture.
BeltsFindings findings_of(const BeltsFit& fit) {
  BeltsFindings found;
  found.machine = fit.machine;
  for (const auto i : each_index(fit.coordinates)) {
    const grid::AnchorCoordinate& c = fit.coordinates[i];
    found.coordinates[i] = {c.name, c.stated_mm, c.fitted_mm, c.fitted_mm, c.sigma_mm};
  }
  for (const grid::FittedPlace& place : fit.places) {
    BeltPlacePicture& picture = found.places.emplace_back();
    picture.at = place.at;
    for (const Belt belt : kBelts) {
      picture.before_mm[belt] = place.belts[belt].residual_mm;
      picture.bad[belt] = !place.belts[belt].counts;
    }
  }
  return found;
}

std::vector<Figure> figures_of(const BeltsError& error) {
  std::vector<Figure> figures;
  if (error.today)
    figures.push_back({fmt::format("{} mm", about_mm(error.today->rms_mm)), kToolTodayLabel});
  figures.push_back({fmt::format("{} mm", about_mm(error.expected.rms_mm)),
                     "expected error of the tool with these anchors, rms"});
  return figures;
}

report::Column variance_share(std::string heading, std::string page_heading, int width) {
  return {.heading = std::move(heading),
          .is_number = true,
          .page_heading = std::move(page_heading),
          .width = width,
          .detail = Detail::verbose};
}

Section fitted_anchors_section(const BeltsFit& fit) {
  Table table{.columns = {text_column("Anchor", 6), number_column("fitted", 12),
                          number_column("sure to", 9), number_column("in force", 11, 1),
                          signed_column("differs", 9, 1), variance_share("rests on tl", "", 14),
                          variance_share("tr", "on tr", 5), variance_share("bl", "on bl", 5),
                          variance_share("br", "on br", 5)},
              .caption = std::string(kAnchorsCaption) +
                         " Rests on: share of its variance from each belt's readings.",
              .is_headed = true};
  for (const grid::AnchorCoordinate& c : fit.coordinates) {
    Row& row = table.rows.emplace_back();
    row.cells = {coordinate_title(c.name), c.fitted_mm, c.sigma_mm, c.stated_mm};
    row.cells.emplace_back(c.stated_mm ? std::optional(c.fitted_mm - *c.stated_mm) : std::nullopt);
    for (const Belt belt : kBelts)
      row.cells.emplace_back(fmt::format("{:.0f}%", 100.0 * c.variance_share[belt]));
  }
  return {"The anchors, mm", {std::move(table)}};
}

Section places_section(const FittedBelts& fitted) {
  const BeltsFit& fit = fitted.fit;
  Table table{
      .columns = {number_column("Point", 3, 0), number_column("x", 10, 1),
                  number_column("y", 10, 1), number_column("read minus fitted, mm:   tl", 30),
                  number_column("tr", 8), number_column("bl", 8), number_column("br", 8)},
      .is_headed = true};
  for (const auto k : each_index(fit.places)) {
    const grid::FittedPlace& place = fit.places[k];
    Row& row = table.rows.emplace_back();
    row.cells = {as_double(1 + grid::index_in_file(fitted.indices, k)), place.at.x_mm,
                 place.at.y_mm};
    for (const Belt belt : kBelts) {
      const auto& residual = place.belts[belt];
      row.cells.emplace_back(
          fmt::format("{:+.2f}{}", residual.residual_mm, residual.counts ? ' ' : '*'));
    }
  }
  Section section{"Place by place", {std::move(table)}, true, Detail::verbose};
  if (!fit.bad.empty()) section.say("* left out");
  return section;
}

Section taped_section(const HolesWithBelts& holes) {
  Table table{.columns = {text_column("Distance", 14),
                          number_column("taped", 8, 1),
                          signed_column("off, mm", 10),
                          signed_column("alone", 11),
                          number_column("+-", 8),
                          {.gap = 1}},
              .caption = "Alone: taped minus predicted from all others. * left out.",
              .is_headed = true,
              .head_width = 15};
  for (const grid::BeltTapedDistance& distance : holes.distances) {
    table.add({distance.words, distance.measured_mm, distance.residual_mm, distance.left_out_mm,
               distance.left_out_sigma_mm},
              distance.rejected, "*");
  }
  return {"Holes on the sheet", {std::move(table)}, false, Detail::verbose};
}

/// The headline, and below it figures, lights and advice.
void put_the_verdict(const FittedBelts& fitted, const std::optional<BeltsError>& error,
                     Document& page) {
  const BeltsFit& fit = fitted.fit;
  page.verdict = {headline_of(fit, error)};
  if (error) page.figures = figures_of(*error);
  if (!fit.places.empty()) {
    page.figures.push_back({fmt::format("{:.2f} mm", fit.residual_sigma_mm), "one belt is off by"});
    page.advice.push_back(
        {"To find the cause of the remaining error, run chaintrue diagnose on the same belts.",
         Detail::page});
  }
  page.tone = fit.bad.empty() && fit.bad_points.empty() ? Tone::good : Tone::caution;
  page.lights = {{fit.scale ? Tone::good : Tone::caution, "Scale known?",
                  fit.scale ? "yes, from the tape" : "no, not taped"}};
  if (fit.scale) {
    page.figures.push_back({fmt::format("{:.5f} +- {:.5f}", fit.scale->factor, fit.scale->sigma),
                            "scale: true length over the belts' length"});
  }
}

}  // namespace

Document anchors_document(const FittedBelts& fitted, std::string_view name,
                          std::string_view source) {
  const BeltsFit& fit = fitted.fit;
  Document document;
  document.title = fmt::format("Anchors: {}", name.empty() ? source : name);
  document.subtitle = fmt::format("{}, {} places", fit.machine.name, fit.places.size());
  const auto error = error_of_belts(fit, fitted.holes);
  put_the_verdict(fitted, error, document);
  document.remarks = agreement_section(fitted, error);
  if (!fit.places.empty()) {
    Chart chart = frame_chart(findings_of(fit), "Anchors as fitted", &BeltPlacePicture::before_mm);
    chart.caption = kFrameCaption;
    document.sections.push_back({"The frame, and the residuals of its belts", {std::move(chart)}});
  }
  document.sections.push_back(fitted_anchors_section(fit));
  document.sections.push_back(tests_section(fitted));
  if (!fit.places.empty()) document.sections.push_back(places_section(fitted));
  if (fitted.holes != nullptr) document.sections.push_back(taped_section(*fitted.holes));
  document.has_glossary = true;
  document.provenance = provenance_of(source);
  return document;
}

}  // namespace chaintrue::cli
