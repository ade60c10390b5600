// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue query: chain lengths for points, and the point for chain lengths.
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "grid/belts/belt_map.hpp"
#include "grid/files/points_file.hpp"
#include "grid/map/length_map.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/names.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// The answers of chaintrue query as a table and as JSON, for maps of either kind.

/// A map of either kind.
struct AskedMap {
  const grid::LengthMap& map;
  int digits = 6;  ///< of lengths
  /// The names of the first two lengths in messages.
  const char* first = "left";
  const char* second = "right";
  /// Replaces the map's reason why a point has no answer; empty: the map's.
  std::string no_answer = {};
};

/// One line of the answer; missing numbers are empty cells, or omitted.
struct AnswerLine {
  BedPoint point;
  tl::expected<grid::LengthsAnswer, grid::MapFailure> answer;
};

grid::MapStatus status_of(const AnswerLine& line) {
  return line.answer ? line.answer->status : grid::MapStatus::outside;
}

std::string as_csv(const AskedMap& asked, const std::vector<AnswerLine>& lines) {
  const auto names = asked.map.length_names();
  std::string text = "x_mm,y_mm,";
  for (const std::string_view name : names) text += fmt::format("{}_mm,", name);
  text += fmt::format("{}_sigma_mm,{}_sigma_mm,status\n", names[0], names[1]);
  for (const AnswerLine& line : lines) {
    text += fmt::format("{},{},", line.point.x_mm, line.point.y_mm);
    if (line.answer) {
      for (const double length : line.answer->lengths_mm)
        text += fmt::format("{:.{}f},", length, asked.digits);
      text +=
          fmt::format("{:.4f},{:.4f},", line.answer->sigma.left_mm, line.answer->sigma.right_mm);
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
    text += fmt::format(
        "{}  {{\"x_mm\": {}, \"y_mm\": {}, ", separator, line.point.x_mm, line.point.y_mm);
    if (line.answer) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        text += fmt::format("\"{}_mm\": {:.{}f}, ",
                            names[i],
                            line.answer->lengths_mm[static_cast<Eigen::Index>(i)],
                            asked.digits);
      }
      text += fmt::format("\"{}_sigma_mm\": {:.4f}, \"{}_sigma_mm\": {:.4f}, ",
                          names[0],
                          line.answer->sigma.left_mm,
                          names[1],
                          line.answer->sigma.right_mm);
      if (line.answer->tool_sigma_mm) {
        text += fmt::format("\"tool_sigma_mm\": {:.4f}, ", *line.answer->tool_sigma_mm);
      }
    }
    text += fmt::format("\"status\": \"{}\"}}", grid::name(status_of(line)));
    separator = ",\n";
  }
  return text + "\n]\n";
}

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
      points.push_back(model::identity_placement(point));
    return points;
  }
  for (std::size_t i = 0; i + 1 < command.coordinates.size(); i += 2) {
    points.push_back({command.coordinates[i], command.coordinates[i + 1]});
  }
  return points;
}

int answer_inverse(const AskedMap& asked, const QueryCommand& command) {
  const auto tool = asked.map.tool({command.inverse[0], command.inverse[1]});
  if (!tool) {
    const bool has_own_words = !asked.no_answer.empty() && !tool.error().cause.empty();
    say("{} {} mm, {} {} mm: {}",
        asked.first,
        command.inverse[0],
        asked.second,
        command.inverse[1],
        has_own_words ? std::string(tool.error().cause) : tool.error().sentence());
    return kNotSupportedOrOutside;
  }
  const auto status = grid::name(asked.map.status(*tool));
  write_output(
      command.output,
      command.json
          ? fmt::format("{{\"x_mm\": {:.6f}, \"y_mm\": {:.6f}, \"status\": \"{}\"}}\n",
                        tool->x_mm,
                        tool->y_mm,
                        status)
          : fmt::format("x_mm,y_mm,status\n{:.6f},{:.6f},{}\n", tool->x_mm, tool->y_mm, status));
  return kDone;
}

int answer_points(const AskedMap& asked, const QueryCommand& command) {
  std::vector<AnswerLine> lines;
  std::string outside;
  const std::vector<BedPoint> points = points_asked(command);
  for (const BedPoint& point : points) {
    progress_is(static_cast<double>(lines.size()), static_cast<double>(points.size()));
    lines.push_back({point, asked.map.query(point)});
    if (lines.back().answer) continue;
    outside += fmt::format(
        "({}, {}): {}\n",
        point.x_mm,
        point.y_mm,
        asked.no_answer.empty() ? lines.back().answer.error().sentence() : asked.no_answer);
  }
  if (!outside.empty()) {
    end_progress();
    fmt::print(stderr, "{}", outside);
  }
  write_output(command.output, command.json ? as_json(asked, lines) : as_csv(asked, lines));
  return outside.empty() ? kDone : kNotSupportedOrOutside;
}

