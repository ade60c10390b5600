// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map on the machine as diagnosed: named causes enter the machine of the fit if they improve the
/// map; otherwise the map is plain. A wrong name must not make a map worse. A cause enters if
///   - its probability is at least kSureOfCause,
///   - it cannot be on the paper instead (a tape error shared by all marks does not show at
///   left-out marks), unless the links or the tape were read, or the owner stated that it is the
///   chain,
///   - points in blocks of the bed that neither map was fitted to come out better with it, by more
///     than the standard error of the difference, the surfaces of both maps included, and do so as
///     well where each block's naming is repeated without it (held_out_improvement.hpp).
///
///   d_b = sum over block b of (|e_plain|^2 - |e|^2),  n_b points,  B blocks,  D = sum d_b / sum n_b
///   se^2 = B / (B - 1) sum (d_b - n_b D)^2 / (sum n_b)^2                                        (1)
///
/// (1) is the standard error of a ratio of two sums over clusters: W. Cochran, Sampling Techniques
/// (1977), equation 6.13. Effects of the visit are taken out of the readings under the same rule.
///
/// A cause that may act and does not enter is part of the expected error, and so is the size of one
/// that does. With f_i the map on cause i of probability p_i, f the map that is given, f_0 the plain
/// one and s the largest sigma of a cause in f over its size, the covariance of the lengths grows by
///
///   V = sum p_i d_i d_i' + s^2 d_0 d_0' + sum d_k d_k' / 4,
///       d_i = f_i - f,  d_0 = f - f_0,  d_k = f_h - f_l, of all places together                   (2)
///
/// A step's or a bend's place is known to the gap between two marks. The map has the mean of such a cause over
/// the places where it may stand, evenly within sqrt(3) sigmas of the likeliest: a single place that is wrong
/// is worse there than a surface without a step. f_l and f_h put it one sigma to either side.
///
/// The sum is the variance between models: J. Hoeting et al., Bayesian model averaging: a tutorial,
/// Statistical Science 14 (1999) 382, equation 3.
///
/// \code
///   const auto found = fit_with_causes(measured);
///   if (found) use(found->fit.map, found->built_on);   // built_on is empty: the plain map
/// \endcode
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/map/joint_fit.hpp"

namespace chaintrue::grid::diagnosis {

struct Naming;

/// Least probability of a cause that may enter a map.
inline constexpr double kSureOfCause = 0.9;

struct CausesFitOptions {
  JointFitOptions fit;
  /// Chain or paper, which no points distinguish: the owner states that it is the chain.
  bool accept_class = false;
  std::uint64_t seed = 1;
};

/// A cause that was named and is not in the map.
struct OfferedCause {
  enum class Reason {
    not_sure,       ///< below kSureOfCause
    may_be_paper,   ///< a reading of the link's pitch or of the tape decides
    is_paper,       ///< the marks themselves are off
    gains_nothing,  ///< it does not improve the map at left-out points
  };
  Cause cause;
  Reason reason;
};

/// Error of the tool at points in blocks of the bed that were left out, rms, mm, including their
/// noise.
struct HeldOutBlocksError {
  double plain_mm = 0.0;
  double with_causes_mm = 0.0;
};

struct CausesFit {
  JointFit fit;
  std::vector<Cause> built_on;  ///< empty: the plain map
  std::vector<OfferedCause> offered;
  std::optional<HeldOutBlocksError> held_out;  ///< where causes were tried in a map
  /// Rms of (2) at the tool over the measured part, mm; zero if it is too small to be known, and nothing is added.
  double left_open_mm = 0.0;
  /// Why no cause could be tried; empty if it was.
  std::string not_weighed;
};

/// Fails where joint_fit() fails on the machine as stated.
[[nodiscard]] tl::expected<CausesFit, FitFailure> fit_with_causes(
    const Measured& measured, const CausesFitOptions& options = {});
/// The same, given the named causes and the plain map. `naming_helps` is asked at most once:
/// whether naming_improves_the_map().
CausesFit fit_on_causes(const Measured& measured, const Naming& naming, JointFit plain,
                        const CausesFitOptions& options, const std::function<bool()>& naming_helps);

/// Sentences for the owner: what the map is built on and what is offered.
std::vector<std::string> in_words(const CausesFit& fit);

/// A cause as in a machine file.
AppliedEffect applied(const Cause& cause);
/// The same with its size divided among its possible places; a single one if its place is certain,
/// or if no step or bend depends on it.
std::vector<AppliedEffect> applied_over_places(const Cause& cause);

}  // namespace chaintrue::grid::diagnosis
