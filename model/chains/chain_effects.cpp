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
    .parameters = {size("scale", "s", "written distance over true distance, less one", 0.0005, -0.05,
                        0.05)},
    .cause = "the tape or the printed sheet that set out the marks is long or short",
    .signature = "errors grow evenly from the bed's centre outwards, along x, along y or both",
    .equation = "x_written = x (1 + s); y_written = y (1 + s)",
    .source =
        "EU directive 2014/32/EU annex X: a class II tape may err by 0.3 mm + 0.2 mm per metre",
    .not_modelled = "a scale that differs along the tape, or a tape that sags between the marks",
    .typical = "0.05 %, 0.5 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "check the tape against a second one over the whole bed and correct the marks; leave the "
        "machine as it is",
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
    .sides = kNoSide,
    .parameters = {mirrored(size("angle_rad", "g",
                                 "angle by which the marks' y axis leans, towards -x for a positive angle",
                                 0.001, -0.05, 0.05))},
    .cause = "the axes drawn for the marks are not square to each other",
    .signature =
        "the upper marks are off to one side, the lower ones to the other, in proportion to y",
    .equation = "x_written = x + y g",
    .source = "geometry of an oblique frame, first order in g (g^2/2 is 0.3 um over the bed)",
    .not_modelled = "bent or kinked axes",
    .typical = "1 mrad, 1 mm on a metre",
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "compare the two diagonals of the marks and correct the marks; leave the machine as it is",
    .write =
        [](MarkPoint mark, EffectSide, Values v) {
          return MarkPoint{mark.x_mm + mark.y_mm * v[0], mark.y_mm};
        },
};

// machine

constexpr Effect ring_radius{
    .id = "ring_radius",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("offset_mm", "d", "true ring radius less the file's", 1.0, -50.0, 50.0)},
    .cause = "the ring or linkage is larger or smaller than the machine file says",
    .signature =
        "like both chain zeros off together; only the sag in the lower corners tells them apart",
    .equation = "rho = rho_stated + d",
    .source = "MaslowCNC forum reports 138.14 and 139.82 mm where 139.1 mm is set",
    .not_modelled = "a ring that is not round, carriages with play",
    .typical = "1 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "measure the ring from the bit to the chain's pin and enter that radius",
    .alter =
        [](EquilibriumParameters& p, Values v) {
          if (auto* ring = std::get_if<Ring>(&p.attachment)) ring->radius_mm += v[0];
        },
    .part = Part::ring,
};

constexpr Effect sled_width{
    .id = "sled_width",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("offset_mm", "w", "true distance between the brackets less the file's",
                        5.0, -200.0, 200.0)},
    .cause =
        "the brackets of the sled are farther apart or nearer together than the machine file says",
    .signature =
        "both chains too short or too long by nearly the same, most along the top, where they lie "
        "flat",
    .equation = "spacing = spacing_stated + w",
    .source = "statics of a sled on two brackets, which turns about the bit",
    .not_modelled = "brackets that stand at different heights or distances from the bit",
    .typical = "2 to 15 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "measure between the points where the chains hold the brackets and enter it (sledwidth)",
    .alter = adds_to_brackets<&Brackets::spacing_mm>,
    .part = Part::brackets,
};

constexpr Effect sled_height{
    .id = "sled_height",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("offset_mm", "h", "true height of the brackets over the bit less the file's",
                        5.0, -200.0, 200.0)},
    .cause =
        "the brackets of the sled are higher or lower over the bit than the machine file says",
    .signature =
        "the whole bed shifted up or down, a little less where the sled tilts, in the lower corners",
    .equation = "height = height_stated + h",
    .source = "statics of a sled on two brackets, which turns about the bit",
    .not_modelled = "brackets that stand at different heights or distances from the bit",
    .typical = "2 to 10 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "measure from the bit up to the line between the brackets and enter it (sledheight)",
    .alter = adds_to_brackets<&Brackets::height_mm>,
    .part = Part::brackets,
};

constexpr Effect sled_cg{
    .id = "sled_cg",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("offset_mm", "g",
                        "how much farther below the bit the centre of gravity is than the file says",
                        10.0, -500.0, 500.0)},
    .cause = "the sled's centre of gravity is higher or lower than the machine file says",
    .signature =
        "the sled tilts more or less at the sides: nothing on the middle line, opposite errors left and "
        "right of it",
    .equation = "cg = cg_stated + g",
    .source = "statics of a sled on two brackets, which turns about the bit",
    .not_modelled = "brackets that stand at different heights or distances from the bit",
    .typical = "5 to 30 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "balance the sled on an edge, measure from there to the bit and enter it (sledcg)",
    .alter = adds_to_brackets<&Brackets::cg_below_bit_mm>,
    .part = Part::brackets,
};

