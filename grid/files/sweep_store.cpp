// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/sweep_store.hpp"

#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <string>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/sha256.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using sweep::CellResult;
using sweep::CellStatus;

/// The first line of a part.
std::string header_of(const ReadSweep& read) {
  return fmt::format(
      "cell,status,chain_rms_mm,chain_max_mm,tool_rms_mm,tool_max_mm,expected_tool_rms_mm,check of "
      "sweep {}\n",
      read.hash);
}

std::string check_of(std::string_view line) {
  constexpr std::size_t kDigits = 8;
  return sha256(std::string(line)).substr(0, kDigits);
}

std::string line_of(std::uint64_t cell, const CellResult& r) {
  std::string line = fmt::format("{},{}", cell, name(r.status));
  for (const auto& [name, error] : kCellErrors) line += fmt::format(",{}", r.*error);
  return fmt::format("{},{}\n", line, check_of(line));
}

/// Adds a line to the cells, unless it is incomplete or damaged.
void take_line(std::string_view line, FinishedCells& cells) {
  const std::size_t check = line.rfind(',');
  if (check == npos || line.substr(check + 1) != check_of(line.substr(0, check))) return;
  const auto cell = static_cast<std::size_t>(number_of(take_until(line, ',')).value());
  CellResult result;
  const std::string_view status = take_until(line, ',');
  for (const CellStatus known :
       {CellStatus::done, CellStatus::no_map, CellStatus::not_reached, CellStatus::no_answer}) {
    if (status == name(known)) result.status = known;
  }
  for (const auto& [name, error] : kCellErrors)
    result.*error = number_of(take_until(line, ',')).value();
  if (cell < cells.size()) cells[cell] = result;
}

/// Appends to one part, cell by cell. Not thread safe.
class Part {
 public:
  Part(fs::path path, const std::string& header) : path_(std::move(path)) {
    std::error_code error;
    fs::create_directories(path_.parent_path(), error);
    std::ifstream before(path_, std::ios::binary | std::ios::ate);
    const bool has_header = before && before.tellg() >= static_cast<std::streamoff>(header.size());
    file_.open(path_,
               has_header ? std::ios::binary | std::ios::app : std::ios::binary | std::ios::trunc);
    if (!file_) refuse(path_.string(), "", "a folder that can be written to");
    // The last line may be torn.
    write(has_header ? "\n" : header);
  }
  void write(const std::string& text) {
    file_ << text << std::flush;
    if (!file_) refuse(path_.string(), "", "room on the disk");
  }

 private:
  fs::path path_;
  std::ofstream file_;
};

/// "shard-3-of-16", with the process's number if there are several.
std::string part_name(const sweep::Share& share) {
  std::string name = fmt::format("shard-{}-of-{}", share.index + 1, share.count);
  if (share.ranks > 1) name += fmt::format("-rank-{}-of-{}", share.rank + 1, share.ranks);
  return name + ".csv";
}

fs::path parts_of(const fs::path& directory) { return directory / "parts"; }

}  // namespace

FinishedCells finished_cells(const fs::path& directory, const ReadSweep& read) {
  FinishedCells cells(as_size(sweep::cells(read.spec)));
  const std::string header = header_of(read);
  std::error_code error;
  for (fs::directory_iterator entry(parts_of(directory), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != ".csv") continue;
    std::ifstream in(entry->path(), std::ios::binary);
    std::string line;
    std::getline(in, line);
    if (in.eof() && header.starts_with(line)) continue;  // stopped before its first cell
    if (line + '\n' != header) {
      refuse(entry->path().string(), "cells of another sweep",
             "an empty folder, or one with parts of the same specification");
    }
    while (std::getline(in, line)) take_line(line, cells);
  }
  return cells;
}

sweep::CellStore cells_kept_in(const fs::path& directory, const ReadSweep& read,
                               const sweep::Share& share) {
  const auto before = std::make_shared<const FinishedCells>(finished_cells(directory, read));
  return {[before](std::uint64_t cell) { return (*before)[as_size(cell)].has_value(); },
          [path = parts_of(directory) / part_name(share), header = header_of(read)] {
            const auto part = std::make_shared<Part>(path, header);
            return [part](std::uint64_t cell, const CellResult& result) {
              part->write(line_of(cell, result));
            };
          }};
}

}  // namespace chaintrue::grid::files
