// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_effects.hpp"

#include <numbers>

#include "model/effects/notation.hpp"
#include "model/plotter/plotter_equations.hpp"

namespace chaintrue::model::plotter {
namespace {

using namespace effects;  // NOLINT(google-build-using-namespace): the words of the table

/// An offset of one of the machine's numbers.
template <double Statics::*kNumber>
void adds_to(Statics& m, EffectSide, const PerSide<double>&, Values v) {
  m.*kNumber += v[0];
}

// machine

constexpr Effect pen_off_centre{
    .id = "pen_off_centre",
    .parameters = {mirrored(
        size("offset_mm", "o", "distance of the pen right of its setting", 5.0, -200.0, 200.0))},
    .cause = "the pen is not in the middle of the gondola",
    .signature =
        "verticals lean and horizontals bow near the sides, in opposite directions left and right",
    .equation = "pen_right + o",
    .source = "a point of a rigid body turns with it",
    .not_modelled = "a pen that wobbles in its holder",
    .typical = "1 to 10 mm",
    .remedy = "centre the pen between the cords, or enter its offset",
    .alter_cords = adds_to<&Statics::pen_right_mm>,
    .part = Part::body,
};

constexpr Effect servo_arm{
    .id = "servo_arm",
    .parameters = {mirrored(size("offset_mm", "o",
                                 "distance of the centre of mass right of its setting", 4.0, -200.0,
                                 200.0))},
    .cause = "the servo's arm, a battery or a cable moves the gondola's centre of mass to one side",
    .signature =
        "the gondola hangs tilted in the middle of the wall, and the drawing leans to one side",
    .equation = "mass_right + o",
    .source = "moments about the middle between the cords",
    .not_modelled = "an arm that moves the mass while it draws",
    .typical = "1 to 10 mm",
    .remedy = "balance the gondola until it hangs level in the middle, with the pen down",
    .alter_cords = adds_to<&Statics::mass_right_mm>,
    .part = Part::body,
};

constexpr Effect gondola_width{
    .id = "gondola_width",
    .parameters = {size("offset_mm", "w", "true minus set distance", 2.0, -50.0, 50.0)},
    .cause = "the gondola's pulleys or eyelets are farther apart than set",
    .signature = "like an error of the pin spacing, reduced by the gondola's tilt",
    .equation = "spacing + w",
    .source = "statics of a body on two cords",
    .not_modelled = "pulleys at different heights in the gondola",
    .typical = "1 to 3 mm",
    .remedy = "measure between the axles of the pulleys and enter it",
    .alter_cords = adds_to<&Statics::spacing_mm>,
    .part = Part::body,
};

constexpr Effect standoff{
    .id = "standoff",
    .parameters = {size("offset_mm", "d", "true minus set distance from the wall", 10.0, -100.0,
                        100.0)},
    .cause = "pins or the gondola's pulleys are closer to the wall or farther from it than set",
    .signature =
        "short cords are more in error than long ones: the top of the drawing is stretched",
    .equation = "standoff + d",
    .source = "geometry: a cord that slants to the wall",
    .not_modelled = "pins of different depths",
    .typical = "5 to 20 mm",
    .remedy = "measure the distances of pins and pulleys from the wall and enter the difference",
    .alter_cords = adds_to<&Statics::standoff_mm>,
};

constexpr Effect gondola_mass{
    .id = "gondola_mass",
    .parameters = {size("relative", "g", "relative excess of its mass", -0.4, -0.9, 9.0)},
    .cause = "the gondola is too light to keep its cords straight, or heavier than set",
    .signature =
        "long, heavy cords sag, so horizontals bow at the sides; with elastic cords the drawing is "
        "taller at the bottom",
    .equation = "W (1 + g)",
    .source = "elastic catenary",
    .not_modelled = "cords that stay curled",
    .typical = "20 to 50 %",
    .remedy = "weigh the gondola and enter it; add weight until the cords hang straight",
    .alter_cords = [](Statics& m, EffectSide, const PerSide<double>&,
                      Values v) { m.weight_n *= 1.0 + v[0]; },
};

constexpr Effect pen_friction{
    .id = "pen_friction",
    .parameters = {size("force_n", "F", "friction force of the pen", 0.2, 0.0, 5.0)},
    .cause = "the pen is pressed on too hard, or the wall is rough, for so light a gondola",
    .signature = "a line drawn from the other end is displaced",
    .equation = "force F against the motion",
    .source = "Coulomb friction",
    .not_modelled = "a force that grows with the pressure on the wall",
    .typical = "0.1 to 0.5 N",
    .needs = DataNeed::order,
    .remedy = "press the pen less, or add weight to the gondola",
    // A gondola that moves down is held up.
    .alter_cords =
        [](Statics& m, EffectSide, const PerSide<double>& direction, Values v) {
          m.side_n -= 0.5 * v[0] * (direction.left - direction.right);
          m.lift_n += 0.5 * v[0] * (direction.left + direction.right);
        },
};

constexpr Effect cord_stretch{
    .id = "cord_stretch",
    .sides = kAnyChain,
    .parameters = {size("compliance_per_n", "c", "additional relative stretch per newton", 2e-4,
                        0.0, 0.01)},
    .cause = "cords or belts stretch under the gondola more than set",
    .signature =
        "the pen hangs low where its cords are long or under high tension: horizontals bow at the "
        "top, and the bottom is low",
    .equation = "S (1 + (compliance + c) T)",
    .source = "Hooke; nikivanov/mural sets 5e-5 per N",
    .not_modelled = "creep",
    .typical = "1e-4 to 5e-4 per N",
    .remedy = "use glass-fibre belts, or enter their stretch",
    .alter_cords =
        [](Statics& m, EffectSide side, const PerSide<double>&, Values v) {
          for (const Side own : kSides)
            if (acts_on(side, own)) m.cord[own].compliance_per_n += v[0];
        },
};

constexpr Effect cord_weight{
    .id = "cord_weight",
    .sides = kAnyChain,
    .parameters = {size("more_g_per_m", "m", "additional mass per metre", 8.0, 0.0, 200.0)},
    .cause = "a cord, chain or belt weighs more than set and sags",
    .signature = "horizontals sag at the sides, where one cord is long and slack",
    .equation = "catenary of w + m",
    .source = "elastic catenary (Irvine)",
    .not_modelled = "a cable tied to a cord in places",
    .typical = "5 to 10 g/m",
    .remedy = "weigh a length and enter it, or use a lighter cord or a heavier gondola",
    .alter_cords =
        [](Statics& m, EffectSide side, const PerSide<double>&, Values v) {
          constexpr double kNewtonPerMmOfGramPerM = 9.80665e-6;
          for (const Side own : kSides)
            if (acts_on(side, own)) m.cord[own].weight_n_per_mm += v[0] * kNewtonPerMmOfGramPerM;
        },
};

// cord

constexpr Effect spool_eccentricity{
    .id = "spool_eccentricity",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = {size("amplitude_mm", "a", "distance of its centre from its axis", 0.2, 0.0,
                        10.0),
                   place("phase_rad", "p", "phase at length 0", 0.0, -6.3, 6.3, 3.2)},
    .cause = "a pulley or spool is bored off its centre, or its shaft is bent",
    .signature = "a wave along every line, repeating with each turn of one pulley",
    .equation = "+ a sin(2 pi L / u + p)",
    .source = "run-out of a wheel, first harmonic",
    .not_modelled = "the second harmonic, below a^2 / r",
    .typical = "0.1 to 0.5 mm",
    .remedy_kind = RemedyKind::repair,
    .remedy = "replace the pulley; no setting can correct it",
    .add =
        [](const LengthState& cord, Values v) {
          return v[0] * sin(2.0 * std::numbers::pi / cord.turn_mm * cord.length_mm + v[1]);
        },
    .part = Part::pulley,
};

constexpr Effect spool_layers{
    .id = "spool_layers",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("growth_mm_per_m2", "b",
                        "excess counted for the second metre over the first", 5.0, 0.0, 500.0)},
    .cause = "the cord winds in layers on its spool, whose diameter shrinks as it pays out",
    .signature = "the drawing shrinks towards the bottom, and verticals lean towards the spool",
    .equation = "+ b L^2 / 2",
    .source =
        "length of an Archimedean spiral; RepRapFirmware HangprinterKinematics.cpp uses the same "
        "as a root of L",
    .not_modelled = "the step from one layer to the next",
    .typical = "2 to 20 mm/m^2",
    .remedy_kind = RemedyKind::repair,
    .remedy = "wind the cord side by side in one layer, or use a toothed belt on a pulley",
    .add =
        [](const LengthState& cord, Values v) {
          const auto metres = 1e-3 * cord.length_mm;
          return 0.5 * v[0] * metres * metres;
        },
};

constexpr Effect tooth_skip{
    .id = "tooth_skip",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = {whole(size("teeth", "k", "teeth, positive if too much is counted", 1.0, -200.0,
                              200.0, 3.0)),
                   first_visit()},
    .cause = "a belt skipped teeth of its pulley, or a motor lost steps",
    .signature = "all lines after one are shifted and bent",
    .equation = "+ k p for n >= m",
    .source = "GT2 belts have 2 mm teeth",
    .not_modelled = "a second skip; add another effect",
    .typical = "1 or 2 teeth, 2 or 4 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy = "draw more slowly, tighten the belt on its pulley, set the zeros and draw again",
    .add = teeth_skipped,
};

constexpr Effect zero_shift{
    .id = "zero_shift",
    .station = Station::chain,
    .sides = kOneChain,
    .parameters = {size("shift_mm", "z", "excess counted from then on", 2.0, -500.0, 500.0, 3.0),
                   first_visit()},
    .cause = "a cord slipped in its clamp or on its pulley while the machine drew",
    .signature = "all lines after one are shifted and bent",
    .equation = "+ z for n >= m",
    .source = "a slipping clamp",
    .not_modelled = "a second shift; add another effect",
    .typical = "1 to 10 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy = "check the cord's clamp; set the zeros and draw again",
    .add = zero_shifted,
};

constexpr Effect drift{
    .id = "drift",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("rate_mm_per_visit", "d", "growth of the excess per visit", 0.03, -1.0,
                        1.0)},
    .cause = "a cord creeps, or slips a little with each move",
    .signature = "the last lines do not meet the first",
    .equation = "+ d n",
    .source = "plastic cords creep under load",
    .not_modelled = "a drift that levels off",
    .typical = "0.01 to 0.05 mm a visit",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy = "let the gondola hang for an hour before drawing; use glass-fibre belts",
    .add = drifted,
};

constexpr const Effect* kEffects[] = {
    &pen_off_centre, &servo_arm,    &gondola_width, &standoff,           &gondola_mass,
    &pen_friction,   &cord_stretch, &cord_weight,   &spool_eccentricity, &spool_layers,
    &tooth_skip,     &zero_shift,   &drift};

}  // namespace

effects::EffectTable plotter_effects() { return kEffects; }

}  // namespace chaintrue::model::plotter
