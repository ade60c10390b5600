// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue sweep: accuracy against the simulator over any product of factors; stopped, resumed,
/// split and merged at will.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/number_text.hpp"
#include "grid/files/sweep_file.hpp"
#include "grid/files/sweep_store.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/sweep/run_sweep.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/processes.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/sweep_page.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

namespace fs = std::filesystem;

struct SweepOptions {
  std::string specification;
  std::string directory;
  std::vector<std::string> effects;
  std::string shard;
  bool resume = false;
};

sweep::Share parse_shard(const std::string& text, OptionProblems& problems) {
  if (text.empty()) return {};
  constexpr int kMost = 1000000;
  const auto numbers = files::pair_of(text, '/', 1, kMost);
  if (numbers && (*numbers)[0] <= (*numbers)[1])
    return {static_cast<std::uint64_t>((*numbers)[0]) - 1,
            static_cast<std::uint64_t>((*numbers)[1])};
  problems.add("--shard", text, "shard/shards, as in 3/16", ProblemKind::bad_syntax);
  return {};
}

void check_options(const SweepOptions& options, OptionProblems& problems) {
  (void)parse_shard(options.shard, problems);
  if (!options.directory.empty() && options.directory != "-") return;
  problems.add("-o",
               options.directory.empty() ? "an empty name" : "-",
               "the name of a folder; a sweep writes many files",
               ProblemKind::output_place);
}

void refuse_old_results(const SweepOptions& options) {
  const fs::path parts = fs::path(options.directory) / "parts";
  std::error_code error;
  if (options.resume || !fs::is_directory(parts, error) || fs::is_empty(parts, error)) return;
  OptionProblems problems;
  problems.add("-o",
               options.directory,
               "a new folder, or --resume to continue with the existing cells",
               ProblemKind::output_place);
  problems.throw_if_any();
}

std::vector<FolderFile> results() {
  return {{"results.csv", "", Origin::table},
          {"summary.json", "", Origin::table},
          {"report.html", "", Origin::page}};
}

int assemble(Verb verb,
             const sweep::SweepSpec& spec,
             const files::FinishedCells& cells,
             const SweepOptions& options) {
  const auto missing = std::count(cells.begin(), cells.end(), std::nullopt);
  if (missing > 0) {
    fmt::print(stderr,
               "chaintrue sweep: {} of {} cells are finished; results.csv is written once the "
               "parts of all shards are in {}/parts\n",
               static_cast<std::ptrdiff_t>(cells.size()) - missing,
               cells.size(),
               options.directory);
    std::vector<std::string> next = {"sweep", options.specification, "-o", options.directory};
    for (const std::string& effect : options.effects)
      next.insert(next.end(), {"--effects", effect});
    next.emplace_back("--resume");
    say_next(next);
    return kDone;
  }
  check_folder(verb, options.directory, results());
  const auto errors = files::write_results(spec, cells, options.directory);
  files::write_whole_file(
      fs::path(options.directory) / "report.html",
      files::signed_text(report::render_html(sweep_page(spec, errors)), Origin::page));
  fmt::print(stderr,
             "{} cells: {}/results.csv, summary.json, report.html (open it in any browser)\n",
             cells.size(),
             options.directory);
  say_next({"start"});
  return kDone;
}

int run_sweep_verb(Verb verb, const SweepOptions& options) {
  const Processes processes;
  std::exception_ptr failure;
  std::optional<files::ReadSweep> read;
  sweep::SweepRun run;
  try {
    OptionProblems sound;  // ensured by check_options
    run.share = parse_shard(options.shard, sound);
    run.share.rank = processes.rank();
    run.share.ranks = processes.count();
    read = files::read_sweep(options.specification, options.effects);
    if (processes.rank() == 0) print_warnings(read->warnings);
    refuse_old_results(options);
    check_folder(verb, options.directory, results());
  } catch (...) {
    failure = std::current_exception();
  }
  // No process starts before all have checked the folder, and none collects before all have
  // finished.
  if (processes.all(failure == nullptr)) {
    try {
      if (processes.rank() == 0)
        run.progress = [](std::uint64_t finished, std::uint64_t total) {
          progress_is(static_cast<double>(finished), static_cast<double>(total));
        };
      sweep::run_sweep(read->spec, files::cells_kept_in(options.directory, *read, run.share), run);
    } catch (...) {
      failure = std::current_exception();
    }
    end_progress();
    if (processes.all(failure == nullptr) && processes.rank() == 0) {
      return assemble(verb, read->spec, files::finished_cells(options.directory, *read), options);
    }
  }
  // One message for an error that all processes found.
  if (failure && processes.rank() == 0) std::rethrow_exception(failure);
  return failure ? kBadInput : kDone;
}

}  // namespace

void add_sweep(Verb app) {
  auto options = std::make_shared<SweepOptions>();
  Verb verb = app.add_verb("sweep", "Simulate the accuracy of maps over combinations of factors");
  add_input(verb, "specification", options->specification, "chaintrue_sweep file").required();
  add_output_folder(
      verb, "-o,--output", options->directory, "Folder for the shards and the results")
      .required();
  verb.add_option("--shard", options->shard, "Compute only this share of the cells, such as 3/16");
  add_input(verb,
            "--effects",
            options->effects,
            "chaintrue_effect files: declared effects that the specification may name");
  verb.add_flag("--resume",
                options->resume,
                "Keep the finished cells in the folder and continue; also merges shards");
  verb.footer(
      "Over several machines: mpirun -n 4 build/chaintrue sweep SPEC.json -o DIR\n\n"
      "Example:\n"
      "  build/chaintrue sweep fixtures/sweeps/quick.json -o sweep");
  add_option_check(verb,
                   [options](OptionProblems& problems) { check_options(*options, problems); });
  verb.runs(options, run_sweep_verb);
}

}  // namespace chaintrue::cli
