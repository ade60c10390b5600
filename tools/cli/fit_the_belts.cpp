// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/fit_the_belts.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/belts_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

namespace files = grid::files;

int fit_the_belts(const BeltsFitCommand& command) {
  const files::ReadBelts read = files::parse_belts(command.text, command.file);
  print_warnings(read.warnings);
  const auto fit = grid::fit_belts(read.belts);
  if (!fit) {
    fmt::print(stderr, "{}: {}\n", command.file, fit.error().sentence);
    return kBadInput;
  }
  const std::string text = files::write_anchors({read.belts.name, *fit});
  std::vector<files::OutputFile> outputs = {{command.output, text}};
  if (command.json) outputs.push_back({"-", text});
  write_outputs(outputs);
  fmt::print(stderr, "{}", belts_fit_in_words(read.belts, *fit));
  if (command.verbose) fmt::print(stderr, "{}", places_in_a_table(*fit));
  say_next({"export", "maslow4", command.output});
  return kDone;
}

}  // namespace chaintrue::cli
