// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace chaintrue::planted {

bool same_class(std::string_view one, std::string_view other) {
  if (one == other) return true;
  using Two = std::array<std::string_view, 2>;
  constexpr std::array<Two, 3> kClasses = {Two{"chain_pitch_error:both", "tape_scale:both"},
                                           Two{"tooth_skip:left", "zero_shift:left"},
                                           Two{"tooth_skip:right", "zero_shift:right"}};
  return std::any_of(kClasses.begin(), kClasses.end(), [&](const Two& members) {
    const auto has = [&](std::string_view id) { return id == members[0] || id == members[1]; };
    return has(one) && has(other);
  });
}

void Method::add(const Scores& scores,
                 const std::vector<std::string>& hidden_here,
                 const std::vector<std::string>& no_matter) {
  ++sets;
  hidden += static_cast<int>(hidden_here.size());
  const auto is_one_of = [](const std::vector<std::string>& ids, const std::string& id) {
    return std::any_of(
        ids.begin(), ids.end(), [&](const std::string& other) { return same_class(id, other); });
  };
  for (const std::string& own : hidden_here) {
    double best = 0.0;
    bool named = false;
    for (const auto& [id, score] : scores) {
      if (!same_class(id, own)) continue;
      best = named ? std::max(best, score) : score;
      named = true;
    }
    if (named) names.push_back({best, true});
  }
  for (const auto& [id, score] : scores) {
    if (!is_one_of(hidden_here, id) && !is_one_of(no_matter, id)) names.push_back({score, false});
  }
}

CurvePoint at_threshold(const Method& method, double threshold) {
  CurvePoint point;
  for (const ScoredName& name : method.names) {
    if (name.score < threshold) continue;
    ++(name.right ? point.right : point.wrong);
  }
  return point;
}

