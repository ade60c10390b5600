// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// firmware_halves: predicts the lower belts at each half of the places from the other half, by the
/// machine's own fit (firmware_anchors.hpp) and by this program's. Prints the numbers of
/// docs/maslow4_rates.md, frame by frame.
///
///   firmware_halves ../shared/data/maslow4
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "sealed/command/campaign.hpp"
#include "sealed/judge/firmware_anchors.hpp"

namespace {

using namespace chaintrue;
using sealed::Spans;

/// Frames by their logs; of five runs of one frame, their numbers.
sealed::Outcome run_frame(const std::string& folder, const sealed::PlannedSet& set) {
  grid::files::Maslow4Options options;
  options.part.run = static_cast<int>(set.seed);
  const std::string file = set.kind + ".txt";
  const auto belts =
      grid::files::parse_maslow4(grid::files::read_whole_file(folder + "/" + file), file, options)
          .belts;
  std::vector<Spans> spans, halves[2];
  for (const auto& point : belts.points) {
    const auto& l = point.lengths_mm;
    spans.push_back({l.tl, l.tr, l.bl, l.br});
    halves[spans.size() % 2].push_back(spans.back());
  }
  sealed::Outcome outcome{.kind = set.kind + ":run_" + std::to_string(set.seed), .seed = set.seed};
  outcome.points = static_cast<int>(spans.size());
  const auto whole = sealed::firmware_anchors(spans);
  const auto ours = grid::diagnosis::fit_with_causes(belts);
  if (!ours || !ours->half_left_out) {
    outcome.fail();
    return outcome;
  }
  auto& numbers = outcome.numbers;
  const char* const names[] = {"tl_x", "tl_y", "tr_x", "tr_y", "bl_x", "bl_y", "br_x", "br_y"};
  for (std::size_t k = 0; k < 8; ++k) numbers[names[k]] = whole.anchors[k / 2][k % 2];
  numbers["theirs_mm"] = whole.rms_mm;
  numbers["ours_predicted_mm"] = ours->half_left_out->rms_mm;
  numbers["ours_worst_mm"] = ours->half_left_out->largest_mm;
  double squares = 0.0, count = 0.0;
  for (const std::size_t half : {0, 1}) {
    for (const double off :
         sealed::lower_off_mm(sealed::firmware_anchors(halves[1 - half]), halves[half])) {
      squares += off * off;
      ++count;
      numbers["theirs_worst_mm"] = std::max(numbers["theirs_worst_mm"], std::abs(off));
    }
  }
  numbers["theirs_predicted_mm"] = std::sqrt(squares / count);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  sealed::Campaign campaign("The machine's own fit of its anchors and this one, half by half", argc,
                            argv);
  campaign.show = true;
  std::string folder = "../shared/data/maslow4";
  campaign.app.remove_option(campaign.app.get_option("FILE"));
  campaign.app.add_option("folder", folder, "Logs of real machines");
  const auto list = [&] {
    std::vector<sealed::PlannedSet> sets =
        campaign.sets_of({"concrete_anchors", "frame_rebuilt", "mini_frame"}, 1);
    const std::vector<sealed::PlannedSet> runs = campaign.sets_of({"ten_runs_1_to_5"}, 5);
    sets.insert(sets.end(), runs.begin(), runs.end());
    return sets;
  };
  return campaign.run(list, [&](const auto& set) { return std::vector{run_frame(folder, set)}; },
                      {});
}
