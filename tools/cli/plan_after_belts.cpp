// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_after_belts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>

#include "grid/containers.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/follow_up.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::BeltPlacePicture;
using diagnosis::MeasurementKind;

/// Whether the diagnosis used these places: in the same order, with lengths that anchors and
/// causes explain.
bool is_of(const Diagnosis& found, const MeasuredBelts& belts) {
  // Larger than the effect of any cause, including an omitted arm.
  constexpr double kSamePlaceMm = 400.0;
  if (!found.belts) return false;
  return std::equal(found.belts->places.begin(),
                    found.belts->places.end(),
                    belts.points.begin(),
                    belts.points.end(),
                    [&](const BeltPlacePicture& place, const grid::BeltPoint& point) {
                      if (place.order != point.order) return false;
                      const auto lengths = model::lengths_at(found.belts->machine, place.at);
                      return lengths && grid::all_of(model::kBelts, [&](model::Belt belt) {
                               return place.bad[belt] ||
                                      std::abs((*lengths)[belt] - point.lengths_mm[belt]) <
                                          kSamePlaceMm;
                             });
                    });
}

std::string points_of(const Diagnosis& found, const MeasuredBelts& belts) {
  std::optional<int> visit;
  for (const auto& point : belts.points) {
    if (point.order) visit = std::max(visit.value_or(0), *point.order + 1);
  }
  std::string lines;
  for (const NextMeasurement& next : found.next_measurements) {
    if (!next.mark) continue;
    std::string own = fmt::format(
        "  {{\"tl_mm\": null, \"tr_mm\": null, \"bl_mm\": null, \"br_mm\": null, "
        "\"commanded_x_mm\": {:g}, \"commanded_y_mm\": {:g}",
        next.mark->x_mm + 0.0,
        next.mark->y_mm + 0.0);
    if (visit) fmt::format_to(std::back_inserter(own), ", \"order\": {}", (*visit)++);
    if (!next.pulled.empty()) {
      std::vector<std::string> names;
      for (const model::Belt belt : next.pulled) names.push_back(fmt::format("\"{}\"", name(belt)));
      fmt::format_to(std::back_inserter(own), ", \"pulled\": [{}]", fmt::join(names, ", "));
    }
    lines += own + "},\n";
  }
  return lines.empty() ? lines : "add to \"points\", replacing each null\n" + lines;
}

/// An anchor's name, a point's number or "(x, y)" as in the belts' file.
std::string end_of(const std::string& end) {
  if (model::belt_of(end)) return fmt::format("\"{}\"", end);
  const std::size_t comma = end.find(", ");
  if (end.empty() || end.front() != '(' || comma == std::string::npos) return end;
  return fmt::format("{{\"x_mm\": {}, \"y_mm\": {}}}",
                     end.substr(1, comma - 1),
                     end.substr(comma + 2, end.size() - comma - 3));
}

std::string distances_of(const Diagnosis& found) {
  std::string lines;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::distance || next.to.empty()) continue;
    fmt::format_to(std::back_inserter(lines),
                   "  {{\"from\": {}, \"to\": {}, \"distance_mm\": null, \"sigma_mm\": {:g}}},\n",
                   end_of(next.from),
                   end_of(next.to.front()),
                   next.sigma);
  }
  return lines.empty() ? lines : "add to \"distances\", replacing each null\n" + lines;
}

std::string drawing_of(const Diagnosis& found) {
  const BeltMachine& machine = found.belts->machine;
  const model::FramePoint centre = model::centre_of(machine);
  FollowUpDrawing drawing;
  for (const BeltPlacePicture& place : found.belts->places)
    drawing.measured.push_back({place.at.x_mm - centre.x_mm, place.at.y_mm - centre.y_mm});
  for (const FollowUpPlace& place : follow_up_places(found))
    drawing.next.push_back({place.numbers, place.mark});
  const auto& a = machine.anchors;
  return draw_follow_up(drawing,
                        {std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm),
                         std::max(a.tl.y_mm, a.tr.y_mm)});
}

}  // namespace

std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const MeasuredBelts& belts) {
  if (!is_of(found, belts)) return std::nullopt;
  return FollowUpTexts{
      follow_up_list(found), "", points_of(found, belts) + distances_of(found), drawing_of(found)};
}

int plan_after_belts(const PlanAfterOptions& options, const InputFile& file) {
  const files::ReadBelts read = load_belts(file, "a diagnosis");
  const InputFile after = open_input(options.after);
  const Diagnosis found = load_diagnosis(after);
  if (!is_of(found, read.belts)) {
    fmt::print(stderr,
               "{} was made from other readings than those in {}: diagnose these first.\n",
               options.after,
               file.name);
    return kBadInput;
  }
  report_difference(after);
  std::vector<files::OutputFile> outputs;
  if (!options.drawing.empty()) outputs.push_back({options.drawing, drawing_of(found)});
  outputs.push_back({options.output, points_of(found, read.belts) + distances_of(found)});
  write_outputs(outputs);
  fmt::print(stderr, "{}", follow_up_list(found));
  if (found.belts->second_pass) fmt::print(stderr, "{}\n", in_words(*found.belts->second_pass));
  say_next({"diagnose", options.file, "-o", options.after});
  return kDone;
}

}  // namespace chaintrue::cli
