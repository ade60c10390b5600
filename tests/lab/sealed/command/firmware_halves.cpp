// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// firmware_halves: predicts the lower belts at each half of the places from the other half, by the
/// machine's own fit (firmware_anchors.hpp) and by this program's. Prints the table of
/// docs/maslow4_rates.md.
///
///   firmware_halves ../shared/data/maslow4
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "sealed/judge/firmware_anchors.hpp"

namespace {

using chaintrue::sealed::Spans;

struct Half {
  double rms_mm = 0.0;
  double largest_mm = 0.0;
};

/// Every second place by the others, and those by these.
Half by_firmware(const std::vector<Spans>& spans) {
  std::vector<double> off;
  for (const std::size_t half : {0, 1}) {
    std::vector<Spans> fitted, predicted;
    for (std::size_t i = 0; i < spans.size(); ++i)
      (i % 2 == half ? predicted : fitted).push_back(spans[i]);
    const auto found = chaintrue::sealed::firmware_anchors(fitted);
    const auto own = chaintrue::sealed::lower_off_mm(found, predicted);
    off.insert(off.end(), own.begin(), own.end());
  }
  Half result;
  for (const double one : off) {
    result.rms_mm += one * one / static_cast<double>(off.size());
    result.largest_mm = std::max(result.largest_mm, std::abs(one));
  }
  result.rms_mm = std::sqrt(result.rms_mm);
  return result;
}

void print_row(const std::string& name, const chaintrue::grid::MeasuredBelts& belts) {
  std::vector<Spans> spans;
  for (const auto& point : belts.points) {
    const auto& l = point.lengths_mm;
    spans.push_back({l.tl, l.tr, l.bl, l.br});
  }
  const auto whole = chaintrue::sealed::firmware_anchors(spans);
  const Half theirs = by_firmware(spans);
  const auto ours = chaintrue::grid::diagnosis::fit_with_causes(belts);
  if (!ours || !ours->half_left_out) {
    fmt::print("| {} | {} | no fit |\n", name, spans.size());
    return;
  }
  const auto& a = whole.anchors;
  fmt::print("| {} | {} | {:.1f}, {:.1f} | {:.1f}, {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.1f} | {:.2f} | {:.1f} |\n",
             name, spans.size(), a[0][0], a[0][1], a[1][0], a[1][1], a[3][0], whole.rms_mm,
             theirs.rms_mm, theirs.largest_mm, ours->half_left_out->rms_mm,
             ours->half_left_out->largest_mm);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder = "../shared/data/maslow4";
  CLI::App app("The machine's own fit of its anchors and this one, half by half");
  app.add_option("folder", folder, "Logs of real machines");
  CLI11_PARSE(app, argc, argv);
  fmt::print("| frame | places | their tl | their tr | their br x | their rms | theirs, predicted | at worst | ours, predicted | at worst |\n"
             "|---|---|---|---|---|---|---|---|---|---|\n");
  struct Named {
    const char* name;
    const char* file;
    int run;
  };
  for (const Named& set : {Named{"concrete anchors", "concrete_anchors.txt", 1},
                           Named{"rebuilt wood", "frame_rebuilt.txt", 1},
                           Named{"small show frame", "mini_frame.txt", 1},
                           Named{"ten runs, run 1", "ten_runs_1_to_5.txt", 1},
                           Named{"run 2", "ten_runs_1_to_5.txt", 2},
                           Named{"run 3", "ten_runs_1_to_5.txt", 3},
                           Named{"run 4", "ten_runs_1_to_5.txt", 4},
                           Named{"run 5", "ten_runs_1_to_5.txt", 5}}) {
    const std::filesystem::path path = std::filesystem::path(folder) / set.file;
    if (!std::filesystem::exists(path)) continue;
    chaintrue::grid::files::Maslow4Options options;
    options.part = set.run;
    print_row(set.name,
              chaintrue::grid::files::parse_maslow4(
                  chaintrue::grid::files::read_whole_file(path), set.file, options)
                  .belts);
  }
}
