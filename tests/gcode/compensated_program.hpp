// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compensates a program, and verifies one.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode {

struct Compensated {
  std::string text;
  CompensateSummary summary;
  Findings findings;
};

inline Result<Compensated> compensate(const std::string& program, const Corrector& corrector,
                                      CompensateOptions options = {}, const Dialect& dialect = {}) {
  Compensated result;
  Compensator compensator(corrector, std::move(options),
                          [&](std::string_view bytes) { result.text += bytes; });
  auto source = LineSource::from_text(program);
  const auto summary = compensator.run(source, dialect);
  if (!summary) return tl::unexpected(summary.error());
  result.summary = *summary;
  result.findings = compensator.findings();
  return result;
}

inline VerifySummary verified(const std::string& original, const std::string& run,
                              const Corrector& corrector, const VerifyOptions& options = {},
                              const Dialect& dialect = {}) {
  auto a = LineSource::from_text(original);
  auto b = LineSource::from_text(run);
  const auto summary = verify(a, b, corrector, dialect, options);
  if (!summary) {
    ADD_FAILURE() << (summary.error().in_original ? "original: " : "output: ")
                  << summary.error().problem.message();
    return {};
  }
  return *summary;
}

}  // namespace chaintrue::gcode
