// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "model/effects/catalogue.hpp"
#include "model/effects/declared_law.hpp"

namespace chaintrue::model::effects {
namespace {

// The heading of a stage's chapter.
struct Chapter {
  Station station;
  std::string_view words;
};

constexpr Chapter kChapters[] = {
    {Station::paper, "where the marks are"},
    {Station::machine, "geometry and forces"},
    {Station::chain, "the length paid out"},
    {Station::reading, "the length recorded"},
};

std::string sides_of(const Effect& effect) {
  std::string list;
  for (const EffectSide side : effect.sides) {
    if (!list.empty()) list += ", ";
    list += side == EffectSide::none ? "-" : name(side);
  }
  return list;
}

std::string parameters_of(const Effect& effect) {
  std::string list;
  for (const EffectParameter& parameter : effect.parameters) {
    if (!list.empty()) list += "<br>";
    list +=
        fmt::format("`{}` {}: {}, {} .. {}{}", parameter.name, parameter.symbol, parameter.meaning,
                    parameter.lower, parameter.upper, parameter.integer ? ", whole" : "");
  }
  return list;
}

std::string row(const Effect& effect) {
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", effect.id, sides_of(effect),
                     parameters_of(effect), effect.equation, effect.typical);
}

std::string paragraph(const Effect& effect) {
  return fmt::format(
      "**{}** — {}. *Shows as:* {}.{} *Remedy ({}):* {}. *Not modelled:* {}. *Source:* {}.\n\n",
      effect.id, effect.cause, effect.signature,
      effect.needs == DataNeed::order ? " Needs the order of visits." : "",
      name(effect.remedy_kind), effect.remedy, effect.not_modelled, effect.source);
}

}  // namespace

std::string catalogue_document() {
  std::string text =
      "# The catalogue of effects\n\n"
      "Printed by `chaintrue effects --markdown` from model/chains/chain_effects.cpp.\n\n"
      "Each effect acts at one of four stations, and values are added to the machine's own. phi is "
      "a "
      "chain's angle below the horizontal where it leaves the sprocket, T and H its tension there "
      "and "
      "the horizontal part of it, S the free unstretched chain, L0 = wrap + S, n the number of the "
      "visit. phi, T, S and L0 come from the equilibrium with all machine effects; chain effects "
      "are "
      "evaluated on it and added in this order, division by (1 + e) comes next, and readings are "
      "added "
      "last. An effect of size 0 changes nothing.\n\n";
  for (const Chapter& chapter : kChapters) {
    text += fmt::format("## {}: {}\n\n", name(chapter.station), chapter.words);
    text += "| effect | side | parameters | equation | usual size |\n|---|---|---|---|---|\n";
    for (const Effect* effect : catalogue()) {
      if (effect->station == chapter.station) text += row(*effect);
    }
    text += "\n";
    for (const Effect* effect : catalogue()) {
      if (effect->station == chapter.station) text += paragraph(*effect);
    }
  }
  text += declared_chapter();
  return text;
}

}  // namespace chaintrue::model::effects
