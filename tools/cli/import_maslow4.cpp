// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/belts_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/maslow4_session.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

struct Maslow4Command {
  std::vector<std::string> inputs;
  std::string settings;
  std::string lengths;
  std::string orientation;
  std::string runs;
  std::string pulls;
  std::string output = "-";
};

files::Maslow4Options options_of(const Maslow4Command& command) {
  files::Maslow4Options options;
  if (!command.settings.empty()) {
    options.settings = files::read_whole_file(command.settings);
    options.settings_file = files::name_in_messages(command.settings);
  }
  for (const model::BeltLengths lengths :
       {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span}) {
    if (command.lengths == name(lengths)) options.lengths = lengths;
  }
  if (command.orientation == "upright") options.orientation = model::Orientation::upright;
  if (command.orientation == "flat") options.orientation = model::Orientation::flat;
  return options;
}

/// Parts of one log, or the last run of each of several.
std::vector<files::Maslow4Import> runs_of(const Maslow4Command& command) {
  files::Maslow4Options options = options_of(command);
  if (command.inputs.size() > 1 && !command.runs.empty()) {
    throw InputError({{"the command line",
                       "--runs",
                       fmt::format("together with {} logs", command.inputs.size()),
                       "one log; the last run of each of several logs is used"}});
  }
  std::vector<files::Maslow4Import> runs;
  for (const std::string& input : command.inputs) {
    const std::string text = files::read_whole_file(input);
    std::vector<files::LogPart> parts = {std::nullopt};
    if (!command.runs.empty()) parts = files::log_parts_of(command.runs, "--runs");
    for (const files::LogPart& part : parts) {
      options.part = part;
      runs.push_back(files::parse_maslow4(text, files::name_in_messages(input), options));
    }
  }
  return runs;
}

/// Lists the runs, and how to choose another.
void tell_runs(const files::Maslow4Import& read, bool was_chosen) {
  if (read.runs.size() < 2) return;
  fmt::print(stderr, "The log holds {} runs:\n", read.runs.size());
  for (std::size_t i = 0; i < read.runs.size(); ++i) {
    const files::LoggedRun& run = read.runs[i];
    fmt::print(stderr,
               "  {} {:>3}  points {}:{}  line {}{}{}\n",
               i == read.taken ? '>' : ' ',
               i + 1,
               run.points.first,
               run.points.last,
               run.line,
               run.heading.empty() ? "" : "  ",
               run.heading);
  }
  if (!was_chosen) {
    fmt::print(stderr, "The last one is used; --runs selects others.\n");
  }
}

/// The pulls of the belts, if more than one is known.
void tell_pulls(const MeasuredBelts& belts) {
  const std::vector<double> different = grid::different_pulls(belts);
  if (different.size() < 2) return;
  fmt::print(stderr,
             "One session with {} pulls: the lowest {}, the others {:.3g} times as strong.\n",
             different.size(),
             grid::words_of(*grid::reference_pull(belts)),
             fmt::join(different.begin() + 1, different.end(), ", "));
}

int import_maslow4(const Maslow4Command& command) {
  std::vector<grid::BeltPull> pulls;
  if (!command.pulls.empty()) pulls = files::pulls_of(command.pulls, "--pulls");
  std::vector<files::Maslow4Import> runs = runs_of(command);
  const bool is_one = runs.size() == 1;
  const files::Maslow4Import read = files::one_session(std::move(runs), pulls);
  std::vector<std::string> comments;
  for (const std::string& sentence : read.assumed) comments.push_back("assumed: " + sentence);
  write_output(command.output, files::write_belts(read.belts, comments));
  print_warnings(read.warnings);
  if (is_one) tell_runs(read, !command.runs.empty());
  tell_pulls(read.belts);
  fmt::print(stderr, "{} points read.\n", read.belts.points.size());
  for (const std::string& sentence : read.assumed) fmt::print(stderr, "Assumed: {}.\n", sentence);
  if (!read.belts.machine.anchors_known) {
    fmt::print(stderr,
               "The anchors in force are unknown; --settings maslow.yaml supplies them, with the "
               "arm and the heights.\n");
  }
  if (read.stopped) fmt::print(stderr, "{}\n", *read.stopped);
  if (read.is_enough) say_next({"fit", command.output, "-o", "anchors.json"});
  return kDone;
}

}  // namespace

void add_import_maslow4(Verb import) {
  auto command = std::make_shared<Maslow4Command>();
  Verb verb =
      import.add_verb("maslow4", "Convert the log of a Maslow 4's Find Anchors into a belts file");
  add_input(verb,
            "file",
            command->inputs,
            "The log, or a list of readings {bl:.., br:.., tr:.., tl:..}; - is standard input. "
            "Several logs are runs of one session on one frame, each with its own pull")
      .required();
  add_input(verb, "--settings", command->settings, "The machine's maslow.yaml");
  verb.add_option(
          "--lengths",
          command->lengths,
          "Meaning of a length: the slanting belt alone; the belt with its extension and arm, as "
          "printed before October 2024; or the level span from anchor to tool, as printed since")
      .one_of({"belt", "belt_and_arm", "span"});
  verb.add_option("--orientation", command->orientation, "Position of the frame")
      .one_of({"upright", "flat"});
  verb.add_option(
      "--runs",
      command->runs,
      "Runs of the log to use, such as 2 or 1,2; several form one session. A run may be given by "
      "its first and last point, counted from 0 over all runs, such as 0:98. Default: the last");
  verb.add_option("--pulls",
                  command->pulls,
                  "Pull on the belts in each run: a ratio (1,1.6), the motors' current "
                  "(1300mA,1900mA; Maslow_Calibration_Current_Threshold) or a force (150N,240N). "
                  "Default: as the log prints that setting");
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::measured},
             "The belts file; - is standard output")
      .shows_default();
  verb.footer(
      "Missing values are assumed, and listed here and in the file.\n\n"
      "Examples:\n"
      "  build/chaintrue import maslow4 fixtures/good/maslow4_log.txt \\\n"
      "    --settings fixtures/machines/maslow.yaml -o belts.json\n"
      "  build/chaintrue import maslow4 fixtures/good/maslow4_log.txt "
      "fixtures/good/maslow4_log.txt \\\n"
      "    --pulls 1,1.6 -o two_pulls.json");
  verb.runs(command, import_maslow4);
}

}  // namespace chaintrue::cli