constexpr Effect sprocket_radius{
    .id = "sprocket_radius",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("offset_mm", "d", "true radius of the chain line less the file's", 0.17,
                        -3.0, 3.0)},
    .cause = "the chain lies on the sprockets at another radius than the machine file says",
    .signature = "a few tenths of a millimetre in the wrap; the chain zeros take nearly all of it",
    .equation = "r = r_stated + d, for tangent and wrap",
    .source =
        "10 teeth of 6.35 mm: 10.106 mm from the circumference, 10.274 mm as the pitch circle p / "
        "(2 sin(pi / z)); both are argued for",
    .not_modelled = "what one turn pays out: that is teeth times pitch, whatever the radius",
    .typical = "0.17 mm",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "enter the radius in the machine file",
    .alter = adds_to<&EquilibriumParameters::sprocket_radius_mm>,
};

constexpr Effect chain_sag{
    .id = "chain_sag",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("relative_weight", "q", "true chain mass over the file's, less one", 0.3,
                        -0.95, 5.0)},
    .cause =
        "the chain's mass per metre is not what the machine file says, so it sags more or less",
    .signature =
        "up to millimetres in the lower corners, where one chain is long and slack; little "
        "elsewhere",
    .equation = "w = w_stated (1 + q) in the elastic catenary",
    .source =
        "statics of the two chains, docs/physics; chain masses from 0.125 to 0.141 kg/m are met",
    .not_modelled = "dirt or oil that gathers on part of a chain",
    .typical = "30 %",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "weigh a metre of chain and enter its mass",
    .alter = [](EquilibriumParameters& p, Values v) { p.chain_weight_n_per_mm *= 1.0 + v[0]; },
};

constexpr Effect chain_stretch{
    .id = "chain_stretch",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("compliance_per_n", "k", "compliance added to the machine's own", 6e-6, 0.0,
                        1e-4)},
    .cause = "the chain gives more under tension than the machine file says",
    .signature = "the tool hangs low, most at the top centre, where both chains pull hardest",
    .equation = "c = c_stated + k; stretched length = S + integral of c T ds",
    .source =
        "MaslowCNC Firmware $45 5.1685e-6 /N; Tsubaki RS25: 2.6 mm/m at 640 N gives 4.1e-6 /N",
    .not_modelled = "creep, and a chain that stretches unevenly",
    .typical = "4e-6 to 8e-6 per N: 1 mm on 3 m at 60 N",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "put the compliance into the machine file",
    .alter = adds_to<&EquilibriumParameters::chain_compliance_per_n>,
};

constexpr Effect beam_flex{
    .id = "beam_flex",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {size("flexibility_mm_per_n", "k",
                        "how far a motor's axis moves along its chain's pull, per newton", 0.01, 0.0,
                        0.1)},
    .cause = "the top beam or its brackets give under the pull of the chains",
    .signature =
        "the tool hangs low and the bed shrinks towards the top centre, where tension is highest",
    .equation = "motor axis = as set + k T_i (unit vector along the chain, towards the sled)",
    .source = "MaslowCNC GroundControl PR 558: motor spacing 2990 mm free, 2980 mm under load",
    .not_modelled =
        "a beam that gives differently along its length, in its plane and across; the other "
        "chain's pull on this motor",
    .typical = "0.003 to 0.02 mm/N: 0.5 to 3 mm at the bed's top",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy = "brace the beam, or put its flexibility into the machine file",
    // Solved together with the equilibrium.
    .alter = adds_to<&EquilibriumParameters::beam_flexibility_mm_per_n>,
};

constexpr Effect side_pull{
    .id = "side_pull",
    .station = Station::machine,
    .sides = kNoSide,
    .parameters = {mirrored(size("force_n", "f", "force on the sled towards +x", 3.0, -10.0, 10.0))},
    .cause = "a hose or a cord pulls the sled to one side",
    .signature =
        "one chain hangs slacker than its mirror image, most in the lower corner it pulls towards",
    .equation = "H_left - H_right = f",
    .source = "horizontal balance of the sled",
    .not_modelled = "a pull that changes with the sled's place, as a hose from a fixed hook does",
    .typical = "1 to 5 N, the weight of 100 to 500 g",
    .remedy_kind = RemedyKind::repair,
    .remedy = "hang the hose and the cord from a boom so that they pull straight up or not at all",
    .alter = adds_to<&EquilibriumParameters::side_force_n>,
};

// chain

