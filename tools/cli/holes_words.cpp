// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/holes_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace chaintrue::cli {
namespace {

using report::number_column;
using report::signed_column;
using report::text_column;

std::string effect_words(const grid::DetectableEffect& effect) {
  return effect.side.empty() ? effect.effect : fmt::format("{} ({})", effect.effect, effect.side);
}

/// Patterns fainter than this cannot be distinguished from chance.
constexpr double kFaintSigmas = 3.0;
constexpr double kDoubtfulSigmas = 1.0;

std::string listed(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

Section distances_section(const MeasuredHoles& set, const grid::FittedDistances& fit,
                          std::string_view file) {
  Table table{.columns = {text_column("Distance", 22),
                          number_column("measured", 10, 1),
                          number_column("commanded", 11, 1),
                          signed_column("left out", 11),
                          signed_column("sigmas", 10, 1),
                          {.gap = 2}},
              .is_headed = true};
  for (std::size_t k = 0; k < fit.distances.size(); ++k) {
    const grid::FittedDistance& distance = fit.distances[k];
    table.rows.push_back(
        report::row_with_flag({words_of(set, set.distances[k]), distance.measured_mm,
                               distance.commanded_mm, distance.left_out_mm, distance.sigmas()},
                              distance.rejected, "left out"));
  }
  Section section{"Distance by distance", {}, true, Detail::verbose, /*is_titled=*/false};
  if (!file.empty()) section.say(fmt::format("{}:", file));
  section.blocks.emplace_back(std::move(table));
  return section;
}

void add_legend(const grid::estimation::ParameterKnowledge& knowledge, Section& distances) {
  distances.say(
      fmt::format("Chain scales: left {:+.3f} +- {:.3f} %, right {:+.3f} +- {:.3f} % "
                  "(readings relative to the model's lengths).",
                  100.0 * knowledge.mean[6], 100.0 * std::sqrt(knowledge.covariance(6, 6)),
                  100.0 * knowledge.mean[7], 100.0 * std::sqrt(knowledge.covariance(7, 7))));
  distances.say("Left out: measured minus predicted by the other readings, mm.");
}

std::string distances_in_number(const MeasuredHoles& set) {
  const auto edges = std::count_if(set.distances.begin(), set.distances.end(),
                                   [](const auto& distance) { return distance.edge.has_value(); });
  const auto all = static_cast<std::ptrdiff_t>(set.distances.size());
  return edges == 0 ? fmt::format("{} distances", all)
                    : fmt::format("{} distances and {} to the sheet's edges", all - edges, edges);
}

std::string workshop_list(const grid::HolesPlan& plan) {
  std::string text = "hole,x_mm,y_mm\n";
  for (const grid::Hole& hole : plan.set.holes) {
    text += fmt::format("{},{:.0f},{:.0f}\n", hole.name, hole.commanded.x_mm + 0.0,
                        hole.commanded.y_mm + 0.0);
  }
  text +=
      "# Write the tape's reading into distance_mm, and leave it empty if you did not measure; the "
      "expected value is next to it.\n";
  text += "from,to,distance_mm,as_commanded_mm\n";
  for (const grid::HoleDistance& distance : plan.set.distances) {
    text += fmt::format("{},{},,{:.0f}\n", plan.set.holes[distance.from].name,
                        distance.edge ? name(*distance.edge) : plan.set.holes[distance.to].name,
                        distance.distance_mm);
  }
  return text;
}

std::string plan_in_words(const grid::HolesPlan& plan, const HolesPlanRequest& request) {
  std::string text = fmt::format(
      "{} holes, {}. With errors of {:g} mm for the tape and {:g} mm for a hole (one sigma) the "
      "expected error of the tool is {:.2f} mm rms over the bed, {}; without measurement {:.2f} "
      "mm{}.\n\nWhat the set shows                    before     after\n",
      plan.set.holes.size(), distances_in_number(plan.set), request.tape_sigma_mm,
      request.hole_sigma_mm, plan.expected_rms_mm,
      request.edges ? "including the sheet's placement" : "for the best placement of the sheet",
      plan.expected_before_mm, request.edges ? " for the best placement of the sheet" : "");
  std::vector<std::string> unreported;
  constexpr double kHardlyBetter = 0.7;
  for (const grid::PlannedKnowledge& known : plan.knowledge) {
    text += fmt::format("  {:<30}{:>12.3f}{:>10.3f} {}\n", known.name, known.before, known.after,
                        known.unit);
    if (known.after > kHardlyBetter * known.before) unreported.push_back(known.name);
  }
  text += fmt::format("It does not determine: {}.{}\n", listed(unreported),
                      request.edges ? "" : " To locate the sheet, measure to its edges: --edges.");
  std::vector<std::string> clear;
  std::vector<std::string> doubtful;
  std::vector<std::string> unseen;
  std::vector<std::string> equal;
  for (std::size_t i = 0; i < plan.effects.size(); ++i) {
    const grid::DetectableEffect& effect = plan.effects[i];
    (effect.sigmas >= kFaintSigmas      ? clear
     : effect.sigmas >= kDoubtfulSigmas ? doubtful
                                        : unseen)
        .push_back(effect_words(effect));
    for (const std::size_t other : effect.same_as) {
      if (other <= i || effect.sigmas < kDoubtfulSigmas) continue;
      equal.push_back(
          fmt::format("{} and {}", effect_words(effect), effect_words(plan.effects[other])));
    }
  }
  text += fmt::format(
      "Detectable causes of usual size that no setting can imitate: {}.\nDoubtful: {}.\nNot "
      "detectable: {}.\nIndistinguishable: {}.\n",
      listed(clear), listed(doubtful), listed(unseen), listed(equal));
  return text;
}

}  // namespace chaintrue::cli
