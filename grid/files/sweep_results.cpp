// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "grid/containers.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/json_text.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/files/sweep_store.hpp"
#include "grid/precondition.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using sweep::CellResult;
using sweep::CellStatus;
using sweep::kFactors;
using sweep::Levels;
using sweep::SweepSpec;

std::string csv_text(const std::string& word) {
  if (word.find_first_of(",\"\n") == npos) return word;
  std::ostringstream quoted;
  quoted << std::quoted(word, '"', '"');
  return quoted.str();
}

std::string csv_header() {
  std::string line = "cell";
  for (const std::string_view factor : sweep::kFactorNames) line += fmt::format(",{}", factor);
  line += ",points,repetition,status";
  for (const auto& [name, error] : kCellErrors) line += fmt::format(",{}", name);
  return line + "\n";
}

std::string csv_levels(const SweepSpec& spec, const Levels& levels) {
  std::string text;
  for (const auto factor : each_below(kFactors)) {
    text += "," + csv_text(level_name(spec, factor, levels[factor]));
  }
  const sweep::GridLevel& grid = spec.grids[levels[kFactors - 1]];
  return text + fmt::format(",{}", grid.columns * grid.rows);
}

std::string csv_values(const CellResult& r) {
  if (r.status == CellStatus::no_map || r.status == CellStatus::not_reached) return ",,,,,";
  std::string values;
  for (const auto& [name, error] : kCellErrors) values += fmt::format(",{}", r.*error);
  return values;
}

std::string summary_head(const SweepSpec& spec) {
  return fmt::format(
      "{{\n  \"file_type\": \"{}\",\n  \"format_version\": \"{}\",\n  \"name\": {},\n"
      "  \"question\": {},\n  \"repetitions\": {},\n  \"combinations\": [\n",
      kSweepSummaryFormat.file_type, kSweepSummaryFormat.version, compact_json(spec.name),
      compact_json(spec.question), spec.repetitions);
}

/// The line of one combination.
std::string summary_line(const SweepSpec& spec, const Levels& levels,
                         const std::vector<CellResult>& repetitions) {
  Json line = Json::object();
  for (const auto factor : each_below(kFactors))
    line[std::string(sweep::kFactorNames[factor])] = level_name(spec, factor, levels[factor]);
  const sweep::GridLevel& grid = spec.grids[levels[kFactors - 1]];
  line["points"] = grid.columns * grid.rows;
  std::vector<CellResult> done = repetitions;
  std::erase_if(done, [](const CellResult& result) { return result.status != CellStatus::done; });
  line["done"] = done.size();
  if (done.empty()) return "    " + compact_json(line);
  for (const auto& [name, error] : kCellErrors) {
    const std::vector<double> values = mapped(done, error);
    line[std::string(name)] = {{"median", median(values)}, {"worst", *max_element(values)}};
  }
  return "    " + compact_json(line);
}

/// Lines of the report by factor, level and grid; their rms are sums of squares until it is written.
using LevelSums = std::map<std::array<std::size_t, 3>, LevelError>;

void add_to(LevelSums& sums, const Levels& levels, const CellResult& r) {
  if (r.status != CellStatus::done) return;
  for (const auto factor : each_below(kFactors)) {
    const std::size_t grid = levels[kFactors - 1];
    LevelError& error =
        sums.try_emplace({factor, levels[factor], grid}, LevelError{factor, levels[factor], grid})
            .first->second;
    ++error.cells;
    error.tool_rms_mm += r.tool_rms_mm * r.tool_rms_mm;
    error.tool_max_mm = std::max(error.tool_max_mm, r.tool_max_mm);
  }
}

}  // namespace

std::vector<LevelError> write_results(const SweepSpec& spec, const FinishedCells& cells,
                                      const fs::path& directory) {
  const auto missing = count_equal(cells, std::nullopt);
  if (missing > 0) throw precondition("sweep: {} of {} cells are missing", missing, cells.size());
  PendingFile csv(directory / "results.csv");
  PendingFile summary(directory / "summary.json");
  csv.write(csv_header());
  summary.write(summary_head(spec));
  LevelSums sums;
  const auto repetitions = static_cast<std::uint64_t>(spec.repetitions);
  std::vector<CellResult> combination;
  std::string levels_text;
  Levels levels{};
  for (std::uint64_t cell = 0; cell < cells.size(); ++cell) {
    const CellResult& result = *cells[as_size(cell)];
    const std::uint64_t repetition = cell % repetitions;
    if (repetition == 0) {
      levels = levels_of(spec, cell / repetitions);
      levels_text = csv_levels(spec, levels);
      combination.clear();
    }
    csv.write(fmt::format("{}{},{},{}{}\n", cell, levels_text, repetition, name(result.status),
                          csv_values(result)));
    add_to(sums, levels, result);
    combination.push_back(result);
    if (repetition + 1 == repetitions) {
      const bool last = cell + 1 == cells.size();
      summary.write(summary_line(spec, levels, combination) + (last ? "\n" : ",\n"));
    }
  }
  summary.write("  ]\n}\n");
  take_places({&csv, &summary});
  std::vector<LevelError> errors;
  for (const auto& [place, sum] : sums) {
    errors.push_back(sum);
    errors.back().tool_rms_mm = std::sqrt(sum.tool_rms_mm / as_double(sum.cells));
  }
  return errors;
}

}  // namespace chaintrue::grid::files
