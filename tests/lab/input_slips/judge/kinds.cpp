// SPDX-License-Identifier: GPL-3.0-or-later
#include "input_slips/judge/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::slips {
namespace {

using generator::Dice;
using grid::MeasuredBelts;
using grid::MeasuredGrid;
using grid::MeasuredHoles;
using grid::MeasuredPoint;

std::string point_place(std::size_t row) { return fmt::format("/points/{}", row); }

Expected written(double meant, double instead, std::string place) {
  return {
      {fmt::format("is it {:.10g} rather than {:.10g}", meant, instead)}, std::move(place), false};
}

/// A number written wrongly, or the number itself where the slip would be none.
using Misread = std::function<double(double meant, Dice& dice)>;

/// Two neighbouring digits exchanged, whole tens and hundreds of it: by 18 mm at least.
double digits_exchanged(double meant, Dice&) {
  const std::string text = fmt::format("{:.10g}", std::abs(meant));
  for (std::size_t i = 0; i + 1 < text.size() && text[i + 1] != '.'; ++i) {
    std::string other = text;
    std::swap(other[i], other[i + 1]);
    const double size = std::strtod(other.c_str(), nullptr);
    if (std::abs(size - std::abs(meant)) >= 18.0) return std::copysign(size, meant);
  }
  return meant;
}

/// One digit is another: of the tens or hundreds.
double digit_wrong(double meant, Dice& dice) {
  const double unit = dice.below(2) == 0 ? 10.0 : 100.0;
  const double digit = std::fmod(std::floor(std::abs(meant) / unit), 10.0);
  const double other = std::fmod(digit + 3.0 + static_cast<double>(dice.below(4)), 10.0);
  return std::copysign(std::abs(meant) + (other - digit) * unit, meant);
}

double digit_dropped(double meant, Dice&) {
  std::string text = fmt::format("{:.10g}", meant);
  text.erase(2, 1);
  const double instead = std::strtod(text.c_str(), nullptr);
  return std::abs(instead - meant) < 18.0 ? meant : instead;
}

Misread misread_as(const std::string& how) {
  if (how == "digits_exchanged") return digits_exchanged;
  if (how == "digit_wrong") return digit_wrong;
  if (how == "digit_dropped") return digit_dropped;
  if (how == "point_left_out") return [](double meant, Dice&) { return std::round(10.0 * meant); };
  // A hundred more is also the tape's mark.
  if (how == "hundred_more") return [](double meant, Dice&) { return meant + 100.0; };
  if (how == "foot_less") return [](double meant, Dice&) { return meant - 304.8; };
  if (how == "foot_less_of_long")
    return [](double meant, Dice&) { return meant < 604.8 ? meant : meant - 304.8; };
  throw std::invalid_argument("no misreading: " + how);
}

/// A number of a point: x, y, left, right; or either of two, x/y.
double& number_in(MeasuredPoint& p, const std::string& name, Dice& dice) {
  const auto slash = name.find('/');
  if (slash != std::string::npos)
    return number_in(p, dice.below(2) == 0 ? name.substr(0, slash) : name.substr(slash + 1), dice);
  if (name == "x") return p.mark.x_mm;
  if (name == "y") return p.mark.y_mm;
  return name == "left" ? p.lengths->left_mm : p.lengths->right_mm;
}

/// A row whose mark is far enough from the axes and the diagonal that the slip is one.
std::size_t some_row(const MeasuredGrid& grid, Dice& dice) {
  for (;;) {
    const std::size_t row = dice.below(grid.points.size());
    const model::MarkPoint m = grid.points[row].mark;
    if (m.x_mm < -100.0 && m.y_mm < -100.0 && std::abs(m.x_mm - m.y_mm) > 100.0) return row;
  }
}

/// A slip of kinds.tsv in the making: its words and numbers, and the session that is spoilt.
struct Slip {
  Way way;
  std::vector<std::string> words;    ///< of the message; any one of them
  std::vector<std::string> numbers;  ///< what the slip is given
  Session& session;
  Dice& dice;

