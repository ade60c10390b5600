// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chain lengths for many points at once: the elastic equilibrium of a ring sled, several points to
/// an instruction: four where the processor has AVX2, chosen when the program runs, else two. Built
/// with clang, the version for every x86-64 alone. The bytes are the same.
///
/// Three Newton steps for every point; what has not settled by then, or is no pose, goes through
/// the scalar inverse, so that answers and failures are the scalar's. Lengths agree with
/// Kinematics::inverse to 2e-11 mm.
///
/// \code
///   const BatchInverse batch(equilibrium_parameters(machine));
///   std::vector<BatchInverse::Result> lengths(points.size());
///   batch.lengths(points, lengths);
/// \endcode
#pragma once

#include <memory>
#include <span>

#include "model/equilibrium.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {

/// Const, stateless and thread safe; lengths() neither allocates nor throws on matching spans.
class BatchInverse {
 public:
  using Result = tl::expected<ChainLengths, PoseFailure>;

  /// \throws std::invalid_argument as make_kinematics, and for brackets.
  explicit BatchInverse(const EquilibriumParameters& parameters);
  /// \throws std::invalid_argument where the spans differ in size.
  void lengths(std::span<const BedPoint> points, std::span<Result> results) const;

 private:
  EquilibriumConstants m_;
  std::unique_ptr<const Kinematics> scalar_;
};

}  // namespace chaintrue::model
