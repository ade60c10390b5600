// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// tooth_skip: a belt jumps over teeth of its pulley, or a motor loses steps.
///   k  teeth
///   p  the cord for one, mm
///   m  first visit after it
///
///   added = p k for n >= m                                                                  (1)
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::model::plotter::tooth_skip_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "teeth",
        .symbol = "k",
        .meaning = "whole teeth, positive where too much is counted",
        .nominal = 1.0,
        .lower = -200.0,
        .upper = 200.0,
        .prior_sigma = 3.0,
        .integer = true,
    },
    kFirstVisit};

// (1)
Number add(const CordState<Number>& /*cord*/, const CordVisit& visit, Values values) {
  return visit.order >= values[1] ? visit.tooth_mm * values[0] : 0.0;
}

}  // namespace

extern constinit const PlotterEffect tooth_skip{
    .described =
        {
            .id = "tooth_skip",
            .station = effects::Station::chain,
            .sides = effects::kOneChain,
            .parameters = kParameters,
            .cause = "a belt jumped over teeth of its pulley, or a motor lost steps",
            .signature = "from one line on, all are shifted and bent",
            .equation = "+ k p for n >= m",
            .source = "GT2 belts have teeth of 2 mm",
            .not_modelled = "a second skip; give it as an effect of its own",
            .typical = "1 or 2 teeth, 2 or 4 mm",
            .needs = effects::DataNeed::order,
            .remedy_kind = effects::RemedyKind::repair,
            .remedy = "draw slower, tighten the belt on its pulley, set the zeros and draw again",
        },
    .add = add,
};

}  // namespace chaintrue::model::plotter::tooth_skip_effect
