// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_sections.hpp"

#include <fmt/format.h>

#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using grid::diagnosis::Cause;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;
using report::Paragraph;
using report::Section;
using report::Table;

std::string cause_and_remedy(const model::effects::Effect& effect) {
  return typeset(fmt::format("{}. What to do: {}.", effect.cause, effect.remedy));
}

/// What became of a term, in one word.
std::string fate_of(const Diagnosis& found, const grid::diagnosis::Term& term) {
  for (const Cause& cause : found.causes) {
    if (cause.cause == term.cause)
      return found.verdict == Verdict::named_set ? "in the set" : "named";
  }
  for (const auto& bound : found.bounds) {
    if (bound.cause == term.cause) return "absent";
  }
  return "not named";
}

std::string_view where_it_goes(const Diagnosis& found) {
  switch (found.observations) {
    case grid::diagnosis::Observations::points:
      return "Points go into the grid's file, readings into its \"readings\"";
    case grid::diagnosis::Observations::distances:
      return "Holes and distances go into the holes' file, readings into its \"readings\"";
    case grid::diagnosis::Observations::belts:
      return "Points and distances go into the belts' file";
    case grid::diagnosis::Observations::both:
      break;
  }
  return "Points go into the grid's file, holes and distances into the holes' file, readings into "
         "the \"readings\" of either";
}

}  // namespace

Section next_in_a_table(const Diagnosis& found) {
  Section section{"What to measure next", {}};
  Table table{
      {{"no.", true}, {"what"}, {fmt::format("{} then", what_stands_alone(found)), true}}, {}, ""};
  const std::vector<std::string> sentences = follow_ups_in_words(found);
  for (std::size_t i = 0; i < found.next_measurements.size(); ++i) {
    table.rows.push_back({{fmt::format("{}", i + 1),
                           sentences[i],
                           chance_in_a_cell(found, i)},
                          false});
  }
  table.caption = fmt::format(
      "In this order; the probability is that of all up to this one done. {}; chaintrue plan {} "
      "--after prints the lines.",
      where_it_goes(found),
      files_in_words(found));
  section.blocks.emplace_back(std::move(table));
  return section;
}

Section causes_section(const Diagnosis& found) {
  Table table{{{"cause"}, {"size"}, {"probability", true}, {"what it is"}}, {}, ""};
  for (const Cause& cause : found.causes) {
    table.rows.push_back(
        {{cause_title(cause.cause) + (cause.order_assumed ? " (order assumed)" : ""),
          typeset(sizes_in_words(cause.cause, cause.parameters)),
          percent(cause.probability),
          cause_and_remedy(*cause.cause.effect)},
         false});
    for (const auto& same : cause.same_as) {
      table.rows.push_back({{"or " + cause_title(same.cause),
                             typeset(sizes_in_words(same.cause, same.parameters)),
                             "the same",
                             cause_and_remedy(*same.cause.effect)},
                            false});
      table.caption =
          fmt::format("No {} of this kind tell the causes marked \"or\" from the one above them.",
                      name(found.observations));
    }
  }
  return {found.verdict == Verdict::named_set ? "One of these"
          : found.causes.size() > 1           ? "The causes"
                                              : "The cause",
          {std::move(table)}};
}

Section terms_section(const Diagnosis& found) {
  Table table{{{"cause"},
               {"size, were it alone"},
               {"strength", true},
               {"share left", true},
               {"chance of noise", true},
               {"probability", true},
               {"verdict"}},
              {},
              "Strength in units of noise. Share left: what the calibration of the settings leaves "
              "of the cause. Chance of noise: that noise alone lets any cause look as strong."};
  for (const auto& term : found.terms) {
    const std::string fate = fate_of(found, term);
    table.rows.push_back({{cause_title(term.cause),
                           typeset(size_in_words(term.cause, term.parameter, term.value, term.sigma)),
                           fixed(term.signal_to_noise, 1),
                           share_percent(term.share_left),
                           share_percent(term.p_value),
                           percent(term.probability),
                           fate},
                          fate == "named" || fate == "in the set"});
  }
  return {"Every cause that was tested", {std::move(table)}};
}

