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

constexpr double kInchMm = 25.4;

std::string point_place(std::size_t row) { return fmt::format("/points/{}", row); }

/// A number with two neighbouring digits exchanged, whole tens and hundreds of it: by 18 mm at least.
std::optional<double> digits_exchanged(double value) {
  std::string text = fmt::format("{:.10g}", std::abs(value));
  for (std::size_t i = 0; i + 1 < text.size() && text[i + 1] != '.'; ++i) {
    std::string other = text;
    std::swap(other[i], other[i + 1]);
    const double size = std::strtod(other.c_str(), nullptr);
    if (std::abs(size - std::abs(value)) < 18.0) continue;
    return std::copysign(size, value);
  }
  return std::nullopt;
}

/// One digit is another: of the tens or hundreds.
double digit_wrong(double value, Dice& dice) {
  const double unit = dice.below(2) == 0 ? 10.0 : 100.0;
  const double digit = std::fmod(std::floor(std::abs(value) / unit), 10.0);
  const double other = std::fmod(digit + 3.0 + static_cast<double>(dice.below(4)), 10.0);
  return std::copysign(std::abs(value) + (other - digit) * unit, value);
}

std::string rather(double meant, double written) {
  return fmt::format("is it {:.10g} rather than {:.10g}", meant, written);
}

using WholePoints = std::function<void(MeasuredPoint&)>;

Kind every_point(const char* id, Way way, std::vector<std::string> words, WholePoints spoil) {
  return {id, way, [=](Session& session, Dice&) {
            for (MeasuredPoint& point : std::get<MeasuredGrid>(session).points) spoil(point);
            return Expected{words, "", true};
          }};
}

/// A row whose mark is far enough from the axes and the diagonal that the slip is one.
std::size_t some_row(const MeasuredGrid& grid, Dice& dice) {
  for (;;) {
    const std::size_t row = dice.below(grid.points.size());
    const model::MarkPoint m = grid.points[row].mark;
    if (m.x_mm < -100.0 && m.y_mm < -100.0 && std::abs(m.x_mm - m.y_mm) > 100.0) return row;
  }
}

/// `spoil` returns the words that report it; none: another row is tried.
using OneRow = std::function<std::vector<std::string>(MeasuredPoint&, Dice&)>;

Kind one_point(const char* id, Way way, OneRow spoil) {
  return {id, way, [=](Session& session, Dice& dice) {
            auto& grid = std::get<MeasuredGrid>(session);
            for (;;) {
              const std::size_t row = some_row(grid, dice);
              const MeasuredPoint before = grid.points[row];
              std::vector<std::string> words = spoil(grid.points[row], dice);
              if (!words.empty()) return Expected{std::move(words), point_place(row), false};
              grid.points[row] = before;
            }
          }};
}

/// From some row on each has the reading of the one after it, or before it.
Kind slipped(const char* id, Way way, bool one_left_out) {
  return {id, way, [=](Session& session, Dice& dice) {
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
            return Expected{{is_after ? "of the line after" : "of the line before"},
                            point_place(from),
                            true};
          }};
}

std::vector<std::string> exchange_digits(double& number) {
  const double meant = number;
  const auto wrong = digits_exchanged(meant);
  if (!wrong) return {};
  number = *wrong;
  return {rather(meant, *wrong)};
}

