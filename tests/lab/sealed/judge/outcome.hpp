// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The outcome of one sealed set, as one line of plain text, identical for the same set and the
/// same diagnosis: words separated by blanks, lists by commas, `-` for nothing.
///
///   kind seed points strength hidden verdict named facts
///   single 1000001 28 7.31 chain_sag:- named chain_sag:- leads,alone,held,all,...
///
/// Facts are counted by the rows of the table of rates. For each fact more is better; a set that
/// could not be diagnosed has none.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

struct Outcome {
  std::string kind;  ///< of plan.hpp
  std::uint64_t seed = 0;
  int points = 0;
  double strength = 0.0;  ///< of the first hidden cause or of the pattern, to 0.01; 0: none
  std::vector<std::string> hidden;  ///< effect:side
  std::string verdict;              ///< as in files; "failed" if there is none
  std::vector<std::string> named;   ///< effect:side, its class after `~`
  std::vector<std::string> facts;

  [[nodiscard]] bool has(std::string_view fact) const;
  bool operator==(const Outcome&) const = default;
};

[[nodiscard]] Outcome outcome_of(std::string kind, const Trial& trial);
[[nodiscard]] Outcome outcome_of(std::string kind, const BeltsTrial& trial);

/// Without the end of the line.
[[nodiscard]] std::string line_of(const Outcome& outcome);
/// \throws std::invalid_argument with the line if it is malformed.
[[nodiscard]] Outcome parse_outcome(const std::string& line);

/// Lines that begin with `#` and empty ones are comments. An incomplete last line comes from an
/// interruption and is left out. \throws std::invalid_argument for any other line that is not an
/// outcome.
[[nodiscard]] std::vector<Outcome> parse_outcomes(const std::string& text);
/// Sorted by kind and seed, one line for each set. \throws std::invalid_argument if two outcomes of
/// one set differ.
[[nodiscard]] std::vector<Outcome> sorted(std::vector<Outcome> outcomes);
[[nodiscard]] std::string text_of(const std::vector<Outcome>& outcomes);

/// \throws std::invalid_argument if the file cannot be read, or for a line as parse_outcomes() does.
[[nodiscard]] std::vector<Outcome> read_outcomes(const std::string& path);
/// By an atomic rename, so that an interruption leaves the old file or the new one. \throws
/// std::invalid_argument if the file cannot be written.
void write_outcomes(const std::string& path, const std::vector<Outcome>& outcomes);

}  // namespace chaintrue::sealed
