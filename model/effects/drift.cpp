// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// drift: the readings drift from visit to visit.
///   n  number of the visit
///   d  rate [mm/visit]
///
///   added = d n                                                                             (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::drift_effect {
namespace {

constexpr EffectParameter kParameters[] = {{
    .name = "rate_mm_per_visit",
    .symbol = "d",
    .meaning = "what a reading gains with each visit",
    .nominal = 0.03,
    .lower = -1.0,
    .upper = 1.0,
    .prior_sigma = 0.03,
}};

// (1)
double misread(const VisitNote& visit, Values values) { return values[0] * visit.order; }

}  // namespace

extern constinit const Effect drift{
    .id = "drift",
    .station = Station::reading,
    .sides = kAnyChain,
    .parameters = kParameters,
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
        "end; the "
        "readings are corrected",
    .misread = misread,
};

}  // namespace chaintrue::model::effects::drift_effect
