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
#include <fmt/format.h>

#include <fstream>

#include "planted/judge/planted_rates.hpp"
#include "sealed/command/campaign.hpp"

int main(int argc, char** argv) {
  using namespace chaintrue;
  using planted::Outcome;
  sealed::Campaign campaign("The rates of the diagnosis on real scans with a known cause added",
                            argc, argv);
  campaign.sets = 36;
  std::vector<std::string> paths;
  std::string settings = CHAINTRUE_SHARED_DATA "/holey/groundcontrol_2018-09-01b.ini";
  std::string frozen = CHAINTRUE_FIXTURES "/planted/references.txt";
  bool is_reference = false;
  CLI::App& app = campaign.app;
  app.add_option("--scan", paths, "A scan of the optical calibration; may be repeated")
      ->check(CLI::ExistingFile);
  app.add_option("--settings", settings, "The machine's groundcontrol.ini");
  app.add_option("--references", frozen, "Diagnoses of the whole scans, frozen");
  app.add_flag("--reference", is_reference, "Write FILE as such references");
  app.add_option("--draws", campaign.sets, "Of each scan");

  std::vector<planted::Scan> scans;
  std::vector<planted::Reference> references;
  const auto list = [&] {
    for (const std::string& path : paths) scans.push_back(planted::read_scan(path, settings));
    references = planted::read_references(frozen);
    std::vector<std::string> names;
    for (const planted::Scan& scan : scans) names.push_back(scan.name);
    // In turn of the scans, so that each part of the list has all of them.
    std::vector<sealed::PlannedSet> all = campaign.sets_of(names);
    std::ranges::stable_sort(all, {}, &sealed::PlannedSet::seed);
    return all;
  };
  app.final_callback([&] {
    if (!is_reference) return;
    for (const std::string& path : paths)
      references.push_back(make_reference(planted::read_scan(path, settings)));
    std::ofstream file(campaign.file, std::ios::binary);
    if (!(file << planted::text_of(references)))
      throw CLI::FileError(campaign.file + " cannot be written");
    throw CLI::Success();
  });
  campaign.finish = [&](std::vector<Outcome>& outcomes) {
    planted::set_facts(outcomes, references);
    const sealed::Calibration calibration = planted::claims_held_against(outcomes, references);
    fmt::print("Stated probabilities, {} claims whose truth is known: calibration error {:.3f}\n\n",
               calibration.claims(), calibration.error());
  };
  return campaign.run(
      list,
      [&](const sealed::PlannedSet& set) {
        auto [plain, planted] = run_draw(*std::ranges::find(scans, set.kind, &planted::Scan::name),
                                         references, set.seed);
        return std::vector<Outcome>{std::move(plain), std::move(planted)};
      },
      sealed::rows_of("planted"));
}
