// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/belts/belt_effects.hpp"

#include <cmath>

#include "model/belts/belt_machine.hpp"
#include "model/effects/notation.hpp"

namespace chaintrue::model::belts {

using namespace effects;  // NOLINT(google-build-using-namespace): the words of the table

// machine: moving all four anchors alike moves the whole frame and changes no length
constinit const Effect anchor_moved{
    .id = "anchor_moved",
    .sides = kOneBeltOrAll,
    .parameters = {size("distance_mm", "d", "how far the anchor moved", 3.0, 0.0, 100.0),
                   place("direction_rad", "a", "direction, from x towards y", 0.0, -3.2, 3.2, 1.8),
                   first_visit()},
    .cause = "an anchor slipped or its screw came loose while the machine measured",
    .signature =
        "from one visit on, one belt disagrees with the others, most where it points along the "
        "slip",
    .equation = "anchor + d (cos a, sin a) for n >= m",
    .source = "geometry",
    .not_modelled = "an anchor that creeps; use drift for it",
    .typical = "1 to 10 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy = "fasten that anchor and let the machine find its anchors again",
    .alter_anchor =
        [](Anchor& anchor, int order, Values v) {
          if (order < v[2]) return;
          anchor.x_mm += v[0] * std::cos(v[1]);
          anchor.y_mm += v[0] * std::sin(v[1]);
        },
    // An anchor that slips by just a tooth along its belt is rarer than a belt that skips, and as rare as a
    // belt that slips where it is clamped, which looks nearly the same.
    .share = 0.01,
};

constinit const Effect anchor_height{
    .id = "anchor_height",
    .sides = kOneBelt,
    .parameters = {size("offset_mm", "h", "height of the anchor above its setting", 20.0, -300.0,
                        300.0)},
    .cause =
        "an anchor's height differs from its setting, or the arms are mounted in a different order",
    .signature = "one belt reads long where it is short",
    .equation = "z + h",
    .source = "kinematics: L^2 = B^2 + c^2",
    .not_modelled = "a sled that tilts on uneven heights",
    .typical = "10 to 40 mm",
    .remedy = "measure the anchors' heights over the bed and enter them (tlZ, trZ, blZ, brZ)",
    .alter_anchor = [](Anchor& anchor, int, Values v) { anchor.z_mm += v[0]; },
};

// belt: T of belt_statics.hpp; belts that hold carry the reaction of those that are pulled
constinit const Effect belt_stretch{
    .id = "belt_stretch",
    .station = Station::chain,
    .parameters = {size("elongation", "e", "stretch of a belt at the pull of the motors", 0.002,
                        0.0, 0.03)},
    .cause = "belts, anchors or arms stretch under tension, in proportion to the belt's length",
    .signature =
        "belts read short in proportion to tension and length; the frame comes out some "
        "millimetres too small at the bottom",
    .equation =
        "- e T L, T the belt's tension over the pull of the first pass: 1 for a pulled belt, from "
        "the balance of forces for a holding one",
    .source =
        "four owners' sets: 0.13 to 0.26 %; tension test: 0.1 to 0.15 %; MaslowCNC/Maslow_4 pull "
        "1060: EA = 178,900 N",
    .not_modelled = "the sled's friction on the sheet; a weight other than 0.3 of the pull",
    .typical = "0.1 to 0.3 %",
    .remedy =
        "reduce the calibration current (Maslow_Calibration_Current_Threshold), or fit the stretch "
        "together with the anchors",
    .add = [](const LengthState& belt, Values v) { return -v[0] * belt.tension * belt.length_mm; },
    .by_tension = true,
    // All four published frames yield under the pull. Three of them discriminate between stretching
    // belts and yielding anchors by factors of 1000 and more; the fourth does not.
    .expected = 0.8,
};

constinit const Effect anchor_flex{
    .id = "anchor_flex",
    .station = Station::chain,
    .parameters = {size("give_mm", "g",
                        "movement of an anchor towards the tool at the pull of the motors", 1.0,
                        0.0, 20.0)},
    .cause = "anchors, arms or the frame yield under the belts' tension",
    .signature = "belts read short in proportion to tension, whatever their length",
    .equation =
        "- g T, T the belt's tension over the pull of the first pass: 1 for a pulled belt, from "
        "the balance of forces for a holding one",
    .source = "a cantilever bends in proportion to its load",
    .not_modelled = "anchors that yield unequally or sideways; the sled's friction on the sheet",
    .typical = "0.5 to 2 mm",
    .remedy_kind = RemedyKind::repair,
    .remedy = "brace the frame and the anchors; reduce the calibration current",
    .add = [](const LengthState& belt, Values v) { return -v[0] * belt.tension; },
    .by_tension = true,
    .expected = 0.2,  // see belt_stretch
};

constinit const Effect belt_scale{
    .id = "belt_scale",
    .station = Station::chain,
    .sides = kOneBeltOrAll,
    .parameters = {size("scale", "s", "relative excess of belt per turn", 0.002, -0.05, 0.05)},
    .cause = "one belt is worn, of a different make, or runs on a different pulley",
    .signature =
        "one belt reads short or long in proportion to its length; an error of all four changes "
        "the size of frame and cuts, and no reading shows it",
    .equation = "L / (1 + s)",
    .source = "an encoder turn is 43.975 mm of belt in the firmware, the same for all four",
    .not_modelled = "a scale common to all four, which only a taped distance shows",
    .typical = "0.1 to 0.3 %",
    .remedy_kind = RemedyKind::repair,
    .remedy = "inspect that belt's pulley and teeth, or replace the belt",
    .add = [](const LengthState& belt,
              Values v) { return belt.length_mm / (1.0 + v[0]) - belt.length_mm; },
};

constinit const Effect belt_zero{
    .id = "belt_zero",
    .station = Station::chain,
    .sides = kOneBeltOrAll,
    .parameters = {size("offset_mm", "z", "excess of every reading", 2.0, -500.0, 500.0, 3.0)},
    .cause =
        "a belt was not fully retracted before counting; for all four, the arm or extension "
        "setting is wrong",
    .signature =
        "one belt is off by the same amount everywhere; for all four, the frame is too large or "
        "small and the four lengths never quite meet",
    .equation = "+ z",
    .source = "kinematics: arm and extension are added to every belt",
    .not_modelled = "an arm that deflects under load",
    .typical = "1 to 5 mm; 153.4 mm if lengths exclude arm and extension",
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "retract and extend all belts again; measure arm and extension and enter them; check what "
        "the lengths in the file include",
    .add = [](const LengthState&, Values v) { return Number(v[0]); },
};

constinit const Effect tooth_skip{
    .id = "tooth_skip",
    .station = Station::chain,
    .sides = kOneBelt,
    .parameters = {whole(size("teeth", "k", "teeth, positive if too much is read", 1.0, -110.0,
                              110.0, 3.0)),
                   first_visit()},
    .cause = "a belt skipped teeth of its pulley, or its encoder lost turns",
    .signature = "from one visit on, one belt is off by a whole number of teeth",
    .equation = "+ k turn / 22 for n >= m",
    .source = "MaslowCNC/Maslow_4: 43.975 mm of belt per encoder turn, 2 mm teeth",
    .not_modelled = "a second skip; add another effect",
    .typical = "1 tooth, 2.0 mm; a turn, 44 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "look for a worn belt or a loose encoder magnet; retract and extend all belts and measure "
        "again",
    .add = teeth_skipped,
    .share = 0.3,
};

constinit const Effect drift{
    .id = "drift",
    .station = Station::chain,
    .sides = kOneBeltOrAll,
    .parameters = {size("rate_mm_per_visit", "d", "growth of readings per visit", 0.03, -1.0, 1.0)},
    .cause = "a belt, an anchor or the frame crept while the machine measured",
    .signature = "the last places disagree with the first ones",
    .equation = "+ d n",
    .source = "belts pull at the frame throughout the measurement",
    .not_modelled = "drift that levels off, pauses between visits",
    .typical = "0.01 to 0.05 mm a visit",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy = "let the frame stand under tension before measuring, and measure again",
    .add = drifted,
};

constinit const Effect zero_shift{
    .id = "zero_shift",
    .station = Station::chain,
    .sides = kOneBelt,
    // The prior of belt_zero: a belt that is retracted again, or slips in its clamp, shifts by
    // millimetres.
    .parameters = {size("shift_mm", "z", "excess of each later reading", 2.0, -500.0, 500.0, 3.0),
                   first_visit()},
    .cause = "the zero of a belt moved while the machine measured",
    .signature =
        "from one visit on, one belt is off by the same amount, which need not be whole teeth",
    .equation = "+ z for n >= m",
    .source = "a belt that was retracted again, or slips in its clamp",
    .not_modelled = "a second shift; add another effect",
    .typical = "1 to 10 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::repair,
    .remedy =
        "check the belt's clamp and its retraction; retract and extend all belts and measure again",
    .add = zero_shifted,
    // Changes during a session are rare, and most of them are skips.
    .share = 0.01,
};

EffectTable belt_effects() {
  static constexpr const Effect* kEffects[] = {&anchor_moved, &anchor_height, &belt_stretch,
                                               &anchor_flex,  &belt_scale,    &belt_zero,
                                               &tooth_skip,   &drift,         &zero_shift};
  return kEffects;
}

}  // namespace chaintrue::model::belts
