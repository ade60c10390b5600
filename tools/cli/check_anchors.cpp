// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/check_anchors.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <iterator>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/belts_input.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

std::string in_words(const grid::AnchorsCheck& check) {
  std::string text = check.sentence + "\n";
  if (!check.not_told_apart.empty()) text += check.not_told_apart + "\n";
  fmt::format_to(std::back_inserter(text),
                 "\nStill valid {:.1f} %, valid after re-zeroing {:.1f} %, to be measured again "
                 "{:.1f} %.\n\nOne belt is off by                      mm     sigma\n",
                 100.0 * check.probability[0],
                 100.0 * check.probability[1],
                 100.0 * check.probability[2]);
  for (std::size_t k = 0; k < check.places.size(); ++k) {
    fmt::format_to(std::back_inserter(text),
                   "  {:<30}{:>10.2f}{:>10.2f}\n",
                   fmt::format("point {}", k),
                   check.places[k].rms_mm,
                   check.places[k].sigma_mm);
  }
  return text;
}

}  // namespace

int check_the_anchors(const AnchorsCheckCommand& command) {
  const files::FittedAnchors anchors =
      parse_anchors_input(command.text, files::name_in_messages(command.anchors));
  const std::string file = files::name_in_messages(command.belts);
  const std::string text = files::read_whole_file(command.belts);
  if (!files::looks_like_belts(text)) {
    throw files::InputError(
        {{file,
          "/file_type",
          "",
          "\"chaintrue_belts\": anchors are checked by what the machine has measured since; holes "
          "and belts together are fitted (chaintrue fit BELTS --with HOLES)"}});
  }
  const files::ReadBelts read = parse_belts_input(text, file, "a check");
  const auto check = grid::check_anchors(anchors.fit, read.belts);
  if (!check) {
    fmt::print(stderr, "{}: {}\n", file, check.error().sentence);
    return kBadInput;
  }
  write_output(command.output, command.json ? files::write_check(*check) : in_words(*check));
  if (check->is_valid_as_it_is()) {
    say_next({"report", command.anchors, "-o", "anchors.html"});
  } else {
    say_next({"diagnose", command.belts, "-o", "diagnosis.json"});
  }
  return check->is_valid_as_it_is() ? kDone : kCheckFailed;
}

}  // namespace chaintrue::cli
