// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A person at a terminal is told that work goes on, from one second on: for how long, how far it
/// is and how long it will take yet. Not a byte of it where standard error is no terminal.
///
/// \code
///   { const Progress progress("diagnose"); ... }            // main() does this for every verb
///   progress_is(finished, total);                           // whoever knows how far it is
///   end_progress();                                         // before anything is said
/// \endcode
#pragma once

#include <string>

namespace chaintrue::cli {

/// One at a time.
class Progress {
 public:
  explicit Progress(const std::string& verb);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
};

/// Safe from any thread, and cheap: a store.
void progress_is(double finished, double total);
/// Takes the line away; nothing more is shown. Without a Progress nothing happens.
void end_progress();

}  // namespace chaintrue::cli