constexpr Effect direction_hysteresis{
    .id = "direction_hysteresis",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("half_width_mm", "b",
                        "half of the difference between arriving with chain paid out and with chain taken in",
                        0.35, 0.0, 5.0)},
    .cause = "friction, a ring that sticks and slips, or play in a gearbox",
    .signature = "the same place reads differently when it is reached from the other side",
    .equation = "+ b sign(change of that chain's length since the previous visit)",
    .source = "Coulomb friction and backlash, both of constant width",
    .not_modelled = "a width that grows with tension, and small moves inside the play",
    .typical = "0.2 to 0.5 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::compensate_on_its_own,
    .remedy =
        "grease the ring and take up the play, or compensate it along the path's direction; it is "
        "taken out of the readings that a map is made of",
    .add = [](const LengthState& chain, Values v) { return Number(chain.direction * v[0]); },
    .by_direction = true,
};

constexpr Effect chain_pitch_error{
    .id = "chain_pitch_error",
    .station = Station::chain,
    .sides = kAnyChain,
    .parameters = {size("elongation", "e", "true length of a link over the nominal pitch, less one",
                        0.001, -0.05, 0.05)},
    .cause = "the chain's links are worn or were never of the right length",
    .signature = "an error in proportion to the length of one chain, or of both",
    .equation = "L / (1 + e)",
    .source =
        "MaslowCNC GroundControl, left and right chain tolerance; worn roller chain is changed at "
        "2 to 3 %",
    .not_modelled = "wear of the part that runs over the sprocket most",
    .typical = "0.05 to 0.15 %: 1.5 to 4.5 mm on 3 m",
    .remedy_kind = RemedyKind::change_the_machine,
    .remedy =
        "measure 100 links under load and put the elongation into the machine file, or change the "
        "chain",
    // The reading model divides once, by the sum of all.
    .elongation = [](Values v) { return v[0]; },
};

// reading

constexpr Effect drift{
    .id = "drift",
    .station = Station::reading,
    .sides = kAnyChain,
    .parameters = {size("rate_mm_per_visit", "d", "what a reading gains with each visit", 0.03, -1.0,
                        1.0)},
    .cause = "the machine warmed up or the chain crept while the points were measured",
    .signature =
        "the last points disagree with the first ones; a second visit of the first point shows it",
    .equation = "+ d n",
    .source = "steel grows 12e-6 per K: 3 m of chain by 0.36 mm over 10 K",
    .not_modelled = "a drift that levels off, and pauses between visits",
    .typical = "0.01 to 0.05 mm per visit",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy =
        "let the machine hang loaded and warm before measuring, revisit the first point at the "
        "end; the readings are corrected",
    .add = drifted,
};

constexpr Effect tooth_skip{
    .id = "tooth_skip",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = {whole(size("links", "k", "whole links, positive where too many are read", 1.0,
                              -20.0, 20.0)),
                   first_visit("number of the first visit after the skip")},
    .cause = "the chain jumped over teeth of a sprocket during the measurement",
    .signature = "from one visit on, one chain is off by a whole number of links",
    .equation = "+ pitch k for n >= m",
    .source = "a roller chain that skips does so by whole teeth",
    .not_modelled = "a second skip back; give it as an effect of its own",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "look for a slack chain at the sprocket, set the chain to 12 o'clock again; the readings "
        "after the skip are corrected",
    .add = teeth_skipped,
};

constexpr Effect link_miscount{
    .id = "link_miscount",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = {whole(size("links", "k", "whole links, positive where too many are read", 1.0,
                              -20.0, 20.0)),
                   visit("visit", "number of the visit")},
    .cause = "the links were miscounted at one visit",
    .signature = "one point alone is off along one chain by a whole number of links",
    .equation = "+ pitch k at visit m alone",
    .source = "counting by hand",
    .not_modelled = "a reading wrong by other than whole links: a bad point",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy = "read that point again; its reading is corrected or left out",
    .add =
        [](const LengthState& chain, Values v) {
          return Number(chain.order == v[1] ? chain.tooth_mm * v[0] : 0.0);
        },
    .at_one_visit = true,
};

constexpr Effect zero_shift{
    .id = "zero_shift",
    .station = Station::reading,
    .sides = kOneChain,
    // Half a link: a sprocket that turns on its shaft, or a zero set by eye, stops anywhere between
    // two teeth.
    .parameters = {size("shift_mm", "z", "how much too long each later reading is", 3.0, -130.0,
                        130.0),
                   first_visit("number of the first visit after the shift")},
    .cause = "the zero of a chain moved during the measurement",
    .signature =
        "from one visit on, one chain is off by the same amount, which need not be whole links",
    .equation = "+ z for n >= m",
    .source = "a sprocket slips on its shaft when its grub screw is loose; a zero set again midway",
    .not_modelled = "a second shift; give it as an effect of its own",
    .typical = "1 to 10 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "check the sprocket's grub screw and set the chain to 12 o'clock again: a map is of the "
        "chain as it hung before the shift",
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
