// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <cmath>

#include "grid/files/holes_file.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace {

void check(const HolesPlanRequest& request, const Bed& bed) {
  OptionProblems problems;
  require_sound(problems, request);
  require_margin(problems, request.margin_mm, bed, grid::kLeastPlannedSideMm);
  problems.throw_if_any();
}

}  // namespace

void require_sound(OptionProblems& problems, const HolesPlanRequest& request) {
  if (request.distances == 0) return;
  problems.require("--distances", request.distances, grid::fewest_distances(request.edges),
                   grid::most_distances(request.holes, request.edges));
}

void add_tape_options(Verb verb, HolesPlanRequest& request) {
  verb.has({{"--distances",
             {request.distances, {"", 1.0, 10000.0}},
             "With --holes: number of distances to measure; by default twice the number of holes "
             "plus two, and six more with --edges",
             facts::tape,
             "to be left out without --holes"},
            {"--edges", request.edges,
             "With --holes: also measure to the sheet's edges, so that jobs are placed "
             "correctly on the sheet",
             facts::tape, "to be left out without --holes"},
            {"--tape-sigma-mm",
             {request.tape_sigma_mm, files::kTapeSigmaMm},
             "With --holes: standard deviation (1 sigma) of a tape reading",
             facts::tape,
             "to be left out without --holes"},
            {"--hole-sigma-mm",
             {request.hole_sigma_mm, files::kHoleSigmaMm},
             "With --holes: standard deviation (1 sigma) of a hole's position on each axis",
             facts::tape,
             "to be left out without --holes"}});
}

namespace {

std::string effect_words(const grid::DetectableEffect& effect) {
  return effect.side.empty() ? effect.effect : fmt::format("{} ({})", effect.effect, effect.side);
}

/// Patterns fainter than this cannot be distinguished from chance.
constexpr double kFaintSigmas = 3.0;
constexpr double kDoubtfulSigmas = 1.0;

std::string listed(const Words& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

Section distances_section(const MeasuredHoles& set, const grid::FittedDistances& fit,
                          std::string_view file) {
  Table table{.columns = {text_column("Distance", 22),
                          number_column("measured", 10, 1),
                          number_column("commanded", 11, 1),
                          report::signed_column("left out", 11),
                          report::signed_column("sigmas", 10, 1),
                          {.gap = 2}},
              .is_headed = true};
  for (const auto k : each_index(fit.distances)) {
    const grid::FittedDistance& distance = fit.distances[k];
    table.add({words_of(set, set.distances[k]), distance.measured_mm, distance.commanded_mm,
               distance.left_out_mm, distance.sigmas()},
              distance.rejected, "left out");
  }
  Section section{"Distance by distance", {}, true, Detail::verbose, /*is_titled=*/false};
  if (!file.empty()) section.say("{}:", file);
  section.blocks.emplace_back(std::move(table));
  return section;
}

void add_legend(const grid::estimation::ParameterKnowledge& knowledge, Section& distances) {
  distances.say(
      "Chain scales: left {:+.3f} +- {:.3f} %, right {:+.3f} +- {:.3f} % "
      "(readings relative to the model's lengths).",
      100.0 * knowledge.mean[6], 100.0 * std::sqrt(knowledge.covariance(6, 6)),
      100.0 * knowledge.mean[7], 100.0 * std::sqrt(knowledge.covariance(7, 7)));
  distances.say("Left out: measured minus predicted by the other readings, mm.");
}

std::string distances_in_number(const MeasuredHoles& set) {
  const std::size_t edges = count_where(set.distances, &grid::HoleDistance::edge);
  const std::size_t all = set.distances.size();
  return edges == 0 ? fmt::format("{} distances", all)
                    : fmt::format("{} distances and {} to the sheet's edges", all - edges, edges);
}

std::string workshop_list(const HolesPlan& plan) {
  std::string text = "hole,x_mm,y_mm\n";
  for (const Hole& hole : plan.set.holes) {
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

namespace {

/// What the plan's set will determine, and what it cannot distinguish.
std::string plan_in_words(const HolesPlan& plan, const HolesPlanRequest& request) {
  std::string text = fmt::format(
      "{} holes, {}. With errors of {:g} mm for the tape and {:g} mm for a hole (one sigma) the "
      "expected error of the tool is {:.2f} mm rms over the bed, {}; without measurement {:.2f} "
      "mm{}.\n\nWhat the set shows                    before     after\n",
      plan.set.holes.size(), distances_in_number(plan.set), request.tape_sigma_mm,
      request.hole_sigma_mm, plan.expected_rms_mm,
      request.edges ? "including the sheet's placement" : "for the best placement of the sheet",
      plan.expected_before_mm, request.edges ? " for the best placement of the sheet" : "");
  Words unreported;
  constexpr double kHardlyBetter = 0.7;
  for (const grid::PlannedKnowledge& known : plan.knowledge) {
    text += fmt::format("  {:<30}{:>12.3f}{:>10.3f} {}\n", known.name, known.before, known.after,
                        known.unit);
    if (known.after > kHardlyBetter * known.before) unreported.push_back(known.name);
  }
  text += fmt::format("It does not determine: {}.{}\n", listed(unreported),
                      request.edges ? "" : " To locate the sheet, measure to its edges: --edges.");
  Words clear;
  Words doubtful;
  Words unseen;
  Words equal;
  for (const auto i : each_index(plan.effects)) {
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

}  // namespace

int plan_the_holes(HolesPlanRequest request, const Machine& machine, const PlanOutputs& wanted) {
  check(request, machine.bed);
  request.progress = shown_progress();
  const HolesPlan plan =
      value_of(plan_holes(machine, request), "chaintrue plan", kNotSupportedOrOutside);
  Outputs outputs = {
      {wanted.drawing, draw_holes_plan(plan)},
      {wanted.page, holes_page(plan, wanted.list)},
      {wanted.gcode, holes_gcode(plan, wanted.drill)},
      {wanted.list, is_json_wanted(wanted.json, wanted.list) ? files::write_holes_sheet(plan.set)
                                                             : workshop_list(plan)}};
  const auto holes =
      mapped(plan.set.holes, [](const Hole& hole) { return identity_placement(hole.commanded); });
  add_answer(holes, {}, fmt::format("\"expected_rms_mm\": {}", plan.expected_rms_mm), wanted,
             outputs);
  write_outputs(outputs);
  say_lines(plan_in_words(plan, request));
  return kDone;
}

}  // namespace chaintrue::cli
