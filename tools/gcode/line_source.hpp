// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lines of a program, read as a stream: constant memory for files of any length, and positions
/// to return to for loops.
///
/// LF, CRLF and CR end a line. A UTF-8 byte order mark is skipped. NUL bytes and UTF-16 are
/// rejected as not text.
///
/// A clean line is without comments, blanks and capitals; every character keeps its column. RS274/NGC
/// ignores blanks everywhere outside comments, even inside numbers: `X1 0` is X10.
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/gcode/problem.hpp"

namespace chaintrue::gcode {

/// A longer line is not G-code: the controllers' own limits are between 60 and 256 characters.
inline constexpr std::size_t kMaxLineLength = 4096;

struct SourceLine {
  /// Without its end of line; valid until the next call.
  std::string_view text;
  std::size_t number = 0;
};

class LineSource {
 public:
  /// A position to return to: the start of the line after `lines_before` lines.
  struct Position {
    std::uint64_t offset = 0;
    std::size_t lines_before = 0;
  };

  /// \param stream seekable, at its beginning, and opened in binary mode.
  explicit LineSource(std::unique_ptr<std::istream> stream) : stream_(std::move(stream)) {}

  [[nodiscard]] static Result<LineSource> from_file(const std::string& path);
  static LineSource from_text(std::string text);

  /// False at the end of the file. \throws Refusal
  bool next(SourceLine& line);
  /// Position of the line that next() would return.
  Position position() const;
  void seek(Position position);
  /// `listener` is called for every line with the number of bytes of the file up to its end.
  void on_line(std::function<void(std::uint64_t)> listener) { listener_ = std::move(listener); }

 private:
  void refill();

  std::unique_ptr<std::istream> stream_;
  std::string buffer_;
  std::size_t begin_ = 0;            // of the unread part of buffer_
  std::uint64_t buffer_offset_ = 0;  // of buffer_[0] in the file
  std::size_t lines_before_ = 0;
  bool exhausted_ = false;
  std::function<void(std::uint64_t)> listener_;
};

struct CommentText {
  std::string text;  ///< between the parentheses or after the semicolon
  bool semicolon = false;
};

/// Reused from line to line, so that reading a file does not allocate for each.
struct CleanLine {
  std::string text;
  std::vector<std::uint32_t> columns;  ///< of each character of text, and one for its end
  std::vector<CommentText> comments;
  std::size_t number = 0;

  Place place(std::size_t index) const { return {number, columns[index]}; }
  operator Place() const { return place(0); }
};

/// A word's letter as messages show it and as the reader knows it; any other character unchanged.
char upper(char letter);
char lower(char letter);
/// Where a run of digits from `at` on ends.
std::size_t past_digits(std::string_view text, std::size_t at);

/// Splits a line into text and comments; a RepRap checksum (`*71`) is checked and removed.
/// \throws Refusal
void clean(std::string_view raw, std::size_t number, CleanLine& line);

}  // namespace chaintrue::gcode
