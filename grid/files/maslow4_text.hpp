// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lines of a pasted log as the machine printed them: without colours and control characters, and
/// with messages that a terminal broke in two put together again. Private to grid/files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::grid::files {

struct LogLine {
  std::string text;
  std::size_t number = 0;  ///< in the file, from 1; of a message over two lines the first
};
/// Without blanks and quotation marks at either end.
std::string_view unquoted(std::string_view text);
/// True for a line that the machine or a terminal prints between others: a message, a status report,
/// an answer to a command.
bool is_other_output(std::string_view line);
/// "Run 2:", "// run three", but not "More runs:" or a sentence that runs on.
bool is_heading(std::string_view line);
std::vector<LogLine> log_lines(const std::string& text);
/// The number that follows a word, blanks skipped; empty if there is none.
std::optional<double> number_after(std::string_view line, std::string_view word);
/// The number of a waypoint; empty if a line that looks like a message contains none.
std::optional<int> waypoint_of(std::optional<double> number);

}  // namespace chaintrue::grid::files
