// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every mechanism that the laws of mechanisms and of their effects are tried on: two chains, four belts, V-plotters
/// of three kinds, and a toy that exists only here.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "model/belts/belt_mechanism.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "model/reading_model.hpp"
#include "tests/contracts/declared_examples.hpp"
#include "tests/contracts/toy_mechanism.hpp"
#include "tests/support/belt_frame.hpp"

namespace chaintrue::model::contract {

using MechanismPtr = std::shared_ptr<const Mechanism>;

/// A mechanism, its mirror image, the position of the mirror's line, and the correspondence between
/// the lengths of the image and its own.
struct Tested {
  std::string name;
  std::function<MechanismPtr()> make;
  std::function<MechanismPtr()> mirrored;
  double mirror_x_mm;  ///< x of the image = this less x
  std::vector<Eigen::Index> mirrored_length;
};

inline void PrintTo(const Tested& tested, std::ostream* out) { *out << tested.name; }

/// A machine without symmetry, with effects that its owner declared.
inline Machine leaning() {
  Machine machine;
  machine.declared = effects::declared_examples();
  machine.motors.left = {-1480.0, 1075.0};
  machine.motors.right = {1495.0, 1068.0};
  machine.chain_zero = {1.5, -0.5};
  return machine;
}

inline Machine leaning_mirrored() {
  Machine machine = leaning();
  std::swap(machine.motors.left, machine.motors.right);
  machine.motors.left.x_mm *= -1.0;
  machine.motors.right.x_mm *= -1.0;
  std::swap(machine.chain_zero.left_mm, machine.chain_zero.right_mm);
  return machine;
}

inline constexpr double kFrameWidthMm = 2953.2;  // of testing_support::stated()

inline BeltMachine four_belts_mirrored(BeltLengths lengths) {
  BeltMachine machine = testing_support::stated(lengths);
  std::swap(machine.anchors.tl, machine.anchors.tr);
  std::swap(machine.anchors.bl, machine.anchors.br);
  for (const Belt belt : kBelts)
    machine.anchors[belt].x_mm = kFrameWidthMm - machine.anchors[belt].x_mm;
  return machine;
}

/// A pen on cords from the wall, a bot with its motors in it, and a light body on heavy cords.
inline std::vector<PlotterMachine> plotters() {
  PlotterMachine point;
  point.name = "point";
  point.pin_rise_mm = 4.5;
  point.pulley_radius_mm = 9.55;
  point.zero_mm = {3.0, -2.0};
  point.cord = {.mass_kg_per_m = 0.008, .compliance_per_n = 2e-5};
  PlotterMachine bot = mural(1500.0);
  bot.pin_rise_mm = -6.0;
  bot.gondola.pen_right_mm = 3.0;
  bot.scale_mm_per_m = {2.0, -1.0};
  PlotterMachine light;
  light.name = "light";
  light.pin_spacing_mm = 2000.0;
  light.feed = Feed::off_bottom;
  light.pulley_radius_mm = 14.0;
  light.gondola = {.spacing_mm = 60.0, .pen_below_mm = 35.0, .mass_below_mm = 55.0, .mass_kg = 0.4};
  light.cord = {.mass_kg_per_m = 0.012, .compliance_per_n = 1e-4};
  light.area = {-600.0, 600.0, -500.0, -1500.0};
  return {point, bot, light};
}

inline PlotterMachine mirrored(PlotterMachine machine) {
  machine.pin_rise_mm *= -1.0;
  machine.gondola.pen_right_mm *= -1.0;
  machine.gondola.mass_right_mm *= -1.0;
  std::swap(machine.zero_mm.left_mm, machine.zero_mm.right_mm);
  std::swap(machine.scale_mm_per_m.left_mm, machine.scale_mm_per_m.right_mm);
  return machine;
}

inline Machine on_brackets(Machine machine) {
  machine.attachment = Brackets{};
  return machine;
}

inline std::vector<Tested> every_mechanism() {
  std::vector<Tested> all;
  for (const PlotterMachine& machine : plotters()) {
    all.push_back({"plotter_" + machine.name,
                   [machine] { return make_plotter_mechanism(machine); },
                   [machine] { return make_plotter_mechanism(mirrored(machine)); },
                   0.0,
                   {1, 0}});
  }
  all.push_back({"chains",
                 [] { return make_chain_mechanism(leaning()); },
                 [] { return make_chain_mechanism(leaning_mirrored()); },
                 0.0,
                 {1, 0}});
  all.push_back({"chains_to_brackets",
                 [] { return make_chain_mechanism(on_brackets(leaning())); },
                 [] { return make_chain_mechanism(on_brackets(leaning_mirrored())); },
                 0.0,
                 {1, 0}});
  for (const BeltLengths lengths :
       {BeltLengths::belt, BeltLengths::belt_and_arm, BeltLengths::span}) {
    all.push_back(
        {"belts_" + std::string(name(lengths)),
         [lengths] { return make_belt_mechanism(testing_support::stated(lengths), 20.0); },
         [lengths] { return make_belt_mechanism(four_belts_mirrored(lengths), 20.0); },
         kFrameWidthMm,
         {1, 0, 3, 2}});
  }
  all.push_back({"toy",
                 [] { return std::make_shared<const ToyMechanism>(-1000.0, 1200.0); },
                 [] { return std::make_shared<const ToyMechanism>(-1200.0, 1000.0); },
                 0.0,
                 {1, 0, 2}});
  return all;
}

/// A mechanism with one more effect, or with none.
struct WithEffect {
  std::string words;
  MechanismPtr mechanism;
};

/// The visit at which effects set in with their nominal values.
inline constexpr int kNominalVisit = 10;

/// Where and when the laws are tried, and with which effects.
class EveryMechanism : public testing::TestWithParam<Tested> {
 protected:
  std::vector<ToolPosition> positions(const Mechanism& mechanism) const {
    const MechanismExtent e = mechanism.extent();
    std::vector<ToolPosition> all;
    for (const double y : {0.05, 0.37, 0.61, 0.93}) {
      for (const double x : {0.04, 0.29, 0.52, 0.71, 0.96}) {
        all.push_back({e.x_min_mm + x * (e.x_max_mm - e.x_min_mm),
                       e.y_min_mm + y * (e.y_max_mm - e.y_min_mm)});
      }
    }
    return all;
  }
  /// The first visit; the one at which effects of one visit act; a later one for which a length was
  /// taken in, and one at which a length was pulled.
  std::vector<MechanismVisit> visits(const Mechanism& mechanism) const {
    const std::size_t n = mechanism.lengths().size();
    std::vector<double> taken_in(n, 1.0);
    std::vector<bool> pulled(n, false);
    taken_in.front() = -1.0;
    pulled.back() = true;
    return {{}, {kNominalVisit, {}, {}}, {40, taken_in, {}}, {41, {}, pulled}};
  }
  /// Those that the mechanism can have.
  static std::vector<AppliedEffect> effects_at(
      const Mechanism& mechanism,
      const std::function<double(const effects::EffectParameter&)>& of) {
    std::vector<AppliedEffect> all;
    for (const effects::Effect* effect : mechanism.effects()) {
      std::vector<double> values;
      for (const effects::EffectParameter& p : effect->parameters) values.push_back(of(p));
      for (const effects::EffectSide side : effect->sides) {
        const AppliedEffect applied = effects::applied(*effect, side, values);
        if (mechanism.problems_of_effects({applied}).empty()) all.push_back(applied);
      }
    }
    return all;
  }
  static std::vector<AppliedEffect> nominal_effects(const Mechanism& mechanism) {
    return effects_at(mechanism, [](const auto& p) { return p.nominal; });
  }
  static std::vector<AppliedEffect> null_effects(const Mechanism& mechanism) {
    return effects_at(mechanism, [](const auto& p) {
      return p.role == effects::ParameterRole::size ? p.null : p.nominal;
    });
  }
  /// Without an effect, and with each at its nominal values.
  static std::vector<WithEffect> in_every_state(const MechanismPtr& mechanism) {
    std::vector<WithEffect> all = {{"without effects", mechanism}};
    for (const AppliedEffect& effect : nominal_effects(*mechanism))
      all.push_back({effect.effect + ":" + effect.side, mechanism->with_effects({effect})});
    return all;
  }
};

}  // namespace chaintrue::model::contract
