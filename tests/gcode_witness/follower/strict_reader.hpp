// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A reader as strict as the small controllers': what it takes, they take.
///
/// Numbers are grbl 1.1's (gnea/grbl, nuts_bolts.c, read_float): an optional sign, digits, at most one
/// point, at least one digit, no exponent; digits beyond the eighth are dropped. Letters are capitals;
/// a letter stands once a line; a line is at most 80 characters (grbl's LINE_BUFFER_SIZE); comments in
/// parentheses are not nested.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace chaintrue::follower {

struct StrictLine {
  /// In their order; G and M may stand several times.
  std::vector<std::pair<char, double>> words;
};

/// The line's words, or nothing and what a small controller would stumble over.
[[nodiscard]] std::optional<StrictLine> read_strictly(const std::string& line, std::string& objection);

/// What grbl makes of the number, to all digits that it keeps; nothing where it refuses it.
[[nodiscard]] std::optional<double> strict_number(const std::string& text);

}  // namespace chaintrue::follower