void add_commands(std::vector<Kind>& kinds) {
  const Way way = Way::commands;
  const auto every = [&](const char* id, const char* words, WholePoints spoil) {
    kinds.push_back(every_point(id, way, {words}, std::move(spoil)));
  };
  every("x mirrored", "sign of x_mm looks turned", [](auto& p) { p.mark.x_mm = -p.mark.x_mm; });
  every("y mirrored", "counted downwards", [](auto& p) { p.mark.y_mm = -p.mark.y_mm; });
  every("both mirrored", "both look turned round", [](auto& p) {
    p.mark = {-p.mark.x_mm, -p.mark.y_mm};
  });
  every("x and y exchanged", "columns look swapped", [](auto& p) {
    p.mark = {p.mark.y_mm, p.mark.x_mm};
  });
  every("no minus on x", "minus signs of x_mm look left out", [](auto& p) {
    p.mark.x_mm = std::abs(p.mark.x_mm);
  });
  every("no minus on y", "minus signs of y_mm look left out", [](auto& p) {
    p.mark.y_mm = std::abs(p.mark.y_mm);
  });
  every("no minus at all", "all the minus signs look left out", [](auto& p) {
    p.mark = {std::abs(p.mark.x_mm), std::abs(p.mark.y_mm)};
  });
  every("marks in inches", "x_mm and y_mm look like inches", [](auto& p) {
    p.mark = {p.mark.x_mm / kInchMm, p.mark.y_mm / kInchMm};
  });
  every("marks in centimetres", "x_mm and y_mm look like centimetres", [](auto& p) {
    p.mark = {p.mark.x_mm / 10.0, p.mark.y_mm / 10.0};
  });
  every("all x from the 100 mm mark", "all x_mm look 100 mm too large", [](auto& p) {
    p.mark.x_mm += 100.0;
  });
  every("from the lower left corner", "counted from the bed's lower left corner", [](auto& p) {
    p.mark = {p.mark.x_mm + 1219.2, p.mark.y_mm + 609.6};
  });
  kinds.push_back(slipped("a row left out", way, true));
  kinds.push_back(slipped("a row twice", way, false));
  kinds.push_back({"marks of another sheet", way, [](Session& session, Dice& dice) {
                     for (MeasuredPoint& point : std::get<MeasuredGrid>(session).points)
                       point.mark = {std::round(dice.uniform(-1000.0, 1000.0)),
                                     std::round(dice.uniform(-500.0, 500.0))};
                     return Expected{{"are they of another sheet"}, "", true};
                   }});
  kinds.push_back(one_point("a minus missing, x", way, [](auto& p, Dice&) -> std::vector<std::string> {
    p.mark.x_mm = -p.mark.x_mm;
    return {"is the minus missing?"};
  }));
  kinds.push_back(one_point("a minus missing, y", way, [](auto& p, Dice&) -> std::vector<std::string> {
    p.mark.y_mm = -p.mark.y_mm;
    return {"is the minus missing?"};
  }));
  kinds.push_back(one_point("x and y in a row", way, [](auto& p, Dice&) -> std::vector<std::string> {
    p.mark = {p.mark.y_mm, p.mark.x_mm};
    return {"re x and y swapped?"};
  }));
  kinds.push_back(one_point("digits exchanged", way, [](auto& p, Dice& dice) {
    return exchange_digits(dice.below(2) == 0 ? p.mark.x_mm : p.mark.y_mm);
  }));
  kinds.push_back(one_point("a digit wrong", way, [](auto& p, Dice& dice) -> std::vector<std::string> {
    const double meant = p.mark.x_mm;
    p.mark.x_mm = digit_wrong(meant, dice);
    // A hundred more is also the tape's mark.
    return {rather(meant, p.mark.x_mm)};
  }));
  kinds.push_back(one_point("a digit dropped", way, [](auto& p, Dice&) -> std::vector<std::string> {
    const double meant = p.mark.x_mm;
    std::string text = fmt::format("{:.10g}", meant);
    text.erase(2, 1);
    p.mark.x_mm = std::strtod(text.c_str(), nullptr);
    if (p.mark.x_mm == meant || std::abs(p.mark.x_mm - meant) < 18.0) return {};
    return {rather(meant, p.mark.x_mm)};
  }));
  kinds.push_back(one_point("the point left out", way, [](auto& p, Dice&) -> std::vector<std::string> {
    const double meant = p.mark.y_mm;
    p.mark.y_mm = std::round(10.0 * meant);
    return {rather(meant, p.mark.y_mm)};
  }));
  kinds.push_back(one_point("100 mm off", way, [](auto& p, Dice&) -> std::vector<std::string> {
    const double meant = p.mark.x_mm;
    p.mark.x_mm += 100.0;
    return {rather(meant, p.mark.x_mm)};
  }));
  kinds.push_back(one_point("a foot off", way, [](auto& p, Dice&) -> std::vector<std::string> {
    const double meant = p.mark.y_mm;
    p.mark.y_mm -= 304.8;
    return {rather(meant, p.mark.y_mm)};
  }));
  kinds.push_back({"two rows exchanged", way, [](Session& session, Dice& dice) {
                     auto& grid = std::get<MeasuredGrid>(session);
                     const std::size_t row = 3 + dice.below(20);
                     std::swap(grid.points[row].mark, grid.points[row + 1].mark);
                     return Expected{{"look exchanged"}, point_place(row), false};
                   }});
  kinds.push_back({"a second visit without its minus", way, [](Session& session, Dice&) {
                     auto& grid = std::get<MeasuredGrid>(session);
                     for (std::size_t i = grid.points.size(); i-- > 0;) {
                       MeasuredPoint& late = grid.points[i];
                       if (late.mark.x_mm > -100.0) continue;
                       const bool is_second = std::any_of(
                           grid.points.begin(),
                           grid.points.begin() + static_cast<std::ptrdiff_t>(i),
                           [&](const MeasuredPoint& p) {
                             return p.commanded->x_mm == late.commanded->x_mm &&
                                    p.commanded->y_mm == late.commanded->y_mm;
                           });
                       if (!is_second) continue;
                       late.mark.x_mm = -late.mark.x_mm;
                       return Expected{{fmt::format("Mark {} was measured twice", *late.order)},
                                       point_place(i),
                                       false};
                     }
                     return Expected{{"no second visit was drawn"}, "", false};
                   }});
}

