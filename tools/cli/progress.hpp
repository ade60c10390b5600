// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shows progress on a terminal after one second: elapsed time, the step and the number of steps
/// and, if known, the share done and the time left. No output if standard error is not a terminal.
///
/// \code
///   { const ProgressLine line("diagnose"); ... }            // main() does this for every verb
///   options.progress = shown_progress();                    // receives the steps of the work
///   progress_is(finished, total);                           // or the progress of a single step
///   end_progress();                                         // before printing anything
/// \endcode
#pragma once

#include <string>

#include "grid/progress.hpp"

namespace chaintrue::cli {

/// One at a time.
class ProgressLine {
 public:
  explicit ProgressLine(const std::string& verb);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
};

/// Shows the steps that it receives. Safe from any thread, and cheap.
grid::Progress shown_progress();
/// For the last step received, or the whole if none was.
void progress_is(double finished, double total);
/// Removes the line; nothing more is shown. No effect without a ProgressLine.
void end_progress();

}  // namespace chaintrue::cli
