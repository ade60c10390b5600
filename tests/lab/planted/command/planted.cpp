// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// planted: diagnoses marks drawn at random from real scans, as read and with a known cause added,
/// and prints how often the cause is named and how often a claim contradicts the whole scan; or
/// compares two versions of the diagnosis draw by draw (docs/diagnosis_rates.md).
///
///   planted now.txt --scan C.csv --scan D.csv --draws 36          # resumable
///   planted now.txt --most 0                                      # the table of what there is
///   planted now.txt --scan C.csv --scan D.csv --against before.txt
///   planted references.txt --scan C.csv --scan D.csv --reference  # diagnoses the whole scans
///
/// Exit code 1: a row is worse; 3: a file cannot be read, or has other draws.
#include "planted/judge/planted_rates.hpp"
#include "sealed/command/sets.hpp"

namespace {

using namespace chaintrue;
using planted::Outcome;

struct Arguments {
  sealed::OutcomeFile file;
  std::vector<std::string> scans;
  std::string settings = CHAINTRUE_SHARED_DATA "/holey/groundcontrol_2018-09-01b.ini";
  std::string references = CHAINTRUE_FIXTURES "/planted/references.txt";
  bool reference = false;
  std::uint64_t seed = 1;
  std::size_t draws = 36;
};

std::vector<planted::Scan> read_scans(const Arguments& arguments) {
  std::vector<planted::Scan> scans;
  for (const std::string& path : arguments.scans)
    scans.push_back(planted::read_scan(path, arguments.settings));
  return scans;
}

int write_references(const Arguments& arguments) {
  std::vector<planted::Reference> references;
  for (const planted::Scan& scan : read_scans(arguments))
    references.push_back(planted::make_reference(scan));
  std::ofstream file(arguments.file.file, std::ios::binary);
  file << planted::text_of(references);
  file.close();
  if (!file) throw std::invalid_argument(arguments.file.file + " cannot be written");
  return 0;
}

int run_all(const Arguments& arguments) {
  if (arguments.reference) return write_references(arguments);
  const std::vector<planted::Reference> references = planted::read_references(arguments.references);
  const std::vector<planted::Scan> scans = read_scans(arguments);
  // In turn of the scans, so that each part of the list has all of them.
  std::vector<sealed::PlannedSet> list;
  for (std::size_t k = 0; k < arguments.draws; ++k) {
    for (const planted::Scan& scan : scans) list.push_back({scan.name, arguments.seed + k});
  }
  std::vector<Outcome> outcomes = arguments.file.known();
  const auto draw = [&](const sealed::PlannedSet& set) {
    const auto scan = std::ranges::find(scans, set.kind, &planted::Scan::name);
    auto [plain, planted] = planted::run_draw(*scan, references, set.seed);
    return std::vector<Outcome>{std::move(plain), std::move(planted)};
  };
  arguments.file.run(list, ":planted", draw, outcomes);
  planted::set_facts(outcomes, references);
  sealed::write_outcomes(arguments.file.file, outcomes);
  fmt::print("{}", planted::planted_table(outcomes, references));
  if (arguments.file.against.empty()) return 0;
  std::vector<Outcome> before = sealed::sorted(sealed::read_outcomes(arguments.file.against));
  planted::set_facts(before, references);
  return arguments.file.print_comparison(before, outcomes, planted::planted_rows());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("The rates of the diagnosis on real scans with a known cause added");
  arguments.file.offer(app);
  app.add_option("--scan", arguments.scans, "A scan of the optical calibration; may be repeated")
      ->check(CLI::ExistingFile);
  app.add_option("--settings", arguments.settings, "The machine's groundcontrol.ini");
  app.add_option("--references", arguments.references, "Diagnoses of the whole scans, frozen");
  app.add_flag("--reference", arguments.reference, "Write FILE as such references");
  app.add_option("--seed", arguments.seed, "Of the first draw; each has the next");
  app.add_option("--draws", arguments.draws, "Of each scan");
  return chaintrue::sealed::run_command(app, argc, argv, [&] { return run_all(arguments); });
}
