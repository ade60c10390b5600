// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The specification of a sweep: the product of its factors, each with its levels, and the number
/// of repetitions of each combination.
///
/// A cell is one combination and one repetition: a session is simulated (grid/synthetic), a map is
/// fitted to it, and the map is compared with the truth over the bed. A repetition uses the same
/// random numbers in every combination, so that levels are compared pairwise. Cells are numbered
/// with the repetition fastest and the first factor slowest.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/synthetic/generator.hpp"

namespace chaintrue::grid::sweep {

struct GridLevel {
  int columns = 7;
  int rows = 4;
};

struct NoiseLevel {
  double length_mm = 0.2;
  double position_mm = 0.3;
};

/// The surfaces of grid/map/fit.hpp; direct ones by their end conditions.
enum class SurfaceLevel { residual, direct, direct_parabolic, direct_natural };

/// A true machine and its stated values.
struct MachineLevel {
  std::string name;
  Machine truth;
  Machine stated;
  model::Model model = model::Model::elastic;
  /// Amplitude of an unmodelled smooth disturbance.
  double unmodelled_mm = 0.0;
};

struct EffectsLevel {
  std::string name;
  std::vector<AppliedEffect> effects;
};

/// The machine that the map is used on: the measured one with more effects (wear), or another one of
/// the same build, with newly drawn settings.
struct UseLevel {
  std::string name;
  std::vector<AppliedEffect> effects;
  bool another_of_the_build = false;
};

struct SweepSpec {
  std::string name;
  std::string question;
  std::uint64_t seed = 1;
  int repetitions = 10;
  /// Raster of the bed on which a map is compared with the truth.
  GridLevel evaluation{40, 25};
  int repeats = 0;
  bool draw_settings = true;
  /// Marks and raster reach to the bed's edges, not only to its last whole 100 mm.
  bool whole_bed = false;
  std::vector<GridLevel> grids;
  std::vector<synthetic::DesignKind> spacings;
  std::vector<NoiseLevel> noises;
  std::vector<double> jitters_mm;
  std::vector<SurfaceLevel> surfaces;
  std::vector<MachineLevel> machines;
  std::vector<EffectsLevel> effects;
  std::vector<UseLevel> uses;
};

inline constexpr std::size_t kFactors = 8;
/// Column names of the results, in the order of numbering.
inline constexpr std::array<std::string_view, kFactors> kFactorNames = {
    "machine", "effects", "used_on", "surface", "spacing", "jitter_mm", "noise_mm", "grid"};

/// The level of each factor, in the order of kFactorNames.
using Levels = std::array<std::size_t, kFactors>;

std::array<std::size_t, kFactors> level_counts(const SweepSpec& spec);
std::uint64_t combinations(const SweepSpec& spec);
std::uint64_t cells(const SweepSpec& spec);
Levels levels_of(const SweepSpec& spec, std::uint64_t combination);
std::string_view name(SurfaceLevel level);
/// Label of a level: "7x4", "0.2/0.3", "residual", a machine's name.
std::string level_name(const SweepSpec& spec, std::size_t factor, std::size_t level);

enum class CellStatus : std::uint64_t {
  done,         ///< the map has an answer at every point of the raster
  no_map,       ///< the fit failed (fewer points than it needs, not a full grid, not converged)
  not_reached,  ///< a mark that the true machine cannot reach
  no_answer,    ///< the map has no answer at some point
};
std::string_view name(CellStatus status);

/// Errors of a map over the raster. Chain: both chains together; tool: distance from the intended
/// position.
struct CellResult {
  CellStatus status = CellStatus::done;
  double chain_rms_mm = 0.0;
  double chain_max_mm = 0.0;
  double tool_rms_mm = 0.0;
  double tool_max_mm = 0.0;
  /// The map's own estimate of the tool's rms error.
  double expected_tool_rms_mm = 0.0;
};

/// Computes one cell; pure, thread safe.
[[nodiscard]] CellResult run_cell(const SweepSpec& spec, std::uint64_t cell);

}  // namespace chaintrue::grid::sweep
