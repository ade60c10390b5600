// SPDX-License-Identifier: GPL-3.0-or-later
#include "input_slips/judge/kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace chaintrue::slips {
namespace {

using generator::Dice;
using grid::MeasuredBelts;
using grid::MeasuredGrid;
using grid::MeasuredHoles;
using grid::MeasuredPoint;
using model::Belt;
using model::PerBelt;

std::string point_place(std::size_t row) { return fmt::format("/points/{}", row); }

std::string rather(double meant, double written) {
  return fmt::format("is it {:.10g} rather than {:.10g}", meant, written);
}

/// A number written wrongly, or the number itself where the slip would be none.
using Misread = std::function<double(double meant, Dice& dice)>;

/// Two neighbouring digits exchanged, whole tens and hundreds of it: by 18 mm at least.
double digits_exchanged(double meant, Dice&) {
  std::string text = fmt::format("{:.10g}", std::abs(meant));
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
  const double written = std::strtod(text.c_str(), nullptr);
  return std::abs(written - meant) < 18.0 ? meant : written;
}

double point_left_out(double meant, Dice&) { return std::round(10.0 * meant); }
// A hundred more is also the tape's mark.
double hundred_more(double meant, Dice&) { return meant + 100.0; }
double foot_less(double meant, Dice&) { return meant - 304.8; }

using Spoil = std::function<Expected(Session& session, Dice& dice)>;

/// Refused, as the file as a whole shows.
Expected whole(std::string words) { return {{std::move(words)}, "", true}; }

Spoil every_point(std::string words, std::function<void(MeasuredPoint&)> spoil) {
  return [=](Session& session, Dice&) {
    for (MeasuredPoint& point : std::get<MeasuredGrid>(session).points) spoil(point);
    return whole(words);
  };
}

/// Every x, and every y, times so much plus so much.
Spoil marks(std::string words, double by_x, double by_y, model::MarkPoint more = {0.0, 0.0}) {
  return every_point(std::move(words), [=](MeasuredPoint& p) {
    p.mark = {p.mark.x_mm * by_x + more.x_mm, p.mark.y_mm * by_y + more.y_mm};
  });
}

Spoil without_minus(std::string words, bool on_x, bool on_y) {
  return every_point(std::move(words), [=](MeasuredPoint& p) {
    if (on_x) p.mark.x_mm = std::abs(p.mark.x_mm);
    if (on_y) p.mark.y_mm = std::abs(p.mark.y_mm);
  });
}

Spoil chain_lengths(std::string words, double factor, double of_marks = 1.0) {
  return every_point(std::move(words), [=](MeasuredPoint& p) {
    p.lengths = {p.lengths->left_mm * factor, p.lengths->right_mm * factor};
    p.mark = {p.mark.x_mm * of_marks, p.mark.y_mm * of_marks};
  });
}

Spoil axes_exchanged() {
  return every_point("columns look swapped", [](MeasuredPoint& p) {
    p.mark = {p.mark.y_mm, p.mark.x_mm};
  });
}

/// A row whose mark is far enough from the axes and the diagonal that the slip is one.
std::size_t some_row(const MeasuredGrid& grid, Dice& dice) {
  for (;;) {
    const std::size_t row = dice.below(grid.points.size());
    const model::MarkPoint m = grid.points[row].mark;
    if (m.x_mm < -100.0 && m.y_mm < -100.0 && std::abs(m.x_mm - m.y_mm) > 100.0) return row;
  }
}

Spoil one_point(std::vector<std::string> words, std::function<void(MeasuredPoint&)> spoil) {
  return [=](Session& session, Dice& dice) {
    auto& grid = std::get<MeasuredGrid>(session);
    const std::size_t row = some_row(grid, dice);
    spoil(grid.points[row]);
    return Expected{words, point_place(row), false};
  };
}

/// Where the slip would be none another row is tried.
Spoil one_number(std::function<double&(MeasuredPoint&, Dice&)> of, Misread misread) {
  return [=](Session& session, Dice& dice) {
    auto& grid = std::get<MeasuredGrid>(session);
    for (;;) {
      const std::size_t row = some_row(grid, dice);
      double& number = of(grid.points[row], dice);
      const double meant = number;
      number = misread(meant, dice);
      if (number != meant) return Expected{{rather(meant, number)}, point_place(row), false};
    }
  };
}

/// From some row on each has the reading of the one after it, or before it.
Spoil slipped(Way way, bool one_left_out) {
  return [=](Session& session, Dice& dice) {
    auto& points = std::get<MeasuredGrid>(session).points;
    const std::size_t from = 2 + dice.below(points.size() - 5);
    const std::vector<MeasuredPoint> before = points;
    for (std::size_t i = from; i < points.size(); ++i) {
      const std::size_t of = one_left_out ? std::min(i + 1, points.size() - 1) : i - 1;
      if (way == Way::commands) {
        points[i].mark = before[of].mark;
      } else {
        points[i].lengths = before[of].lengths;
      }
    }
    // Lengths that stand twice to the last digit are counted once.
    if (one_left_out) points.pop_back();
    const bool is_after = one_left_out == (way == Way::commands);
    return Expected{
        {is_after ? "of the line after" : "of the line before"}, point_place(from), true};
  };
}

Expected other_sheet(Session& session, Dice& dice) {
  for (MeasuredPoint& point : std::get<MeasuredGrid>(session).points)
    point.mark = {std::round(dice.uniform(-1000.0, 1000.0)),
                  std::round(dice.uniform(-500.0, 500.0))};
  return whole("are they from another sheet");
}

Expected rows_exchanged(Session& session, Dice& dice) {
  auto& points = std::get<MeasuredGrid>(session).points;
  const std::size_t row = 3 + dice.below(20);
  std::swap(points[row].mark, points[row + 1].mark);
  return {{"look exchanged"}, point_place(row), false};
}

Expected second_visit_without_minus(Session& session, Dice&) {
  auto& points = std::get<MeasuredGrid>(session).points;
  for (std::size_t i = points.size(); i-- > 0;) {
    MeasuredPoint& late = points[i];
    const bool is_second = std::any_of(points.begin(),
                                       points.begin() + static_cast<std::ptrdiff_t>(i),
                                       [&](const MeasuredPoint& p) {
                                         return p.commanded->x_mm == late.commanded->x_mm &&
                                                p.commanded->y_mm == late.commanded->y_mm;
                                       });
    if (late.mark.x_mm > -100.0 || !is_second) continue;
    late.mark.x_mm = -late.mark.x_mm;
    return {{fmt::format("Mark {} was measured twice", *late.order)}, point_place(i), false};
  }
  return {{"no second visit was drawn"}, "", false};
}

Spoil every_distance(std::string words, double factor, double more_mm) {
  return [=](Session& session, Dice&) {
    for (auto& distance : std::get<MeasuredHoles>(session).distances)
      distance.distance_mm = distance.distance_mm * factor + more_mm;
    return whole(words);
  };
}

Spoil one_distance(Misread misread) {
  return [=](Session& session, Dice& dice) {
    auto& distances = std::get<MeasuredHoles>(session).distances;
    for (;;) {
      double& distance = distances[dice.below(distances.size())].distance_mm;
      const double meant = distance;
      distance = misread(meant, dice);
      if (distance != meant) return Expected{{rather(meant, distance)}, "", false};
    }
  };
}

Expected hole_without_minus(Session& session, Dice& dice) {
  auto& set = std::get<MeasuredHoles>(session);
  for (;;) {
    auto& hole = set.holes[dice.below(set.holes.size())];
    if (hole.commanded.x_mm > -100.0) continue;
    hole.commanded.x_mm = -hole.commanded.x_mm;
    // If another hole is there already, both are reported.
    return {{fmt::format("holes {} and", hole.name),
             fmt::format("and {} are at the same spot", hole.name)},
            "",
            true};
  }
}

Expected distances_slipped(Session& session, Dice& dice) {
  auto& distances = std::get<MeasuredHoles>(session).distances;
  const std::size_t from = 2 + dice.below(distances.size() - 6);
  for (std::size_t i = from; i + 1 < distances.size(); ++i)
    distances[i].distance_mm = distances[i + 1].distance_mm;
  distances.pop_back();
  return whole("fit the two holes of the line after");
}

Spoil every_place(std::string words, std::function<void(PerBelt<double>&)> spoil) {
  return [=](Session& session, Dice&) {
    for (auto& point : std::get<MeasuredBelts>(session).points) spoil(point.lengths_mm);
    return whole(words);
  };
}

Spoil belt_lengths(std::string words, double factor) {
  return every_place(std::move(words), [=](PerBelt<double>& lengths) {
    for (const Belt belt : model::kBelts) lengths[belt] *= factor;
  });
}

Spoil diagonal(const char* words, double factor) {
  return [=](Session& session, Dice&) {
    auto& distance = std::get<MeasuredBelts>(session).distances.front();
    const double meant = distance.distance_mm;
    distance.distance_mm *= factor;
    return Expected{{fmt::format("{} {:.10g} mm", words, meant)}, "/distances/0", true};
  };
}

Expected belt_digit_wrong(Session& session, Dice& dice) {
  auto& points = std::get<MeasuredBelts>(session).points;
  const std::size_t row = dice.below(points.size());
  double& read = points[row].lengths_mm[model::kBelts[dice.below(4)]];
  const double meant = read;
  read = digit_wrong(meant, dice);
  return {{rather(meant, read)}, point_place(row), false};
}

std::vector<Kind> all_kinds() {
  const auto x = [](MeasuredPoint& p, Dice&) -> double& { return p.mark.x_mm; };
  const auto y = [](MeasuredPoint& p, Dice&) -> double& { return p.mark.y_mm; };
  const auto x_or_y = [](MeasuredPoint& p, Dice& dice) -> double& {
    return dice.below(2) == 0 ? p.mark.x_mm : p.mark.y_mm;
  };
  const auto right = [](MeasuredPoint& p, Dice&) -> double& { return p.lengths->right_mm; };
  const auto left_or_right = [](MeasuredPoint& p, Dice& dice) -> double& {
    return dice.below(2) == 0 ? p.lengths->left_mm : p.lengths->right_mm;
  };
  const Misread foot_less_of_long = [](double meant, Dice& dice) {
    return meant < 604.8 ? meant : foot_less(meant, dice);
  };
  constexpr double kToInches = 1.0 / 25.4;
  using enum Way;
  return {
      {"x mirrored", commands, marks("sign of x_mm looks reversed", -1.0, 1.0)},
      {"y mirrored", commands, marks("counted downwards", 1.0, -1.0)},
      {"both mirrored", commands, marks("both look reversed", -1.0, -1.0)},
      {"x and y exchanged", commands, axes_exchanged()},
      {"no minus on x", commands, without_minus("minus signs of x_mm seem to be missing", true, false)},
      {"no minus on y", commands, without_minus("minus signs of y_mm seem to be missing", false, true)},
      {"no minus at all", commands, without_minus("all minus signs seem to be missing", true, true)},
      {"marks in inches", commands, marks("x_mm and y_mm look like inches", kToInches, kToInches)},
      {"marks in centimetres", commands, marks("x_mm and y_mm look like centimetres", 0.1, 0.1)},
      {"all x from the 100 mm mark",
       commands,
       marks("all x_mm look 100 mm too large", 1.0, 1.0, {100.0, 0.0})},
      {"from the lower left corner",
       commands,
       marks("counted from the bed's lower left corner", 1.0, 1.0, {1219.2, 609.6})},
      {"a row left out", commands, slipped(commands, true)},
      {"a row twice", commands, slipped(commands, false)},
      {"marks of another sheet", commands, other_sheet},
      {"a minus missing, x",
       commands,
       one_point({"is the minus missing?"}, [](auto& p) { p.mark.x_mm = -p.mark.x_mm; })},
      {"a minus missing, y",
       commands,
       one_point({"is the minus missing?"}, [](auto& p) { p.mark.y_mm = -p.mark.y_mm; })},
      {"x and y in a row",
       commands,
       one_point({"re x and y swapped?"},
                 [](auto& p) {
                   p.mark = {p.mark.y_mm, p.mark.x_mm};
                 })},
      {"digits exchanged", commands, one_number(x_or_y, digits_exchanged)},
      {"a digit wrong", commands, one_number(x, digit_wrong)},
      {"a digit dropped", commands, one_number(x, digit_dropped)},
      {"the point left out", commands, one_number(y, point_left_out)},
      {"100 mm off", commands, one_number(x, hundred_more)},
      {"a foot off", commands, one_number(y, foot_less)},
      {"two rows exchanged", commands, rows_exchanged},
      {"a second visit without its minus", commands, second_visit_without_minus},
      // For a mirror-symmetric frame these two are indistinguishable: both are reported.
      {"left and right exchanged",
       lengths,
       every_point("left_mm and right_mm look swapped",
                   [](auto& p) { std::swap(p.lengths->left_mm, p.lengths->right_mm); })},
      {"x mirrored", lengths, marks("sign of x_mm looks reversed", -1.0, 1.0)},
      {"y mirrored", lengths, marks("counted downwards", 1.0, -1.0)},
      {"x and y exchanged", lengths, axes_exchanged()},
      {"lengths in inches", lengths, chain_lengths("the lengths look like inches", kToInches)},
      {"lengths in centimetres", lengths, chain_lengths("the lengths look like centimetres", 0.1)},
      {"all in inches", lengths, chain_lengths("these look like inches", kToInches, kToInches)},
      {"no minus on x", lengths, without_minus("minus signs of x_mm seem to be missing", true, false)},
      {"a row left out", lengths, slipped(lengths, true)},
      {"left and right in a row",
       lengths,
       one_point({"re left_mm and right_mm exchanged?", "is the minus missing?", "minus too many"},
                 [](auto& p) { std::swap(p.lengths->left_mm, p.lengths->right_mm); })},
      {"digits exchanged", lengths, one_number(left_or_right, digits_exchanged)},
      {"100 mm off", lengths, one_number(right, hundred_more)},
      {"distances in inches", holes, every_distance("distances look like inches", kToInches, 0.0)},
      {"distances in centimetres",
       holes,
       every_distance("distances look like centimetres", 0.1, 0.0)},
      {"all from the 100 mm mark", holes, every_distance("give 100 mm", 1.0, 100.0)},
      {"one from the 100 mm mark", holes, one_distance(hundred_more)},
      {"a foot off", holes, one_distance(foot_less_of_long)},
      {"digits exchanged", holes, one_distance(digits_exchanged)},
      {"a hole's minus missing", holes, hole_without_minus},
      {"rows slipped", holes, distances_slipped},
      {"tl and tr exchanged",
       belts,
       every_place("tl and tr swapped", [](auto& lengths) { std::swap(lengths.tl, lengths.tr); })},
      {"both left with both right",
       belts,
       every_place("tl and tr swapped and bl and br as well",
                   [](auto& lengths) {
                     std::swap(lengths.tl, lengths.tr);
                     std::swap(lengths.bl, lengths.br);
                   })},
      {"lengths in inches", belts, belt_lengths("these lengths look like inches", kToInches)},
      {"lengths in centimetres", belts, belt_lengths("these lengths look like centimetres", 0.1)},
      {"a diagonal twice over", belts, diagonal("is it double the true", 2.0)},
      {"half a diagonal", belts, diagonal("is it half of the true", 0.5)},
      {"a digit wrong", belts, belt_digit_wrong}};
}

bool names(const std::string& message, const Expected& expected) {
  const bool is_there = expected.place.empty() ||
                        message.find(expected.place + ":") != std::string::npos ||
                        message.find(expected.place + "/") != std::string::npos;
  return is_there &&
         std::any_of(expected.words.begin(), expected.words.end(), [&](const std::string& word) {
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
                     std::any_of(said.begin(), said.end(), [&](const std::string& message) {
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
