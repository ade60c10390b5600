// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The outcome of one set of a campaign, as one line of plain text, identical for the same set and the
/// same version: words separated by blanks, lists by commas, `-` for nothing; numbers last, if there are any.
///
///   kind seed points strength hidden verdict named facts
///   single 1000001 28 7.31 chain_sag:- named chain_sag:- leads,alone,held,all,...
///   drift:28 3 34 0.00 - - - - built=0,true_mm=0.21
///
/// Facts are counted by rows of rates (rates.hpp); a set that failed has none.
#include <charconv>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "grid/files/parse_double.hpp"

namespace chaintrue::sealed {

struct Outcome {
  std::string kind{};  ///< one word; what sets of several kinds have in common stands after a colon
  std::uint64_t seed = 0;
  int points = 0;
  double strength = 0.0;  ///< of the first hidden cause or of the pattern, to 0.01; 0: none
  std::vector<std::string> hidden{};  ///< effect:side
  std::string verdict = "-";          ///< as in files; "failed" if there is none
  std::vector<std::string> named{};   ///< effect:side, its class after `~`
  std::vector<std::string> facts{};
  std::map<std::string, double> numbers{};

  void add(const std::string& fact, bool holds) {
    if (holds) facts.push_back(fact);
  }
  void fail();
  /// Also "is_" with the verdict.
  bool has(std::string_view fact) const;
  /// The kind up to its last colon, and after it.
  std::string group() const { return kind.substr(0, kind.rfind(':')); }
  std::string way() const { return kind.substr(kind.rfind(':') + 1); }
};

/// \throws std::invalid_argument with the text if it is not a number as a whole.
template <class Number>
Number number_of(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = [&] {
    if constexpr (std::is_floating_point_v<Number>) {
      return grid::files::parse_double(text.data(), end, value);
    } else {
      return std::from_chars(text.data(), end, value);
    }
  }();
  if (error != std::errc{} || rest != end)
    throw std::invalid_argument("\"" + text + "\" is not a number");
  return value;
}

/// The parts between separators; none of "-".
std::vector<std::string> words_of(const std::string& text, char separator);

/// The lines of a table of tests/lab, cell by cell; those that begin with `#` are comments.
std::vector<std::vector<std::string>> table(const std::string& file);

/// Without the end of the line.
std::string line_of(const Outcome& outcome);
/// \throws std::invalid_argument with the line if it is malformed.
[[nodiscard]] Outcome parse_outcome(const std::string& line);

/// Lines that begin with `#` and empty ones are comments. An incomplete last line comes from an
/// interruption and is left out. \throws std::invalid_argument for any other line that is not an
/// outcome.
[[nodiscard]] std::vector<Outcome> parse_outcomes(const std::string& text);

/// Sorted by kind and seed, one line for each set. \throws std::invalid_argument if two outcomes of
/// one set differ.
[[nodiscard]] std::vector<Outcome> sorted(std::vector<Outcome> outcomes);

std::string text_of(const std::vector<Outcome>& outcomes);

/// \throws std::invalid_argument if the file cannot be read, or for a line as parse_outcomes() does.
[[nodiscard]] std::vector<Outcome> read_outcomes(const std::string& path);
/// By an atomic rename, so that an interruption leaves the old file or the new one. \throws
/// std::invalid_argument if the file cannot be written.
void write_outcomes(const std::string& path, const std::vector<Outcome>& outcomes);

}  // namespace chaintrue::sealed
