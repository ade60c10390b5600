// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The section of a diagnosis on laws: variables of the part that no listed cause explains.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "tools/cli/diagnosis_sections.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::Law;

constexpr int kCurvePoints = 200;
/// With more waves than this only one is drawn, with all points on it.
constexpr double kMostWaves = 3.0;

bool is_folded(const Law& law) {
  return is_periodic(law.shape) && law.to - law.from > kMostWaves * law.parameters[1].value;
}

double degrees_of(const Law& law, double at) {
  return unit_of(law.of) == "rad" ? at * 180.0 / std::numbers::pi : at;
}

/// x of a point.
double drawn(const Law& law, double at) {
  if (!is_folded(law)) return degrees_of(law, at);
  const double period = law.parameters[1].value;
  return degrees_of(law, at - law.from - period * std::floor((at - law.from) / period));
}

std::string axis_title(const Law& law) {
  const std::string_view unit = unit_of(law.of);
  const std::string_view words = unit == "rad"  ? "degrees"
                                 : unit == "n"  ? "N"
                                 : unit == "mm" ? "mm"
                                                : "visits";
  const std::string variable = variable_in_words(law);
  if (is_folded(law)) {
    return fmt::format("{}, {} past a full period of {:.4g}", variable, words,
                       degrees_of(law, law.parameters[1].value));
  }
  return unit == "visit" ? variable : fmt::format("{}, {}", variable, words);
}

std::vector<std::pair<double, double>> curve_of(const Law& law) {
  const double span = is_folded(law) ? law.parameters[1].value : law.to - law.from;
  std::vector<double> at;
  for (int k = 0; k <= kCurvePoints; ++k) at.push_back(law.from + span * k / kCurvePoints);
  if (law.shape == diagnosis::LawShape::step) {
    // Both ends of the step at its place.
    const double place = std::clamp(law.parameters[1].value, law.from, law.to);
    at = {law.from, place - 1e-9 * (law.to - law.from), place, law.to};
  }
  std::vector<std::pair<double, double>> curve;
  for (const double v : at)
    curve.emplace_back(degrees_of(law, is_folded(law) ? v - law.from : v), value_of(law, v));
  return curve;
}

Chart law_chart(const Law& law, bool is_likeliest) {
  ResidualScatter chart{
      .title = is_likeliest ? "The most probable" : "Its best rival",
      .caption =
          fmt::format("{}: {}. {}", capitalised(in_words(law)), diagnosis::percent(law.probability),
                      is_likeliest ? "Dots are the readings minus all other known effects; "
                                     "the right curve passes through them."
                                   : "The same readings, under this law."),
      .x_title = axis_title(law),
      .first_label = "readings and curve",
      .first_color = is_likeliest ? report::kAfterColor : report::kNeutralColor};
  for (const diagnosis::LawResidual& point : law.points)
    chart.dots.push_back({point_name(point.index), drawn(law, point.at), point.residual_mm});
  chart.curve = curve_of(law);
  return residual_scatter_chart(chart);
}

ChartRow law_charts(const Diagnosis& found) {
  const std::vector<Law>& laws = found.unexplained->laws;
  ChartRow row;
  for (std::size_t k = 0; k < std::min<std::size_t>(laws.size(), 2); ++k)
    row.charts.push_back(law_chart(laws[k], k == 0));
  return row;
}

std::vector<ChartRow> law_rest_charts(const Diagnosis& found) {
  const Law& law = found.unexplained->laws.front();
  std::vector<Arrow> before, after;
  for (const PointPicture& point : found.points) {
    const auto* own = find_where(law.points, having(&diagnosis::LawResidual::index, point.index));
    const Eigen::Vector2d& shift = found.causes.empty() ? point.before_mm : point.after_mm;
    before.push_back(arrow_of(point, shift));
    if (own == nullptr || !own->left_x_mm || !own->left_y_mm) continue;
    after.push_back(arrow_of(point, {*own->left_x_mm, *own->left_y_mm}));
  }
  return arrow_rows(bed_of(found), before, after,
                    {found.causes.empty() ? "Without it: the machine calibrated"
                                          : "Without it: the residual with the causes",
                     "Arrows from the intended to the actual position of the tool. Grey: "
                     "one sigma of the noise at that mark.",
                     "With it, same scale",
                     "Neighbours that still point the same way show an error that the law "
                     "does not explain either."});
}

/// Hints are worded as hints, and not given for a law that is only possible.
std::vector<Item> details_of(const Law& law, const Diagnosis& found) {
  std::vector<Item> details;
  if (law.probability < diagnosis::kLawLikely) return details;
  details.push_back({fmt::format(
      "on average it {}: {} of the residual of the {}", average_in_words(law, found.observations),
      diagnosis::percent(law.share), found.belts ? "anchors" : "settings")});
  if (law.held_out) {
    const auto& [inside, outside] = *law.held_out;
    details.push_back(
        {fmt::format("every fourth place left out: predicted to {:.2f} mm with the law, {:.2f} "
                     "without; a quarter of the bed left out: {:.2f} with it, {:.2f} without",
                     inside.with_mm, inside.without_mm, outside.with_mm, outside.without_mm)});
  }
  if (law.shape_probability < diagnosis::kLawClaimed) {
    details.push_back(
        {fmt::format("probability of this shape: {}", diagnosis::percent(law.shape_probability))});
  }
  const Words hints =
      found.belts ? hints_of(law, found.belts->machine) : hints_of(law, found.extended_machine);
  for (const std::string& hint : hints) details.push_back({"a hint: " + hint});
  return details;
}

}  // namespace

Section laws_section(const Diagnosis& found) {
  const std::vector<Law>& laws = found.unexplained->laws;
  List list;
  for (const Law& law : laws) {
    Item& item = list.items.emplace_back(Item{
        fmt::format("{}: {}", capitalised(in_words(law)), diagnosis::percent(law.probability))});
    item.items = details_of(law, found);
  }
  Section section{"What the remaining error may depend on", {std::move(list)}};
  if (!laws.front().points.empty()) {
    section.blocks.emplace_back(law_charts(found));
    if (!found.points.empty()) append_all(section.blocks, law_rest_charts(found));
  }
  const bool is_claimed = laws.front().probability >= diagnosis::kLawClaimed;
  section.say(is_claimed && found.belts ? "No listed cause explains this."
              : is_claimed ? "No listed cause explains this. --law writes it as a declared "
                             "cause, to be named, edited and used with --effects."
                           : fmt::format("These {} do not show which of these acts, if any.",
                                         name(found.observations)));
  return section;
}

Section declared_section(const Diagnosis& found) {
  using Says = diagnosis::DeclaredAnswer::Says;
  Table table{{{.width = 34}, {}, {.gap = 2}}, {}, ""};
  for (const auto& [cause, says, probability] : found.declared) {
    const char* words = says == Says::confirmed ? "confirmed: it acts here"
                        : says == Says::denied
                            ? "denied: with the values in the file it would have shown"
                        : says == Says::open ? "left open: measure more points"
                                             : "not testable with these readings";
    table.add({cause_title(cause), words,
               says == Says::not_testable ? Cell{} : Cell(diagnosis::percent(probability))});
  }
  return {"Declared effects", {std::move(table)}};
}

}  // namespace chaintrue::cli
