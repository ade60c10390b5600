// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The verbs of `chaintrue gcode`; each returns the exit code. \throws files::InputError.
#pragma once

#include "tools/cli/gcode_job.hpp"

namespace chaintrue::cli {

/// A program's extent and, with a map, all problems that compensating would report.
[[nodiscard]] int run_gcode_check(const GcodeOptions& options);
/// Chain lengths along the path, as a CSV.
[[nodiscard]] int run_gcode_lengths(const GcodeOptions& options);
[[nodiscard]] int run_gcode_compensate(const GcodeOptions& options);
/// Runs a program on a simulated controller and compares the track with another program's path.
[[nodiscard]] int run_gcode_verify(const GcodeOptions& options);
/// One line: the state before, what it does, the state after.
[[nodiscard]] int run_gcode_explain(const GcodeOptions& options);

}  // namespace chaintrue::cli
