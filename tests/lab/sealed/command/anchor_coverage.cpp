// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// anchor_coverage: how often the 95 % intervals of the anchors of four belts hold the true ones, for
/// each cause at its usual size, and those of anchors alone. Not part of the test run; its table is
/// in docs/maslow4_rates.md.
///
///   anchor_coverage --sessions 40 --first-seed 1
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "sealed/judge/anchor_coverage.hpp"
#include "sealed/judge/binomial.hpp"

int main(int argc, char** argv) {
  int sessions = 40;
  int side = 9;
  std::uint64_t first_seed = 1;
  std::string only;
  CLI::App app("How often the intervals of anchors hold the true ones");
  app.add_option("--sessions", sessions, "For each cause")->check(CLI::PositiveNumber);
  app.add_option("--side", side, "Places along each side of the grid")->check(CLI::Range(3, 20));
  app.add_option("--first-seed", first_seed, "Of the first session");
  app.add_option("--only", only, "This cause only");
  CLI11_PARSE(app, argc, argv);
  fmt::print(
      "{} sessions a cause, {} by {} places, seeds from {}\n", sessions, side, side, first_seed);
  for (const auto& cause : chaintrue::sealed::usual_causes()) {
    if (!only.empty() && only != cause.effect) continue;
    const auto found = chaintrue::sealed::coverage_of(cause, first_seed, sessions, side);
    // Errors of one session's coordinates are correlated, so the bounds count sessions.
    const int held = static_cast<int>(static_cast<double>(sessions) * found.held / found.of + 0.5);
    const auto bounds = chaintrue::sealed::rate_bounds_95(held, sessions);
    fmt::print(
        "{:<16} {:5.1f} % ({:.0f} to {:.0f} % by {} sessions), anchors alone {:5.1f} %; mean "
        "square {:.2f}\n",
        cause.effect.empty() ? "nothing" : cause.effect,
        100.0 * found.held / found.of,
        100.0 * bounds.lower,
        100.0 * bounds.upper,
        sessions,
        100.0 * found.held_alone / found.of,
        found.square / found.of);
    std::fflush(stdout);
  }
}
