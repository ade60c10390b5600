// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// baselines: what textbook methods of variable selection name on the columns of the diagnosis, next to
/// the diagnosis itself, on sets of the frozen sealed list and on real scans with a cause added
/// (docs/diagnosis_rates.md).
///
///   baselines --each 30                                           # sealed sets, of each kind
///   baselines --each 0 --scan C.csv --scan D.csv --draws 36       # real scans
///   baselines --each 30 --scan C.csv --chart curves.svg           # both, as a picture
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/grid_file.hpp"
#include "planted/judge/columns.hpp"
#include "planted/judge/curves.hpp"
#include "planted/judge/scan.hpp"
#include "sealed/judge/plan.hpp"
#include "sealed/judge/trial.hpp"

namespace {

using namespace chaintrue;
using planted::Method;
using planted::Scores;

constexpr int kBadInput = 3;

struct Arguments {
  std::size_t each = 30;
  std::vector<std::string> kinds = {
      "single", "two", "beside", "beside_other", "pattern", "near", "nothing"};
  std::vector<std::string> scans;
  std::string settings = CHAINTRUE_SHARED_DATA "/holey/groundcontrol_2018-09-01b.ini";
  std::string references = CHAINTRUE_FIXTURES "/planted/references.txt";
  std::uint64_t seed = 1;
  std::size_t draws = 36;
  std::string chart;
};

/// Thresholds: the F of 4 that textbooks and packages enter at, a weight of one half, any coefficient, and
/// 90 % claimed.
std::vector<Method> methods() {
  return {{"stepwise, F test", 4.0},
          {"BIC, all sets of three", 0.5},
          {"LASSO, ten folds", 0.0},
          {"diagnosis without a pattern", 0.9},
          {"diagnosis, all readings at once", 0.9},
          {"diagnosis", 0.9}};
}

/// In the order of methods().
std::vector<Scores> scores_of(const grid::MeasuredGrid& grid) {
  const planted::Prepared prepared = planted::prepare(grid);
  const planted::Regression data = planted::regression_of(prepared);
  const auto claimed = [&](bool average_parts) {
    Scores own;
    for (const planted::Claim& claim : planted::claims_of(planted::diagnosed(grid, average_parts)))
      own[claim.members.front()] = claim.probability;
    return own;
  };
  return {planted::stepwise_scores(data),
          planted::bic_scores(data),
          planted::lasso_scores(data),
          planted::scores_without_discrepancy(prepared),
          claimed(false),
          claimed(true)};
}

void add(const grid::MeasuredGrid& grid,
         const std::vector<std::string>& hidden,
         const std::vector<std::string>& no_matter,
         std::vector<Method>& all) {
  const std::vector<Scores> scores = scores_of(grid);
  for (std::size_t k = 0; k < all.size(); ++k) all[k].add(scores[k], hidden, no_matter);
}

std::vector<Method> on_sealed_sets(const Arguments& arguments) {
  std::vector<Method> all = methods();
  std::map<std::string, std::size_t> done;
  for (const std::string& kind : arguments.kinds) done[kind] = 0;
  for (const sealed::PlannedSet& planned : sealed::plan()) {
    const auto kind = done.find(planned.kind);
    if (kind == done.end() || kind->second == arguments.each) continue;
    const auto recipe = sealed::recipe_of(planned);
    if (!recipe)
      throw std::invalid_argument("no sets of chains at points: \"" + planned.kind + "\"");
    ++kind->second;
    const generator::SealedSet set = generator::draw_set(*recipe, planned.seed);
    std::vector<std::string> hidden;
    for (const auto& one : set.answer.hidden) hidden.push_back(sealed::id_of(one));
    add(grid::files::parse_grid(set.grid_text, "sealed.json").grid, hidden, {}, all);
    fmt::print(stderr, "\r{} sealed sets", all.front().sets);
  }
  return all;
}

/// What the whole scan does not deny counts neither way.
std::vector<Method> on_scans(const Arguments& arguments) {
  constexpr double kDenied = 0.5;
  std::vector<Method> all = methods();
  const auto references = planted::read_references(arguments.references);
  for (const std::string& path : arguments.scans) {
    const planted::Scan scan = planted::read_scan(path, arguments.settings);
    for (std::size_t k = 0; k < arguments.draws; ++k) {
      const planted::Draw draw = planted::draw_planted(scan, references, arguments.seed + k);
      std::vector<std::string> no_matter;
      for (const auto& claim : planted::reference_of(references, scan.name).claims) {
        if (claim.probability < kDenied) continue;
        no_matter.insert(no_matter.end(), claim.members.begin(), claim.members.end());
      }
      add(draw.planted, {sealed::id_of(draw.hidden)}, no_matter, all);
      fmt::print(stderr, "\r{} draws", all.front().sets);
    }
  }
  return all;
}

void print(const std::string& title, const std::vector<Method>& all) {
  fmt::print(stderr, "\n");
  fmt::print("{}: {} sets, {} causes\n\n{}\n",
             title,
             all.front().sets,
             all.front().hidden,
             planted::curves_table(all));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Textbook methods of variable selection next to the diagnosis");
  app.add_option("--each", arguments.each, "Sealed sets of each kind; 0: none");
  app.add_option("--kind", arguments.kinds, "Kinds of sealed sets")
      ->check(CLI::IsMember(sealed::kinds()));
  app.add_option("--scan", arguments.scans, "A scan of the optical calibration; may be repeated")
      ->check(CLI::ExistingFile);
  app.add_option("--settings", arguments.settings, "The machine's groundcontrol.ini");
  app.add_option("--references", arguments.references, "Diagnoses of the whole scans, frozen");
  app.add_option("--seed", arguments.seed, "Of the first draw; each has the next");
  app.add_option("--draws", arguments.draws, "Of each scan");
  app.add_option("--chart", arguments.chart, "Right names over false ones as a picture, to this SVG file");
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<planted::CurveGroup> groups;
    if (arguments.each > 0) groups.push_back({"Sealed sets", on_sealed_sets(arguments)});
    if (!arguments.scans.empty()) groups.push_back({"Real scans with a cause added", on_scans(arguments)});
    for (const planted::CurveGroup& group : groups) print(group.title, group.methods);
    if (!arguments.chart.empty()) std::ofstream(arguments.chart, std::ios::binary) << planted::curves_svg(groups);
    return 0;
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{}\n", trouble.what());
    return kBadInput;
  }
}
