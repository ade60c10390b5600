// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Progress of a long computation, reported to a callback. No clock and no output here: the caller
/// measures the time.
///
/// \code
///   FitOptions options;
///   options.progress = [](const WorkStep& step) { show(step.what, step.number, step.of); };
/// \endcode
#pragma once

#include <functional>
#include <string_view>

namespace chaintrue::grid {

/// A step of the work, in a user's words.
struct WorkStep {
  std::string_view what;  ///< a literal
  int number = 1;         ///< from 1; steps that the data do not need are skipped
  int of = 1;
  /// Share of this step, or of its pass, that is done, 0 to 1; negative: unknown.
  double share = -1.0;
  int pass = 0;  ///< of a step that iterates until it converges, from 1; 0: of others
};

/// Called by the working thread; may be empty.
using Progress = std::function<void(const WorkStep&)>;

inline void tell(const Progress& progress, const WorkStep& step) {
  if (progress) progress(step);
}

}  // namespace chaintrue::grid
