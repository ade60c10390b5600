// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Indexed by OfferedCause::Reason.
constexpr std::string_view kOffered[] = {
    "Possible cause: {}. It is not certain enough to be used in the map; chaintrue diagnose "
    "proposes "
    "what to measure next.",
    "Probable cause: {}. The tape used to place the marks may be wrong instead; marks alone cannot "
    "show which. Measure a hundred links, or the tape, and enter the reading. If you know that it "
    "is "
    "the chain, use --accept-class.",
    "Probable cause: {}. The marks themselves are wrong: correct them, or place them again.",
    "Probable cause: {}. The map already corrects it."};

}  // namespace

std::vector<std::string> in_words(const CausesFit& fit) {
  std::vector<std::string> sentences;
  const auto worded = [](const Cause& cause) {
    std::string same;
    for (const SameCause& other : cause.same_as) {
      same += fmt::format(", or else {}: {}", sized(other.cause, {}),
                          in_workshop_units(other.cause, other.parameters.front()));
    }
    return fmt::format("{} ({}; {}{})", sized(cause.cause, {}),
                       in_workshop_units(cause.cause, cause.parameters.front()),
                       percent(cause.probability), same);
  };
  if (!fit.not_weighed.empty())
    sentences.push_back("No cause was looked for: " + fit.not_weighed + ".");
  if (!fit.built_on.empty()) {
    sentences.push_back(fmt::format(
        "Found and used in the map: {}. In parts of the bed left out of the fit the "
        "map is off by {:.2f} mm rms; without {} it would be {:.2f} mm.",
        joined(mapped(fit.built_on, worded), "and"), fit.held_out->with_causes_mm,
        fit.built_on.size() == 1 ? "this cause" : "these causes", fit.held_out->plain_mm));
  }
  if (sentences.empty() && fit.offered.empty())
    sentences.emplace_back("No single cause stands out, and the map needs none.");
  for (const OfferedCause& offered : fit.offered) {
    sentences.push_back(
        fmt::format(fmt::runtime(kOffered[as_size(offered.reason)]), worded(offered.cause)));
  }
  if (fit.left_open_mm > 0.0) {
    sentences.push_back(fmt::format("{}. This contributes {:.2f} mm rms to the expected error.",
                                    fit.offered.empty()
                                        ? "The sizes and places of the causes are not known exactly"
                                        : "Causes that were found but are not in the map may "
                                          "still act",
                                    fit.left_open_mm));
  }
  return sentences;
}

}  // namespace chaintrue::grid::diagnosis
