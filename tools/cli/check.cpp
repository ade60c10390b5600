// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue check: checks by a few new points whether a map, or anchors, are still valid.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/controller_settings.hpp"
#include "grid/map/check.hpp"
#include "tools/cli/verb.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {
namespace {

// The result of a check of a map or of anchors, as a document.

/// `what` is the table's heading.
Table table_of(std::string what, bool has_sign) {
  return {.columns = {report::text_column(std::move(what), 30),
                      {.heading = "mm", .is_number = true, .has_sign = has_sign, .width = 10},
                      report::number_column("+-", 10)},
          .is_headed = true};
}

Document document_of(const Check& check, Table table) {
  Document document;
  document.title = "Check";
  document.verdict = {check.sentence};
  document.remarks = {"What the readings do not show", {Paragraph{check.not_separable}}};
  document.sections = {
      {"How sure",
       {Paragraph{fmt::format(
           "Still valid {:.1f} %, valid after re-zeroing {:.1f} %, no longer valid {:.1f} %.",
           100.0 * check.probability[0], 100.0 * check.probability[1],
           100.0 * check.probability[2])}},
       false,
       Detail::always,
       /*is_titled=*/false},
      {"What was measured", {std::move(table)}}};
  return document;
}

/// Each residual.
Document map_check_document(const Check& check) {
  Table table = table_of("Measured less map", true);
  for (const grid::CheckResidual& one : check.residuals)
    table.add({one.name, one.residual_mm, one.sigma_mm});
  Document document = document_of(check, std::move(table));
  for (const std::string& note : check.notes) document.remarks.say(note);
  return document;
}

/// Each place with the rms residual of its belts.
Document anchors_check_document(const Check& check) {
  Table table = table_of("Error of one belt", false);
  for (const grid::CheckUnit& place : check.units) {
    table.add({place.name, place.rms_mm(check.residuals), place.sigma_mm(check.residuals)});
  }
  return document_of(check, std::move(table));
}

struct CheckCommand {
  std::string map;
  GridInput input;
  TapeOptions tape;
  /// The controller's settings when the new points were commanded.
  std::string settings;
  /// Further files of new points.
  Words with;
  bool json = false;
  std::string output = "-";
  std::string report;
};

/// A check with its page, its numbers (JSON), and the next command.
struct Answer {
  Check check;
  Document document;
  std::string numbers;
  Words next;
};

/// For a valid map its error; after re-zeroing, and if the points do not decide, a few more points;
/// a map that is no longer valid is replaced. \param is_after the map is for numbers that were
/// typed in
Words next_of(const Check& check, const CheckCommand& command, bool is_after) {
  if (check.settings_have_changed && !is_after) {
    return {"export",      "groundcontrol",        command.map, "-o", "settings.ini",
            "--map-after", after_name(command.map)};
  }
  if (check.is_valid_as_it_is())
    return {"report", command.map, "--certificate", "-o", "certificate.html"};
  if (check.decided && check.verdict == grid::CheckVerdict::measure_again &&
      !command.input.machine.empty()) {
    return {"plan", "--machine", command.input.machine, "-o", "marks.csv"};
  }
  return {"plan", "--check", command.map, "-o", "check.csv"};
}

/// For a file with a machine whose controller has settings other than the map's: its commands used
/// these.
void say_other_settings(const CompensationMap& map, const Measured& measured) {
  if (map.machine() == nullptr) return;
  const ControllerKind kind = map.machine()->controller.kind;
  // Others have none: they depend on the motors, which a fit changes.
  if (kind != ControllerKind::maslow_classic && kind != ControllerKind::holey) return;
  for (const MeasuredFile& file : measured.files()) {
    if (!file.machine() || file.machine()->controller.kind != kind) continue;
    const auto changes = changed_settings(files::settings_in_force(*map.machine()),
                                          files::settings_in_force(*file.machine()));
    if (changes.empty()) continue;
    say("The machine's settings in {} differ from the map's ({}); those in the file are used. Give "
        "the controller's settings with --settings.",
        file.name.empty() ? "the new points" : file.name, in_words(changes));
  }
}

Answer check_of_map(const CheckCommand& command, const InputFiles& files, const InputFile& map) {
  const CompensationMap as_measured = load_map(map);
  std::optional<ControllerSettings> before = settings_before(command.map);
  const bool is_after = before.has_value();
  if (!command.settings.empty() && as_measured.machine() != nullptr)
    before = as_measured.machine()->controller.settings;
  Measured measured;
  for (const InputFile& file : files)
    measured.add(load_measured(file, command.input, command.tape, MeasuredUse::check,
                               as_measured.machine()));
  if (command.settings.empty()) say_other_settings(as_measured, measured);
  const CompensationMap in_force =
      command.settings.empty()
          ? as_measured
          : with_settings_of(command.settings, command.map, as_measured, measured);
  Check check = value_of(check_map(in_force, measured, shown_progress()), files.front().name);
  if (auto changed = with_typed_settings(in_force, measured, check, before))
    check = *std::move(changed);
  return {check, map_check_document(check), files::write_map_check(check),
          next_of(check, command, is_after)};
}

/// Valid anchors are reported; others are diagnosed.
Answer check_of_anchors(const CheckCommand& command, const InputFiles& files,
                        const InputFile& anchors) {
  const FittedAnchors loaded = load_anchors(anchors);
  require_kind(files.front(), {FileKind::belts},
               "anchors are checked only against new belt lengths; fit holes and belts together "
               "(chaintrue fit BELTS --with HOLES)");
  const ReadBelts read = load_belts(files.front(), "a check");
  const Check check = value_of(check_anchors(loaded.fit, read.belts), files.front().name);
  return {check, anchors_check_document(check), files::write_anchors_check(check),
          check.is_valid_as_it_is()
              ? Words{"report", command.map, "-o", "anchors.html"}
              : Words{"diagnose", command.input.grid, "-o", "diagnosis.json"}};
}

int run_check(Verb verb, const CheckCommand& command) {
  const InputFile map = open_input(command.map);
  require_kind(map, {FileKind::map, FileKind::anchors});
  const bool of_belts = map.kind == FileKind::anchors;
  const InputFiles files = open_inputs(command.input.grid, command.with);
  verb.refuse_idle_options(map.fact() | (facts_of(files) & (of_belts ? facts::table : facts::any)));
  const Answer answer =
      of_belts ? check_of_anchors(command, files, map) : check_of_map(command, files, map);
  write_outputs({{command.output, command.json ? answer.numbers : render_text(answer.document)},
                 {command.report, render_html(answer.document)}});
  say_next(answer.next);
  return answer.check.is_valid_as_it_is() ? kDone : kCheckFailed;
}

}  // namespace

