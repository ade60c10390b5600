// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue fit: measured points become a compensation map, and the fit is reported in words.
#include "tools/cli/fit.hpp"

#include <fmt/format.h>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/names.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/threads/use_threads.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

/// A fit of these takes some ten seconds (docs/reliability.md).
constexpr std::size_t kMostPoints = 10000;
constexpr std::size_t kMostDistances = 5000;
constexpr std::size_t kMostHoles = 150;

constexpr const char* kNoMachine = "to be left out for a direct surface, which has no machine";

constexpr Range kWishMm{"mm", 0.001, 50.0};

/// \throws Failed
void refuse_too_many(const Measured& measured) {
  const auto refuse = [&](std::size_t found, const char* what, std::size_t most) {
    if (found <= most) return;
    throw Failed(
        measured.files().front().name, "too_many",
        fmt::format("{} {} are more than a fit accepts ({}): leave some out, evenly over the bed",
                    found, what, most));
  };
  const ReadingCounts counts = counts_of(measured);
  refuse(counts.points, "points", kMostPoints);
  refuse(counts.distances, "distances", kMostDistances);
  refuse(counts.holes, "holes", kMostHoles);
}

/// \throws Failed for a map that its reader rejects
void check_as_read(const std::string& text, const std::string& measured) {
  try {
    (void)files::parse_map(text, "the map");
  } catch (const InputError& error) {
    throw Failed(measured, name_of(grid::FitReason::impossible_readings),
                 "no machine is consistent with these points, so no map is written: " +
                     error.problems().front().message());
  }
}

int finish(Verb verb, const FitCommand& command, const CompensationMap& map,
           const std::vector<Section>& more) {
  const std::string text = files::write_map(map, made_by(verb));
  check_as_read(text, name_in_messages(command.input.grid));
  Document document = map_document(map, command.output, command.detail(), command.wish_mm);
  append_all(document.sections, more);
  write_fitted(command, text,
               command.json ? files::write_fit(map, fit_sentence(map), command.wish_mm) : "",
               document);
  if (const std::string why = not_to_cut_with(map); !why.empty()) {
    say("{}", why);
    say_next({"diagnose", command.input.grid});
    return kCheckFailed;
  }
  const Machine* machine = map.machine();
  const bool typed = machine != nullptr && machine->controller.settings.motor_spacing_mm;
  say_next(typed ? Words{"export", "groundcontrol", command.output} : report_words(command.output));
  return kDone;
}

/// The tables of distances, each under its file's name if there are several.
std::vector<Section> distances_of(const Measured& measured, const grid::JointFit& fit) {
  const std::vector<MeasuredFile>& files = measured.files();
  std::vector<Section> sections;
  for (const grid::FittedDistances& one : fit.distances) {
    const MeasuredFile& file = files[one.file];
    sections.push_back(
        distances_section(*file.holes(), one, files.size() > 1 ? file.name : std::string{}));
  }
  if (!sections.empty()) add_legend(fit.estimate.knowledge, sections.back());
  return sections;
}

/// On the machine with the causes found, or as stated.
tl::expected<grid::JointFit, grid::FitFailure> fit_of(const FitCommand& command,
                                                      const Measured& measured) {
  grid::keep_freed_memory();
  const grid::JointFitOptions options{.outside = rule_of(command.outside, {}),
                                      .progress = shown_progress()};
  if (command.plain) return joint_fit(measured, options);
  auto found =
      diagnosis::fit_with_causes(measured, {.fit = options, .accept_class = command.accept_class});
  if (!found) return tl::unexpected(found.error());
  return std::move(found->fit);
}

/// The file and those of --with in one estimate.
int fit_jointly(Verb verb, const FitCommand& command, const Measured& measured) {
  const grid::JointFit fit = value_of(
      fit_of(command, measured),
      measured.files().size() == 1 ? name_in_messages(command.input.grid) : "chaintrue fit");
  return finish(verb, command, fit.map, distances_of(measured, fit));
}

/// Splines through the lengths of one grid; the options' rules refuse anything else.
int fit_directly(Verb verb, const FitCommand& command, const MeasuredFile& file) {
  grid::FitOptions options;
  options.surface = grid::SurfaceKind::direct;
  const interp::EndCondition end = *files::named(files::kEndConditions, command.ends);
  options.ends = {{end, end}, {end, end}};
  options.outside = rule_of(command.outside, {});
  options.progress = shown_progress();
  const CompensationMap map =
      value_of(grid::fit(*file.grid(), options), name_in_messages(command.input.grid));
  return finish(verb, command, map, {});
}

Facts facts_of(const FitCommand& command, const InputFiles& files) {
  Facts facts = facts_of(files);
  Facts of_belts = facts::nothing;
  for (const InputFile& file : files) of_belts |= file.fact() & (facts::belts | facts::belt_holes);
  if (of_belts != 0) {
    if ((facts & facts::holes) != 0) of_belts |= facts::belt_holes;
    facts = (facts & ~facts::chains) | of_belts;
  }
  facts |= command.surface == "direct" ? facts::direct : facts::residual;
  if (!command.plain) facts |= facts::causes;
  if (command.outside.way == "fade") facts |= facts::fade;
  return facts;
}

