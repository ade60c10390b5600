// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/svg.hpp"

#include <cmath>
#include <optional>
#include <string_view>

#include "grid/diagnosis/workshop_units.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/synthetic/atlas.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "model/reading_model.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {
namespace {

// The atlas of causes (grid/synthetic/atlas.hpp) as a self-contained page: small pictures side by
// side, each with a slider for the size of its cause. Without scripts it shows the usual sizes.

using report::escaped;
using synthetic::Atlas;
using synthetic::AtlasFrame;
using synthetic::AtlasLine;
using synthetic::AtlasPicture;

// A picture, in its own units.
constexpr double kPictureWidth = 300.0;
// Margin around the lines: the usual size moves a line by at most half of it.
constexpr double kPad = 0.12 * kPictureWidth;
// A smaller error is below a pen's line width.
constexpr double kNothingMm = 0.005;

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --ink: #1b2330; --soft: #5b6675; --paper: #fff; --ground: #f4f6f8; --line: #d9dee5; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e8ecf1; --soft: #a3adba; --paper: #1d242d; --ground: #12171d; --line: #38424f; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1200px; padding: 20px; background: var(--ground); color: var(--ink);
  font: 16px/1.45 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 6px; }
h2 { font-size: 1.2rem; margin: 26px 0 10px; }
p { margin: 4px 0; max-width: 70ch; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(250px, 100%), 1fr)); gap: 14px; }
figure { margin: 0; padding: 10px; background: var(--paper); border: 1px solid var(--line); border-radius: 6px;
  display: flex; flex-direction: column; break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; }
figcaption { font-size: .92rem; flex: 1; }
figcaption code, output { font-size: .82rem; color: var(--soft); overflow-wrap: anywhere; display: block; }
input { width: 100%; margin: 4px 0 0; }
)";

constexpr std::string_view kScript = R"(
for (const figure of document.querySelectorAll('figure')) {
  const slider = figure.querySelector('input');
  const frames = figure.querySelectorAll('g');
  const output = figure.querySelector('output');
  if (!slider) continue;
  const show = () => {
    frames.forEach((frame, i) => { frame.style.display = i === Number(slider.value) ? '' : 'none'; });
    output.textContent = frames[slider.value].getAttribute('data-size');
    slider.setAttribute('aria-valuetext', output.textContent);
  };
  slider.addEventListener('input', show);
  show();
}
)";

BedView view_of(const std::vector<AtlasLine>& lines) {
  const ToolPosition first = lines.front().points.front();
  Rectangle box{first.x_mm, first.x_mm, first.y_mm, first.y_mm};
  for (const AtlasLine& line : lines) {
    for (const ToolPosition& point : line.points) grid::take_in(box, {point.x_mm, point.y_mm});
  }
  return {box, {kPad, kPad}, kPictureWidth - 2.0 * kPad};
}

/// Errors `times` as large; a line is broken where the machine cannot hold the tool.
std::string path_of(const BedView& view, const AtlasLine& line,
                    const std::vector<std::optional<ToolPosition>>& drawn, double times) {
  std::string path;
  bool pen_is_down = false;
  for (const auto i : each_index(line.points)) {
    if (!drawn[i]) {
      pen_is_down = false;
      continue;
    }
    const ToolPosition& at = line.points[i];
    path += fmt::format("{}{:.1f} {:.1f}", pen_is_down ? "L" : "M",
                        view.x(at.x_mm + times * (drawn[i]->x_mm - at.x_mm)),
                        view.y(at.y_mm + times * (drawn[i]->y_mm - at.y_mm)));
    pen_is_down = true;
  }
  return path;
}

/// The lines of the lattice as one path, those of the square as another.
std::string paths(const BedView& view, const std::vector<AtlasLine>& lines, const AtlasFrame& frame,
                  double times, std::string_view colour) {
  std::string svg;
  for (const bool of_square : {false, true}) {
    std::string path;
    for (const auto k : each_index(lines)) {
      if (lines[k].is_of_square == of_square)
        path += path_of(view, lines[k], frame.lines[k], times);
    }
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", path,
                       colour, of_square ? 2.2 : 1.1);
  }
  return svg;
}