int answer_alone(const AskedMap& asked, const QueryCommand& command) {
  return command.inverse.empty() ? answer_points(asked, command) : answer_inverse(asked, command);
}

int answer(const AskedMap& asked, const QueryCommand& command) {
  const int code = answer_alone(asked, command);
  if (code == kDone) {
    say_next({"report", command.map, "-o", page_alongside(command.map)});
  }
  return code;
}

int query_map(const QueryCommand& command, const CompensationMap& stored) {
  if (command.outside.way == "fade" && stored.machine() == nullptr) {
    say("{}: fade needs a map with a machine; choose another --outside", command.map);
    return kNotSupportedOrOutside;
  }
  const CompensationMap map =
      stored.with_outside(rule_of(command.outside, stored.contents().outside));
  if (command.frame == "bed" && map.machine() == nullptr) {
    say("{}: a map without a machine has only the frame of its marks", command.map);
    return kNotSupportedOrOutside;
  }
  const grid::MapInFrame in_frame(
      map, command.frame == "bed" ? grid::MapFrame::bed : grid::MapFrame::marks);
  return answer({in_frame}, command);
}

/// Belts have only one frame.
int query_anchors(const QueryCommand& command, const InputFile& file) {
  const files::FittedAnchors anchors = load_anchors(file);
  if (!anchors.holes && !anchors.fit.coordinates.front().stated_mm) {
    refuse(file.name,
           "/fit/coordinates",
           "no stated_mm",
           "anchors fitted to a file with the anchors in force, which define the origin of "
           "commands (import maslow4 --settings maslow.yaml)");
  }
  const grid::BeltMap map(anchors.fit, anchors.holes ? &*anchors.holes : nullptr);
  return answer({map,
                 4,
                 "top left",
                 "top right",
                 "outside the frame of these anchors, or closer to one than the length of its arm"},
                command);
}

int run_query(Verb verb, const QueryCommand& command) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map, FileKind::anchors, FileKind::plotter});
  verb.refuse_idle_options((file.kind == FileKind::map       ? facts::map
                            : file.kind == FileKind::anchors ? facts::anchors
                                                             : facts::plotter) |
                           (command.outside.way == "fade" ? facts::fade : 0U));
  if (file.kind == FileKind::anchors) return query_anchors(command, file);
  if (file.kind == FileKind::plotter)
    return answer_alone({*load_plotter_map(file, load_plotter(file).plotter)}, command);
  return query_map(command, load_map(file));
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
  auto command = std::make_shared<QueryCommand>();
  Verb verb = app.add_verb(
      "query", "Compute chain lengths for points of the bed, or the point for chain lengths");
  add_input(verb,
            "map",
            command->map,
            "A chaintrue_map or chaintrue_anchors file, or a chaintrue_plotter that fit wrote from "
            "a drawing; - is standard input")
      .required();
  add_numbers(verb, "coordinates", command->coordinates, {"mm", -1e6, 1e6}, "Pairs X Y [mm]");
  add_input(
      verb, "--points", command->points, "CSV with the columns x_mm and y_mm; - is standard input");
  add_numbers(verb,
              "--inverse",
              command->inverse,
              {"mm", -1e6, 1e6},
              "Find the tool's position from the chain lengths L R [mm]")
      .takes(2);
  verb.add_option("--frame",
                  command->frame,
                  "marks: coordinates as on the measured sheet; bed: as in the machine file, "
                  "without the sheet's placement")
      .one_of({"marks", "bed"})
      .shows_default()
      .acts_on(facts::map | facts::anchors,
               "\"marks\", because a plotter has only its controller's frame",
               "marks")
      .acts_on(facts::map,
               "\"marks\", because belts have only one frame, from the crossing of its diagonals",
               "marks");
  add_output(verb, "-o,--output", command->output, {Origin::table}, "- is standard output")
      .shows_default();
  add_outside_options(verb, command->outside, "by default as stored in the map");
  verb.option("--outside")
      .acts_on(facts::map | facts::anchors, "to be left out, because a plotter has no surface")
      .acts_on(facts::map, "to be left out, because four belts have no surface");
  verb.add_flag("--json", command->json, "Print JSON instead of CSV");
  verb.footer(
      "status: inside the measured points, at their edge, extrapolated beyond them, or outside the "
      "bed (exit code 4).\nSigmas are one standard deviation of the map at that point.\nWith "
      "anchors, the answer is the lengths of the four belts as the firmware pays them out: "
      "slanted,\nfrom the anchor to the belt's end. The upper two determine the position, and "
      "--inverse takes\nthose two.\n\nExample:\n  build/chaintrue fit "
      "fixtures/grids/seven_by_four.json -o map.json\n  build/chaintrue query map.json 100 200 "
      "-1000 -450");
  verb.runs(command, run_query, check_usage);
}

}  // namespace chaintrue::cli