void add_check(Verb app) {
  auto [verb, c] = app.add_verb<CheckCommand>(
      "check",
      "Check with a few new points whether a map is still valid, or valid after re-zeroing",
      R"help(Three to five points far apart are enough, or holes and the distances between them;
chaintrue plan --check picks the most informative points.
"Still valid (74 %)" is the probability that nothing has changed, given the new points and
what usually changes. From 80 % on it is the verdict. The exit code is 0 if the map is valid
unchanged; otherwise 1: it is valid after re-zeroing, must be measured again, was made for
other settings than the controller's, or needs more points.
Anchors of four belts are checked against new places in a chaintrue_belts file.

Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue check map.json fixtures/grids/five_new_points.json)help",
      run_check);
  verb.has({{"map", required(reads(c.map)), "A chaintrue_map or chaintrue_anchors file"}});
  add_grid_options(verb, c.input);
  add_tape_options(verb, c.tape);
  verb.acts_on(
      "--noise-dof",
      {{facts::nothing, "to be left out, because a check assumes that the noise is known"}});
  verb.has(
      {{"--with", reads(c.with), "More new points, or holes and distances, to compare with the map",
        facts::map,
        "to be left out, because anchors are checked against a single file of new places"},
       {"--settings", reads(c.settings),
        "The controller's settings when the new points were commanded, if they had changed "
        "since the map was measured: groundcontrol.ini, webcontrol.json, or a machine file",
        facts::map, "to be left out, because the anchors' file already contains the settings"},
       {"--json", c.json, "Print all numbers as JSON"},
       {"-o,--output", writes(c.output, {Origin::table, Origin::check}), "- is standard output"},
       {"--report", writes(c.report, {Origin::page}), "The answer as a web page (HTML)"}});
}

}  // namespace chaintrue::cli