std::string words_of_size(const AtlasPicture& picture, double size) {
  if (picture.effect != nullptr) {
    return diagnosis::in_workshop_units({picture.effect, picture.side},
                                        {std::string(picture.parameter), size});
  }
  const std::string unit = diagnosis::parameter_words(picture.parameter).unit;
  return fmt::format("{} {}{}{} than set", short_number(std::abs(size)), unit,
                     unit.empty() ? "" : " ", size > 0.0 ? "more" : "less");
}

std::string caption_of(const AtlasPicture& picture, double times) {
  std::string title;
  std::string id;
  if (picture.effect == nullptr) {
    title =
        report::capitalised(diagnosis::parameter_words(picture.parameter).name) + " is set wrong";
    id = picture.parameter;
  } else {
    const std::string side(name(picture.side));
    title = report::capitalised(std::string(picture.effect->cause));
    if (!side.empty()) title += fmt::format(" ({})", side);
    id = fmt::format("{}{}{}", picture.effect->id, side.empty() ? "" : ":", side);
  }
  const std::string drawn =
      picture.largest_shift_mm < kNothingMm
          ? "No line moves."
          : fmt::format("Up to {} mm, errors drawn {} times as large.",
                        short_number(picture.largest_shift_mm), short_number(times));
  return fmt::format("<figcaption><b>{}</b><br>{}<code>{}</code></figcaption>\n", escaped(title),
                     drawn, escaped(id));
}

/// Index of the frame without error among the sizes.
std::size_t place_of_nothing(const AtlasPicture& picture) {
  std::size_t place = 0;
  while (place < picture.frames.size() && picture.frames[place].size < picture.null) ++place;
  return place;
}

AtlasFrame as_commanded(const std::vector<AtlasLine>& lines) {
  AtlasFrame frame;
  for (const AtlasLine& line : lines)
    frame.lines.emplace_back(line.points.begin(), line.points.end());
  return frame;
}

std::string figure_of(const BedView& view, const Atlas& atlas, const AtlasPicture& picture) {
  const double wanted = 0.5 * kPad / view.scale();
  const double times = picture.largest_shift_mm < kNothingMm
                           ? 1.0
                           : report::round_down_125(wanted / picture.largest_shift_mm);
  const AtlasFrame straight = as_commanded(atlas.lines);
  const std::string usual = escaped(words_of_size(picture, picture.frames[picture.usual].size));
  std::string svg =
      fmt::format("<figure>\n<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">\n",
                  kPictureWidth, view.high() + 2.0 * kPad, usual);
  svg += paths(view, atlas.lines, straight, 1.0, report::kNeutralColor);
  const std::size_t nothing = place_of_nothing(picture);
  const std::size_t shown = picture.usual + (picture.usual >= nothing ? 1 : 0);
  const auto add = [&](std::size_t at, const std::string& size, const std::string& lines) {
    svg += fmt::format("<g data-size=\"{}\"{}>\n{}</g>\n", escaped(size),
                       at == shown ? "" : " style=\"display:none\"", lines);
  };
  for (std::size_t at = 0; at <= picture.frames.size(); ++at) {
    if (at == nothing) {
      add(at, "nothing wrong", "");
      continue;
    }
    const AtlasFrame& frame = picture.frames[at - (at > nothing ? 1 : 0)];
    add(at, words_of_size(picture, frame.size),
        paths(view, atlas.lines, frame, times, report::kBeforeColor));
  }
  svg += "</svg>\n" + caption_of(picture, times);
  svg += fmt::format(
      "<input type=\"range\" min=\"0\" max=\"{}\" step=\"1\" value=\"{}\" aria-label=\"size of the "
      "cause\">\n<output>{}</output>\n</figure>\n",
      picture.frames.size(), shown, usual);
  return svg;
}

