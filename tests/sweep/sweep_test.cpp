// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "grid/files/sweep_file.hpp"
#include "grid/files/sweep_store.hpp"
#include "grid/parallel.hpp"
#include "grid/sweep/run_sweep.hpp"
#include "grid/threads/use_threads.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::grid::sweep {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;

const std::string kSpecs = std::string(CHAINTRUE_FIXTURES) + "/sweeps/";

// The test's own folder, empty at its start.
fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("chaintrue_sweep_" + name);
  fs::remove_all(folder);
  return folder;
}

std::string results_of(const files::ReadSweep& read, const fs::path& folder) {
  files::write_results(read.spec, files::finished_cells(folder, read), folder);
  return read_text(folder / "results.csv") + read_text(folder / "summary.json");
}

std::ptrdiff_t finished_in(const fs::path& folder, const files::ReadSweep& read) {
  const files::FinishedCells cells = files::finished_cells(folder, read);
  return std::count_if(cells.begin(), cells.end(),
                       [](const auto& cell) { return cell.has_value(); });
}

std::uint64_t run_in(const fs::path& folder, const files::ReadSweep& read, const SweepRun& run) {
  return run_sweep(read.spec, files::cells_kept_in(folder, read, run.share), run);
}

std::string whole_run(const files::ReadSweep& read, const std::string& name, int threads) {
  const fs::path folder = fresh_folder(name);
  use_threads(threads);
  EXPECT_EQ(run_in(folder, read, {}), cells(read.spec));
  set_index_loop(nullptr);
  return results_of(read, folder);
}

TEST(SweepSpec, NumbersCellsWithTheRepetitionFastest) {
  const SweepSpec spec = files::read_sweep(kSpecs + "quick.json").spec;
  EXPECT_EQ(combinations(spec), 4U);
  EXPECT_EQ(cells(spec), 8U);
  EXPECT_EQ(level_name(spec, 7, levels_of(spec, 0)[7]), "4x3");
  EXPECT_EQ(level_name(spec, 7, levels_of(spec, 1)[7]), "7x4");
  EXPECT_EQ(level_name(spec, 4, levels_of(spec, 1)[4]), "regular");
  EXPECT_EQ(level_name(spec, 4, levels_of(spec, 2)[4]), "chebyshev");
}

TEST(SweepSpec, AcceptsAllFixtures) {
  for (const auto& entry : fs::directory_iterator(kSpecs)) {
    SCOPED_TRACE(entry.path().string());
    EXPECT_GT(cells(files::read_sweep(entry.path()).spec), 0U);
  }
}

TEST(Sweep, GivesTheSameBytesForAnyNumberOfThreads) {
  const files::ReadSweep read = files::read_sweep(kSpecs + "quick.json");
  EXPECT_EQ(whole_run(read, "one", 1), whole_run(read, "two", 2));
}

// A run that ends at any byte of its part can be resumed with the same results.
TEST(Sweep, ResumesFromAnyTruncation) {
  const files::ReadSweep read = files::read_sweep(kSpecs + "quick.json");
  const std::string whole = whole_run(read, "untorn", 2);
  const fs::path part = fs::path("parts") / "shard-1-of-1.csv";
  const std::string complete =
      read_text(fresh_folder("none").parent_path() / "chaintrue_sweep_untorn" / part);
  ASSERT_EQ(std::count(complete.begin(), complete.end(), '\n'), 9) << "a header and eight cells";
  const std::size_t first = complete.find('\n') + 1;
  const std::size_t second = complete.find('\n', first) + 1;
  for (const std::size_t length : {std::size_t{0}, std::size_t{5}, first - 1, first, first + 1,
                                   second - 1, second, complete.size() - 1}) {
    SCOPED_TRACE(length);
    const fs::path folder = fresh_folder("torn");
    fs::create_directories(folder / "parts");
    std::ofstream(folder / part, std::ios::binary) << complete.substr(0, length);
    SweepRun run;
    const std::uint64_t computed = run_in(folder, read, run);
    // A line whose end alone is lost still has its check.
    EXPECT_EQ(computed, length < second - 1 ? 8U : length <= second ? 7U : 0U);
    EXPECT_EQ(results_of(read, folder), whole);
    EXPECT_EQ(finished_in(folder, read), 8);
  }
}

TEST(Sweep, ComputesADamagedCellAgain) {
  const files::ReadSweep read = files::read_sweep(kSpecs + "quick.json");
  const std::string whole = whole_run(read, "sound", 2);
  const fs::path folder = fs::path(::testing::TempDir()) / "chaintrue_sweep_sound";
  const fs::path part = folder / "parts" / "shard-1-of-1.csv";
  std::string bytes = read_text(part);
  char& digit = bytes[bytes.rfind(".") + 1];
  digit = digit == '9' ? '8' : '9';
  std::ofstream(part, std::ios::binary) << bytes;
  EXPECT_EQ(finished_in(folder, read), 7);
  SweepRun run;
  EXPECT_EQ(run_in(folder, read, run), 1U);
  EXPECT_EQ(results_of(read, folder), whole);
}

// Without noise and with the true machine stated, the error of a map is that of the fit's surface.
TEST(RunCell, MapsAKnownMachineExactly) {
  SweepSpec spec = files::read_sweep(kSpecs + "quick.json").spec;
  spec.draw_settings = false;
  spec.noises = {{0.0, 0.0}};
  spec.jitters_mm = {0.0};
  spec.repeats = 0;
  const CellResult result = run_cell(spec, 2);
  EXPECT_EQ(result.status, CellStatus::done);
  // The stated machine is the true one: only the solvers' last digits remain.
  EXPECT_LT(result.tool_max_mm, 1e-3);
}

TEST(RunCell, MapIsWorseOnAnotherMachine) {
  SweepSpec spec = files::read_sweep(kSpecs + "another_machine.json").spec;
  spec.evaluation = {13, 7};
  double same = 0.0, other = 0.0;
  for (std::uint64_t repetition = 0; repetition < 3; ++repetition) {
    same += run_cell(spec, repetition).tool_rms_mm;
    other += run_cell(spec, static_cast<std::uint64_t>(spec.repetitions) + repetition).tool_rms_mm;
  }
  // Motors taped to 3 mm: another machine's map has errors of millimetres, its own of tenths.
  EXPECT_GT(other, 3.0 * same);
}

}  // namespace
}  // namespace chaintrue::grid::sweep