void add_lengths(std::vector<Kind>& kinds) {
  const Way way = Way::lengths;
  const auto every = [&](const char* id, std::vector<std::string> words, WholePoints spoil) {
    kinds.push_back(every_point(id, way, std::move(words), std::move(spoil)));
  };
  // For a mirror-symmetric frame these two are indistinguishable: both are reported.
  every("left and right exchanged", {"left_mm and right_mm look swapped"}, [](auto& p) {
    std::swap(p.lengths->left_mm, p.lengths->right_mm);
  });
  every("x mirrored", {"sign of x_mm looks turned"}, [](auto& p) { p.mark.x_mm = -p.mark.x_mm; });
  every("y mirrored", {"counted downwards"}, [](auto& p) { p.mark.y_mm = -p.mark.y_mm; });
  every("x and y exchanged", {"columns look swapped"}, [](auto& p) {
    p.mark = {p.mark.y_mm, p.mark.x_mm};
  });
  every("lengths in inches", {"the lengths look like inches"}, [](auto& p) {
    p.lengths = {p.lengths->left_mm / kInchMm, p.lengths->right_mm / kInchMm};
  });
  every("lengths in centimetres", {"the lengths look like centimetres"}, [](auto& p) {
    p.lengths = {p.lengths->left_mm / 10.0, p.lengths->right_mm / 10.0};
  });
  every("all in inches", {"these look like inches"}, [](auto& p) {
    p.lengths = {p.lengths->left_mm / kInchMm, p.lengths->right_mm / kInchMm};
    p.mark = {p.mark.x_mm / kInchMm, p.mark.y_mm / kInchMm};
  });
  every("no minus on x", {"minus signs of x_mm look left out"}, [](auto& p) {
    p.mark.x_mm = std::abs(p.mark.x_mm);
  });
  kinds.push_back(slipped("a row left out", way, true));
  kinds.push_back(one_point("left and right in a row", way, [](auto& p, Dice&) -> std::vector<std::string> {
    std::swap(p.lengths->left_mm, p.lengths->right_mm);
    return {"re left_mm and right_mm exchanged?", "is the minus missing?", "minus too many"};
  }));
  kinds.push_back(one_point("digits exchanged", way, [](auto& p, Dice& dice) {
    return exchange_digits(dice.below(2) == 0 ? p.lengths->left_mm : p.lengths->right_mm);
  }));
  kinds.push_back(one_point("100 mm off", way, [](auto& p, Dice&) -> std::vector<std::string> {
    const double meant = p.lengths->right_mm;
    p.lengths->right_mm += 100.0;
    return {rather(meant, p.lengths->right_mm)};
  }));
}

Kind every_distance(const char* id, std::vector<std::string> words, double factor, double more_mm) {
  return {id, Way::holes, [=](Session& session, Dice&) {
            for (auto& distance : std::get<MeasuredHoles>(session).distances)
              distance.distance_mm = distance.distance_mm * factor + more_mm;
            return Expected{words, "", true};
          }};
}

Kind one_distance(const char* id, std::function<std::vector<std::string>(double&, Dice&)> spoil) {
  return {id, Way::holes, [=](Session& session, Dice& dice) {
            auto& set = std::get<MeasuredHoles>(session);
            for (;;) {
              const std::size_t row = dice.below(set.distances.size());
              double& distance = set.distances[row].distance_mm;
              const double before = distance;
              std::vector<std::string> words = spoil(distance, dice);
              if (!words.empty())
                return Expected{std::move(words), "", false};
              distance = before;
            }
          }};
}

