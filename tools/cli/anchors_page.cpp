// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/anchors_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/belts_frame_chart.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::BeltPlacePicture;
using grid::diagnosis::BeltsFindings;
using model::Belt;
using model::kBelts;
using report::Chart;
using report::Section;
using report::Table;
using report::Tone;

/// A fit as a diagnosis without causes has it: the same picture.
BeltsFindings findings_of(const grid::BeltsFit& fit) {
  BeltsFindings found;
  found.machine = fit.machine;
  for (std::size_t i = 0; i < fit.coordinates.size(); ++i) {
    const grid::AnchorCoordinate& c = fit.coordinates[i];
    found.coordinates[i] = {c.name, c.stated_mm, c.fitted_mm, c.fitted_mm, c.sigma_mm};
  }
  for (const grid::FittedPlace& place : fit.places) {
    BeltPlacePicture& picture = found.places.emplace_back();
    picture.at = place.at;
    for (const Belt belt : kBelts) {
      picture.before_mm[belt] = place.belts[belt].off_mm;
      picture.bad[belt] = !place.belts[belt].counts;
    }
  }
  return found;
}

Section fitted_anchors_section(const grid::BeltsFit& fit) {
  Table table{
      {{"anchor"}, {"stated, mm", true}, {"fitted, mm", true}, {"\u00b1", true}, {"rests on"}},
      {},
      "From the bottom left anchor, x to the bottom right one; \u00b1: one sigma; rests on: the "
      "share of its variance that comes of each belt's readings."};
  for (const auto& c : fit.coordinates) {
    const auto belt = model::belt_of(c.name.substr(0, 2));
    std::string rests;
    for (const Belt on : kBelts)
      rests +=
          fmt::format("{}{} {:.0f} %", rests.empty() ? "" : ", ", name(on), 100.0 * c.rests_on[on]);
    table.rows.push_back(
        {{fmt::format("{} {}", belt ? model::words(*belt) : "", c.name.substr(3, 1)),
          c.stated_mm ? fixed(*c.stated_mm, 1) : "\u2013",
          fixed(c.fitted_mm, 2),
          fixed(c.sigma_mm, 2),
          fit.places.empty() ? "what is stated" : rests},
         false});
  }
  return {"The anchors", {std::move(table)}};
}

Section taped_section(const grid::HolesBesideBelts& holes) {
  Table table{{{"distance"}, {"taped, mm", true}, {"off, mm", true}, {"foretold without it", true}},
              {},
              "A flagged distance was set aside: the others foretell another."};
  for (const grid::BeltTapedDistance& distance : holes.distances) {
    table.rows.push_back({{distance.words,
                           fixed(distance.measured_mm, 1),
                           fixed(distance.off_mm, 2),
                           fmt::format("{} \u00b1 {}",
                                       fixed(distance.left_out_mm, 2),
                                       fixed(distance.left_out_sigma_mm, 2))},
                          distance.set_aside});
  }
  return {"Holes on the sheet", {std::move(table)}};
}

Section foretold_section(const grid::BeltsFit& fit) {
  Table table{{{"left out"}, {"rms, mm", true}, {"at worst, mm", true}},
              {},
              "Lower belts as the upper two foretell them, at places that had no part."};
  table.rows.push_back({{"one place after the other",
                         fixed(fit.one_left_out.rms_mm, 2),
                         fixed(fit.one_left_out.largest_mm, 2)},
                        false});
  if (fit.half_left_out) {
    table.rows.push_back({{"either half",
                           fixed(fit.half_left_out->rms_mm, 2),
                           fixed(fit.half_left_out->largest_mm, 2)},
                          false});
  }
  return {"Foretold", {std::move(table)}};
}

/// Verdict, figures, lights and advice.
void say(const grid::BeltsFit& fit, report::Document& page) {
  double worst = 0.0;
  for (const auto& c : fit.coordinates) worst = std::max(worst, c.sigma_mm);
  page.verdict.text = fmt::format("The anchors are known to {:.2g} mm at worst.", worst);
  if (!fit.places.empty()) {
    page.verdict.text += fmt::format(" One belt's reading is off by {:.2f} mm.", fit.spread_mm);
    page.figures = {{fmt::format("{:.2f} mm", fit.spread_mm), "one belt is off by"},
                    {fmt::format("{:.2f} mm", fit.rms_mm), "rms as the machine counts"}};
  }
  page.tone = fit.bad.empty() && fit.bad_points.empty() ? Tone::good : Tone::caution;
  page.lights = {{fit.scale ? Tone::good : Tone::caution,
                  "Scale known?",
                  fit.scale ? "yes, by the tape" : "not without a tape"}};
  if (fit.scale) {
    page.figures.push_back(
        {fmt::format("{:.5f} \u00b1 {:.5f}", fit.scale->factor, fit.scale->sigma),
         "scale: true over what belts say"});
  } else {
    page.advice.push_back({
        "Tape one long distance: no belt knows how large the frame is. "
        "chaintrue fit says which tells most."});
  }
}

}  // namespace

report::Document anchors_page(const grid::BeltsFit& fit,
                          const grid::HolesBesideBelts* holes,
                          std::string_view name,
                          std::string_view source) {
  report::Document page;
  page.title = fmt::format("Anchors: {}", name.empty() ? source : name);
  page.subtitle = fmt::format("{}, {} places", fit.machine.name, fit.places.size());
  say(fit, page);
  if (!fit.places.empty()) {
    page.advice.push_back({"Ask why what is left is left: chaintrue diagnose of the same belts."});
    Chart chart = frame_chart(findings_of(fit), "Anchors as fitted", &BeltPlacePicture::before_mm);
    chart.caption = kFrameCaption;
    page.sections.push_back({"The frame, and what its belts disagree about", {std::move(chart)}});
  }
  page.sections.push_back(fitted_anchors_section(fit));
  if (fit.one_left_out.readings > 0) page.sections.push_back(foretold_section(fit));
  if (holes != nullptr) page.sections.push_back(taped_section(*holes));
  page.has_glossary = true;
  page.provenance = fmt::format("Made from {} by chaintrue {}.", source, CHAINTRUE_VERSION);
  return page;
}

}  // namespace chaintrue::cli
