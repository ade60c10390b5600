// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Chain lengths for a point and the point for chain lengths: the interface of every kinematics,
/// and the pose that they return.
///
/// Lengths here are physical: unstretched chain past 12 o'clock, without the machine's chain_zero
/// and without effects at the chain or at the reading (added by reading_model.hpp).
///
/// \code
///   const auto kinematics = make_kinematics(equilibrium_parameters(machine), Model::elastic);
///   const auto pose = kinematics->inverse({100.0, -200.0});
///   if (!pose) fmt::print("{}\n", pose.error().sentence());
///   else fmt::print("{} {}\n", pose->lengths.left_mm, pose->lengths.right_mm);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string_view>
#include <tl/expected.hpp>

#include "model/coordinates.hpp"
#include "model/dual.hpp"
#include "model/failure.hpp"
#include "model/machine.hpp"

namespace chaintrue::model {

/// The parameters of the equilibrium.
struct EquilibriumParameters {
  PerSide<MotorPosition> motors;
  double sprocket_radius_mm = 0.0;
  Feed feed = Feed::over_top;
  Attachment attachment = Ring{};
  /// Weight of the sled and of a millimetre of chain: the components in the sheet's plane.
  double sled_weight_n = 0.0;
  double chain_weight_n_per_mm = 0.0;
  double chain_compliance_per_n = 0.0;
  /// Angle of the frame from the vertical; used by Model::elastic_3d only.
  double tilt_rad = 0.0;
  /// Each motor's axis moves along its chain's pull, towards the sled, by this times the tension
  /// there (beam_flex).
  double beam_flexibility_mm_per_n = 0.0;
  /// H_left - H_right: a hose or cord that pulls the sled towards +x (side_pull).
  double side_force_n = 0.0;
  /// The firmware's sag factor in 1e-12 / mm^2 (Model::firmware); 1e12 (lambda/m)^2/24 unless the
  /// machine states it.
  double sag_correction = 0.0;
};

EquilibriumParameters equilibrium_parameters(const Machine& machine);

/// Models of a chain, from crudest to finest.
enum class Model { straight, wrap, firmware, one_shot, inextensible, elastic, elastic_3d };

/// Reasons why there is no pose.
enum class PoseReason {
  outside_verticals,  ///< outside the vertical through a sprocket's tangent: no equilibrium exists
  above_sprockets,    ///< at or above the line between the sprockets
  link_does_not_fit,  ///< the ring or bracket is longer than the distance to the sprocket
  slack,              ///< a chain would be in compression, or hangs slack
  too_short,          ///< the chains are too short to meet
  not_converged,      ///< the iteration did not converge
};

MechanismReason named(PoseReason reason);
using PoseFailure = Failure<PoseReason>;

/// One chain in equilibrium. s = 0 is the sled's end.
struct ChainState {
  double horizontal_n = 0.0;  ///< H, constant along the chain
  /// V, upward pull on the sled; negative: the chain hangs below its end.
  double vertical_at_sled_n = 0.0;
  double out_of_sheet_n = 0.0;     ///< N, pull off the sheet at the sled; Model::elastic_3d only
  double tension_at_sled_n = 0.0;  ///< T(0)
  double tension_at_sprocket_n = 0.0;  ///< T(S)
  double angle_rad = 0.0;       ///< phi, below the horizontal where the chain leaves the sprocket
  double free_length_mm = 0.0;  ///< S, unstretched
  double wrap_mm = 0.0;         ///< chain on the sprocket past 12 o'clock
};

struct Pose {
  BedPoint position;
  ChainLengths lengths;
  double sled_rotation_rad = 0.0;  ///< brackets only
  PerSide<ChainState> chains;
  int iterations = 0;
};

using PoseResult = tl::expected<Pose, PoseFailure>;

/// Parameters of the lengths' derivatives.
enum class Parameter {
  motor_left_x_mm,
  motor_left_y_mm,
  motor_right_x_mm,
  motor_right_y_mm,
  ring_radius_mm,
  sprocket_radius_mm,
  sled_weight_n,
  chain_weight_n_per_mm,
  chain_compliance_per_n,
  beam_flexibility_mm_per_n,
  side_force_n,
};
inline constexpr std::size_t kParameters = static_cast<std::size_t>(Parameter::side_force_n) + 1;

/// A chain at a pose, with exact derivatives; what effects of its length depend on.
template <int N>
struct ChainNumbers {
  Dual<N> length_mm, angle_rad, free_length_mm, tension_at_sprocket_n, horizontal_n;
};

/// Stateless and thread safe; the hot path neither allocates nor throws.
class Kinematics {
 public:
  virtual ~Kinematics() = default;
  [[nodiscard]] virtual PoseResult inverse(BedPoint point) const = 0;
  [[nodiscard]] virtual PoseResult forward(ChainLengths lengths) const = 0;
  /// At a pose returned by this object, with derivatives by x and y.
  virtual PerSide<ChainNumbers<2>> by_place(const Pose& pose) const = 0;
  /// With derivatives by the parameter at fixed (x, y).
  virtual PerSide<ChainNumbers<1>> by_parameter(const Pose& pose, Parameter parameter) const = 0;
  /// d(left, right)/d(x, y)
  virtual Eigen::Matrix2d jacobian(const Pose& pose) const;
};

/// \throws std::invalid_argument if a parameter is not finite or out of its range, with its name
/// and value.
std::unique_ptr<const Kinematics> make_kinematics(const EquilibriumParameters& parameters,
                                                  Model model = Model::elastic);

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::Model;
}  // namespace chaintrue
