// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue query: chain lengths for points, and the point for chain lengths.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/points_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/outside_option.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/query_anchors.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

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

/// One line of the answer: numbers that are not there are empty cells, or null.
struct AnswerLine {
  model::MarkPoint point;
  tl::expected<grid::MapAnswer, grid::MapFailure> answer;
};

grid::MapStatus status_of(const AnswerLine& line) {
  return line.answer ? line.answer->status : grid::MapStatus::outside;
}

std::string as_csv(const std::vector<AnswerLine>& lines) {
  std::string text = "x_mm,y_mm,left_mm,right_mm,left_sigma_mm,right_sigma_mm,status\n";
  for (const AnswerLine& line : lines) {
    fmt::format_to(std::back_inserter(text), "{},{},", line.point.x_mm, line.point.y_mm);
    if (line.answer) {
      fmt::format_to(std::back_inserter(text),
                     "{:.6f},{:.6f},{:.4f},{:.4f},",
                     line.answer->lengths.left_mm,
                     line.answer->lengths.right_mm,
                     line.answer->sigma.left_mm,
                     line.answer->sigma.right_mm);
    } else {
      text += ",,,,";
    }
    text += fmt::format("{}\n", grid::name(status_of(line)));
  }
  return text;
}

std::string as_json(const std::vector<AnswerLine>& lines) {
  std::string text = "[";
  const char* separator = "\n";
  for (const AnswerLine& line : lines) {
    fmt::format_to(std::back_inserter(text),
                   "{}  {{\"x_mm\": {}, \"y_mm\": {}, ",
                   separator,
                   line.point.x_mm,
                   line.point.y_mm);
    if (line.answer) {
      fmt::format_to(std::back_inserter(text),
                     "\"left_mm\": {:.6f}, \"right_mm\": {:.6f}, \"left_sigma_mm\": {:.4f}, "
                     "\"right_sigma_mm\": {:.4f}, "
                     "\"tool_sigma_mm\": {:.4f}, ",
                     line.answer->lengths.left_mm,
                     line.answer->lengths.right_mm,
                     line.answer->sigma.left_mm,
                     line.answer->sigma.right_mm,
                     line.answer->tool_sigma_mm);
    }
    fmt::format_to(std::back_inserter(text), "\"status\": \"{}\"}}", grid::name(status_of(line)));
    separator = ",\n";
  }
  return text + "\n]\n";
}

/// In the frame of --frame.
std::vector<model::MarkPoint> points_asked(const QueryCommand& command) {
  if (!command.points.empty()) return files::read_points(command.points);
  std::vector<model::MarkPoint> points;
  for (std::size_t i = 0; i + 1 < command.coordinates.size(); i += 2) {
    points.push_back({command.coordinates[i], command.coordinates[i + 1]});
  }
  return points;
}

model::MarkPoint mark_of(model::MarkPoint asked,
                         const grid::CompensationMap& map,
                         const QueryCommand& command) {
  return command.frame == "bed" ? map.to_mark(model::identity_placement(asked)) : asked;
}

int run_inverse(const grid::CompensationMap& map, const QueryCommand& command) {
  const auto mark = map.inverse({command.inverse[0], command.inverse[1]});
  if (!mark) {
    fmt::print(stderr,
               "left {} mm, right {} mm: {}\n",
               command.inverse[0],
               command.inverse[1],
               grid::explain(mark.error()));
    return kNotSupportedOrOutside;
  }
  const model::MarkPoint point =
      command.frame == "bed" ? model::identity_placement(map.to_bed(*mark)) : *mark;
  write_output(command.output,
               command.json
                   ? fmt::format("{{\"x_mm\": {:.6f}, \"y_mm\": {:.6f}, \"status\": \"{}\"}}\n",
                                 point.x_mm,
                                 point.y_mm,
                                 grid::name(map.status(*mark)))
                   : fmt::format("x_mm,y_mm,status\n{:.6f},{:.6f},{}\n",
                                 point.x_mm,
                                 point.y_mm,
                                 grid::name(map.status(*mark))));
  return kDone;
}

std::string page_of(const std::string& map) {
  return std::filesystem::path(map).replace_extension(".html").string();
}

