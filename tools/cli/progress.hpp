// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shows at a terminal that work goes on, from one second on: for how long, at what step
/// of how many it is and, where that can be known, how much of the step is done and how long it will
/// take yet. Not a byte of it where standard error is no terminal.
///
/// \code
///   { const ProgressLine line("diagnose"); ... }            // main() does this for every verb
///   options.progress = shown_progress();                    // whoever works tells its steps
///   progress_is(finished, total);                           // or how far its only one is
///   end_progress();                                         // before anything is said
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
[[nodiscard]] grid::Progress shown_progress();
/// Of the step that was received last, or of the whole where none was.
void progress_is(double finished, double total);
/// Takes the line away; nothing more is shown. Without a ProgressLine nothing happens.
void end_progress();

}  // namespace chaintrue::cli