int run_fit(Verb verb, const FitCommand& command) {
  const InputFiles opened = open_inputs(command.input.grid, command.with);
  if (opened.front().kind == FileKind::drawing) {
    verb.refuse_idle_options(facts::drawing);
    return fit_the_drawing(verb, command, opened.front());
  }
  for (const InputFile& file : opened)
    require_kind(file, {FileKind::grid, FileKind::holes, FileKind::belt_holes, FileKind::belts});
  const Facts facts = facts_of(command, opened);
  verb.refuse_idle_options(facts);
  if ((facts & (facts::belts | facts::belt_holes)) != 0)
    return fit_the_belts(verb, command, opened);
  Measured all;
  for (const InputFile& file : opened)
    all.add(load_measured(file, command.input, command.tape, MeasuredUse::fit));
  refuse_too_many(all);
  return command.surface == "direct" ? fit_directly(verb, command, all.files().front())
                                     : fit_jointly(verb, command, all);
}

}  // namespace

void write_fitted(const FitCommand& command, const std::string& text, const std::string& json,
                  const Document& document) {
  Outputs outputs = {{command.output, text}};
  if (command.json) outputs.push_back({"-", json});
  write_outputs(outputs);
  say_lines(render_text(document, command.detail()));
}

void add_fit(Verb app) {
  using namespace facts;
  auto [verb, c] = app.add_verb<FitCommand>(
      "fit",
      "Compute a map from measured points, anchors from belt lengths, or "
      "settings from a test drawing",
      R"(The result is printed on standard error.

Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue fit fixtures/holes/nine_holes.json -o map.json
  build/chaintrue fit fixtures/grids/seven_by_four.json --with fixtures/holes/nine_holes.json -o map.json
  build/chaintrue fit fixtures/belts/thirty_one_places.json -o anchors.json
  build/chaintrue fit fixtures/plotter/mural_drawing.json -o found.json)",
      run_fit, [](const FitCommand& own) {
        if (own.json && own.output == "-") {
          usage_error("fit", "--json and the map cannot both go to standard output");
        }
      });
  add_grid_options(verb, c.input);
  add_tape_options(verb, c.tape);
  verb.has(
      {effects_row(c.input),
       {"--with",
        reads(c.with),
        "More files of the same machine: grids or chaintrue_holes; with belts, "
        "chaintrue_holes. All are fitted together, in the coordinates of the first",
        no_drawing,
        "to be left out for a test drawing, whose file describes the plotter",
        {{residual, "to be left out, because a direct surface needs a single grid"}}},
       {"-o,--output", required(writes(c.output, {Origin::map, Origin::anchors, Origin::machine})),
        "The result: a map file, for belts an anchors file, for a drawing a plotter file; - "
        "is standard output"},
       {"--surface",
        {c.surface, {"residual", "direct"}},
        "residual: a smooth correction of the calibrated machine; direct: splines "
        "through the lengths, without a machine",
        chains,
        "to be left out, because belts and drawings have no surface",
        {{one_grid,
          "\"residual\", because a direct surface needs chain lengths at known places, from a "
          "single grid"}},
        "residual"},
       {"--ends",
        {c.ends, files::kEndConditions},
        "End condition of direct splines",
        direct,
        "to be left out without --surface direct"}});
  add_outside_options(verb, c.outside, "continued by default");
  verb.has({{"--plain",
             c.plain,
             "Do not look for causes. By default, fit looks for causes as diagnose does and "
             "uses those that improve the map at points left out",
             chains,
             "to be left out, because only maps use causes; for belts and drawings run chaintrue "
             "diagnose",
             {{residual, kNoMachine}}},
            {"--accept-class",
             c.accept_class,
             "If the points cannot distinguish long links from a long tape, assume the links",
             chains,
             "to be left out, because it applies to chains and the tape for marks only",
             {{residual, kNoMachine},
              {causes, "to be left out with --plain, which looks for no causes"}}},
            {"--wish-mm",
             {c.wish_mm, kWishMm},
             "The accuracy you want: fit reports whether the map reaches it, and how to reach it",
             no_drawing,
             "to be left out for a test drawing, whose file describes the plotter",
             {{residual, "to be left out for a direct surface, whose tool error is unknown"}}},
            {"-v,--verbose", c.verbose,
             "Also print the tables: settings, errors at left-out points, each distance, left "
             "against right"},
            without_row(c.without),
            {"--json", c.json, "Print the results as JSON"}});
  verb.acts_on(
      "--noise-dof",
      {{residual, "to be left out for a direct surface, which passes through the readings"}});
  verb.acts_on("--effects",
               {{residual, kNoMachine},
                {causes,
                 "to be left out with --plain: a map uses either the machine file alone or the "
                 "causes found"}});
  verb.acts_on("--outside",
               {{chains, "to be left out, because belts and drawings have no surface"},
                {residual, "to be left out for a direct surface, which ends at its points"}});
}

}  // namespace chaintrue::cli
