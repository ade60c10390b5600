// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/import_maslow4.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "grid/files/belts_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct Maslow4Command {
  std::string input;
  std::string settings;
  std::string points;
  std::optional<int> run;
  std::string lengths;
  std::string orientation;
  std::string output = "-";
};

files::Maslow4Options options_of(const Maslow4Command& command) {
  files::Maslow4Options options;
  if (!command.settings.empty()) {
    options.settings = files::read_whole_file(command.settings);
    options.settings_file = files::name_in_messages(command.settings);
  }
  options.run = command.run;
  if (!command.points.empty()) options.points = files::point_range_of(command.points, "--points");
  for (const model::BeltLengths lengths :
       {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span}) {
    if (command.lengths == name(lengths)) options.lengths = lengths;
  }
  if (command.orientation == "upright") options.orientation = model::Orientation::upright;
  if (command.orientation == "flat") options.orientation = model::Orientation::flat;
  return options;
}

/// Which runs there are, and how to take another.
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
    fmt::print(stderr, "Taken is the last one; --run N or --points A:B takes another.\n");
  }
}

int import_maslow4(const Maslow4Command& command) {
  const files::Maslow4Options options = options_of(command);
  const files::Maslow4Import read = files::parse_maslow4(
      files::read_whole_file(command.input), files::name_in_messages(command.input), options);
  std::vector<std::string> comments;
  for (const std::string& sentence : read.assumed) comments.push_back("assumed: " + sentence);
  write_output(command.output, files::write_belts(read.belts, comments));
  print_warnings(read.warnings);
  tell_runs(read, options.run || options.points);
  fmt::print(stderr, "{} points read.\n", read.belts.points.size());
  for (const std::string& sentence : read.assumed) fmt::print(stderr, "Assumed: {}.\n", sentence);
  if (!read.belts.machine.anchors_known) {
    fmt::print(
        stderr,
        "Where the anchors are taken to be is not known; --settings maslow.yaml says it, and "
        "the arm and the heights.\n");
  }
  // A warning is that of places which are not enough for a fit.
  if (read.warnings.empty()) say_next({"fit", command.output, "-o", "anchors.json"});
  return kDone;
}

}  // namespace

void add_import_maslow4(Verb import, Run& run) {
  auto command = std::make_shared<Maslow4Command>();
  Verb verb = import.add_verb(
      "maslow4", "What a Maslow 4 prints while it finds its anchors becomes a belts file");
  add_input(verb,
            "file",
            command->input,
            "The log, or a list of readings {bl:.., br:.., tr:.., tl:..}; - is standard input")
      .required();
  add_input(verb, "--settings", command->settings, "The machine's maslow.yaml");
  verb.add_option("--points",
                  command->points,
                  "First and last point to take, counted from 0 over all runs, as in 0:98");
  add_number(
      verb, "--run", command->run, {"", 1.0, 10000.0}, "Which run to take; the last if unsaid");
  verb.add_option("--lengths",
                  command->lengths,
                  "What a length counts: the belt alone, slanting; the belt with its extension and "
                  "arm, as printed before October 2024; or the level span from anchor to tool, as "
                  "since")
      .one_of({"belt", "belt_and_arm", "span"});
  verb.add_option("--orientation", command->orientation, "How the frame stands")
      .one_of({"upright", "flat"});
  add_output(verb,
             "-o,--output",
             command->output,
             {Origin::measured},
             "The belts file; - is standard output")
      .shows_default();
  verb.footer(
      "What the log does not say is assumed, and said so here and in the file.\n\n"
      "Example:\n"
      "  build/chaintrue import maslow4 fixtures/good/maslow4_log.txt \\\n"
      "    --settings fixtures/machines/maslow.yaml -o belts.json");
  verb.when_chosen([command, &run] { run = [command] { return import_maslow4(*command); }; });
}

}  // namespace chaintrue::cli
