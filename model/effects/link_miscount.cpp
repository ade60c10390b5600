// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// link_miscount: the links of one reading are miscounted.
///   p  nominal pitch [mm]
///   k  links
///   n  number of the visit
///   m  the visit whose links are miscounted
///
///   added = p k for n = m, otherwise 0                                                      (1)
#include "model/effects/sides.hpp"

namespace chaintrue::model::effects::link_miscount_effect {
namespace {

constexpr EffectParameter kParameters[] = {
    {
        .name = "links",
        .symbol = "k",
        .meaning = "whole links, positive where too many are read",
        .nominal = 1.0,
        .lower = -20.0,
        .upper = 20.0,
        .prior_sigma = 1.0,
        .integer = true,
    },
    visit_parameter("visit", "number of the visit"),
};

// (1)
double misread(const VisitNote& visit, Values values) {
  return visit.order == values[1] ? visit.pitch_mm * values[0] : 0.0;
}

}  // namespace

extern constinit const Effect link_miscount{
    .id = "link_miscount",
    .station = Station::reading,
    .sides = kOneChain,
    .parameters = kParameters,
    .cause = "the links were miscounted at one visit",
    .signature = "one point alone is off along one chain by a whole number of links",
    .equation = "+ pitch k at visit m alone",
    .source = "counting by hand",
    .not_modelled = "a reading wrong by other than whole links: a bad point",
    .typical = "1 link, 6.35 mm",
    .needs = DataNeed::order,
    .remedy_kind = RemedyKind::correct_the_data,
    .remedy = "read that point again; its reading is corrected or left out",
    .misread = misread,
    .at_one_visit = true,
};

}  // namespace chaintrue::model::effects::link_miscount_effect
