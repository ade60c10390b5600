// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by the verbs of `chaintrue gcode`: inputs of compensating and verifying, the program's
/// text, messages.
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

/// Checks that the tolerance exceeds the rounding.
void check_limits(const GcodeOptions& options, OptionProblems& problems);
/// Inputs of compensating, except the program.
[[nodiscard]] gcode::CompensateOptions compensate_options(const GcodeOptions& options,
                                                          const GcodeMachine& machine);

/// Inputs of running the output on the simulated machine.
[[nodiscard]] gcode::VerifyOptions verify_options(const GcodeOptions& options,
                                                  const GcodeMachine& machine);

/// A program's lines; standard input ("-") and pipes are kept in memory. \throws InputError where
/// it cannot be read.
class GcodeText {
 public:
  explicit GcodeText(const std::string& path);
  [[nodiscard]] gcode::LineSource open() const;
  /// As above, and shows this step of the work and the share of the program that was read.
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

/// Thrown for a refused program, after all of its problems were printed.
struct GcodeRefused : Failed {
  explicit GcodeRefused(std::vector<gcode::Problem> found);
  std::vector<gcode::Problem> problems;
};

/// A JSON text.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// Prints a problem to stderr as `file: line 3: ...`; returns the exit code of its kind.
int report(const std::string& file, const gcode::Problem& problem);
/// Prints all findings and how many there are beyond those kept; the exit code of the first, or
/// kDone.
int report(const std::string& file, const gcode::Findings& findings);

/// The content of a pending file, as a program. \throws InputError if it could not be written.
[[nodiscard]] gcode::LineSource written_so_far(files::PendingFile& file);

}  // namespace chaintrue::cli