Section bounds_section(const Diagnosis& found) {
  Section section{"Looked for and absent, and not testable", {}};
  if (!found.bounds.empty()) {
    Table table{{{"absent"}, {"larger than this it would have shown"}}, {}, "95 % bounds."};
    for (const auto& bound : found.bounds)
      table.rows.push_back({{cause_title(bound.cause), bound_in_words(bound)}, false});
    section.blocks.emplace_back(std::move(table));
  }
  if (!found.not_testable.empty()) {
    Table table{{{"not testable"}, {"because"}}, {}, "Nothing is said about these."};
    for (const auto& missing : found.not_testable)
      table.rows.push_back({{cause_title(missing.cause), missing.reason}, false});
    section.blocks.emplace_back(std::move(table));
  }
  return section;
}

namespace {

Table bad_distances(const Diagnosis& found) {
  Table table{{{"distance"}, {"read less predicted, mm", true}, {"in sigmas", true}},
              {},
              fmt::format("Against what all the other {} make of it. They were set aside; measure "
                          "them again.",
                          name(found.observations))};
  for (const auto& bad : found.outliers) {
    if (!is_distance(found, bad)) continue;
    table.rows.push_back(
        {{distance_name(found, bad.index), fixed(bad.off_mm, 2), fixed(bad.distance, 1)}, true});
  }
  return table;
}

Table bad_points(const Diagnosis& found) {
  Table table{{{"point"}, {"right of its mark, mm", true}, {"up, mm", true}, {"in sigmas", true}},
              {},
              "Where the tool would have to have been for the reading to be right. They were set "
              "aside; measure them again."};
  for (const auto& bad : found.outliers) {
    if (is_distance(found, bad)) continue;
    table.rows.push_back({{point_name(bad.index),
                           fixed(bad.shift_mm.x(), 2),
                           fixed(bad.shift_mm.y(), 2),
                           fixed(bad.distance, 1)},
                          true});
  }
  return table;
}

}  // namespace

Section outliers_section(const Diagnosis& found) {
  Section section{.title = fmt::format("Bad {}", name(found.observations))};
  for (const Table& table : {bad_points(found), bad_distances(found)}) {
    if (!table.rows.empty()) section.blocks.emplace_back(table);
  }
  return section;
}

Section settings_section(const Diagnosis& found) {
  Table table{{{"setting"},
               {"stated", true},
               {"\u00b1", true},
               {"calibrated", true},
               {"\u00b1", true},
               {"unit"},
               {"remark"}},
              {},
              "\u00b1: one sigma."};
  for (const auto& result : found.settings) {
    const int digits = unit_of(result.setting) == "mm" ? 2 : 3;
    const auto cell = [&](double value) { return fixed(in_unit(result.setting, value), digits); };
    table.rows.push_back(
        {{std::string(setting_in_words(result.setting)),
          cell(result.stated),
          cell(result.stated_sigma),
          cell(result.calibrated),
          cell(result.sigma),
          std::string(unit_of(result.setting)),
          result.off ? "off: further from what was stated than its uncertainty allows; check it"
                     : ""},
         result.off});
  }
  return {"The machine's settings", {std::move(table)}};
}

namespace {

std::string noise_in_words(const Diagnosis& found) {
  std::vector<std::string> stated;
  if (found.stated_noise) {
    stated.push_back(
        fmt::format("{:g} mm a chain and {:g} mm a mark (one sigma, {:g} degrees of freedom); ",
                    found.stated_noise->length_mm,
                    found.stated_noise->position_mm,
                    found.stated_noise->dof));
  }
  if (found.stated_tape) {
    stated.push_back(fmt::format(
        "{:g} mm a reading of the tape and {:g} mm a hole on either axis (one sigma, {:g} degrees "
        "of freedom); ",
        found.stated_tape->tape_sigma_mm,
        found.stated_tape->hole_sigma_mm,
        found.stated_tape->dof));
  }
  if (stated.empty()) return "The noise was not stated; ";
  return fmt::format("Noise as stated: {}", fmt::join(stated, ""));
}

}  // namespace

Section method_section(const Diagnosis& found) {
  Section section{"What this rests on", {}};
  for (const std::string& note : found.notes) section.blocks.emplace_back(Paragraph{typeset(note)});
  std::string noise = noise_in_words(found);
  noise += fmt::format("what was found is {:.2f} times that.", found.noise_factor);
  section.blocks.emplace_back(Paragraph{std::move(noise)});
  for (const auto& correction : found.data_corrections) {
    section.blocks.emplace_back(
        Paragraph{fmt::format("The data are corrected by {}; it does not go into the machine.",
                              cause_title(correction))});
  }
  return section;
}

}  // namespace chaintrue::cli
