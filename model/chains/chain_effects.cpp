// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue of effects of two chains, in the order in which they act; those with a law that needs
/// a derivation stand in effects/<id>.cpp.
#include <variant>

#include "model/effects/catalogue.hpp"
#include "model/effects/notation.hpp"

namespace chaintrue::model::effects {

extern const Effect chain_plane_offset;
extern const Effect sprocket_eccentricity;
extern const Effect angular_kink;

namespace {

/// An offset of one of the equilibrium's numbers.
template <double EquilibriumParameters::*kNumber>
void adds_to(EquilibriumParameters& p, Values v) {
  p.*kNumber += v[0];
}
/// Precondition: Part::brackets.
template <double Brackets::*kNumber>
void adds_to_brackets(EquilibriumParameters& p, Values v) {
  std::get<Brackets>(p.attachment).*kNumber += v[0];
}

// paper

constexpr Effect tape_scale{
    .id = "tape_scale",
    .station = Station::paper,
    .sides = kPaperAxes,
    .parameters = {size("scale", "s", "written over true distance, minus one", 0.0005, -0.05,
                        0.05)},
    .cause = "the tape or the printed sheet used to place the marks is too long or too short",
    .signature = "errors grow evenly from the bed's centre outwards, along x, along y or both",
    .equation = "x_written = x (1 + s); y_written = y (1 + s)",
    .source =
        "EU directive 2014/32/EU annex X: a class II tape may err by 0.3 mm + 0.2 mm per metre",
    .not_modelled = "a scale that varies along the tape, a sagging tape",
    .typical = "0.05 %, 0.5 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy = "compare the tape with a second one and correct the marks; do not change the machine",
    .write =
        [](MarkPoint mark, EffectSide side, Values v) {
          const double factor = 1.0 + v[0];
          return MarkPoint{side == EffectSide::y ? mark.x_mm : mark.x_mm * factor,
                           side == EffectSide::x ? mark.y_mm : mark.y_mm * factor};
        },
};

constexpr Effect axes_skew{
    .id = "axes_skew",
    .station = Station::paper,
    .parameters = {mirrored(size("angle_rad", "g", "lean of the marks' y axis, positive towards -x",
                                 0.001, -0.05, 0.05))},
    .cause = "the marks' axes are not square",
    .signature = "upper marks are off to one side, lower ones to the other, in proportion to y",
    .equation = "x_written = x + y g",
    .source = "oblique frame, first order in g",
    .not_modelled = "bent or kinked axes",
    .typical = "1 mrad, 1 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "compare the two diagonals of the marks and correct the marks; do not change the machine",
    .write =
        [](MarkPoint mark, EffectSide, Values v) {
          return MarkPoint{mark.x_mm + mark.y_mm * v[0], mark.y_mm};
        },
};

// machine

constexpr Effect ring_radius{
    .id = "ring_radius",
    .parameters = {size("offset_mm", "d", "true radius minus the file's", 1.0, -50.0, 50.0)},
    .cause = "the ring or linkage is larger or smaller than in the machine file",
    .signature =
        "like an error of both chain zeros; only the sag in the lower corners distinguishes them",
    .equation = "rho = rho_stated + d",
    .source = "MaslowCNC forum: 138.14 and 139.82 mm measured, 139.1 mm set",
    .not_modelled = "an out-of-round ring, carriages with play",
    .typical = "1 mm",
    .remedy = "measure the ring from the bit to the chain's pin and enter that radius",
    .alter =
        [](EquilibriumParameters& p, Values v) {
          if (auto* ring = std::get_if<Ring>(&p.attachment)) ring->radius_mm += v[0];
        },
    .part = Part::ring,
};

constexpr Effect sled_width{
    .id = "sled_width",
    .parameters = {size("offset_mm", "w", "true distance minus the file's", 5.0, -200.0, 200.0)},
    .cause = "the sled's brackets are farther apart or closer together than in the machine file",
    .signature =
        "both chains are too short or too long by nearly the same amount, most along the top",
    .equation = "spacing = spacing_stated + w",
    .source = "statics of a sled on two brackets",
    .not_modelled = "brackets at different heights or distances from the bit",
    .typical = "2 to 15 mm",
    .remedy = "measure between the points where the chains are attached and enter it (sledwidth)",
    .alter = adds_to_brackets<&Brackets::spacing_mm>,
    .part = Part::brackets,
};

constexpr Effect sled_height{
    .id = "sled_height",
    .parameters = {size("offset_mm", "h", "true height minus the file's", 5.0, -200.0, 200.0)},
    .cause = "the sled's brackets are higher or lower than in the machine file",
    .signature =
        "the whole bed is shifted up or down, slightly less in the lower corners, where the sled "
        "tilts",
    .equation = "height = height_stated + h",
    .source = "statics of a sled on two brackets",
    .not_modelled = "brackets at different heights or distances from the bit",
    .typical = "2 to 10 mm",
    .remedy = "measure from the bit up to the line between the brackets and enter it (sledheight)",
    .alter = adds_to_brackets<&Brackets::height_mm>,
    .part = Part::brackets,
};

constexpr Effect sled_cg{
    .id = "sled_cg",
    .parameters = {size("offset_mm", "g", "true distance below the bit minus the file's", 10.0,
                        -500.0, 500.0)},
    .cause = "the sled's centre of gravity is higher or lower than in the machine file",
    .signature = "opposite errors on the left and right, none on the middle line",
    .equation = "cg = cg_stated + g",
    .source = "statics of a sled on two brackets",
    .not_modelled = "brackets at different heights or distances from the bit",
    .typical = "5 to 30 mm",
    .remedy =
        "balance the sled on an edge, measure from there to the bit and enter the distance "
        "(sledcg)",
    .alter = adds_to_brackets<&Brackets::cg_below_bit_mm>,
    .part = Part::brackets,
};

constexpr Effect sprocket_radius{
    .id = "sprocket_radius",
    .parameters = {size("offset_mm", "d", "true radius minus the file's", 0.17, -3.0, 3.0)},
    .cause = "the chain lies on the sprockets at a different radius than in the machine file",
    .signature = "a few tenths of a millimetre in the wrap, nearly all absorbed by the chain zeros",
    .equation = "r = r_stated + d, for tangent and wrap",
    .source =
        "10 teeth of 6.35 mm: 10.106 mm from the circumference, 10.274 mm as pitch circle; both "
        "are in use",
    .not_modelled = "the chain paid out by one turn, which is always teeth times pitch",
    .typical = "0.17 mm",
    .remedy = "enter the radius in the machine file",
    .alter = adds_to<&EquilibriumParameters::sprocket_radius_mm>,
};

constexpr Effect chain_sag{
    .id = "chain_sag",
    .parameters = {size("relative_weight", "q", "true chain mass over the file's, minus one", 0.3,
                        -0.95, 5.0)},
    .cause = "the chain is heavier or lighter than in the machine file, so it sags more or less",
    .signature = "up to millimetres in the lower corners, where one chain is long and slack",
    .equation = "w = w_stated (1 + q) in the elastic catenary",
    .source = "statics of two chains; masses of 0.125 to 0.141 kg/m are in use",
    .not_modelled = "dirt or oil on part of a chain",
    .typical = "30 %",
    .remedy = "weigh a metre of chain and enter its mass",
    .alter = [](EquilibriumParameters& p, Values v) { p.chain_weight_n_per_mm *= 1.0 + v[0]; },
};

constexpr Effect chain_stretch{
    .id = "chain_stretch",
    .parameters = {size("compliance_per_n", "k", "compliance beyond the file's", 6e-6, 0.0, 1e-4)},
    .cause = "the chain stretches more under tension than in the machine file",
    .signature = "the tool hangs low, most at the top centre, where tension is highest",
    .equation = "c = c_stated + k; stretched length = S + integral of c T ds",
    .source =
        "MaslowCNC Firmware $45 5.1685e-6 /N; Tsubaki RS25: 2.6 mm/m at 640 N gives 4.1e-6 /N",
    .not_modelled = "creep, uneven stretch",
    .typical = "4e-6 to 8e-6 per N: 1 mm on 3 m at 60 N",
    .remedy = "enter the compliance in the machine file",
    .alter = adds_to<&EquilibriumParameters::chain_compliance_per_n>,
};

constexpr Effect beam_flex{
    .id = "beam_flex",
    .parameters = {size("flexibility_mm_per_n", "k",
                        "movement of a motor's axis along its chain, per newton", 0.01, 0.0, 0.1)},
    .cause = "the top beam or its brackets bend under the tension of the chains",
    .signature = "the tool hangs low, and the bed shrinks towards the top centre",
    .equation = "motor axis = as set + k T_i (unit vector along the chain, towards the sled)",
    .source = "MaslowCNC GroundControl PR 558: motor spacing 2990 mm free, 2980 mm under load",
    .not_modelled =
        "stiffness that depends on place or direction; the effect of the other chain on this motor",
    .typical = "0.003 to 0.02 mm/N: 0.5 to 3 mm at the bed's top",
    .remedy = "brace the beam, or enter its flexibility in the machine file",
    // Solved together with the equilibrium.
    .alter = adds_to<&EquilibriumParameters::beam_flexibility_mm_per_n>,
};

constexpr Effect side_pull{
    .id = "side_pull",
    .parameters = {mirrored(
        size("force_n", "f", "force on the sled towards +x", 3.0, -10.0, 10.0))},
    .cause = "a hose or a cord pulls the sled to one side",
    .signature =
        "one chain is slacker than its mirror image, most in the lower corner towards the pull",
    .equation = "H_left - H_right = f",
    .source = "horizontal balance of the sled",
    .not_modelled = "a pull that depends on the sled's place",
    .typical = "1 to 5 N, the weight of 100 to 500 g",
    .remedy_kind = RemedyKind::repair,
    .remedy = "hang the hose and the cord from a boom so that they do not pull sideways",
    .alter = adds_to<&EquilibriumParameters::side_force_n>,
};

// chain

constexpr Effect direction_hysteresis{
    .id = "direction_hysteresis",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("half_width_mm", "b",
                        "half of the difference between paying out and taking in", 0.35, 0.0, 5.0)},
    .cause = "friction, a sticking ring, or play in a gearbox",
    .signature = "the same place reads differently when approached from the other side",
    .equation = "+ b sign(change of that chain's length since the previous visit)",
    .source = "Coulomb friction and backlash of constant width",
    .not_modelled = "a width that grows with tension, small moves within the play",
    .typical = "0.2 to 0.5 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "grease the ring and remove the play, or compensate it along the path; maps are made from "
        "readings corrected for it",
    .add = [](const LengthState& chain, Values v) { return Number(chain.direction * v[0]); },
    .by_direction = true,
};

constexpr Effect chain_pitch_error{
    .id = "chain_pitch_error",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("elongation", "e", "true over nominal pitch, minus one", 0.001, -0.05,
                        0.05)},
    .cause = "the chain's links are worn or were never of the right length",
    .signature = "an error in proportion to the length of a chain",
    .equation = "L / (1 + e)",
    .source = "GroundControl's chain tolerances; worn roller chain is replaced at 2 to 3 %",
    .not_modelled = "uneven wear along the chain",
    .typical = "0.05 to 0.15 %: 1.5 to 4.5 mm on 3 m",
    .remedy =
        "measure 100 links under load and enter the elongation in the machine file, or replace the "
        "chain",
    // The reading model divides once, by the sum of all.
    .elongation = [](Values v) { return v[0]; },
};

