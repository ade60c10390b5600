// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The observability of an effect: its signature over a session, the part of it that the
/// calibration of the settings does not absorb, and the size from which such points can identify
/// it.
///
/// Notation
///   r_i    residual of a visit that the effect causes, reading less that of the stated machine
///          at the mark as written: dL - J dw; for the two chains [mm]
///   C_i    J S_xy J' + diag(s_L^2): covariance of that residual, from position and length noise
///   g      all r_i, whitened by C_i
///   J_s    the settings' sensitivities, whitened by C_i, their stated sigmas as further rows
///   M      projection orthogonal to J_s
///   delta  |M g|: the signal-to-noise ratio
///   rho    |cos| of the angle between M g of two effects: their collinearity
///
/// An effect is detected at delta 4.8 (1 in 100 false alarms over the catalogue, 9 in 10 found) and
/// distinguished from a rival in 95 of 100 cases at 1.645 sqrt(2 / (1 - rho)): the rival fits
/// better with probability Phi(-delta sqrt((1 - rho) / 2)). Beyond kInseparable no number of such
/// points is sufficient. Signatures are secants at the usual size, so delta is proportional to the
/// size as far as the effect is.
///
/// \code
///   const StrengthTable table(machine, regular_session(machine, 10, 6), StatedNoise{});
///   const EffectStrength s = table.strength(*find_effect("chain_stretch"), EffectSide::none);
///   fmt::print("{} {}\n", s.named_size, s.nearest_rival->id);
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "grid/observation/measured_grid.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::synthetic {

inline constexpr double kDetectableSignalToNoise = 4.8;
inline constexpr double kInseparable = 0.9995;

/// Marks of a regular grid, visited row by row.
std::vector<model::Visit> regular_session(const Machine& machine, int columns, int rows);

/// The changes of a session's readings by effects.
struct SessionSignature {
  std::vector<Vector2d> residual_mm;   ///< r_i
  std::vector<Matrix2d> length_by_xy;  ///< J_i of the stated machine
  /// To first order: actual position of the tool less that of the stated machine, -J^-1 r.
  std::vector<Vector2d> tool_shift_mm() const;
};

/// \throws std::invalid_argument if a visit cannot be reached.
SessionSignature signature(const Machine& stated, const std::vector<AppliedEffect>& effects,
                           const std::vector<model::Visit>& visits);

struct Rival {
  const Effect* effect = nullptr;
  EffectSide side = EffectSide::none;
  double collinearity = 0.0;
};

struct EffectStrength {
  /// At the usual size.
  double signal_to_noise = 0.0;
  /// Share of the signature that remains after calibration.
  double share_left = 0.0;
  /// Size of the effect's first parameter at kDetectableSignalToNoise.
  double detectable_size = 0.0;
  /// The rival with the most collinear signature, apart from the effect's own class.
  std::optional<Rival> nearest;
  /// Size from which it is also distinguished from the nearest rival; absent if that is out of the
  /// parameter's range.
  std::optional<double> named_size;
  /// Effects that no points of this kind distinguish from this one.
  std::vector<Rival> inseparable;
};

/// The signatures of the whole catalogue over one session.
class StrengthTable {
 public:
  /// \throws std::invalid_argument if a visit cannot be reached or a noise is not above 0.
  StrengthTable(const Machine& stated, std::vector<model::Visit> visits, const StatedNoise& noise);

  EffectStrength strength(const Effect& effect, EffectSide side) const;

  /// The change of the tool's position at each visit by an effect, after calibration of the
  /// settings on these visits.
  std::vector<Vector2d> calibrated_shift_mm(const AppliedEffect& applied) const;

 private:
  /// Sigma of what is stated exactly, in mm: below every other number here.
  static constexpr double kKnownSigma = 1e-7;

  struct Entry {
    const Effect* effect;
    EffectSide side;
    bool usual = false;  ///< at its nominal places
    double norm = 0.0;   ///< of g
    VectorXd left;       ///< M g, measurement rows and prior rows
  };
  /// Candidate places at which a rival may set in: evenly over the range of the session.
  static std::vector<std::vector<double>> place_choices(const Effect& effect, std::size_t visits);

  void add_entries(const Effect& effect, EffectSide side);

  Entry entry(const AppliedEffect& applied) const;

  const Entry& usual(const Effect& effect, EffectSide side) const;

  Machine stated_;
  std::vector<model::Visit> visits_;
  std::vector<Matrix2d> whitening_;  ///< inverse Cholesky factors of C_i
  std::vector<Matrix2d> length_by_xy_;
  MatrixXd settings_basis_;  ///< orthonormal columns that span J_s
  std::vector<Entry> entries_;
};

}  // namespace chaintrue::grid::synthetic
