// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// pen_friction: the pen rubs on the wall and holds the gondola back.
///   F  force, N
///   d  of each cord
///
///   f -= F (d_left - d_right) / 2,   p += F (d_left + d_right) / 2                          (1)
///
/// A gondola that moves down is held up.
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::pen_friction_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "force_n",
    .symbol = "F",
    .meaning = "force of the pen against the move",
    .nominal = 0.2,
    .lower = 0.0,
    .upper = 5.0,
    .prior_sigma = 0.2,
}};

// (1)
void alter(Statics& m, EffectSide /*side*/, const CordVisit& visit, Values values) {
  const double right = 0.5 * (visit.direction.left - visit.direction.right);
  const double down = 0.5 * (visit.direction.left + visit.direction.right);
  m.side_n -= values[0] * right;
  m.lift_n += values[0] * down;
}

}  // namespace

extern constinit const PlotterEffect pen_friction{
    .described =
        {
            .id = "pen_friction",
            .station = effects::Station::machine,
            .sides = effects::kNoSide,
            .parameters = kParameters,
            .cause = "the pen is pressed on too hard, or the wall is rough, for so light a gondola",
            .signature = "the same line lies elsewhere when it is drawn from the other end",
            .equation = "force F against the move",
            .source = "Coulomb friction",
            .not_modelled = "a force that grows with the pull to the wall",
            .typical = "0.1 to 0.5 N",
            .needs = effects::DataNeed::order,
            .remedy_kind = effects::RemedyKind::change_the_machine,
            .remedy = "press the pen less, or add weight to the gondola",
        },
    .alter = alter,
};

}  // namespace chaintrue::model::plotter::pen_friction_effect
