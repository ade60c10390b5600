// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The interface of a hanging machine: parameters with priors, effects that may act, lengths for a
/// position of the tool and the position for lengths.
///
/// Notation
///   q       position of the tool in the mechanism's own frame                       2, mm
///   v       visit: its number, how each length was reached, which were pulled
///   theta   parameters                                                              p of them
///   f       lengths as read                                                         n of them, mm
///
///   f = f(q, v; theta, effects)                                                     (1)
///
/// A Mechanism holds values of theta and effects; with_values() and with_effects() return another
/// one. Every implementation is immutable and thread safe. The contract is tested in
/// tests/contracts/mechanism_contract_test.cpp.
///
/// \code
///   const auto mechanism = make_chain_mechanism(machine);     // or make_belt_mechanism(belts)
///   const auto at = mechanism->predict({100.0, -200.0}, {});
///   if (!at) say(at.error().sentence());
///   else use(at->lengths_mm, at->by_position, at->by_parameter);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "model/effects/effect_table.hpp"
#include "model/failure.hpp"
#include "model/machine.hpp"
#include "model/mechanism_change.hpp"

namespace chaintrue::model {

/// In the mechanism's own frame: the bed's for two chains, the anchors' for four belts.
struct ToolPosition {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

/// A parameter that can be calibrated.
struct MechanismParameter {
  std::string_view name;         ///< ends in its unit; as in files and messages
  std::string_view unit;         ///< "mm"; empty for a number without a unit
  std::optional<double> stated;  ///< empty: not stated
  /// Prior sigma of the stated value; empty: no prior.
  std::optional<double> prior_sigma;
  /// Set when the machine is zeroed again.
  bool set_by_zeroing = false;
};

/// How the tool came to a position. Vectors have an entry for each length, or none.
struct MechanismVisit {
  int order = 0;  ///< the visit's number
  /// +1 if the length was paid out to get there, -1 if it was taken in; empty: paid out.
  std::vector<double> direction = {};
  /// Whether a motor pulled its length tight at the reading while others held; empty: none did.
  std::vector<bool> pulled = {};
  /// Its force over the pull that sizes of effects refer to.
  double pull = 1.0;
};

/// (1) and its derivatives. n lengths, p parameters.
struct LengthsPrediction {
  Eigen::VectorXd lengths_mm;
  Eigen::MatrixX2d by_position;  ///< n x 2, mm per mm
  /// n x p, mm per unit of the parameter; n x 0 unless requested.
  Eigen::MatrixXd by_parameter;
};

/// Why there are no lengths at a position, or no position for lengths; each mechanism defines its
/// reasons.
using MechanismFailure = Failure<MechanismReason>;
[[nodiscard]] MechanismFailure mechanism_failure(NamedReason auto reason) { return named(reason); }
template <NamedReason Reason>
[[nodiscard]] MechanismFailure mechanism_failure(const Failure<Reason>& failure) {
  return named(failure.reason);
}

/// Positions that may be sampled: the bed, or the inside of a frame.
struct MechanismExtent {
  double x_min_mm = 0.0;
  double x_max_mm = 0.0;
  double y_min_mm = 0.0;
  double y_max_mm = 0.0;
  ToolPosition centre() const { return {0.5 * (x_min_mm + x_max_mm), 0.5 * (y_min_mm + y_max_mm)}; }
};

/// A point of the mechanism itself at which a tape may end: an anchor, a nail.
struct FixedPoint {
  std::string_view name;
  ToolPosition at;
  Eigen::Matrix2Xd by_parameter;  ///< 2 x p
};

/// True millimetres over those of the mechanism's own frame, as a tape finds them.
struct FrameScale {
  double factor = 1.0;
  Eigen::RowVectorXd by_parameter;  ///< p
};

enum class Derivatives { by_position, by_position_and_parameter };

class Mechanism {
 public:
  virtual ~Mechanism() = default;

  /// Identifier: "chains", "belts".
  virtual std::string_view kind() const = 0;
  /// Words for its lengths, in the order of every vector of lengths: left, right. The first two place
  /// the tool: they are what a controller pays out for a command.
  virtual std::span<const std::string_view> lengths() const = 0;
  virtual std::span<const MechanismParameter> parameters() const = 0;
  /// theta, in the order of parameters(); 0 if not stated.
  virtual const Eigen::VectorXd& values() const = 0;
  /// Positions at which predict() succeeds for a valid mechanism.
  virtual MechanismExtent extent() const = 0;

  /// The same mechanism with other values of its parameters. Stated values and priors are kept.
  /// \throws std::invalid_argument for values that are not valid, with the first reason.
  [[nodiscard]] virtual std::shared_ptr<const Mechanism> with_values(
      const Eigen::VectorXd& values) const = 0;

  /// The effects that may act, in the order in which they act.
  virtual std::span<const effects::Effect* const> effects() const = 0;
  /// Why it cannot have these effects, each with its place ("/effects/0/side"); empty if it can.
  [[nodiscard]] virtual std::vector<MachineProblem> problems_of_effects(
      const std::vector<AppliedEffect>& applied) const = 0;
  /// With these effects in addition to those it has. \throws std::invalid_argument for effects with
  /// problems.
  [[nodiscard]] virtual std::shared_ptr<const Mechanism> with_effects(
      const std::vector<AppliedEffect>& applied) const = 0;

