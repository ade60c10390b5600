// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// planted: diagnoses marks drawn at random from real scans, as they were read and with a known cause
/// added, and prints how often the cause is named and how often a claim is made that the whole scan
/// denies; or compares two versions of the diagnosis draw by draw (docs/diagnosis_rates.md).
///
///   planted now.txt --scan C.csv --scan D.csv --draws 36          # resumable
///   planted now.txt --most 0                                      # the table of what there is
///   planted now.txt --scan C.csv --scan D.csv --against before.txt
///   planted references.txt --scan C.csv --scan D.csv --reference  # diagnoses the whole scans
///
/// A file belongs to one version of the diagnosis and to one process at a time. Exit code 1: a row is
/// worse; 3: a file cannot be read, or has other draws.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <stdexcept>

#include "planted/judge/planted_rates.hpp"
#include "sealed/judge/plan.hpp"

namespace {

using namespace chaintrue;
using planted::Outcome;

constexpr int kWorse = 1;
constexpr int kBadInput = 3;

struct Arguments {
  std::string file;
  std::vector<std::string> scans;
  std::string settings = CHAINTRUE_SHARED_DATA "/holey/groundcontrol_2018-09-01b.ini";
  std::string references = CHAINTRUE_FIXTURES "/planted/references.txt";
  bool reference = false;
  std::uint64_t seed = 1;
  std::size_t draws = 36;
  std::string shard = "1/1";
  std::size_t most = std::numeric_limits<std::size_t>::max();
  std::vector<std::string> join;
  std::string against;
  bool show = false;
};

std::vector<planted::Scan> read_scans(const Arguments& arguments) {
  std::vector<planted::Scan> scans;
  for (const std::string& path : arguments.scans) {
    scans.push_back(planted::read_scan(path, arguments.settings));
  }
  return scans;
}

int write_references(const Arguments& arguments) {
  std::vector<planted::Reference> references;
  for (const planted::Scan& scan : read_scans(arguments)) {
    references.push_back(planted::make_reference(scan));
  }
  std::ofstream file(arguments.file, std::ios::binary);
  file << planted::text_of(references);
  file.close();
  if (!file) throw std::invalid_argument(arguments.file + " cannot be written");
  return 0;
}

/// Draws in turn of the scans, so that each part of the list has all of them.
std::vector<sealed::PlannedSet> asked(const Arguments& arguments,
                                      const std::vector<planted::Scan>& scans) {
  std::vector<sealed::PlannedSet> list;
  for (std::size_t k = 0; k < arguments.draws; ++k) {
    for (const planted::Scan& scan : scans) list.push_back({scan.name, arguments.seed + k});
  }
  std::size_t shard = 0, shards = 0;
  char end = 0;
  if (std::sscanf(arguments.shard.c_str(), "%zu/%zu%c", &shard, &shards, &end) != 2) {
    throw std::invalid_argument("--shard \"" + arguments.shard + "\": expected as in 3/16");
  }
  return sealed::shard_of(list, shard, shards);
}

std::vector<Outcome> known(const Arguments& arguments) {
  std::vector<Outcome> outcomes;
  if (std::filesystem::exists(arguments.file)) outcomes = sealed::read_outcomes(arguments.file);
  for (const std::string& other : arguments.join) {
    const std::vector<Outcome> more = sealed::read_outcomes(other);
    outcomes.insert(outcomes.end(), more.begin(), more.end());
  }
  return sealed::sorted(std::move(outcomes));
}

/// Each draw is written as soon as it is diagnosed.
void run(const Arguments& arguments,
         const std::vector<planted::Reference>& references,
         std::vector<Outcome>& outcomes) {
  const std::vector<planted::Scan> scans = read_scans(arguments);
  std::set<std::pair<std::string, std::uint64_t>> done;
  for (const Outcome& o : outcomes) done.emplace(o.kind, o.seed);
  sealed::write_outcomes(arguments.file, outcomes);
  std::ofstream file(arguments.file, std::ios::binary | std::ios::app);
  std::size_t count = 0;
  for (const sealed::PlannedSet& set : asked(arguments, scans)) {
    if (count == arguments.most) break;
    if (done.contains({set.kind + ":planted", set.seed})) continue;
    const auto scan = std::find_if(
        scans.begin(), scans.end(), [&](const auto& one) { return one.name == set.kind; });
    const auto [plain, planted] = planted::run_draw(*scan, references, set.seed);
    file << sealed::line_of(plain) << "\n" << sealed::line_of(planted) << "\n" << std::flush;
    if (!file) throw std::invalid_argument(arguments.file + " cannot be written");
    outcomes.push_back(plain);
    outcomes.push_back(planted);
    fmt::print(stderr, "\r{} draws", ++count);
  }
  if (count > 0) fmt::print(stderr, "\n");
  outcomes = sealed::sorted(std::move(outcomes));
}

int print_comparison(const Arguments& arguments,
                     const std::vector<planted::Reference>& references,
                     const std::vector<Outcome>& outcomes) {
  std::vector<Outcome> before = sealed::sorted(sealed::read_outcomes(arguments.against));
  planted::set_facts(before, references);
  const sealed::Comparison comparison = sealed::compare(before, outcomes, planted::planted_rows());
  if (comparison.sets == 0) throw std::invalid_argument("no draw is in both files");
  fmt::print("{}\n{} outcomes compared, {} are others\n",
             sealed::comparison_table(comparison),
             comparison.sets,
             comparison.changed.size());
  if (arguments.show) {
    for (const auto& [old, now] : comparison.changed) {
      fmt::print("- {}\n+ {}\n", sealed::line_of(old), sealed::line_of(now));
    }
  }
  return comparison.worse() ? kWorse : 0;
}

int run_all(const Arguments& arguments) {
  if (arguments.reference) return write_references(arguments);
  const std::vector<planted::Reference> references = planted::read_references(arguments.references);
  std::vector<Outcome> outcomes = known(arguments);
  run(arguments, references, outcomes);
  planted::set_facts(outcomes, references);
  sealed::write_outcomes(arguments.file, outcomes);
  fmt::print("{}", planted::planted_table(outcomes, references));
  if (!arguments.against.empty()) return print_comparison(arguments, references, outcomes);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("The rates of the diagnosis on real scans with a known cause added");
  app.add_option("FILE", arguments.file, "Outcomes, two lines a draw: read, added to, sorted")
      ->required();
  app.add_option("--scan", arguments.scans, "A scan of the optical calibration; may be repeated")
      ->check(CLI::ExistingFile);
  app.add_option("--settings", arguments.settings, "The machine's groundcontrol.ini");
  app.add_option("--references", arguments.references, "Diagnoses of the whole scans, frozen");
  app.add_flag("--reference", arguments.reference, "Write FILE as such references");
  app.add_option("--seed", arguments.seed, "Of the first draw; each has the next");
  app.add_option("--draws", arguments.draws, "Of each scan");
  app.add_option("--shard", arguments.shard, "Part of the draws, as in 3/16");
  app.add_option("--most", arguments.most, "Draws to run; 0: none, the table of what there is");
  app.add_option("--join", arguments.join, "Outcomes of another file of the same version");
  app.add_option("--against", arguments.against, "Compare with these outcomes, draw by draw");
  app.add_flag("--show", arguments.show, "Print each outcome that is another");
  CLI11_PARSE(app, argc, argv);
  try {
    return run_all(arguments);
  } catch (const std::exception& trouble) {
    fmt::print(stderr, "{}\n", trouble.what());
    return kBadInput;
  }
}
