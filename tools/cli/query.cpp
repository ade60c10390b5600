// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue query: chain lengths for points, and the point for chain lengths.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "grid/files/points_file.hpp"
#include "tools/cli/fields.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct QueryCommand {
  std::string map;
  std::vector<double> coordinates;
  std::string points;
  std::vector<double> inverse;
  std::string frame = "marks";
  std::string output = "-";
  OutsideOption outside;
  bool json = false;
};

/// In the frame of --frame.
std::vector<BedPoint> points_asked(const QueryCommand& command) {
  std::vector<BedPoint> points;
  if (!command.points.empty()) {
    for (const MarkPoint& point : files::read_points(command.points))
      points.push_back(identity_placement(point));
    return points;
  }
  for (std::size_t i = 0; i + 1 < command.coordinates.size(); i += 2) {
    points.push_back({command.coordinates[i], command.coordinates[i + 1]});
  }
  return points;
}

/// Words for one of the first two lengths: "left", "top left".
std::string_view words_of(std::string_view length) {
  const auto belt = model::belt_of(length);
  return belt ? words(*belt) : length;
}

Field status_field(grid::MapStatus status) { return {"status", std::string(name(status)), true}; }

/// The fields of a point; without an answer, in a table they are empty, and JSON has none.
Fields fields_of(const QueryCommand& command, const grid::LengthMap& map, const BedPoint& point,
                 const tl::expected<grid::LengthsAnswer, grid::MapFailure>& answer) {
  const auto names = map.length_names();
  const int digits = names.size() == 2 ? 6 : 4;
  Fields fields = {{"x_mm", fmt::format("{}", point.x_mm)},
                   {"y_mm", fmt::format("{}", point.y_mm)}};
  for (const auto i : each_index(names)) {
    fields.push_back(
        {fmt::format("{}_mm", names[i]),
         answer ? fmt::format("{:.{}f}", answer->lengths_mm[grid::as_index(i)], digits) : ""});
  }
  for (const Side side : kSides) {
    fields.push_back({fmt::format("{}_sigma_mm", names[side == Side::left ? 0 : 1]),
                      answer ? fmt::format("{:.4f}", answer->sigma[side]) : ""});
  }
  // A table keeps the columns that its readers know.
  if (command.json && answer && answer->tool_sigma_mm)
    fields.push_back({"tool_sigma_mm", fmt::format("{:.4f}", *answer->tool_sigma_mm)});
  if (command.json) std::erase_if(fields, [](const Field& field) { return field.text.empty(); });
  fields.push_back(status_field(answer ? answer->status : grid::MapStatus::outside));
  return fields;
}

int answer_inverse(const Target& target, const QueryCommand& command) {
  const grid::LengthMap& map = *target.lengths;
  const auto tool = map.tool({command.inverse[0], command.inverse[1]});
  if (!tool) {
    const bool of_belts = target.as<FittedAnchors>() != nullptr;
    const auto names = map.length_names();
    say("{} {} mm, {} {} mm: {}", words_of(names[0]), command.inverse[0], words_of(names[1]),
        command.inverse[1],
        of_belts && !tool.error().cause.empty() ? std::string(tool.error().cause)
                                                : tool.error().sentence());
    return kNotSupportedOrOutside;
  }
  const Fields fields = {{"x_mm", fmt::format("{:.6f}", tool->x_mm)},
                         {"y_mm", fmt::format("{:.6f}", tool->y_mm)},
                         status_field(map.status(*tool))};
  write_output(command.output,
               command.json ? json_of(fields) + "\n" : csv_names(fields) + csv_values(fields));
  return kDone;
}

