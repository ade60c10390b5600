// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A hanging two-chain router: one struct for each part, with the names of a chaintrue_machine file, and
/// the stated uncertainties. Data only; the equilibrium is in kinematics.hpp.
///
/// \code
///   Machine machine;                      // the classic Maslow on a ten-foot beam
///   machine.sled.mass_kg = 10.2;
///   for (const MachineProblem& p : problems_of(machine)) say(p.parameter, p.value, p.expected);
/// \endcode
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "model/controllers/controller.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::model {

namespace effects {
struct Effect;
}

struct Bed {
  double width_mm = 2438.4;
  double height_mm = 1219.2;
};

/// Where the axis of a motor's sprocket is, in the bed's frame.
struct MotorPosition {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

struct Sprocket {
  int teeth = 10;
  double pitch_mm = 6.35;
  /// Radius of the chain line, for the tangent and the wrap; absent: pitch * teeth / (2 pi).
  std::optional<double> radius_mm;
  /// The radius in force.
  double effective_radius_mm() const;
};

/// Which way the chain leaves the sprocket: over its top, with the slack hanging down, or off its
/// bottom.
enum class Feed { over_top, off_bottom };

/// Ring or linkage: both chains point at the bit; the chain ends at this distance from it.
struct Ring {
  double radius_mm = 139.1;
};

/// Two brackets, `spacing_mm` apart and `height_mm` above the bit; the sled rotates about the bit.
struct Brackets {
  double spacing_mm = 310.0;
  double height_mm = 139.0;
  double cg_below_bit_mm = 79.0;
};

using Attachment = std::variant<Ring, Brackets>;

struct Chain {
  double mass_kg_per_m = 0.14;
  /// Strain per newton of tension, on unstretched length; 0: inextensible.
  double compliance_per_n = 5.17e-6;
};

struct Sled {
  double mass_kg = 11.6;
};

struct Frame {
  double tilt_from_vertical_deg = 15.0;
};

/// One sigma of each taped dimension.
struct Uncertainty {
  double motor_position_mm = 3.0;
  double chain_zero_mm = 1.0;
  double ring_radius_mm = 1.0;
};

/// An effect that acts on this machine, from the catalogue (chains/chain_effects.cpp) or declared
/// for it.
struct AppliedEffect {
  std::string effect;
  /// "left", "right", "both", "x", "y" or "" where the effect has no side.
  std::string side;
  std::map<std::string, double> parameters;
  /// Probability that it acts, if a diagnosis added it; empty if it was stated.
  std::optional<double> probability = std::nullopt;
};

struct Machine {
  std::string name = "classic Maslow";
  Bed bed;
  PerSide<MotorPosition> motors{{-1489.2, 1072.6}, {1489.2, 1072.6}};
  Sprocket sprocket;
  Feed feed = Feed::over_top;
  Attachment attachment = Ring{};
  Chain chain;
  /// Added to every reading.
  ChainLengths chain_zero;
  Sled sled;
  Frame frame;
  Uncertainty uncertainty;
  /// The controller's firmware and settings.
  Controller controller;
  std::vector<AppliedEffect> effects;
  /// Effects declared in files, which may act on this machine in addition to those of the catalogue
  /// (effects/declared_effect.hpp). They live as long as the program.
  std::vector<const effects::Effect*> declared;
};

/// One reason why a machine is invalid.
struct MachineProblem {
  /// JSON pointer below the machine, such as "/sled/mass_kg".
  std::string parameter;
  std::string value;
  std::string expected;
};

/// \throws std::invalid_argument with the first of them, if there is one.
void require_none(const std::vector<MachineProblem>& problems);

/// All problems at once; empty when the machine is valid. Ranges are wide (any real hanging router
/// passes), so that a value outside is a mistake in units or typing: inches for mm, grams for kg,
/// motors below the bed.
[[nodiscard]] std::vector<MachineProblem> problems_of(const Machine& machine);

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::AppliedEffect;
using model::Bed;
using model::Feed;
using model::Machine;
using model::MachineProblem;
using model::Ring;
}  // namespace chaintrue
