// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/query_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace chaintrue::cli {
namespace {

grid::MapStatus status_of(const AnswerLine& line) {
  return line.answer ? line.answer->status : grid::MapStatus::outside;
}

}  // namespace

std::string as_csv(const AskedMap& asked, const std::vector<AnswerLine>& lines) {
  const auto names = asked.map.length_names();
  std::string text = "x_mm,y_mm,";
  for (const std::string_view name : names) text += fmt::format("{}_mm,", name);
  text += fmt::format("{}_sigma_mm,{}_sigma_mm,status\n", names[0], names[1]);
  for (const AnswerLine& line : lines) {
    fmt::format_to(std::back_inserter(text), "{},{},", line.point.x_mm, line.point.y_mm);
    if (line.answer) {
      for (const double length : line.answer->lengths_mm)
        fmt::format_to(std::back_inserter(text), "{:.{}f},", length, asked.digits);
      fmt::format_to(std::back_inserter(text),
                     "{:.4f},{:.4f},",
                     line.answer->sigma.left_mm,
                     line.answer->sigma.right_mm);
    } else {
      text.append(names.size() + 2, ',');
    }
    text += fmt::format("{}\n", grid::name(status_of(line)));
  }
  return text;
}

std::string as_json(const AskedMap& asked, const std::vector<AnswerLine>& lines) {
  const auto names = asked.map.length_names();
  std::string text = "[";
  const char* separator = "\n";
  for (const AnswerLine& line : lines) {
    fmt::format_to(std::back_inserter(text),
                   "{}  {{\"x_mm\": {}, \"y_mm\": {}, ",
                   separator,
                   line.point.x_mm,
                   line.point.y_mm);
    if (line.answer) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        fmt::format_to(std::back_inserter(text),
                       "\"{}_mm\": {:.{}f}, ",
                       names[i],
                       line.answer->lengths_mm[static_cast<Eigen::Index>(i)],
                       asked.digits);
      }
      fmt::format_to(std::back_inserter(text),
                     "\"{}_sigma_mm\": {:.4f}, \"{}_sigma_mm\": {:.4f}, ",
                     names[0],
                     line.answer->sigma.left_mm,
                     names[1],
                     line.answer->sigma.right_mm);
      if (line.answer->tool_sigma_mm) {
        fmt::format_to(
            std::back_inserter(text), "\"tool_sigma_mm\": {:.4f}, ", *line.answer->tool_sigma_mm);
      }
    }
    fmt::format_to(std::back_inserter(text), "\"status\": \"{}\"}}", grid::name(status_of(line)));
    separator = ",\n";
  }
  return text + "\n]\n";
}

}  // namespace chaintrue::cli
