// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue sweep: accuracy against the simulator over any product of factors; stopped, resumed,
/// split and merged at will.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>

#include "grid/files/sweep_file.hpp"
#include "grid/files/sweep_store.hpp"
#include "grid/sweep/run_sweep.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/document.hpp"

#ifdef CHAINTRUE_HAS_MPI
#include <mpi.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>
#endif

namespace chaintrue::cli {
namespace {

#ifdef CHAINTRUE_HAS_MPI
// What mpirun (Open MPI), MPICH's hydra and Slurm's own launcher leave in the environment. Started
// by hand, the program does not start MPI, which would cost more than a small sweep.
bool is_launched_together() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(variable) != nullptr) return true;
  }
  return false;
}
#endif

/// The processes of one command under mpirun or a cluster's scheduler. Without MPI, or outside
/// mpirun, there is one. Joins the others when constructed, leaves when destroyed. One per program.
class Processes {
 public:
#ifdef CHAINTRUE_HAS_MPI
  Processes() {
    if (!is_launched_together()) return;
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    joined_ = true;
  }
  ~Processes() {
    if (joined_) MPI_Finalize();
  }
#else
  Processes() = default;
#endif
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  std::uint64_t rank() const { return static_cast<std::uint64_t>(rank_); }
  std::uint64_t count() const { return static_cast<std::uint64_t>(count_); }
  /// A barrier; returns true for all if `ok` is true for all.
  bool all(bool ok) const {
#ifdef CHAINTRUE_HAS_MPI
    int all_ok = ok ? 1 : 0;
    if (joined_) MPI_Allreduce(MPI_IN_PLACE, &all_ok, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all_ok == 1;
#else
    return ok;
#endif
  }

 private:
  int rank_ = 0;
  int count_ = 1;
#ifdef CHAINTRUE_HAS_MPI
  bool joined_ = false;
#endif
};

// A sweep's report: the error against the number of points, one panel a factor.

constexpr std::array<std::string_view, sweep::kFactors> kTitles = {
    "The machine",
    "Hidden effects",
    "The machine that the map is used on",
    "The surface",
    "The spacing of the marks",
    "Distance of the sled from the marks, mm",
    "Noise of length / position, mm",
    "The grid"};

double points_of(const sweep::SweepSpec& spec, std::size_t grid) {
  return spec.grids[grid].columns * spec.grids[grid].rows;
}

Chart panel(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors,
            std::size_t factor) {
  DataTable lines{"lines", {"level", "points", "rms_mm", "max_mm", "cells"}};
  for (const files::LevelError& error : errors) {
    if (error.factor != factor) continue;
    const std::string level =
        factor + 1 == sweep::kFactors ? "all" : sweep::level_name(spec, factor, error.level);
    lines.rows.push_back({level, points_of(spec, error.grid), error.tool_rms_mm, error.tool_max_mm,
                          as_double(error.cells)});
  }
  return {.specification = "sweep_lines",
          .title = std::string(kTitles[factor]),
          .caption =
              "Error of the tool over the bed, rms in mm, against the number of points; all other "
              "factors combined.",
          .data = {std::move(lines)}};
}

Table table(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  Table table;
  table.columns = {{"factor"},
                   {"level"},
                   {"points", true, 0},
                   {"rms at the tool, mm", true, 3},
                   {"worst, mm", true, 3},
                   {"cells", true, 0}};
  const auto counts = sweep::level_counts(spec);
  for (const files::LevelError& error : errors) {
    // A factor with one level duplicates the grids.
    if (counts[error.factor] == 1 && error.factor + 1 < sweep::kFactors) continue;
    table.add({std::string(sweep::kFactorNames[error.factor]),
               sweep::level_name(spec, error.factor, error.level), points_of(spec, error.grid),
               error.tool_rms_mm, error.tool_max_mm, as_double(error.cells)});
  }
  return table;
}

/// Pooled over the grids, one for each level of a factor; 0 if nothing was done.
std::vector<double> errors_of_levels(const std::vector<files::LevelError>& errors,
                                     std::size_t factor, std::size_t levels) {
  std::vector<double> squares(levels, 0.0);
  std::vector<double> cells(levels, 0.0);
  for (const files::LevelError& error : errors) {
    if (error.factor != factor) continue;
    const auto number = as_double(error.cells);
    squares[error.level] += number * error.tool_rms_mm * error.tool_rms_mm;
    cells[error.level] += number;
  }
  for (std::size_t level = 0; level < levels; ++level)
    squares[level] = cells[level] > 0.0 ? std::sqrt(squares[level] / cells[level]) : 0.0;
  return squares;
}

/// The sweep's answer to its question, a sentence for each varying factor.
Words answers(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  const auto counts = sweep::level_counts(spec);
  Words sentences;
  std::vector<files::LevelError> grids;
  for (const files::LevelError& error : errors) {
    if (error.factor + 1 == sweep::kFactors) grids.push_back(error);
  }
  if (grids.size() > 1) {
    const auto [fewest, most] = minmax_element(grids, [&](const auto& a, const auto& b) {
      return points_of(spec, a.grid) < points_of(spec, b.grid);
    });
    sentences.push_back(fmt::format(
        "From {:.0f} to {:.0f} points the error changes from {:.2f} to {:.2f} mm rms at the tool.",
        points_of(spec, fewest->grid), points_of(spec, most->grid), fewest->tool_rms_mm,
        most->tool_rms_mm));
  }
  for (std::size_t factor = 0; factor + 1 < sweep::kFactors; ++factor) {
    if (counts[factor] < 2) continue;
    const std::vector<double> rms = errors_of_levels(errors, factor, counts[factor]);
    const auto [least, most] = minmax_element(rms);
    const auto level = [&](auto at) {
      return sweep::level_name(spec, factor, as_size(at - rms.begin()));
    };
    // Results that round to the same hundredths are equal in practice.
    if (fmt::format("{:.2f}", *least) == fmt::format("{:.2f}", *most)) {
      sentences.push_back(fmt::format("{}: no difference, {:.2f} mm rms at the tool with each.",
                                      kTitles[factor], *least));
      continue;
    }
    sentences.push_back(fmt::format(
        "{}: {} has the smallest error, {:.2f} mm rms at the tool; {} the largest, {:.2f} mm.",
        kTitles[factor], level(least), *least, level(most), *most));
  }
  return sentences;
}

Document sweep_page(const sweep::SweepSpec& spec, const std::vector<files::LevelError>& errors) {
  Document page;
  page.title = spec.name;
  page.subtitle = spec.question;
  const auto counts = sweep::level_counts(spec);
  Section panels{"Error against the number of points"};
  for (std::size_t factor = 0; factor < sweep::kFactors; ++factor) {
    const bool varies = counts[factor] > 1 && factor + 1 < sweep::kFactors;
    if (varies) panels.blocks.emplace_back(panel(spec, errors, factor));
  }
  if (panels.blocks.empty()) panels.blocks.emplace_back(panel(spec, errors, sweep::kFactors - 1));
  page.verdict = {fmt::format("{} cells: {} combinations, {} repetitions each.", sweep::cells(spec),
                              sweep::combinations(spec), spec.repetitions)};
  for (std::string& line : answers(spec, errors)) page.advice.push_back({std::move(line)});
  page.not_proved = {"Made with the simulator; a real machine has errors that it does not model."};
  page.sections.push_back(std::move(panels));
  page.sections.push_back({"Numbers", {table(spec, errors)}});
  return page;
}

namespace fs = std::filesystem;

struct SweepOptions {
  std::string specification;
  std::string directory;
  Words effects;
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
  problems.add("-o", options.directory.empty() ? "an empty name" : "-",
               "the name of a folder; a sweep writes many files", ProblemKind::output_place);
}

void refuse_old_results(const SweepOptions& options) {
  const fs::path parts = fs::path(options.directory) / "parts";
  std::error_code error;
  if (options.resume || !fs::is_directory(parts, error) || fs::is_empty(parts, error)) return;
  refuse("command line", "-o", options.directory,
         "a new folder, or --resume to continue with the existing cells",
         ProblemKind::output_place);
}

std::vector<FolderFile> results() {
  return {{"results.csv", "", Origin::table},
          {"summary.json", "", Origin::table},
          {"report.html", "", Origin::page}};
}

int assemble(Verb verb, const sweep::SweepSpec& spec, const files::FinishedCells& cells,
             const SweepOptions& options) {
  const std::size_t missing = grid::count_equal(cells, std::nullopt);
  if (missing > 0) {
    say("chaintrue sweep: {} of {} cells are finished; results.csv is written once the parts of "
        "all shards are in {}/parts",
        cells.size() - missing, cells.size(), options.directory);
    Words next = {"sweep", options.specification, "-o", options.directory};
    add_option_words(next, "--effects", options.effects);
    next.emplace_back("--resume");
    say_next(next);
    return kDone;
  }
  check_folder(verb, options.directory, results());
  const auto errors = files::write_results(spec, cells, options.directory);
  files::write_whole_file(fs::path(options.directory) / "report.html",
                          files::signed_text(render_html(sweep_page(spec, errors)), Origin::page));
  say("{} cells: {}/results.csv, summary.json, report.html (open it in any browser)", cells.size(),
      options.directory);
  say_next({"start"});
  return kDone;
}

int run_sweep_verb(Verb verb, const SweepOptions& options) {
  const Processes processes;
  std::exception_ptr failure;
  // Whether all processes did it: none starts before all have checked the folder, and none collects
  // before all have finished.
  const auto all_did = [&](const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    return processes.all(failure == nullptr);
  };
  std::optional<files::ReadSweep> read;
  sweep::SweepRun run;
  const bool is_ready = all_did([&] {
    OptionProblems sound;  // ensured by check_options
    run.share = parse_shard(options.shard, sound);
    run.share.rank = processes.rank();
    run.share.ranks = processes.count();
    read = files::read_sweep(options.specification, options.effects);
    if (processes.rank() == 0) print_warnings(read->warnings);
    refuse_old_results(options);
    check_folder(verb, options.directory, results());
    if (processes.rank() > 0) return;
    run.progress = [](std::uint64_t finished, std::uint64_t total) {
      progress_is(as_double(finished), as_double(total));
    };
  });
  const bool is_done =
      is_ready && all_did([&] {
        sweep::run_sweep(read->spec, files::cells_kept_in(options.directory, *read, run.share),
                         run);
      });
  end_progress();
  if (processes.rank() > 0) return failure ? kBadInput : kDone;
  // One message for an error that all processes found.
  if (failure) std::rethrow_exception(failure);
  if (!is_done) return kDone;
  return assemble(verb, read->spec, files::finished_cells(options.directory, *read), options);
}

}  // namespace

void add_sweep(Verb app) {
  auto [verb, c] = app.add_verb<SweepOptions>(
      "sweep", "Simulate the accuracy of maps over combinations of factors",
      R"(Over several machines: mpirun -n 4 build/chaintrue sweep SPEC.json -o DIR

Example:
  build/chaintrue sweep fixtures/sweeps/quick.json -o sweep)",
      run_sweep_verb);
  verb.has(
      {{"specification", required(reads(c.specification)), "chaintrue_sweep file"},
       {"-o,--output", required(writes_into(c.directory)), "Folder for the shards and the results"},
       {"--shard", c.shard, "Compute only this share of the cells, such as 3/16"},
       {"--effects", reads(c.effects),
        "chaintrue_effect files: declared effects that the specification may name"},
       {"--resume", c.resume,
        "Keep the finished cells in the folder and continue; also merges shards"}});
  add_option_check(verb, c, check_options);
}

}  // namespace chaintrue::cli
