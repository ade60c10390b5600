// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/outside_option.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/numbers.hpp"

#include <map>

namespace chaintrue::cli {
namespace {

const std::map<std::string, grid::Outside>& ways() {
  static const std::map<std::string, grid::Outside> kByName = {
      {"continued", grid::Outside::continued},
      {"refuse", grid::Outside::refuse},
      {"fade", grid::Outside::fade},
      {"linear", grid::Outside::linear},
      {"clamp", grid::Outside::clamp}};
  return kByName;
}

}  // namespace

void add_outside_options(Verb verb, OutsideOption& option, const std::string& usual) {
  verb.add_option("--outside",
                  option.way,
                  "Beyond the measured points: continued (smoothly), refuse, fade (to the machine "
                  "without correction), linear or clamp; " +
                      usual)
      .one_of({"continued", "refuse", "fade", "linear", "clamp"});
  add_number(verb,
             "--fade-mm",
             option.fade_width_mm,
             files::kFadeWidthMm,
             "Distance over which --outside fade ends the correction")
      .acts_on(facts::fade, "to be left out without --outside fade");
}

grid::OutsideRule rule_of(const OutsideOption& option, const grid::OutsideRule& usual) {
  if (option.way.empty()) return usual;
  return {ways().at(option.way), option.fade_width_mm};
}

}  // namespace chaintrue::cli