// reading

constexpr Effect drift{
    .id = "drift",
    .station = Station::reading,
    .sides = kAnyChain,
    .parameters = {size("rate_mm_per_visit", "d", "growth of readings per visit", 0.03, -1.0, 1.0)},
    .cause = "the machine warmed up or the chain crept while the points were measured",
    .signature =
        "the last points disagree with the first; a second visit to the first point shows it",
    .equation = "+ d n",
    .source = "thermal expansion of steel, 12e-6 per K: 0.36 mm for 3 m and 10 K",
    .not_modelled = "drift that levels off, pauses between visits",
    .typical = "0.01 to 0.05 mm per visit",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "let the machine hang loaded and warm up before measuring; the readings are corrected",
    .add = drifted,
};

constexpr Effect tooth_skip{
    .id = "tooth_skip",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = {whole(size("links", "k", "links, positive if too many are read", 1.0, -20.0,
                              20.0)),
                   first_visit("first visit after the skip")},
    .cause = "the chain skipped teeth of a sprocket during the measurement",
    .signature = "from one visit on, one chain is off by a whole number of links",
    .equation = "+ pitch k for n >= m",
    .source = "roller chains skip whole teeth",
    .not_modelled = "a second skip; add another effect",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "look for a slack chain at the sprocket and set the chain to 12 o'clock again; the "
        "readings after the skip are corrected",
    .add = teeth_skipped,
};

