// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/plane_vectors.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// chaintrue plan BELTS --after: what a four-belt router should measure next.

/// Whether the diagnosis used these places: in the same order, with lengths that anchors and
/// causes explain.
bool is_of(const Diagnosis& found, const MeasuredBelts& belts) {
  // Larger than the effect of any cause, including an omitted arm.
  constexpr double kSamePlaceMm = 400.0;
  if (!found.belts) return false;
  return std::equal(
      found.belts->places.begin(), found.belts->places.end(), belts.points.begin(),
      belts.points.end(), [&](const BeltPlacePicture& place, const grid::BeltPoint& point) {
        if (place.order != point.order) return false;
        const auto lengths = lengths_at(found.belts->machine, place.at);
        return lengths && all_of(kBelts, [&](Belt belt) {
                 return place.bad[belt] ||
                        std::abs((*lengths)[belt] - point.lengths_mm[belt]) < kSamePlaceMm;
               });
      });
}

std::string points_of(const Diagnosis& found, const MeasuredBelts& belts) {
  std::optional<int> visit = next_visit(belts.points);
  std::string lines;
  for (const NextMeasurement& next : found.next_measurements) {
    if (!next.mark) continue;
    std::string own = fmt::format(
        "  {{\"tl_mm\": null, \"tr_mm\": null, \"bl_mm\": null, \"br_mm\": null, "
        "\"commanded_x_mm\": {:g}, \"commanded_y_mm\": {:g}",
        next.mark->x_mm + 0.0, next.mark->y_mm + 0.0);
    if (visit) own += fmt::format(", \"order\": {}", (*visit)++);
    if (!next.pulled.empty()) {
      Words names;
      for (const Belt belt : next.pulled) names.push_back(fmt::format("\"{}\"", name(belt)));
      own += fmt::format(", \"pulled\": [{}]", fmt::join(names, ", "));
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
  return fmt::format("{{\"x_mm\": {}, \"y_mm\": {}}}", end.substr(1, comma - 1),
                     end.substr(comma + 2, end.size() - comma - 3));
}

std::string distances_of(const Diagnosis& found) {
  std::string lines;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::distance || next.to.empty()) continue;
    lines +=
        fmt::format("  {{\"from\": {}, \"to\": {}, \"distance_mm\": null, \"sigma_mm\": {:g}}},\n",
                    end_of(next.from), end_of(next.to.front()), next.sigma);
  }
  return lines.empty() ? lines : "add to \"distances\", replacing each null\n" + lines;
}

std::string drawing_of(const Diagnosis& found) {
  const BeltMachine& machine = found.belts->machine;
  const FramePoint centre = centre_of(machine);
  std::vector<MarkPoint> measured;
  for (const BeltPlacePicture& place : found.belts->places)
    measured.push_back({place.at.x_mm - centre.x_mm, place.at.y_mm - centre.y_mm});
  const auto& a = machine.anchors;
  return draw_follow_up(measured, follow_up_places(found),
                        {std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm),
                         std::max(a.tl.y_mm, a.tr.y_mm)});
}

/// `text` is that of the belts' file. \throws InputError. Returns an exit code.
int plan_after_belts(const PlanAfterOptions& options, const InputFile& file) {
  const ReadBelts read = load_belts(file, "a diagnosis");
  const InputFile after = open_input(options.after);
  const Diagnosis found = load_diagnosis(after);
  if (!is_of(found, read.belts)) {
    say("{} was made from other readings than those in {}: diagnose these first.", options.after,
        file.name);
    return kBadInput;
  }
  report_difference(after);
  write_outputs({{options.drawing, drawing_of(found)},
                 {options.output, points_of(found, read.belts) + distances_of(found)}});
  say_lines(follow_up_list(found));
  if (found.belts->second_pass) say("{}", in_words(*found.belts->second_pass));
  say_next({"diagnose", options.file, "-o", options.after});
  return kDone;
}

/// The files of a diagnosis, and for each whether lines for it are JSON.
struct Sources {
  Measured measured;
  std::vector<bool> are_json;
};

/// `few`: with other files one or two readings are enough.
void read(const InputFile& file, const std::optional<Machine>& machine, bool few,
          Sources& sources) {
  require_kind(file, {FileKind::grid, FileKind::holes});
  const files::MeasuredOptions options{.machine = machine, .few = few};
  MeasuredFile read{file.name, {}};
  if (file.kind == FileKind::holes)
    read.measured = files::parse_holes(file.text, file.name, options).holes;
  else
    read.measured = files::parse_grid(file.text, file.name, options).grid;
  sources.measured.add(std::move(read));
  sources.are_json.push_back(is_json(file.text));
}

Sources read_sources(const PlanAfterOptions& options, const InputFile& file) {
  std::optional<Machine> machine;
  if (!options.machine.empty()) machine = read_machine_input(options.machine);
  Sources sources;
  read(file, machine, false, sources);
  for (const std::string& path : options.with) read(open_input(path), machine, true, sources);
  return sources;
}

