// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The options of chaintrue simulate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/generator.hpp"
#include "grid/synthetic/holes.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

struct HolesOptions {
  /// 0 holes: a grid is simulated instead.
  HolesPlanRequest plan{.holes = 0, .progress = {}};
  double tape_zero_offset_mm = 0.0;
  double rounding_mm = 0.0;
};

struct SimulateOptions {
  std::string machine;
  /// Instead of a machine: a chaintrue_belts or chaintrue_anchors file.
  std::string belts;
  /// For belts: the pull in each pass, as in 1,1.6.
  std::string pulls;
  std::string grid;
  std::string spacing = "regular";
  int random_points = 0;
  std::string marks;
  std::string points;
  HolesOptions holes;
  std::string model = "elastic";
  std::optional<double> margin_mm;
  bool without_corners = false;
  std::string region = "whole";
  std::string order = "rows";
  int repeats = 0;
  double jitter_mm = 0.0;
  synthetic::SyntheticNoise noise;
  std::optional<double> stated_length_mm;
  std::optional<double> stated_position_mm;
  std::optional<double> stated_dof;
  synthetic::BadPoints bad;
  Words effects;
  /// Files of declared effects.
  Words declared;
  Words offsets;
  bool draw_settings = false;
  std::optional<double> sheet_shift_mm;
  std::optional<double> sheet_rotation_mrad;
  std::uint64_t seed = 1;
  std::string name;
  std::string output = "-";
  std::string answer;
};

/// From --model; an unknown word becomes a problem.
[[nodiscard]] model::Model parse_model(const std::string& word, OptionProblems& problems);
/// For --offset.
[[nodiscard]] std::vector<synthetic::SettingOffset> parse_offsets(const Words& arguments,
                                                                  OptionProblems& problems);
/// Checks the options of a session or of places before any file is read.
void check_words(const SimulateOptions& options, OptionProblems& problems);
/// A session's whole specification. \throws InputError with all problems.
[[nodiscard]] synthetic::SyntheticSpec parse_spec(const SimulateOptions& options,
                                                  const Machine& machine);

// chaintrue simulate --belts: simulates a four-belt router that finds its anchors.

/// Writes the belts file; an exit code. \throws InputError with all problems.
[[nodiscard]] int simulate_the_belts(const SimulateOptions& options);

// chaintrue simulate --holes: cuts holes and measures them with a tape.

/// Writes the set and, if requested, its hidden truth; returns the exit code. \throws
/// InputError for values out of range.
[[nodiscard]] int simulate_the_holes(const SimulateOptions& options, const Machine& stated);

}  // namespace chaintrue::cli
