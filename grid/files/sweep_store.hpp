// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The finished cells of a sweep on disk: any number of part files, appended to cell by cell, so
/// that a sweep can be stopped at any moment, resumed, or spread over processes; and the results
/// assembled from them, with the same bytes in every case.
///
///   DIR/parts/NAME.cells   header, then records of 64 bytes, each with a checksum; a partial one at
///                          the end is ignored
///   DIR/results.csv        every cell, in the order of their numbers
///   DIR/summary.json       every combination: medians and worst values over the repetitions
///
/// Memory: one bit for each cell, and one combination.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grid/sweep/run_sweep.hpp"
#include "grid/sweep/sweep_spec.hpp"

namespace chaintrue::grid::files {

struct ClosePart {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenPart = std::unique_ptr<std::FILE, ClosePart>;

/// Appends to one part. Not thread safe.
class PartWriter {
 public:
  /// Opens DIR/parts/NAME.cells and cuts off an incomplete record. \throws InputError if it cannot
  /// be written.
  PartWriter(const std::filesystem::path& directory,
             const std::string& name,
             std::uint64_t spec_hash);
  /// Written to the file when it returns.
  void append(std::uint64_t cell, const sweep::CellResult& result);

 private:
  std::filesystem::path path_;
  OpenPart file_;
};

class ResultStore {
 public:
  /// Reads which cells the parts hold. \throws InputError for parts of another
  /// specification.
  ResultStore(std::filesystem::path directory, std::uint64_t spec_hash, std::uint64_t cells);
  [[nodiscard]] bool has(std::uint64_t cell) const { return done_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] std::uint64_t finished() const { return finished_; }
  [[nodiscard]] std::uint64_t cells() const { return done_.size(); }
  [[nodiscard]] bool complete() const { return finished_ == cells(); }
  /// Visits every cell in the order of their numbers. \throws std::logic_error where one is
  /// missing.
  void for_each(const std::function<void(std::uint64_t, const sweep::CellResult&)>& visit) const;

 private:
  void read_parts(const std::function<void(std::uint64_t, const sweep::CellResult&)>& visit) const;

  std::filesystem::path directory_;
  std::uint64_t spec_hash_ = 0;
  std::vector<bool> done_;
  std::uint64_t finished_ = 0;
};

/// The store of a folder for run_sweep: its parts, and a part of the share's own to append to.
/// \throws InputError if the folder has cells of another specification.
[[nodiscard]] sweep::CellStore cells_kept_in(const std::filesystem::path& directory,
                                             const sweep::SweepSpec& spec,
                                             std::uint64_t spec_hash,
                                             const sweep::Share& share);

/// A point of the report's lines: the error of one factor's level at one number of points, over all
/// other factors and repetitions.
struct LevelError {
  std::size_t factor = 0;
  std::size_t level = 0;
  std::size_t grid = 0;
  std::uint64_t cells = 0;
  double tool_rms_mm = 0.0;
  double tool_max_mm = 0.0;
};

/// Writes results.csv and summary.json. \returns the data of the report's charts.
std::vector<LevelError> write_results(const sweep::SweepSpec& spec,
                                      const ResultStore& store,
                                      const std::filesystem::path& directory);

}  // namespace chaintrue::grid::files
