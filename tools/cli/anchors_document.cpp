// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/anchors_document.hpp"

#include <fmt/format.h>

#include <optional>

#include "tools/cli/anchors_sections.hpp"
#include "tools/cli/belts_frame_chart.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::BeltPlacePicture;
using diagnosis::BeltsFindings;
using model::Belt;
using model::kBelts;

/// A fit as a diagnosis without causes: the same picture.
BeltsFindings findings_of(const BeltsFit& fit) {
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
      picture.before_mm[belt] = place.belts[belt].residual_mm;
      picture.bad[belt] = !place.belts[belt].counts;
    }
  }
  return found;
}

/// The headline, and below it figures, lights and advice.
void put_the_verdict(const FittedBelts& fitted,
                     const std::optional<BeltsError>& error,
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
  page.lights = {{fit.scale ? Tone::good : Tone::caution,
                  "Scale known?",
                  fit.scale ? "yes, from the tape" : "no, not taped"}};
  if (fit.scale) {
    page.figures.push_back({fmt::format("{:.5f} +- {:.5f}", fit.scale->factor, fit.scale->sigma),
                            "scale: true length over the belts' length"});
  }
}

}  // namespace

Document anchors_document(const FittedBelts& fitted,
                          std::string_view name,
                          std::string_view source) {
  const BeltsFit& fit = fitted.fit;
  Document document;
  document.title = fmt::format("Anchors: {}", name.empty() ? source : name);
  document.subtitle = fmt::format("{}, {} places", fit.machine.name, fit.places.size());
  const auto error = grid::error_of_belts(fit, fitted.holes);
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
  document.provenance = fmt::format("Made from {} by chaintrue {}.", source, CHAINTRUE_VERSION);
  return document;
}

}  // namespace chaintrue::cli
