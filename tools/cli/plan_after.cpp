// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_after.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "grid/containers.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/follow_up.hpp"
#include "tools/cli/follow_up_holes.hpp"
#include "tools/cli/grid_input.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/plan_after_belts.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

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
  require_kind(file,
               {FileKind::grid, FileKind::holes},
               file.kind == FileKind::belt_holes ? kBeltHolesAreFitted : "");
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

/// Whether the diagnosis used the points of these grids. A CSV may round them.
bool is_of(const Diagnosis& found, const std::vector<MeasuredGrid>& grids) {
  constexpr double kSamePlaceMm = 1e-3;
  std::vector<MarkPoint> marks;
  for (const MeasuredGrid& measured : grids) {
    for (const grid::MeasuredPoint& point : measured.points) marks.push_back(point.mark);
  }
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
    text = source.json ? distances_json(found, sources.sets, source.position)
                       : distances_csv(found, sources.sets, source.position);
  } else if (source.position == 0) {  // new points are on the first sheet
    const MeasuredGrid& measured = sources.grids.front();
    text = source.json ? points_json(found, measured) : points_csv(found, measured);
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
  FollowUpDrawing drawing;
  for (const MeasuredGrid& measured : sources.grids) {
    for (const auto& point : measured.points) drawing.measured.push_back(point.mark);
  }
  for (const MeasuredHoles& set : sources.sets) {
    for (const grid::Hole& hole : set.holes)
      drawing.measured.push_back(model::identity_placement(hole.commanded));
  }
  for (const FollowUpPlace& place : follow_up_places(found))
    drawing.next.push_back({place.numbers, place.mark});
  return draw_follow_up(drawing, found.extended_machine.bed);
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
  require_kind(file,
               {FileKind::grid, FileKind::holes, FileKind::belts},
               file.kind == FileKind::belt_holes ? kBeltHolesAreFitted : "");
  return facts::follow_up | (file.kind == FileKind::grid    ? facts::grid
                             : file.kind == FileKind::holes ? facts::holes
                                                            : facts::belts);
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
  std::vector<files::OutputFile> outputs;
  if (!options.drawing.empty()) outputs.push_back({options.drawing, drawing_of(found, sources)});
  outputs.push_back({options.output, lines_of(found, sources)});
  write_outputs(outputs);
  fmt::print(stderr, "{}", follow_up_list(found));
  const bool none_holds_readings =
      grid::none_of(sources.all, [](const Source& source) { return source.json; });
  if (none_holds_readings && proposes(found, MeasurementKind::reading)) {
    fmt::print(stderr,
               "A CSV file cannot store readings: use a {} (JSON), which has a list for them.\n",
               sources.grids.empty() ? "holes a chaintrue_holes" : "grid a chaintrue_grid");
  }
  // The next step once these are measured and written into their files.
  std::vector<std::string> words = {"diagnose", sources.all.front().name};
  for (std::size_t k = 1; k < sources.all.size(); ++k) {
    words.insert(words.end(), {"--with", sources.all[k].name});
  }
  words.insert(words.end(), {"-o", options.after});
  say_next(words);
  return kDone;
}

}  // namespace chaintrue::cli
