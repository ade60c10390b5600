// SPDX-License-Identifier: GPL-3.0-or-later
// The options of each kind of variable.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include <CLI/CLI.hpp>

#include "grid/files/problems.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {
namespace {

std::string expected(const Range& range, bool is_whole) {
  const std::string text = range.expected();
  constexpr std::string_view kNumber = "a number";
  return is_whole ? "a whole number" + text.substr(kNumber.size()) : text;
}

std::optional<double> read_number(const std::string& name, const std::string& text,
                                  const Range& range, bool is_whole) {
  const auto number = files::number_of(text);
  if (number && range.holds(*number) && (!is_whole || *number == std::floor(*number)))
    return number;
  declared().misread.add(
      name, text.empty() ? "nothing" : text, files::kind_of_bad_number(text),
      expected(range, is_whole) +
          (files::looks_like_decimal_comma(text) ? ", with a decimal point" : ""));
  return std::nullopt;
}

}  // namespace

Value::Value(std::string& text, Words one_of)
    : declare([&text, one_of = std::move(one_of)](Verb verb, auto& names, auto& help) {
        CLI::Option* option = verb.app().add_option(names, text, help)->default_str(text);
        if (!one_of.empty()) option->check(CLI::IsMember(one_of));
        return option;
      }) {}

Value::Value(Words& texts)
    : declare([&texts](Verb verb, auto& names, auto& help) {
        return verb.app().add_option(names, texts, help);
      }) {}

Value::Value(bool& flag)
    : declare([&flag](Verb verb, auto& names, auto& help) {
        return verb.app().add_flag(names, flag, help);
      }) {}

Value::Value(const Range& range, bool is_whole, Take take, std::optional<double> usual)
    : declare([=, take = std::move(take)](Verb verb, auto& names, auto& help) {
        const auto read = [names, range, is_whole, take](const std::string& text) {
          if (const auto number = read_number(names, text, range, is_whole)) take(*number);
        };
        CLI::Option* option = verb.app().add_option_function<std::string>(names, read, help);
        if (usual && range.holds(*usual)) option->default_str(fmt::format("{}", *usual));
        return option->type_name(is_whole ? "INT" : "FLOAT");
      }) {}

Value::Value(std::vector<double>& numbers, const Range& range, int count)
    : declare([&numbers, range, count](Verb verb, auto& names, auto& help) {
        const auto read = [&numbers, names, range](const Words& texts) {
          // The number of values is kept as typed.
          for (const std::string& text : texts)
            numbers.push_back(read_number(names, text, range, false).value_or(0.0));
        };
        CLI::Option* option = verb.app().add_option_function<Words>(names, read, help);
        if (count > 0) option->expected(count);
        return option->type_name("FLOAT");
      }) {}

Value::Value(std::string usual, std::string expected, std::function<bool(const std::string&)> take)
    : declare([=](Verb verb, auto& names, auto& help) {
        const auto read = [names, expected, take](const std::string& word) {
          if (!take(word)) declared().misread.add(names, word, ProblemKind::unknown_word, expected);
        };
        return verb.app().add_option_function<std::string>(names, read, help)->default_str(usual);
      }) {}

Value Value::with(Change change) const {
  Value value = *this;
  value.declare = [declare = declare, change = std::move(change)](Verb verb, auto& names,
                                                                  auto& help) {
    CLI::Option* option = declare(verb, names, help);
    change(verb, names, *option);
    return option;
  };
  return value;
}

Value required(const Value& value) {
  return value.with([](Verb, auto&, CLI::Option& option) {
    // A default of the command is none of an option that must be given.
    option.required()->default_str("");
  });
}

Value without_default(const Value& value) {
  return value.with([](Verb, auto&, CLI::Option& option) { option.default_str(""); });
}

}  // namespace chaintrue::cli
