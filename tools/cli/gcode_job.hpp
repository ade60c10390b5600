// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of `chaintrue gcode` share: what compensating and verifying need to know, the program's text,
/// messages.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/pending_file.hpp"
#include "grid/progress.hpp"
#include "grid/provenance.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/gcode_machine.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::cli {

/// That the tolerance leaves room for rounding.
void check_limits(const GcodeOptions& options, OptionProblems& problems);
/// What compensating needs to know, but where the program comes from.
[[nodiscard]] gcode::CompensateOptions compensate_options(const GcodeOptions& options,
                                                          const GcodeMachine& machine);

/// What running the output on the simulated machine needs to know.
[[nodiscard]] gcode::VerifyOptions verify_options(const GcodeOptions& options,
                                                  const GcodeMachine& machine);

/// A program's lines; standard input ("-") and pipes are kept in memory. \throws InputError where
/// it cannot be read.
class GcodeText {
 public:
  explicit GcodeText(const std::string& path);
  [[nodiscard]] gcode::LineSource open() const;
  /// The same, which shows this step of the work and how much of the program was read.
  [[nodiscard]] gcode::LineSource open(const grid::WorkStep& step) const;
  /// Its name without folders, and its hash.
  [[nodiscard]] grid::SourceFile source() const;

 private:
  std::string path_;
  std::optional<std::string> text_;
};

/// A command on the map of these options, with their --settings.
[[nodiscard]] std::vector<std::string> with_map_words(const GcodeOptions& options,
                                                      std::vector<std::string> words);

/// part.nc becomes part.true.nc.
[[nodiscard]] std::string compensated_name(const std::string& program);

/// A program that is refused, once all that is wrong in it was printed.
struct GcodeRefused : Failed {
  explicit GcodeRefused(std::vector<gcode::Problem> found);
  std::vector<gcode::Problem> problems;
};

/// A JSON text.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Prints a problem to stderr as `file: line 3: ...`; gives the exit code that its kind has.
int report(const std::string& file, const gcode::Problem& problem);
/// Prints all findings and how many there are beyond those kept; the exit code of the first, or
/// kDone.
int report(const std::string& file, const gcode::Findings& findings);

/// What a file that has not taken its place yet holds, as a program. \throws InputError where it
/// could not be written.
[[nodiscard]] gcode::LineSource written_so_far(grid::files::PendingFile& file);

}  // namespace chaintrue::cli