  /// (1). Derivatives are those of f at this visit.
  [[nodiscard]] virtual tl::expected<LengthsPrediction, MechanismFailure> predict(
      const ToolPosition& position, const MechanismVisit& visit,
      Derivatives wanted = Derivatives::by_position_and_parameter) const = 0;
  /// The position of the tool when these lengths are read at a visit: the inverse of predict(),
  /// 1e-9 mm. For more than two lengths the position with the least sum of squared residuals.
  [[nodiscard]] virtual tl::expected<ToolPosition, MechanismFailure> locate(
      const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const = 0;
  /// The first two lengths of predict(), of a machine at rest: without a visit.
  [[nodiscard]] virtual tl::expected<ChainLengths, MechanismFailure> first_lengths(
      const ToolPosition& position) const;
  /// Where the tool is when these are the first two: the inverse of first_lengths(), 1e-9 mm.
  [[nodiscard]] virtual tl::expected<ToolPosition, MechanismFailure> locate_by_first(
      ChainLengths lengths) const;
  /// Where a tape may end besides the tool's positions; none by default.
  virtual std::vector<FixedPoint> fixed_points() const { return {}; }
  /// One by default: its lengths are read in true millimetres.
  virtual FrameScale frame_scale() const {
    return {1.0, Eigen::RowVectorXd::Zero(values().size())};
  }
  /// The true position of the mark with these numbers: effects of the paper are removed.
  virtual ToolPosition place_of_mark(const ToolPosition& written) const { return written; }
  /// What may have changed since it was calibrated. By default: all parameters that zeroing sets,
  /// or one of them, or one of the others.
  virtual std::vector<MechanismChange> possible_changes() const;
};

/// Base of this library's mechanisms. It holds values, parameters and effects; a derived class
/// implements how a copy with others is made.
class MechanismBase : public Mechanism {
 public:
  std::string_view kind() const final { return kind_; }
  std::span<const std::string_view> lengths() const final { return lengths_; }
  std::span<const MechanismParameter> parameters() const final { return parameters_; }
  const Eigen::VectorXd& values() const final { return values_; }
  std::span<const effects::Effect* const> effects() const final { return effects_; }
  /// \throws std::invalid_argument also for values that are not finite, or too few or too many.
  [[nodiscard]] std::shared_ptr<const Mechanism> with_values(
      const Eigen::VectorXd& values) const final;
  [[nodiscard]] std::shared_ptr<const Mechanism> with_effects(
      const std::vector<AppliedEffect>& applied) const final;
  [[nodiscard]] std::vector<MachineProblem> problems_of_effects(
      const std::vector<AppliedEffect>& applied) const override;

 protected:
  /// `kind` and `lengths` live as long as the program.
  MechanismBase(std::string_view kind, std::span<const std::string_view> lengths,
                effects::EffectTable effects, std::vector<MechanismParameter> parameters,
                Eigen::VectorXd values, std::vector<AppliedEffect> applied)
      : kind_(kind),
        lengths_(lengths),
        effects_(effects.begin(), effects.end()),
        parameters_(std::move(parameters)),
        values_(std::move(values)),
        applied_(std::move(applied)) {}
  /// The same mechanism with these values and these effects alone.
  virtual std::shared_ptr<const Mechanism> rebuild(const Eigen::VectorXd& values,
                                                   std::vector<AppliedEffect> applied) const = 0;
  virtual bool has(effects::Part /*part*/) const { return true; }
  const std::vector<MechanismParameter>& stated() const { return parameters_; }
  const std::vector<AppliedEffect>& applied() const { return applied_; }
  /// \throws std::invalid_argument for lengths that are not as many as lengths().
  void require_all(const Eigen::VectorXd& lengths_mm) const;

 private:
  std::string_view kind_;
  std::span<const std::string_view> lengths_;
  std::vector<const effects::Effect*> effects_;
  std::vector<MechanismParameter> parameters_;
  Eigen::VectorXd values_;
  std::vector<AppliedEffect> applied_;
};

/// One sigma of the movement of a parameter without prior knowledge, in its unit.
inline constexpr double kParameterShiftSigma = 5.0;

/// (1) at other values of the parameters.
[[nodiscard]] tl::expected<LengthsPrediction, MechanismFailure> predict(
    const Mechanism& mechanism, const ToolPosition& position, const MechanismVisit& visit,
    const Eigen::VectorXd& values);

/// What an effect adds to the lengths at the mark with these numbers, mm: lengths with it less
/// lengths without it.
[[nodiscard]] tl::expected<Eigen::VectorXd, MechanismFailure> added_by(const Mechanism& mechanism,
                                                                       const AppliedEffect& effect,
                                                                       const ToolPosition& mark,
                                                                       const MechanismVisit& visit);

/// locate() for a mechanism without a closed form: Gauss-Newton from `start`, halving steps that
/// leave the domain. `counting` selects the lengths that are read, at least two; empty: all. Fails
/// with "not_converged" after 50 steps.
[[nodiscard]] tl::expected<ToolPosition, MechanismFailure> locate_by_newton(
    const Mechanism& mechanism, const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit,
    const ToolPosition& start, const std::vector<bool>& counting = {});

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::Mechanism;
using model::ToolPosition;
}  // namespace chaintrue
