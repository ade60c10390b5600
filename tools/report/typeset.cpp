// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/typeset.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "grid/precondition.hpp"

namespace chaintrue::report {

std::string replaced(std::string text, std::initializer_list<Replacement> replacements) {
  for (const auto& [from, to] : replacements) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  }
  return text;
}

std::string escaped(std::string_view bytes) {
  using Json = nlohmann::json;
  const std::string utf8 = Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace);
  return replaced(Json::parse(utf8).get<std::string>(),
                  {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string typeset(std::string text) {
  constexpr std::string_view kAtFirst = "+- ";
  if (text.starts_with(kAtFirst)) text.replace(0, kAtFirst.size(), "\u00b1\u00a0");
  return replaced(std::move(text), {{" +- ", "\u00a0\u00b1\u00a0"}});
}

std::string number_of(double value, const Column& column) {
  if (!std::isfinite(value)) throw grid::precondition("{} is {}", column.heading, value);
  std::string text = column.has_sign ? fmt::format("{:+.{}f}", value, column.digits)
                                     : fmt::format("{:.{}f}", value, column.digits);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos)
    text.replace(0, 1, column.has_sign ? "+" : "");
  return text;
}

std::string typed(const Cell& cell, const Column& column, const char* unknown) {
  if (const auto* number = std::get_if<double>(&cell.value)) return number_of(*number, column);
  const auto* text = std::get_if<std::string>(&cell.value);
  return text != nullptr ? *text : unknown;
}

std::string with_true_minus(std::string number) {
  return number.front() == '-' ? "\u2212" + number.substr(1) : number;
}

std::string fixed(double value, int digits) {
  return with_true_minus(number_of(value, {.heading = "a number", .digits = digits}));
}

void check_row(const Table& table, const Row& row) {
  if (row.cells.size() <= table.columns.size()) return;
  throw grid::precondition("a table row has {} cells for {} columns", row.cells.size(),
                           table.columns.size());
}

}  // namespace chaintrue::report
