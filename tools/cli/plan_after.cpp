// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_after.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "grid/containers.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "tools/cli/follow_up.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// chaintrue plan BELTS --after: what a four-belt router should measure next.

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
    if (visit) own += fmt::format(", \"order\": {}", (*visit)++);
    if (!next.pulled.empty()) {
      std::vector<std::string> names;
      for (const model::Belt belt : next.pulled) names.push_back(fmt::format("\"{}\"", name(belt)));
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
  return fmt::format("{{\"x_mm\": {}, \"y_mm\": {}}}",
                     end.substr(1, comma - 1),
                     end.substr(comma + 2, end.size() - comma - 3));
}

std::string distances_of(const Diagnosis& found) {
  std::string lines;
  for (const NextMeasurement& next : found.next_measurements) {
    if (next.kind != MeasurementKind::distance || next.to.empty()) continue;
    lines +=
        fmt::format("  {{\"from\": {}, \"to\": {}, \"distance_mm\": null, \"sigma_mm\": {:g}}},\n",
                    end_of(next.from),
                    end_of(next.to.front()),
                    next.sigma);
  }
  return lines.empty() ? lines : "add to \"distances\", replacing each null\n" + lines;
}

std::string drawing_of(const Diagnosis& found) {
  const BeltMachine& machine = found.belts->machine;
  const model::FramePoint centre = model::centre_of(machine);
  std::vector<MarkPoint> measured;
  for (const BeltPlacePicture& place : found.belts->places)
    measured.push_back({place.at.x_mm - centre.x_mm, place.at.y_mm - centre.y_mm});
  const auto& a = machine.anchors;
  return draw_follow_up(measured,
                        follow_up_places(found),
                        {std::max(a.tr.x_mm, a.br.x_mm) - std::min(a.tl.x_mm, a.bl.x_mm),
                         std::max(a.tl.y_mm, a.tr.y_mm)});
}

/// `text` is that of the belts' file. \throws InputError. Returns an exit code.
int plan_after_belts(const PlanAfterOptions& options, const InputFile& file) {
  const files::ReadBelts read = load_belts(file, "a diagnosis");
  const InputFile after = open_input(options.after);
  const Diagnosis found = load_diagnosis(after);
  if (!is_of(found, read.belts)) {
    say("{} was made from other readings than those in {}: diagnose these first.",
        options.after,
        file.name);
    return kBadInput;
  }
  report_difference(after);
  write_outputs({{options.drawing, drawing_of(found)},
                 {options.output, points_of(found, read.belts) + distances_of(found)}});
  fmt::print(stderr, "{}", follow_up_list(found));
  if (found.belts->second_pass) say("{}", in_words(*found.belts->second_pass));
  say_next({"diagnose", options.file, "-o", options.after});
  return kDone;
}

using diagnosis::MeasurementKind;

/// An input file, and its index among the grids or the sets of holes.
struct Source {
  std::string name;
  bool json = false;
  bool of_holes = false;
  std::size_t position = 0;
};

struct Sources {
  std::vector<Source> all;
  std::vector<MeasuredGrid> grids;
  std::vector<MeasuredHoles> sets;
};

/// `few`: with other files one or two readings are enough.
void read(const InputFile& file,
          const std::optional<Machine>& machine,
          bool few,
          Sources& sources) {
  require_kind(file, {FileKind::grid, FileKind::holes});
  const bool of_holes = file.kind == FileKind::holes;
  sources.all.push_back({file.name,
                         files::is_json(file.text),
                         of_holes,
                         of_holes ? sources.sets.size() : sources.grids.size()});
  const files::MeasuredOptions options{.machine = machine, .few = few};
  if (of_holes) {
    sources.sets.push_back(files::parse_holes(file.text, file.name, options).holes);
  } else {
    sources.grids.push_back(files::parse_grid(file.text, file.name, options).grid);
  }
}

Sources read_sources(const PlanAfterOptions& options, const InputFile& file) {
  std::optional<Machine> machine;
  if (!options.machine.empty()) machine = read_machine_input(options.machine);
  Sources sources;
  read(file, machine, false, sources);
  for (const std::string& path : options.with) read(open_input(path), machine, true, sources);
  return sources;
}

std::vector<MarkPoint> marks_of(const std::vector<MeasuredGrid>& grids) {
  std::vector<MarkPoint> marks;
  for (const MeasuredGrid& measured : grids) {
    for (const grid::MeasuredPoint& point : measured.points) marks.push_back(point.mark);
  }
  return marks;
}

/// Whether the diagnosis used the points of these grids. A CSV may round them.
bool is_of(const Diagnosis& found, const std::vector<MeasuredGrid>& grids) {
  constexpr double kSamePlaceMm = 1e-3;
  const std::vector<MarkPoint> marks = marks_of(grids);
  return std::equal(found.points.begin(),
                    found.points.end(),
                    marks.begin(),
                    marks.end(),
                    [&](const auto& pictured, const MarkPoint& mark) {
                      return std::abs(pictured.mark.x_mm - mark.x_mm) < kSamePlaceMm &&
                             std::abs(pictured.mark.y_mm - mark.y_mm) < kSamePlaceMm;
                    });
}