  double number(std::size_t at) const { return sealed::number_of<double>(numbers.at(at)); }
  MeasuredGrid& grid() const { return std::get<MeasuredGrid>(session); }
  MeasuredHoles& holes() const { return std::get<MeasuredHoles>(session); }
  MeasuredBelts& belts() const { return std::get<MeasuredBelts>(session); }
  /// Refused, as the file as a whole shows.
  Expected whole() const { return {words, "", true}; }
};

using Spoil = Expected (*)(const Slip& slip);

/// Every x, and every y, times so much plus so much.
Expected marks(const Slip& slip) {
  for (MeasuredPoint& p : slip.grid().points)
    p.mark = {p.mark.x_mm * slip.number(0) + slip.number(2),
              p.mark.y_mm * slip.number(1) + slip.number(3)};
  return slip.whole();
}

Expected without_minus(const Slip& slip) {
  for (MeasuredPoint& p : slip.grid().points) {
    for (const std::string& name : slip.numbers)
      number_in(p, name, slip.dice) = std::abs(number_in(p, name, slip.dice));
  }
  return slip.whole();
}

/// Every length, and every mark, times so much.
Expected chain_lengths(const Slip& slip) {
  for (MeasuredPoint& p : slip.grid().points) {
    p.lengths = {p.lengths->left_mm * slip.number(0), p.lengths->right_mm * slip.number(0)};
    p.mark = {p.mark.x_mm * slip.number(1), p.mark.y_mm * slip.number(1)};
  }
  return slip.whole();
}

/// Two numbers of each point.
Expected exchanged(const Slip& slip) {
  for (MeasuredPoint& p : slip.grid().points)
    std::swap(number_in(p, slip.numbers[0], slip.dice), number_in(p, slip.numbers[1], slip.dice));
  return slip.whole();
}

Expected exchanged_in_a_row(const Slip& slip) {
  const std::size_t row = some_row(slip.grid(), slip.dice);
  MeasuredPoint& p = slip.grid().points[row];
  std::swap(number_in(p, slip.numbers[0], slip.dice), number_in(p, slip.numbers[1], slip.dice));
  return {slip.words, point_place(row), false};
}

Expected sign_in_a_row(const Slip& slip) {
  const std::size_t row = some_row(slip.grid(), slip.dice);
  double& number = number_in(slip.grid().points[row], slip.numbers[0], slip.dice);
  number = -number;
  return {slip.words, point_place(row), false};
}

/// Where the slip would be none another row is tried.
Expected one_number(const Slip& slip) {
  const Misread misread = misread_as(slip.numbers[1]);
  for (;;) {
    const std::size_t row = some_row(slip.grid(), slip.dice);
    double& number = number_in(slip.grid().points[row], slip.numbers[0], slip.dice);
    const double meant = number;
    number = misread(meant, slip.dice);
    if (number != meant) return written(meant, number, point_place(row));
  }
}

/// From some row on each has the reading of the one after it, or before it.
Expected slipped(const Slip& slip) {
  const bool one_left_out = slip.numbers[0] == "left_out";
  auto& points = slip.grid().points;
  const std::size_t from = 2 + slip.dice.below(points.size() - 5);
  const std::vector<MeasuredPoint> before = points;
  for (std::size_t i = from; i < points.size(); ++i) {
    const std::size_t of = one_left_out ? std::min(i + 1, points.size() - 1) : i - 1;
    if (slip.way == Way::commands)
      points[i].mark = before[of].mark;
    else
      points[i].lengths = before[of].lengths;
  }
  // Lengths that stand twice to the last digit are counted once.
  if (one_left_out) points.pop_back();
  return {slip.words, point_place(from), true};
}

Expected other_sheet(const Slip& slip) {
  for (MeasuredPoint& point : slip.grid().points)
    point.mark = {std::round(slip.dice.uniform(-1000.0, 1000.0)),
                  std::round(slip.dice.uniform(-500.0, 500.0))};
  return slip.whole();
}

Expected rows_exchanged(const Slip& slip) {
  auto& points = slip.grid().points;
  const std::size_t row = 3 + slip.dice.below(20);
  std::swap(points[row].mark, points[row + 1].mark);
  return {slip.words, point_place(row), false};
}

Expected second_visit_without_minus(const Slip& slip) {
  auto& points = slip.grid().points;
  for (std::size_t i = points.size(); i-- > 0;) {
    MeasuredPoint& late = points[i];
    const bool is_second = std::ranges::any_of(std::span(points).first(i), [&](const auto& p) {
      return p.commanded->x_mm == late.commanded->x_mm && p.commanded->y_mm == late.commanded->y_mm;
    });
    if (late.mark.x_mm > -100.0 || !is_second) continue;
    late.mark.x_mm = -late.mark.x_mm;
    return {{fmt::format("Mark {} was measured twice", *late.order)}, point_place(i), false};
  }
  return {{"no second visit was drawn"}, "", false};
}

/// Times so much plus so much.
Expected every_distance(const Slip& slip) {
  for (auto& distance : slip.holes().distances)
    distance.distance_mm = distance.distance_mm * slip.number(0) + slip.number(1);
  return slip.whole();
}

Expected one_distance(const Slip& slip) {
  const Misread misread = misread_as(slip.numbers[0]);
  auto& distances = slip.holes().distances;
  for (;;) {
    double& distance = distances[slip.dice.below(distances.size())].distance_mm;
    const double meant = distance;
    distance = misread(meant, slip.dice);
    if (distance != meant) return written(meant, distance, "");
  }
}

Expected hole_without_minus(const Slip& slip) {
  auto& holes = slip.holes().holes;
  for (;;) {
    auto& hole = holes[slip.dice.below(holes.size())];
    if (hole.commanded.x_mm > -100.0) continue;
    hole.commanded.x_mm = -hole.commanded.x_mm;
    // If another hole is there already, both are reported.
    return {{fmt::format("holes {} and", hole.name),
             fmt::format("and {} are at the same spot", hole.name)},
            "",
            true};
  }
}

Expected distances_slipped(const Slip& slip) {
  auto& distances = slip.holes().distances;
  const std::size_t from = 2 + slip.dice.below(distances.size() - 6);
  for (std::size_t i = from; i + 1 < distances.size(); ++i)
    distances[i].distance_mm = distances[i + 1].distance_mm;
  distances.pop_back();
  return slip.whole();
}

Expected upper_exchanged(const Slip& slip) {
  for (auto& point : slip.belts().points) {
    std::swap(point.lengths_mm.tl, point.lengths_mm.tr);
    if (!slip.numbers.empty()) std::swap(point.lengths_mm.bl, point.lengths_mm.br);
  }
  return slip.whole();
}

Expected belt_lengths(const Slip& slip) {
  for (auto& point : slip.belts().points) {
    for (const model::Belt belt : model::kBelts) point.lengths_mm[belt] *= slip.number(0);
  }
  return slip.whole();
}

Expected diagonal(const Slip& slip) {
  auto& distance = slip.belts().distances.front();
  const double meant = distance.distance_mm;
  distance.distance_mm *= slip.number(0);
  return {{fmt::format("{} {:.10g} mm", slip.words.front(), meant)}, "/distances/0", true};
}

Expected belt_digit_wrong(const Slip& slip) {
  auto& points = slip.belts().points;
  const std::size_t row = slip.dice.below(points.size());
  double& read = points[row].lengths_mm[model::kBelts[slip.dice.below(4)]];
  const double meant = read;
  read = digit_wrong(meant, slip.dice);
  return written(meant, read, point_place(row));
}

const std::map<std::string, Spoil> kSpoils = {
    {"marks", marks},
    {"without_minus", without_minus},
    {"chain_lengths", chain_lengths},
    {"exchanged", exchanged},
    {"exchanged_in_a_row", exchanged_in_a_row},
    {"sign_in_a_row", sign_in_a_row},
    {"one_number", one_number},
    {"slipped", slipped},
    {"other_sheet", other_sheet},
    {"rows_exchanged", rows_exchanged},
    {"second_visit_without_minus", second_visit_without_minus},
    {"every_distance", every_distance},
    {"one_distance", one_distance},
    {"hole_without_minus", hole_without_minus},
    {"distances_slipped", distances_slipped},
    {"upper_exchanged", upper_exchanged},
    {"belt_lengths", belt_lengths},
    {"diagonal", diagonal},
    {"belt_digit_wrong", belt_digit_wrong}};

std::vector<Kind> all_kinds() {
  std::vector<Kind> kinds;
  for (const std::vector<std::string>& row : sealed::table("input_slips/kinds.tsv")) {
    const Way way = *std::ranges::find(kWays, row.at(0), word);
    kinds.push_back(
        {row.at(1), way, [way, spoil = kSpoils.at(row.at(2)), row](Session& session, Dice& dice) {
           return spoil({way, sealed::words_of(row.at(4), '|'), sealed::words_of(row.at(3), ' '),
                         session, dice});
         }});
  }
  return kinds;
}

bool names(const std::string& message, const Expected& expected) {
  const bool is_there = expected.place.empty() ||
                        message.find(expected.place + ":") != std::string::npos ||
                        message.find(expected.place + "/") != std::string::npos;
  return is_there && std::ranges::any_of(expected.words, [&](const std::string& word) {
           return message.find(word) != std::string::npos;
         });
}

}  // namespace

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kAll = all_kinds();
  return kAll;
}

Outcome try_kind(const Kind& kind, std::uint64_t seed) {
  Session session = clean_session(kind.way, seed);
  Dice dice(seed, kind.id);
  Outcome outcome;
  outcome.expected = kind.spoil(session, dice);
  outcome.reported = reported_of(session);
  const auto& said = outcome.reported.messages;
  outcome.is_named = (!outcome.expected.refused || outcome.reported.is_refused) &&
                     std::ranges::any_of(said, [&](const std::string& message) {
                       return names(message, outcome.expected);
                     });
  return outcome;
}

std::vector<std::string> false_alarms(Way way, std::uint64_t seed) {
  std::vector<std::string> messages = reported_of(clean_session(way, seed)).messages;
  // Friction and drift separate a mark's two visits too: the report of a disagreement is right, and
  // not a slip.
  std::erase_if(messages, [](const std::string& message) {
    return message.find("was also measured at") != std::string::npos;
  });
  return messages;
}

}  // namespace chaintrue::slips