void add_holes(std::vector<Kind>& kinds) {
  kinds.push_back(
      every_distance("distances in inches", {"distances look like inches"}, 1.0 / kInchMm, 0.0));
  kinds.push_back(
      every_distance("distances in centimetres", {"distances look like centimetres"}, 0.1, 0.0));
  kinds.push_back(every_distance("all from the 100 mm mark", {"give 100 mm"}, 1.0, 100.0));
  kinds.push_back(one_distance("one from the 100 mm mark", [](double& d, Dice&) -> std::vector<std::string> {
    const double meant = d;
    d += 100.0;
    return {rather(meant, d)};
  }));
  kinds.push_back(one_distance("a foot off", [](double& d, Dice&) -> std::vector<std::string> {
    const double meant = d;
    d -= 304.8;
    if (d < 300.0) return {};
    return {rather(meant, d)};
  }));
  kinds.push_back(one_distance("digits exchanged", [](double& d, Dice&) { return exchange_digits(d); }));
  kinds.push_back({"a hole's minus missing", Way::holes, [](Session& session, Dice& dice) {
                     auto& set = std::get<MeasuredHoles>(session);
                     for (;;) {
                       auto& hole = set.holes[dice.below(set.holes.size())];
                       if (hole.commanded.x_mm > -100.0) continue;
                       hole.commanded.x_mm = -hole.commanded.x_mm;
                       // If another hole is there already, both are reported.
                       return Expected{{fmt::format("hole {} was cut at", hole.name),
                                        fmt::format("as hole {}: is a minus missing", hole.name)},
                                       "",
                                       true};
                     }
                   }});
  kinds.push_back({"rows slipped", Way::holes, [](Session& session, Dice& dice) {
                     auto& distances = std::get<MeasuredHoles>(session).distances;
                     const std::size_t from = 2 + dice.below(distances.size() - 6);
                     for (std::size_t i = from; i + 1 < distances.size(); ++i)
                       distances[i].distance_mm = distances[i + 1].distance_mm;
                     distances.pop_back();
                     return Expected{{"fit the two holes of the line after"}, "", true};
                   }});
}

void add_belts(std::vector<Kind>& kinds) {
  const auto pairs = [&](const char* id,
                         std::vector<std::string> words,
                         std::vector<std::pair<model::Belt, model::Belt>> exchanged) {
    kinds.push_back({id, Way::belts, [=](Session& session, Dice&) {
                       for (auto& point : std::get<MeasuredBelts>(session).points) {
                         for (const auto& [a, b] : exchanged)
                           std::swap(point.lengths_mm[a], point.lengths_mm[b]);
                       }
                       return Expected{words, "", true};
                     }});
  };
  using model::Belt;
  pairs("tl and tr exchanged", {"tl and tr swapped"}, {{Belt::tl, Belt::tr}});
  pairs("both left with both right",
        {"tl and tr swapped and bl and br as well"},
        {{Belt::tl, Belt::tr}, {Belt::bl, Belt::br}});
  const auto unit = [&](const char* id, const char* words, double factor) {
    kinds.push_back({id, Way::belts, [=](Session& session, Dice&) {
                       for (auto& point : std::get<MeasuredBelts>(session).points) {
                         for (const Belt belt : model::kBelts) point.lengths_mm[belt] *= factor;
                       }
                       return Expected{{words}, "", true};
                     }});
  };
  unit("lengths in inches", "these lengths look like inches", 1.0 / kInchMm);
  unit("lengths in centimetres", "these lengths look like centimetres", 0.1);
  const auto taped = [&](const char* id, const char* words, double factor) {
    kinds.push_back({id, Way::belts, [=](Session& session, Dice&) {
                       auto& distance = std::get<MeasuredBelts>(session).distances.front();
                       const double meant = distance.distance_mm;
                       distance.distance_mm *= factor;
                       return Expected{
                           {fmt::format("{} {:.10g} mm", words, meant)}, "/distances/0", true};
                     }});
  };
  taped("a diagonal twice over", "was it taped twice over,", 2.0);
  taped("half a diagonal", "was only half of it taped, of", 0.5);
  kinds.push_back({"a digit wrong", Way::belts, [](Session& session, Dice& dice) {
                     auto& belts = std::get<MeasuredBelts>(session);
                     const std::size_t row = dice.below(belts.points.size());
                     double& read = belts.points[row].lengths_mm[model::kBelts[dice.below(4)]];
                     const double meant = read;
                     read = digit_wrong(meant, dice);
                     return Expected{{rather(meant, read)}, point_place(row), false};
                   }});
}

bool names(const std::string& message, const Expected& expected) {
  const bool is_there =
      expected.place.empty() || message.find(expected.place + ":") != std::string::npos ||
      message.find(expected.place + "/") != std::string::npos;
  return is_there && std::any_of(expected.words.begin(),
                                 expected.words.end(),
                                 [&](const std::string& word) {
                                   return message.find(word) != std::string::npos;
                                 });
}

}  // namespace

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> kAll = [] {
    std::vector<Kind> all;
    add_commands(all);
    add_lengths(all);
    add_holes(all);
    add_belts(all);
    return all;
  }();
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
    return message.find("was measured twice, also at") != std::string::npos;
  });
  return messages;
}

}  // namespace chaintrue::slips