std::vector<MarkPoint> marks_of(const Measured& measured) {
  std::vector<MarkPoint> marks;
  for (const MeasuredGrid* own : measured.grids()) {
    append_all(marks, mapped(own->points, &grid::MeasuredPoint::mark));
  }
  return marks;
}

/// Whether the diagnosis used the points of these grids. A CSV may round them.
bool has_points_of(const Diagnosis& found, const Measured& measured) {
  constexpr double kSamePlaceMm = 1e-3;
  const std::vector<MarkPoint> marks = marks_of(measured);
  return std::equal(found.points.begin(), found.points.end(), marks.begin(), marks.end(),
                    [&](const auto& pictured, const MarkPoint& mark) {
                      return grid::distance_mm(pictured.mark, mark) < kSamePlaceMm;
                    });
}

/// Empty if the diagnosis used exactly these files.
std::string made_from_others(const PlanAfterOptions& options, const Diagnosis& found,
                             const Measured& measured) {
  const bool points = has_points_of(found, measured);
  const bool distances = is_diagnosis_of(found, measured.holes());
  if (points && distances) return {};
  const bool has_grids = !measured.grids().empty();
  if (points ? measured.holes().empty() : distances && !has_grids) {
    return fmt::format(
        "{} was made from points and distances together: give its other files with --with.\n",
        options.after);
  }
  return fmt::format("{} was made from other {} than those in {}: diagnose these first.\n",
                     options.after, points || !has_grids ? "holes" : "points",
                     fmt::join(mapped(measured.files(), &MeasuredFile::name), " and "));
}

/// The lines for each file; readings of the machine go into the first that has any.
std::string lines_of(const Diagnosis& found, const Measured& measured,
                     const std::vector<bool>& are_json) {
  const std::vector<MeasuredFile>& files = measured.files();
  std::string text;
  std::size_t grids = 0, sets = 0;
  bool takes_readings = true;
  for (const auto k : each_index(files)) {
    std::string lines;
    if (files[k].holes() != nullptr) {
      lines = distance_lines(found, measured.holes(), sets++, are_json[k]);
    } else if (grids++ == 0) {  // new points are on the first sheet
      lines = point_lines(found, *files[k].grid(), are_json[k]);
    }
    if (are_json[k] && std::exchange(takes_readings, false)) lines += readings_json(found);
    if (files.size() > 1 && !lines.empty()) text += "# " + files[k].name + "\n";
    text += lines;
  }
  return text;
}

std::string drawing_of(const Diagnosis& found, const Measured& measured) {
  std::vector<MarkPoint> marks = marks_of(measured);
  for (const MeasuredHoles* set : measured.holes()) {
    for (const Hole& hole : set->holes) marks.push_back(identity_placement(hole.commanded));
  }
  return draw_follow_up(marks, follow_up_places(found), found.extended_machine.bed);
}

}  // namespace

std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const Measured& measured) {
  if (!has_points_of(found, measured) || !is_diagnosis_of(found, measured.holes()))
    return std::nullopt;
  const auto lines = [&](bool is_json) {
    return lines_of(found, measured, std::vector<bool>(measured.files().size(), is_json));
  };
  return FollowUpTexts{follow_up_list(found), lines(false), lines(true),
                       drawing_of(found, measured)};
}

Facts facts_after(const InputFile& file) {
  require_kind(file, {FileKind::grid, FileKind::holes, FileKind::belts});
  return facts::follow_up | file.fact();
}

int plan_after(const PlanAfterOptions& options, const InputFile& file) {
  if (file.kind == FileKind::belts) return plan_after_belts(options, file);
  const Sources sources = read_sources(options, file);
  const InputFile after = open_input(options.after);
  const Diagnosis found = load_diagnosis(after);
  const std::string others = made_from_others(options, found, sources.measured);
  if (!others.empty()) {
    say_lines(others);
    return kBadInput;
  }
  report_difference(after);
  write_outputs({{options.drawing, drawing_of(found, sources.measured)},
                 {options.output, lines_of(found, sources.measured, sources.are_json)}});
  say_lines(follow_up_list(found));
  const std::vector<MeasuredFile>& files = sources.measured.files();
  if (!contains(sources.are_json, true) && proposes(found, MeasurementKind::reading)) {
    say("A CSV file cannot store readings: use a {} (JSON), which has a list "
        "for them.",
        sources.measured.grids().empty() ? "holes a chaintrue_holes" : "grid a chaintrue_grid");
  }
  // The next step once these are measured and written into their files.
  Words words = {"diagnose", files.front().name};
  for (std::size_t k = 1; k < files.size(); ++k) add_option_words(words, "--with", files[k].name);
  add_option_words(words, "-o", options.after);
  say_next(words);
  return kDone;
}

std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const MeasuredBelts& belts) {
  if (!is_of(found, belts)) return std::nullopt;
  return FollowUpTexts{follow_up_list(found), "", points_of(found, belts) + distances_of(found),
                       drawing_of(found)};
}

}  // namespace chaintrue::cli
