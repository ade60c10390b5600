// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The content of a compensation map, and its answers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "grid/estimation/residual_surface.hpp"
#include "grid/map/error_summary.hpp"
#include "grid/map/lattice_residual.hpp"
#include "grid/map/measured_area.hpp"
#include "grid/observation/measured_grid.hpp"
#include "interp/eigen.hpp"
#include "interp/tensor_spline.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid {

/// One setting, before and after.
struct SettingResult {
  Setting setting;
  double stated = 0.0;
  double calibrated = 0.0;
  double sigma = 0.0;
  /// Changed by more than three of its stated sigmas: the stated value is wrong, or something else
  /// imitates it.
  bool off = false;
};

/// Errors for one way of leaving points out. Chain: both chains equally. Tool: distance from where
/// the tool was.
struct HeldOutError {
  ErrorSummary chain;
  ErrorSummary tool;
  double tool_x_rms_mm = 0.0;
  double tool_y_rms_mm = 0.0;
};

/// The map's own error. Held-out errors are relative to the readings, whose noise they contain;
/// expected errors are relative to the true machine, one sigma.
struct MapAccuracy {
  HeldOutError leave_one_out;
  HeldOutError blocked;
  /// For the tool over the measured part of the bed (controller_error.hpp).
  ErrorSummary expected_tool;
  MarkPoint expected_worst_at;  ///< where it is largest
};

enum class NoiseSource {
  stated,
  repeats,
  fit,
  assumed,  ///< for a direct map if none is stated
};
/// As in files.
std::string_view name(NoiseSource source);

/// The noise that the fit assumed.
struct MapNoise {
  double length_mm = 0.0;
  double position_mm = 0.0;
  NoiseSource source = NoiseSource::stated;
  /// The noise found in the residuals, as a multiple of the one above.
  double factor_found = 1.0;
};

/// A measured point in millimetres at the tool: where it landed minus where each model puts it. For
/// a point with a command, "as stated" is the commanded place.
struct MapPoint {
  MarkPoint mark;
  ChainLengths lengths;
  bool bad = false;
  /// Left-out residual in sigmas, both chains together.
  double distance_sigmas = 0.0;
  Vector2d as_stated_mm = Vector2d::Zero();
  Vector2d sheet_placed_mm = Vector2d::Zero();
  Vector2d mapped_mm = Vector2d::Zero();
  Vector2d left_out_mm = Vector2d::Zero();
};

/// Test of the claim that R is L mirrored (seeds/001) against the points: R measured at (x, y)
/// minus the map's L at (-x, y), mirrored about the middle of the bed.
struct MirrorTest {
  std::size_t points = 0;  ///< whose mirror image lies on the map
  ErrorSummary difference;
  double mean_mm = 0.0;
  MarkPoint worst_at;
  double worst_signed_mm = 0.0;
  /// No point differs by more than 4.5 sigmas of noise and map.
  bool holds = true;
  std::string sentence;
};

/// The data of a map made from holes and a tape: its points are the holes at the positions given by
/// the distances, and its held-out errors are those of distances, along the tape.
struct DistancesUsed {
  int used = 0;
  int rejected = 0;
  double tape_sigma_mm = 0.0;
  ErrorSummary left_out_all;
  ErrorSummary left_out_good;
};

/// Surface on the calibrated model.
struct ModelSurface {
  Machine machine;  ///< calibrated
  SheetPlacement sheet;
  ResidualSurface residual;
  FitColumns columns;
  std::vector<Setting> settings;
  /// C = F F', lower triangular, of all unknowns in the order of FitColumns.
  MatrixXd covariance_factor;
  /// Replaces the residual's splines (not its chain scales) if noise-free readings lie on a
  /// lattice.
  std::optional<LatticeResidual> lattice = std::nullopt;
};

/// Splines through the measured lengths themselves; no machine.
struct DirectSurface {
  std::vector<double> x_nodes_mm;
  std::vector<double> y_nodes_mm;
  PerSide<MatrixXd> lengths_mm;  ///< (ix, iy)
  interp::TensorEnds ends;
  /// Estimated by leaving out inner lines.
  double interpolation_sigma_mm = 0.0;
};

/// How the map's surfaces continue beyond the measured points. The calibrated machine and its
/// chains' scales continue everywhere; sigmas show the accuracy of each way.
enum class Outside {
  continued,  ///< the surfaces' own smooth continuation, the best guess
  refuse,     ///< no answer where the status would be extrapolated
  fade,       ///< the linear continuation, falling to zero over the fade's width beyond the edge
  linear,     ///< the tangent plane at the nearest measured place
  clamp,      ///< the value at the nearest measured place
};

struct OutsideRule {
  Outside way = Outside::continued;
  double fade_width_mm = 200.0;  ///< > 0; for `fade`
};

/// The content of a map file.
struct MapContents {
  std::string name;
  std::variant<DirectSurface, ModelSurface> surface;
  std::vector<MarkPoint> hull;
  double edge_mm = 0.0;
  interp::Rectangle domain;
  OutsideRule outside;
  /// Factor on sigmas where the status is extrapolated, at least 1: another map of the same
  /// readings may be as good there (diagnosis/causes_fit.hpp).
  double sigma_factor_beyond = 1.0;
  MapNoise noise;
  MapAccuracy accuracy;
  std::vector<SettingResult> settings;
  std::vector<MapPoint> points;
  std::optional<MirrorTest> mirror;
  /// Only for a map made from holes.
  std::optional<DistancesUsed> distances = std::nullopt;
  /// Sentences for the user: what was assumed, rejected, or unusual.
  std::vector<std::string> notes;
};

struct MapAnswer {
  ChainLengths lengths;
  ChainLengths sigma;
  /// For the two lengths, including their correlation.
  Matrix2d covariance;
  /// d(left, right)/d(mark)
  Matrix2d mark_jacobian;
  /// Root of the summed variances of the tool's x and y.
  double tool_sigma_mm = 0.0;
  MapStatus status = MapStatus::inside;
};

/// Lengths and their derivative by the mark.
struct MapLengths {
  ChainLengths lengths;
  Matrix2d mark_jacobian;
};

/// A row for each length, and a column for one sigma of each uncertain direction; the directions are
/// the same at every mark within the points.
struct MapSpread {
  MapLengths here;
  Matrix2Xd spread_mm;
};

}  // namespace chaintrue::grid
