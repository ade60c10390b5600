// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings `{bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85}` in a log's lines. One that a serial line
/// or a clipboard damaged is reported with the others; it keeps its place in the list. Private to
/// grid/files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/belts/belt.hpp"

namespace chaintrue::grid::files {

struct ScannedReading {
  std::optional<model::PerBelt<double>> lengths_mm;  ///< empty: not measured, or not readable
  std::size_t line = 0;
  /// The reasons why it is not readable, each with its place in the file.
  std::vector<InputProblem> problems;
  /// Made of single readings, since no list has it.
  bool from_single_readings = false;
};

/// Reads lines in order. A reading may continue on the next lines.
class ReadingReader {
 public:
  explicit ReadingReader(std::string file) : file_(std::move(file)) {}

  struct Found {
    std::vector<ScannedReading> readings;
    bool list_ends = false;  ///< a "]" outside of readings
  };
  [[nodiscard]] Found take(std::string_view line, std::size_t number);
  /// A reading has begun that has not ended.
  [[nodiscard]] bool is_open() const { return open_; }
  /// Ends such a reading: as one that is not readable, if it looks like one.
  [[nodiscard]] std::optional<ScannedReading> give_up();

 private:
  enum class End { closed, lost };
  [[nodiscard]] std::optional<ScannedReading> read(const std::string& text, End end) const;
  void begin(std::size_t number, std::size_t column);

  std::string file_;
  bool open_ = false;
  std::string text_;     ///< of the open reading
  std::string outside_;  ///< after the last reading
  std::size_t line_ = 0;
  std::size_t column_ = 0;
  std::size_t lines_ = 0;  ///< that the open reading has taken
};

}  // namespace chaintrue::grid::files
