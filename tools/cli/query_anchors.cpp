// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/query_anchors.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <optional>

#include "grid/belts/belt_map.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;
using model::Belt;
using model::kBelts;

/// One line of the answer: numbers that are not there are empty cells, or left out.
struct AnswerOfBelts {
  model::BedPoint point;
  std::optional<model::PerBelt<double>> lengths_mm;
  model::ChainLengths sigma;  ///< of the upper two
  std::string_view status = "outside";
};

grid::BeltMap map_of(const files::FittedAnchors& anchors, const std::string& file) {
  if (!anchors.holes && !anchors.fit.coordinates.front().stated_mm) {
    throw files::InputError(
        {{file,
          "/fit/coordinates",
          "no stated_mm",
          "anchors fitted to a file that states those in force: where commands count from follows "
          "from them (import maslow4 --settings maslow.yaml)"}});
  }
  return grid::BeltMap(anchors.fit, anchors.holes ? &*anchors.holes : nullptr);
}

/// The upper two decide where the tool is; the lower two follow it there.
AnswerOfBelts answered(const grid::BeltMap& map,
                       const model::BeltMachine& machine,
                       model::BedPoint point) {
  AnswerOfBelts line{point, std::nullopt, {}};
  const auto upper = map.lengths(point);
  if (!upper || map.status(point) == grid::MapStatus::outside) return line;
  const auto place = model::place_of_upper(machine, upper->left_mm, upper->right_mm);
  const auto all =
      place
          ? model::lengths_at(machine, *place)
          : tl::expected<model::PerBelt<double>, model::BeltFailure>(tl::unexpected(place.error()));
  if (!all) return line;
  line.lengths_mm = *all;
  line.sigma = map.sigma(point);
  line.status = grid::name(map.status(point));
  return line;
}

std::string as_csv(const std::vector<AnswerOfBelts>& lines) {
  std::string text = "x_mm,y_mm,tl_mm,tr_mm,bl_mm,br_mm,tl_sigma_mm,tr_sigma_mm,status\n";
  for (const AnswerOfBelts& line : lines) {
    fmt::format_to(std::back_inserter(text), "{},{},", line.point.x_mm, line.point.y_mm);
    if (line.lengths_mm) {
      for (const Belt belt : kBelts)
        fmt::format_to(std::back_inserter(text), "{:.4f},", (*line.lengths_mm)[belt]);
      fmt::format_to(
          std::back_inserter(text), "{:.4f},{:.4f},", line.sigma.left_mm, line.sigma.right_mm);
    } else {
      text += ",,,,,,";
    }
    text += fmt::format("{}\n", line.status);
  }
  return text;
}

std::string as_json(const std::vector<AnswerOfBelts>& lines) {
  std::string text = "[";
  const char* separator = "\n";
  for (const AnswerOfBelts& line : lines) {
    fmt::format_to(std::back_inserter(text),
                   "{}  {{\"x_mm\": {}, \"y_mm\": {}, ",
                   separator,
                   line.point.x_mm,
                   line.point.y_mm);
    if (line.lengths_mm) {
      for (const Belt belt : kBelts)
        fmt::format_to(
            std::back_inserter(text), "\"{}_mm\": {:.4f}, ", name(belt), (*line.lengths_mm)[belt]);
      fmt::format_to(std::back_inserter(text),
                     "\"tl_sigma_mm\": {:.4f}, \"tr_sigma_mm\": {:.4f}, ",
                     line.sigma.left_mm,
                     line.sigma.right_mm);
    }
    fmt::format_to(std::back_inserter(text), "\"status\": \"{}\"}}", line.status);
    separator = ",\n";
  }
  return text + "\n]\n";
}

int answer_inverse(const grid::BeltMap& map, const AnchorsQuery& query) {
  const auto tool = map.tool({query.inverse[0], query.inverse[1]});
  if (!tool) {
    fmt::print(stderr,
               "top left {} mm, top right {} mm: {}\n",
               query.inverse[0],
               query.inverse[1],
               model::explain(tool.error()));
    return kNotSupportedOrOutside;
  }
  const auto status = grid::name(map.status(*tool));
  write_output(
      query.output,
      query.json
          ? fmt::format("{{\"x_mm\": {:.6f}, \"y_mm\": {:.6f}, \"status\": \"{}\"}}\n",
                        tool->x_mm,
                        tool->y_mm,
                        status)
          : fmt::format("x_mm,y_mm,status\n{:.6f},{:.6f},{}\n", tool->x_mm, tool->y_mm, status));
  return kDone;
}

}  // namespace

int query_anchors(const AnchorsQuery& query) {
  const files::FittedAnchors anchors = load_anchors(query.file);
  const grid::BeltMap map = map_of(anchors, query.file.name);
  const model::BeltMachine machine = grid::paying_out(anchors.fit.machine);
  const std::vector<std::string> next = {
      "report",
      query.file.path,
      "-o",
      std::filesystem::path(query.file.path).replace_extension(".html").string()};
  if (!query.inverse.empty()) {
    const int code = answer_inverse(map, query);
    if (code == kDone) say_next(next);
    return code;
  }
  std::vector<AnswerOfBelts> lines;
  bool reached = true;
  for (const model::BedPoint& point : query.points) {
    lines.push_back(answered(map, machine, point));
    if (lines.back().lengths_mm) continue;
    reached = false;
    fmt::print(
        stderr,
        "({}, {}): outside the frame of these anchors, or nearer to one than its arm is long\n",
        point.x_mm,
        point.y_mm);
  }
  write_output(query.output, query.json ? as_json(lines) : as_csv(lines));
  if (reached) say_next(next);
  return reached ? kDone : kNotSupportedOrOutside;
}

}  // namespace chaintrue::cli
