// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/check_anchors.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "grid/belts/anchors_check.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/check_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/check_document.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace files = grid::files;

int check_the_anchors(const AnchorsCheckCommand& command) {
  const files::FittedAnchors anchors = load_anchors(command.anchors);
  require_kind(command.belts,
               {FileKind::belts},
               "anchors are checked by what the machine has measured since; holes and belts "
               "together are fitted (chaintrue fit BELTS --with HOLES)");
  const files::ReadBelts read = load_belts(command.belts, "a check");
  const auto check = grid::check_anchors(anchors.fit, read.belts);
  if (!check) {
    fmt::print(stderr, "{}: {}\n", command.belts.name, check.error().sentence);
    return kBadInput;
  }
  write_output(command.output, command.json ? files::write_check(*check) : report::render_text(check_document(*check)));
  if (check->is_valid_as_it_is()) {
    say_next({"report", command.anchors.path, "-o", "anchors.html"});
  } else {
    say_next({"diagnose", command.belts.path, "-o", "diagnosis.json"});
  }
  return check->is_valid_as_it_is() ? kDone : kCheckFailed;
}

}  // namespace chaintrue::cli