CurvePoint at_most_wrong(const Method& method, int wrong) {
  std::vector<ScoredName> ranked = method.names;
  std::sort(
      ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  CurvePoint here, best;
  for (std::size_t k = 0; k < ranked.size(); ++k) {
    ++(ranked[k].right ? here.right : here.wrong);
    if (here.wrong > wrong) break;
    // Names of one score come together.
    const bool last_of_score = k + 1 == ranked.size() || ranked[k + 1].score < ranked[k].score;
    if (last_of_score) best = here;
  }
  return best;
}

std::string curves_table(const std::vector<Method>& methods) {
  constexpr std::array kWrongInAHundred = {1, 2, 5, 10, 20, 50};
  std::string text = "| right names, %, with so many false ones in 100 sets |";
  for (const int wrong : kWrongInAHundred) text += fmt::format(" {} |", wrong);
  text += " usual threshold | right, % | false in 100 sets |\n|---|";
  for (std::size_t k = 0; k < kWrongInAHundred.size() + 3; ++k) text += "---|";
  text += "\n";
  for (const Method& method : methods) {
    if (method.sets == 0 || method.hidden == 0) continue;
    const auto share = [&](int right) { return 100.0 * right / method.hidden; };
    text += "| " + method.name + " |";
    for (const int wrong : kWrongInAHundred) {
      text +=
          fmt::format(" {:.0f} |", share(at_most_wrong(method, wrong * method.sets / 100).right));
    }
    const CurvePoint usual = at_threshold(method, method.usual);
    text += fmt::format(" {:g} | {:.0f} | {:.0f} |\n",
                        method.usual,
                        share(usual.right),
                        100.0 * usual.wrong / method.sets);
  }
  return text;
}

namespace {

constexpr double kMostWrong = 50.0;  // in 100 sets
constexpr double kPanel = 300.0;     // width and height of the axes
constexpr double kLeft = 60.0;
constexpr double kTop = 40.0;
constexpr double kPitch = kPanel + 80.0;
constexpr std::array kColours = {"#888888", "#d95f02", "#7570b3", "#66a61e", "#e7298a", "#1b4f9c"};

/// Where a panel has a share of right names at so many false ones.
class Panel {
 public:
  Panel(const Method& method, double left) : method_(method), left_(left) {}
  [[nodiscard]] std::string at(const CurvePoint& point) const {
    const double wrong = std::min(kMostWrong, 100.0 * point.wrong / method_.sets);
    const double right = static_cast<double>(point.right) / method_.hidden;
    return fmt::format("{:.1f},{:.1f}", left_ + kPanel * wrong / kMostWrong, kTop + kPanel * (1.0 - right));
  }

 private:
  const Method& method_;
  double left_;
};

std::string curve_of(const Method& method, double left, const char* colour) {
  const Panel panel(method, left);
  std::string points;
  const int most = static_cast<int>(kMostWrong * method.sets / 100.0);
  CurvePoint last{-1, 0};
  for (int wrong = 0; wrong <= most; ++wrong) {
    CurvePoint here = at_most_wrong(method, wrong);
    if (here.right == last.right && wrong != most) continue;
    last = here;
    points += panel.at({here.right, wrong}) + " ";
  }
  std::string text =
      fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", points, colour);
  const CurvePoint usual = at_threshold(method, method.usual);
  if (100.0 * usual.wrong <= kMostWrong * method.sets) {
    const std::string at = panel.at(usual);
    const std::size_t comma = at.find(',');
    text += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"4\" fill=\"{}\"/>\n",
                        at.substr(0, comma), at.substr(comma + 1), colour);
  }
  return text;
}

std::string axes_at(double left, const std::string& title) {
  std::string text = fmt::format(
      "<rect x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\n"
      "<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"middle\">false names in 100 sets</text>\n",
      left, kTop, kPanel, kPanel, left + 0.5 * kPanel, kTop - 14.0, title, left + 0.5 * kPanel, kTop + kPanel + 36.0);
  for (int tick = 0; tick <= 5; ++tick) {
    const double x = left + kPanel * tick / 5.0;
    const double y = kTop + kPanel * (1.0 - tick / 5.0);
    text += fmt::format(
        "<line x1=\"{0:g}\" y1=\"{1:g}\" x2=\"{2:g}\" y2=\"{1:g}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{3:g}\" y=\"{4:g}\" text-anchor=\"middle\">{5:g}</text>\n"
        "<text x=\"{6:g}\" y=\"{7:g}\" text-anchor=\"end\">{8}</text>\n",
        left, y, left + kPanel, x, kTop + kPanel + 16.0, kMostWrong * tick / 5.0, left - 6.0, y + 4.0, 20 * tick);
  }
  return text;
}

}  // namespace

std::string curves_svg(const std::vector<CurveGroup>& groups) {
  const double width = kLeft + kPitch * static_cast<double>(groups.size());
  const double below = kTop + kPanel + 56.0;
  const std::size_t methods = groups.empty() ? 0 : groups.front().methods.size();
  const double height = below + 18.0 * static_cast<double>(methods) + 8.0;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text transform=\"translate(16 {:g}) rotate(-90)\" text-anchor=\"middle\">right names, % of the hidden "
      "causes</text>\n",
      width, height, kTop + 0.5 * kPanel);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double left = kLeft + kPitch * static_cast<double>(g);
    text += axes_at(left, groups[g].title);
    for (std::size_t k = 0; k < groups[g].methods.size(); ++k) {
      const Method& method = groups[g].methods[k];
      if (method.sets > 0 && method.hidden > 0) text += curve_of(method, left, kColours[k % kColours.size()]);
    }
  }
  for (std::size_t k = 0; k < methods; ++k) {
    const double y = below + 18.0 * static_cast<double>(k);
    text += fmt::format(
        "<line x1=\"{0:g}\" y1=\"{1:g}\" x2=\"{2:g}\" y2=\"{1:g}\" stroke=\"{3}\" stroke-width=\"2\"/>\n"
        "<text x=\"{4:g}\" y=\"{5:g}\">{6}</text>\n",
        kLeft, y, kLeft + 30.0, kColours[k % kColours.size()], kLeft + 38.0, y + 4.0,
        groups.front().methods[k].name);
  }
  return text + "</svg>\n";
}

}  // namespace chaintrue::planted
