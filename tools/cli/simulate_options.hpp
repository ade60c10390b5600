// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The options of chaintrue simulate.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/generator.hpp"
#include "model/machine.hpp"
#include "tools/cli/names.hpp"
#include "tools/cli/places.hpp"

namespace chaintrue::cli {

using synthetic::DesignKind;
using synthetic::SettingOffset;

struct SimulateOptions {
  std::string machine;
  /// Instead of a machine: a chaintrue_belts or chaintrue_anchors file.
  std::string belts;
  /// For belts: the pull in each pass, as in 1,1.6.
  std::string pulls;
  std::string grid;
  DesignKind spacing = DesignKind::regular;
  int random_points = 0;
  std::string marks;
  std::string points;
  /// 0 holes: a grid is simulated instead.
  HolesPlanRequest holes{.holes = 0, .progress = {}};
  double tape_zero_offset_mm = 0.0;
  double tape_rounding_mm = 0.0;
  /// What is stated as it is; parse_spec() adds the rest. Belts and holes use what they have.
  synthetic::SyntheticSpec spec;
  std::optional<double> stated_length_mm;
  std::optional<double> stated_position_mm;
  std::optional<double> stated_dof;
  Words effects;
  /// Files of declared effects.
  Words declared;
  Words offsets;
  std::optional<double> sheet_shift_mm;
  std::optional<double> sheet_rotation_mrad;
  std::string name;
  std::string output = "-";
  std::string answer;

  /// The options of what is simulated.
  std::string title() const;
};

/// For --grid. \param most columns or rows
template <class Places>
void take_size(const std::string& grid, int most, std::string expected, Places& places,
               OptionProblems& problems) {
  const auto size = files::pair_of(grid, 'x', 2, most);
  if (!size) return problems.add("--grid", grid, std::move(expected), ProblemKind::bad_syntax);
  places.columns = (*size)[0];
  places.rows = (*size)[1];
}
/// For --offset.
std::vector<SettingOffset> parse_offsets(const Words& arguments, OptionProblems& problems);
/// \throws InputError with all problems, and those of a machine with these offsets.
void throw_if_impossible(const Machine& truth, OptionProblems& problems);
/// At most one bad reading for each of these.
void require_bad_points(const SimulateOptions& options, std::size_t most, std::string_view what,
                        OptionProblems& problems);
/// Checks the options of a session or of places before any file is read.
void check_words(const SimulateOptions& options, OptionProblems& problems);
/// A session's whole specification. \throws InputError with all problems.
synthetic::SyntheticSpec parse_spec(const SimulateOptions& options, const Machine& machine);

// chaintrue simulate --belts: simulates a four-belt router that finds its anchors.

/// Writes the belts file; an exit code. \throws InputError with all problems.
int simulate_the_belts(const SimulateOptions& options);

// chaintrue simulate --holes: cuts holes and measures them with a tape.

/// Writes the set and, if requested, its hidden truth; returns the exit code. \throws
/// InputError for values out of range.
int simulate_the_holes(const SimulateOptions& options, const Machine& stated);

// Effects on the command line: `id:side:key=value,key=value`, `-` for no side.
/// The effects that `--effect` named, one for each argument, not checked against any catalogue. An
/// argument of another form is a problem, as is an effect without a name.
std::vector<AppliedEffect> parse_effect_words(const Words& arguments, OptionProblems& problems);

/// The effects that `--effect` named, checked against the catalogue as effects of `machine` in addition to
/// its own.
std::vector<AppliedEffect> parse_effects(const Words& arguments, const Machine& machine,
                                         OptionProblems& problems);

struct NamedNumber {
  std::string name;
  double value = 0.0;
};
/// `name=number`; empty for any other text.
std::optional<NamedNumber> named_number(std::string_view text);

}  // namespace chaintrue::cli