constexpr Effect link_miscount{
    .id = "link_miscount",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = {whole(size("links", "k", "links, positive if too many are read", 1.0, -20.0,
                              20.0)),
                   visit("visit", "number of the visit")},
    .cause = "the links were miscounted at one visit",
    .signature = "one point is off along one chain by a whole number of links",
    .equation = "+ pitch k at visit m alone",
    .source = "counting by hand",
    .not_modelled = "other reading errors, which are bad points",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy = "measure that point again; its reading is corrected or left out",
    .add = [](const LengthState& chain,
              Values v) { return Number(chain.order == v[1] ? chain.tooth_mm * v[0] : 0.0); },
    .at_one_visit = true,
};

constexpr Effect zero_shift{
    .id = "zero_shift",
    .station = Station::reading,
    .sides = kOneChain,
    // Half a link: a sprocket that turns on its shaft, or a zero set by eye, stops anywhere between
    // two teeth.
    .parameters = {size("shift_mm", "z", "excess of each later reading", 3.0, -130.0, 130.0),
                   first_visit("first visit after the shift")},
    .cause = "the zero of a chain moved during the measurement",
    .signature =
        "from one visit on, one chain is off by the same amount, which need not be whole links",
    .equation = "+ z for n >= m",
    .source = "a loose grub screw, or a zero that was set again midway",
    .not_modelled = "a second shift; add another effect",
    .typical = "1 to 10 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "check the sprocket's grub screw and set the chain to 12 o'clock again; maps hold for the "
        "zero before the shift",
    .add = zero_shifted,
};

constexpr const Effect* kCatalogue[] = {
    &tape_scale,
    &axes_skew,
    &ring_radius,
    &sled_width,
    &sled_height,
    &sled_cg,
    &sprocket_radius,
    &chain_sag,
    &chain_stretch,
    &beam_flex,
    &side_pull,
    &chain_plane_offset,
    &sprocket_eccentricity,
    &angular_kink,
    &direction_hysteresis,
    &chain_pitch_error,
    &drift,
    &tooth_skip,
    &link_miscount,
    &zero_shift,
};

}  // namespace

EffectTable catalogue() { return kCatalogue; }

}  // namespace chaintrue::model::effects
