// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A line without its comments, blanks and capitals; every character keeps its column.
///
/// RS274/NGC ignores blanks everywhere outside comments, even inside numbers: `X1 0` is X10.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/problem.hpp"

namespace chaintrue::gcode {

struct CommentText {
  std::string text;  ///< the text between the parentheses or after the semicolon
  std::size_t column = 0;
  bool semicolon = false;
};

/// Reused from line to line, so that reading a file does not allocate for each.
struct CleanLine {
  std::string text;
  std::vector<std::uint32_t> columns;  ///< of each character of text, and one for its end
  std::vector<CommentText> comments;
  std::size_t number = 0;

  [[nodiscard]] Place place(std::size_t index) const {
    return {number, index < columns.size() ? columns[index] : 0};
  }
};

/// Splits a line into text and comments; a RepRap checksum (`*71`) is checked and removed.
[[nodiscard]] Result<void> clean(std::string_view raw, std::size_t number, CleanLine& line);

}  // namespace chaintrue::gcode