int answer_points(const Target& target, const QueryCommand& command) {
  const bool of_belts = target.as<FittedAnchors>() != nullptr;
  std::string text, outside;
  const std::vector<BedPoint> points = points_asked(command);
  for (const auto i : each_index(points)) {
    const BedPoint& point = points[i];
    progress_is(as_double(i), as_double(points.size()));
    const auto answer = target.lengths->query(point);
    const Fields fields = fields_of(command, *target.lengths, point, answer);
    if (command.json) {
      text += (i == 0 ? "[\n  " : ",\n  ") + json_of(fields);
    } else {
      text += (i == 0 ? csv_names(fields) : "") + csv_values(fields);
    }
    if (answer) continue;
    outside += fmt::format("({}, {}): {}\n", point.x_mm, point.y_mm,
                           of_belts ? "outside the frame of these anchors, or closer to one than "
                                      "the length of its arm"
                                    : answer.error().sentence());
  }
  if (!outside.empty()) {
    end_progress();
    say_lines(outside);
  }
  write_output(command.output, command.json ? text + "\n]\n" : text);
  return outside.empty() ? kDone : kNotSupportedOrOutside;
}

int run_query(Verb verb, const QueryCommand& command) {
  const InputFile file = open_target_file(command.map);
  verb.refuse_idle_options(file.fact() |
                           (command.outside.way == "fade" ? facts::fade : facts::nothing));
  const Target target = open_target(file, command.frame, command.outside);
  const auto* map = target.as<CompensationMap>();
  if (command.frame == "bed" && map->machine() == nullptr) {
    say("{}: a map without a machine has only the frame of its marks", command.map);
    return kNotSupportedOrOutside;
  }
  const int code =
      command.inverse.empty() ? answer_points(target, command) : answer_inverse(target, command);
  const bool has_report = file.kind != FileKind::plotter;
  if (code == kDone && has_report) say_next(report_words(command.map));
  return code;
}

/// Rules between options that CLI11 cannot express.
void check_usage(const QueryCommand& command) {
  const int ways = (command.coordinates.empty() ? 0 : 1) + (command.points.empty() ? 0 : 1) +
                   (command.inverse.empty() ? 0 : 1);
  if (ways != 1) usage_error("query", "give points as X Y ..., or --points FILE, or --inverse L R");
  if (command.coordinates.size() % 2 != 0) {
    usage_error("query",
                fmt::format("{} numbers: give X and Y in pairs", command.coordinates.size()));
  }
}

}  // namespace

void add_query(Verb app) {
  auto [verb, c] = app.add_verb<QueryCommand>(
      "query", "Compute chain lengths for points of the bed, or the point for chain lengths",
      R"(status: inside the measured points, at their edge, extrapolated beyond them, or outside the bed (exit code 4).
Sigmas are one standard deviation of the map at that point.
With anchors, the answer is the lengths of the four belts as the firmware pays them out: slanted,
from the anchor to the belt's end. The upper two determine the position, and --inverse takes
those two.

Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue query map.json 100 200 -1000 -450)",
      run_query, check_usage);
  verb.has(
      {{"map", required(reads(c.map)),
        "A chaintrue_map or chaintrue_anchors file, or a chaintrue_plotter that fit wrote from "
        "a drawing; - is standard input"},
       {"coordinates", {c.coordinates, {"mm", -1e6, 1e6}}, "Pairs X Y [mm]"},
       {"--points", reads(c.points), "CSV with the columns x_mm and y_mm; - is standard input"},
       {"--inverse",
        {c.inverse, {"mm", -1e6, 1e6}, 2},
        "Find the tool's position from the chain lengths L R [mm]"},
       frame_row(c.frame,
                 "marks: coordinates as on the measured sheet; bed: as in the machine file, "
                 "without the sheet's placement"),
       {"-o,--output", writes(c.output, {Origin::table}), "- is standard output"}});
  add_outside_options(verb, c.outside, "by default as stored in the map");
  verb.acts_on("--outside",
               {{facts::map | facts::anchors, "to be left out, because a plotter has no surface"},
                {facts::map, "to be left out, because four belts have no surface"}});
  verb.has({{"--json", c.json, "Print JSON instead of CSV"}});
}

}  // namespace chaintrue::cli
