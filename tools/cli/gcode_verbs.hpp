// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of `chaintrue gcode` do; each returns the exit code. \throws files::InputError.
#pragma once

#include "tools/cli/gcode_job.hpp"

namespace chaintrue::cli {

/// How far a program goes and, with a map, everything that compensating would object to.
[[nodiscard]] int run_gcode_check(const GcodeOptions& options);
/// Chain lengths along the path, as a CSV.
[[nodiscard]] int run_gcode_lengths(const GcodeOptions& options);
[[nodiscard]] int run_gcode_compensate(const GcodeOptions& options);
/// Runs one program through a simulated controller and compares it with what another one means.
[[nodiscard]] int run_gcode_verify(const GcodeOptions& options);
/// One line: the state before, what it does, the state after.
[[nodiscard]] int run_gcode_explain(const GcodeOptions& options);

}  // namespace chaintrue::cli
