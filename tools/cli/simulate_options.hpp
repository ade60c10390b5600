// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The options of chaintrue simulate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "grid/synthetic/generator.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/simulate_holes.hpp"

namespace chaintrue::cli {

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
  std::vector<std::string> effects;
  /// Files of declared effects.
  std::vector<std::string> declared;
  std::vector<std::string> offsets;
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
[[nodiscard]] std::vector<synthetic::SettingOffset> parse_offsets(
    const std::vector<std::string>& arguments, OptionProblems& problems);
/// Checks the options of a session or of places before any file is read.
void check_words(const SimulateOptions& options, OptionProblems& problems);
/// A session's whole specification. \throws InputError with all problems.
[[nodiscard]] synthetic::SyntheticSpec parse_spec(const SimulateOptions& options,
                                                  const Machine& machine);

// chaintrue simulate --belts: simulates a four-belt router that finds its anchors.

/// Writes the belts file; an exit code. \throws InputError with all problems.
[[nodiscard]] int simulate_the_belts(const SimulateOptions& options);

}  // namespace chaintrue::cli