int query_map(const QueryCommand& command, const grid::CompensationMap& stored) {
  if (command.outside.way == "fade" && stored.machine() == nullptr) {
    fmt::print(stderr,
               "{}: without a machine nothing is left where the map's surface fades out\n",
               command.map);
    return kNotSupportedOrOutside;
  }
  const grid::CompensationMap map =
      stored.with_outside(rule_of(command.outside, stored.contents().outside));
  if (command.frame == "bed" && map.machine() == nullptr) {
    fmt::print(
        stderr, "{}: a map without a machine knows only the frame of its marks\n", command.map);
    return kNotSupportedOrOutside;
  }
  const std::vector<std::string> next = {"report", command.map, "-o", page_of(command.map)};
  if (!command.inverse.empty()) {
    const int code = run_inverse(map, command);
    if (code == kDone) say_next(next);
    return code;
  }
  std::vector<AnswerLine> lines;
  std::string outside;
  const std::vector<model::MarkPoint> points = points_asked(command);
  for (const model::MarkPoint& point : points) {
    progress_is(static_cast<double>(lines.size()), static_cast<double>(points.size()));
    lines.push_back({point, map.query(mark_of(point, map, command))});
    if (lines.back().answer) continue;
    fmt::format_to(std::back_inserter(outside),
                   "({}, {}): {}\n",
                   point.x_mm,
                   point.y_mm,
                   grid::explain(lines.back().answer.error()));
  }
  if (!outside.empty()) {
    end_progress();
    fmt::print(stderr, "{}", outside);
  }
  write_output(command.output, command.json ? as_json(lines) : as_csv(lines));
  if (outside.empty()) say_next(next);
  return outside.empty() ? kDone : kNotSupportedOrOutside;
}

int run_query(Verb verb, const QueryCommand& command) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map, FileKind::anchors});
  refuse_what_does_nothing(verb,
                           (file.kind == FileKind::map ? facts::map : facts::anchors) |
                               (command.outside.way == "fade" ? facts::fade : 0U));
  if (file.kind == FileKind::map) {
    return with_map(
        file, [&](const grid::CompensationMap& stored) { return query_map(command, stored); });
  }
  // A program for belts knows one frame.
  std::vector<model::BedPoint> points;
  if (command.inverse.empty()) {
    for (const model::MarkPoint& point : points_asked(command))
      points.push_back(model::identity_placement(point));
  }
  return query_anchors({file, std::move(points), command.inverse, command.output, command.json});
}

/// What CLI11 cannot say of the options together.
void check_usage(const QueryCommand& command) {
  const int ways = (command.coordinates.empty() ? 0 : 1) + (command.points.empty() ? 0 : 1) +
                   (command.inverse.empty() ? 0 : 1);
  if (ways != 1) usage_error("query", "give points as X Y ..., or --points FILE, or --inverse L R");
  if (command.coordinates.size() % 2 != 0) {
    usage_error("query",
                fmt::format("{} numbers are no pairs of X and Y", command.coordinates.size()));
  }
}

}  // namespace

void add_query(Verb app, Run& run) {
  auto command = std::make_shared<QueryCommand>();
  Verb verb =
      app.add_verb("query", "Chain lengths for points of the bed, or the point for chain lengths");
  add_input(
      verb, "map", command->map, "A chaintrue_map or chaintrue_anchors file; - is standard input")
      .required();
  add_numbers(verb,
              "coordinates",
              command->coordinates,
              {"mm", -1e6, 1e6},
              "X Y, in mm, as many pairs as you like");
  add_input(verb,
            "--points",
            command->points,
            "A CSV with the columns x_mm and y_mm; - is standard input");
  add_numbers(verb,
              "--inverse",
              command->inverse,
              {"mm", -1e6, 1e6},
              "Chain lengths L R in mm: where is the tool?")
      .takes(2);
  verb.add_option("--frame",
                  command->frame,
                  "marks: coordinates as on the measured sheet; bed: as in the machine file, the "
                  "sheet's placement taken out")
      .one_of({"marks", "bed"})
      .shows_default();
  add_output(verb, "-o,--output", command->output, {Origin::table}, "- is standard output")
      .shows_default();
  add_outside_options(verb, command->outside, "as the map says where not said");
  verb.add_flag("--json", command->json, "JSON in place of CSV");
  verb.footer(
      "status: inside the measured points, at their edge, extrapolated beyond them, or outside the "
      "bed (exit code 4).\n"
      "Sigmas are one standard deviation of the map at that point.\n"
      "Of anchors the answer is four belts' own lengths at the bed's height, from the anchor\n"
      "slanting to the end, as the firmware pays them out; the upper two decide, and --inverse\n"
      "takes these two.\n\nExample:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue query map.json 100 200 -1000 -450");
  verb.when_chosen([command, verb, &run] {
    check_usage(*command);
    run = [command, verb] { return run_query(verb, *command); };
  });
}

}  // namespace chaintrue::cli
