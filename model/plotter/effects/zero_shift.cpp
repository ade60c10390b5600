// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// zero_shift: the zero of a cord moves once, by any amount.
///   z  shift, mm
///   m  first visit after it
///
///   added = z for n >= m                                                                    (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::zero_shift_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "shift_mm",
        .symbol = "z",
        .meaning = "how much too much is counted from then on",
        .nominal = 2.0,
        .lower = -500.0,
        .upper = 500.0,
        .prior_sigma = 3.0,
    },
    kFirstVisit};

// (1)
Number add(const CordState<Number>& /*cord*/, const CordVisit& visit, Values values) {
  return visit.order >= values[1] ? values[0] : 0.0;
}

}  // namespace

extern constinit const PlotterEffect zero_shift{
    .described =
        {
            .id = "zero_shift",
            .station = effects::Station::chain,
            .sides = effects::kOneChain,
            .parameters = kParameters,
            .cause = "a cord slipped in its clamp or on its pulley while the machine drew",
            .signature = "from one line on, all are shifted and bent",
            .equation = "+ z for n >= m",
            .source = "a clamp that gives",
            .not_modelled = "a second shift; give it as an effect of its own",
            .typical = "1 to 10 mm",
            .needs = effects::DataNeed::order,
            .remedy_kind = effects::RemedyKind::repair,
            .remedy = "look where the cord is clamped; set the zeros and draw again",
        },
    .add = add,
};

}  // namespace chaintrue::model::plotter::zero_shift_effect
