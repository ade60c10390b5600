// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// zero_shift: the zero of a chain moves once, by any amount.
///   z  shift [mm]
///   n  number of the visit
///   m  number of the first visit after it
///
///   added = z for n >= m, otherwise 0                                                       (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::zero_shift_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "shift_mm",
        .symbol = "z",
        .meaning = "how much too long each later reading is",
        .nominal = 3.0,
        .lower = -130.0,
        .upper = 130.0,
        // Half a link: a sprocket that turns on its shaft, or a zero set by eye, stops anywhere between
        // two teeth.
        .prior_sigma = 3.0,
    },
    visit_parameter("first_visit", "number of the first visit after the shift"),
};

// (1)
double misread(const VisitNote& visit, Values values) {
  return visit.order >= values[1] ? values[0] : 0.0;
}

}  // namespace

extern constinit const Effect zero_shift{
    .id = "zero_shift",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = kParameters,
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
        "chain "
        "as it hung before the shift",
    .misread = misread,
};

}  // namespace chaintrue::model::effects::zero_shift_effect
