// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A reader as strict as those of small controllers: what it accepts, they accept.
///
/// Numbers are grbl 1.1's (gnea/grbl, nuts_bolts.c, read_float): an optional sign, digits, at most one
/// point, at least one digit, no exponent; digits beyond the eighth are dropped. Letters are capitals;
/// a letter occurs once in a line; a line is at most 80 characters (grbl's LINE_BUFFER_SIZE); comments
/// in parentheses are not nested.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace chaintrue::follower {

struct StrictLine {
  /// In their order; G and M may occur several times.
  std::vector<std::pair<char, double>> words;
};

/// The line's words; otherwise empty, with the problem that a small controller would have.
std::optional<StrictLine> read_strictly(const std::string& line, std::string& objection);

/// The value that grbl reads, to all digits that it keeps; empty if it rejects the number.
std::optional<double> strict_number(const std::string& text);

}  // namespace chaintrue::follower
