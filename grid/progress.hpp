// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How far a long piece of work is, told to whoever listens. Neither a clock nor any output here:
/// who shows it knows how long it took so far.
///
/// \code
///   FitOptions options;
///   options.progress = [](const WorkStep& step) { show(step.what, step.number, step.of); };
/// \endcode
#pragma once

#include <functional>
#include <string_view>

namespace chaintrue::grid {

/// A step of the work, as a person at the machine would call it.
struct WorkStep {
  std::string_view what;  ///< a literal
  int number = 1;         ///< from 1; steps that the data do not ask for are passed over
  int of = 1;
  /// Of this step, or of its pass, that is done, 0 to 1; negative: nobody can know.
  double share = -1.0;
  int pass = 0;  ///< of a step that ends when it has settled, from 1; 0: of others
};

/// Called by the thread that works; empty where nobody listens.
using Progress = std::function<void(const WorkStep&)>;

inline void tell(const Progress& progress, const WorkStep& step) {
  if (progress) progress(step);
}

}  // namespace chaintrue::grid
