// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "grid/files/problems.hpp"

namespace chaintrue::cli {
namespace {

/// Of the current command line.
files::Problems& problems() {
  static files::Problems all("command line");
  return all;
}

std::string expected(const files::Range& range, bool is_whole) {
  const std::string text = range.expected();
  constexpr std::string_view kNumber = "a number";
  return is_whole ? "a whole number" + text.substr(kNumber.size()) : text;
}

std::optional<double> read_number(const std::string& name,
                                  const std::string& text,
                                  const files::Range& range,
                                  bool is_whole) {
  const auto number = files::number_of(text);
  if (number && range.holds(*number) && (!is_whole || *number == std::floor(*number)))
    return number;
  problems().add(name,
                 text.empty() ? "nothing" : text,
                 files::kind_of_bad_number(text),
                 expected(range, is_whole) +
                     (files::looks_like_decimal_comma(text) ? ", with a decimal point" : ""));
  return std::nullopt;
}

}  // namespace

namespace detail {

Option add_number(Verb verb,
                  const std::string& names,
                  const files::Range& range,
                  bool is_whole,
                  const std::string& help,
                  std::function<void(double)> take,
                  std::optional<double> shown_default) {
  const auto read =
      [name = names, range, is_whole, take = std::move(take)](const std::string& text) {
        if (const auto number = read_number(name, text, range, is_whole)) take(*number);
      };
  Option option = verb.add_option(names, read, help).value_word(is_whole ? "INT" : "FLOAT");
  if (shown_default) option.shows_default(fmt::format("{}", *shown_default));
  return option;
}

}  // namespace detail

Option add_numbers(Verb verb,
                   const std::string& names,
                   std::vector<double>& values,
                   const files::Range& range,
                   const std::string& help) {
  const auto read = [name = names, range, &values](const Words& texts) {
    // The number of values is kept as typed.
    for (const std::string& text : texts)
      values.push_back(read_number(name, text, range, false).value_or(0.0));
  };
  return verb.add_option(names, read, help).value_word("FLOAT");
}

void check_numbers() { problems().throw_if_any(); }

void forget_numbers() { problems() = files::Problems("command line"); }

}  // namespace chaintrue::cli