std::string section_of(const BedView& view, const Atlas& atlas, bool of_settings) {
  std::string figures;
  for (const AtlasPicture& picture : atlas.pictures) {
    if ((picture.effect == nullptr) == of_settings) figures += figure_of(view, atlas, picture);
  }
  if (figures.empty()) return "";
  return fmt::format("<h2>{}</h2>\n<div class=\"pictures\">\n{}</div>\n",
                     of_settings ? "Wrong settings" : "Causes in the machine", figures);
}

/// \param machine its name. Same atlas, same bytes.
std::string atlas_page(const Atlas& atlas, const std::string& machine) {
  const BedView view = view_of(atlas.lines);
  return fmt::format(
             R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>What each cause draws: {0}</title>
<style>{1}</style></head><body>
<h1>What each cause draws</h1>
<p>{0}. Grey: the lines as they were sent. Orange: the lines as the machine draws them with one thing wrong. Find the picture that looks like your sheet; the slider makes the cause larger, smaller, or turns it round.</p>
{2})",
             escaped(machine), kStyle,
             atlas.calibrates_first
                 ? "<p>With a cause in the machine the frame is calibrated first: the drawing "
                   "shows the remaining error with the anchors found.</p>\n"
                 : "") +
         section_of(view, atlas, true) + section_of(view, atlas, false) +
         fmt::format("<script>{}</script>\n</body></html>\n", kScript);
}

struct NamedAtlas {
  synthetic::Atlas atlas;
  std::string machine;
};

NamedAtlas of_plotter(const PlotterMachine& machine, const std::string& cause) {
  return {synthetic::atlas_of(*make_plotter_mechanism(machine), cause), machine.name};
}

void refuse_declared(const InputFile& file, const Words& declared) {
  if (declared.empty()) return;
  refuse("command line", "--effects", declared.front(),
         fmt::format(
             "to be left out, because declared effects act on two chains, which {} does not have",
             file.name),
         ProblemKind::contradiction);
}

NamedAtlas atlas_of_file(const InputFile& file, const std::string& cause, const Words& declared) {
  if (is_of_a_plotter(file)) {
    refuse_declared(file, declared);
    const files::ReadPlotter read = load_plotter(file);
    print_warnings(read.warnings);
    return of_plotter(read.plotter.set.machine, cause);
  }
  require_kind(file, {FileKind::machine, FileKind::belts, FileKind::anchors, FileKind::plotter,
                      FileKind::drawing});
  if (file.kind == FileKind::machine) {
    Machine machine = load_machine(file);
    files::declare_effects(declared, machine);
    return {synthetic::atlas_of(*make_chain_mechanism(machine), cause), machine.name};
  }
  refuse_declared(file, declared);
  if (file.kind == FileKind::drawing)
    return of_plotter(files::parse_drawing(file.text, file.name).machine, cause);
  const BeltMachine machine = load_belt_machine(file);
  return {synthetic::atlas_of(machine, cause), machine.name};
}

}  // namespace

int write_atlas(const std::string& machine, const std::string& cause, const Words& declared,
                const std::string& output) {
  const NamedAtlas named = atlas_of_file(open_input(machine), cause, declared);
  if (named.atlas.pictures.empty() && named.atlas.not_drawn.empty()) {
    refuse("command line", "effect", cause,
           fmt::format("a cause or a setting of {}: without a name all are drawn", machine),
           ProblemKind::unknown_word);
  }
  end_progress();
  write_output(output, atlas_page(named.atlas, named.machine));
  say("{}: {} of possible causes; find the one that looks like your sheet", output,
      named.atlas.pictures.size() == 1 ? "a picture"
                                       : fmt::format("{} pictures", named.atlas.pictures.size()));
  for (const std::string& missing : named.atlas.not_drawn)
    say("No picture of {}: this machine cannot work with it at its usual size.", missing);
  return kDone;
}

}  // namespace chaintrue::cli