/// Empty if the diagnosis used exactly these files.
std::string made_from_others(const PlanAfterOptions& options,
                             const Diagnosis& found,
                             const Sources& sources) {
  const auto sentence = [&](std::string_view what) {
    std::vector<std::string> names;
    for (const Source& source : sources.all) names.push_back(source.name);
    return fmt::format("{} was made from other {} than those in {}: diagnose these first.\n",
                       options.after,
                       what,
                       fmt::join(names, " and "));
  };
  const bool points = is_of(found, sources.grids);
  const bool distances = is_diagnosis_of(found, sources.sets);
  if (points && distances) return {};
  if ((points && sources.sets.empty()) || (distances && sources.grids.empty())) {
    return fmt::format(
        "{} was made from points and distances together: give its other files with --with.\n",
        options.after);
  }
  return sentence(points || sources.grids.empty() ? "holes" : "points");
}

/// The lines for one of the files; readings of the machine go into the first that has any.
std::string lines_for(const Source& source,
                      const Diagnosis& found,
                      const Sources& sources,
                      bool takes_readings) {
  std::string text;
  if (source.of_holes) {
    text = distance_lines(found, sources.sets, source.position, source.json);
  } else if (source.position == 0) {  // new points are on the first sheet
    text = point_lines(found, sources.grids.front(), source.json);
  }
  return takes_readings ? text + readings_json(found) : text;
}

std::string lines_of(const Diagnosis& found, const Sources& sources) {
  const auto holds_readings = [](const Source& source) { return source.json; };
  const auto first = std::find_if(sources.all.begin(), sources.all.end(), holds_readings);
  std::string text;
  for (auto source = sources.all.begin(); source != sources.all.end(); ++source) {
    const std::string lines = lines_for(*source, found, sources, source == first);
    if (sources.all.size() > 1 && !lines.empty()) text += "# " + source->name + "\n";
    text += lines;
  }
  return text;
}

std::string drawing_of(const Diagnosis& found, const Sources& sources) {
  std::vector<MarkPoint> measured = marks_of(sources.grids);
  for (const MeasuredHoles& set : sources.sets) {
    for (const grid::Hole& hole : set.holes)
      measured.push_back(model::identity_placement(hole.commanded));
  }
  return draw_follow_up(measured, follow_up_places(found), found.extended_machine.bed);
}

}  // namespace

std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found,
                                             const std::vector<MeasuredGrid>& grids,
                                             const std::vector<MeasuredHoles>& sets) {
  if (!is_of(found, grids) || !is_diagnosis_of(found, sets)) return std::nullopt;
  Sources sources{{}, grids, sets};
  for (std::size_t k = 0; k < grids.size(); ++k)
    sources.all.push_back({grids[k].name, false, false, k});
  for (std::size_t k = 0; k < sets.size(); ++k)
    sources.all.push_back({sets[k].name, false, true, k});
  FollowUpTexts texts{follow_up_list(found), lines_of(found, sources), "", ""};
  for (Source& source : sources.all) source.json = true;
  texts.json = lines_of(found, sources);
  texts.drawing = drawing_of(found, sources);
  return texts;
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
  const std::string others = made_from_others(options, found, sources);
  if (!others.empty()) {
    fmt::print(stderr, "{}", others);
    return kBadInput;
  }
  report_difference(after);
  write_outputs(
      {{options.drawing, drawing_of(found, sources)}, {options.output, lines_of(found, sources)}});
  fmt::print(stderr, "{}", follow_up_list(found));
  const bool none_holds_readings =
      grid::none_of(sources.all, [](const Source& source) { return source.json; });
  if (none_holds_readings && proposes(found, MeasurementKind::reading)) {
    say("A CSV file cannot store readings: use a {} (JSON), which has a list for them.",
        sources.grids.empty() ? "holes a chaintrue_holes" : "grid a chaintrue_grid");
  }
  // The next step once these are measured and written into their files.
  Words words = {"diagnose", sources.all.front().name};
  for (std::size_t k = 1; k < sources.all.size(); ++k) {
    add_option_words(words, "--with", sources.all[k].name);
  }
  add_option_words(words, "-o", options.after);
  say_next(words);
  return kDone;
}

std::optional<FollowUpTexts> follow_up_texts(const Diagnosis& found, const MeasuredBelts& belts) {
  if (!is_of(found, belts)) return std::nullopt;
  return FollowUpTexts{
      follow_up_list(found), "", points_of(found, belts) + distances_of(found), drawing_of(found)};
}

}  // namespace chaintrue::cli
