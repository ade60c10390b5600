// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/measuring_drawings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

#include "tools/cli/svg.hpp"

namespace chaintrue::cli {
namespace {

constexpr double kHowWide = 380.0, kHowHigh = 200.0;

/// Objects in black, measurements in blue.
class Drawing : public Svg {
 public:
  explicit Drawing(std::string_view title)
      : Svg(kHowWide, kHowHigh, "class=\"how\" font-size=\"13\" role=\"img\"", title) {}
  void path(std::string_view d, std::string_view look = "fill=\"none\" stroke=\"#111\"") {
    Svg::path(d, look);
  }
  void text(double x, double y, std::string_view words, std::string_view anchor = "middle") {
    Svg::text(x, y, words, anchor);
  }
  /// A measured length, with an arrow head at either end.
  void measure(double x1, double y1, double x2, double y2) {
    const std::string blue =
        fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", report::kAfterColor);
    path(fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}{}{}",
                     x1,
                     y1,
                     x2,
                     y2,
                     head(x1, y1, x2, y2),
                     head(x2, y2, x1, y1)),
         blue);
  }

 private:
  /// At (x, y), of an arrow that comes from (from_x, from_y).
  static std::string head(double x, double y, double from_x, double from_y) {
    constexpr double kLong = 7.0, kHalfOpening = 0.4;
    const double back = std::atan2(from_y - y, from_x - x);
    return fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}L{:.1f},{:.1f}",
                       x + kLong * std::cos(back - kHalfOpening),
                       y + kLong * std::sin(back - kHalfOpening),
                       x,
                       y,
                       x + kLong * std::cos(back + kHalfOpening),
                       y + kLong * std::sin(back + kHalfOpening));
  }
};

constexpr std::string_view kWood = "fill=\"#f7f1e6\" stroke=\"#111\"";
constexpr std::string_view kSteel = "fill=\"#e3e7ec\" stroke=\"#111\"";
constexpr std::string_view kHole = "fill=\"#fff\" stroke=\"#111\" stroke-width=\"1.5\"";

}  // namespace

std::string draw_middle_lines() {
  Drawing drawing("A mark measured from the middle lines of the sheet with a square");
  drawing.path("M10,10H370V170H10Z", kWood);
  drawing.path("M10,90H370M190,10V170",
               "fill=\"none\" stroke=\"#111\" stroke-dasharray=\"8 4 2 4\"");
  // A square: its stock on the line across, its blade up to the mark.
  drawing.path("M300,90V28H314V90H344V100H270V90Z", kSteel);
  drawing.circle(300, 40, 5, kHole);
  drawing.measure(190, 112, 300, 112);
  drawing.path("M300,90V118", "fill=\"none\" stroke=\"#111\" stroke-width=\"0.8\"");
  drawing.measure(288, 90, 288, 40);
  drawing.text(245, 129, "x");
  drawing.text(277, 70, "y");
  drawing.text(293, 30, "mark", "end");
  drawing.text(186, 24, "middle line", "end");
  drawing.text(20, 84, "middle line", "start");
  drawing.text(100, 122, "here x has a minus");
  drawing.text(280, 160, "here y has a minus");
  drawing.text(190, 190, "draw both middle lines first; hold the square against them");
  return drawing.finished();
}

std::string draw_tape_and_hook() {
  Drawing drawing("A tape with its 100 mm mark at the first hole and the hook hanging free");
  drawing.path("M10,20H370V150H10Z", kWood);
  drawing.path("M40,70H350V94H40Z", "fill=\"#fdf3c4\" stroke=\"#111\"");
  drawing.path("M40,66V104H34V66Z", "fill=\"#555\" stroke=\"#111\"");
  std::string ticks;
  constexpr double kFirst = 40.0, kStep = 10.0;
  for (int i = 1; i <= 30; ++i)
    ticks += fmt::format("M{:.0f},94V{:.0f}", kFirst + kStep * i, i % 5 == 0 ? 82.0 : 88.0);
  drawing.path(ticks);
  for (const double x : {140.0, 310.0}) {
    drawing.circle(x, 106, 6, kHole);
    drawing.path(fmt::format("M{0:.0f},94V112M{1:.0f},106H{2:.0f}", x, x - 9, x + 9));
  }
  drawing.text(140, 66, "100");
  drawing.text(310, 66, "tape reading");
  drawing.text(37, 60, "hook: free", "start");
  drawing.text(140, 130, "first hole");
  drawing.text(310, 130, "second hole");
  drawing.measure(140, 140, 310, 140);
  drawing.text(190, 170, "from centre to centre; the hook has play, so leave");
  drawing.text(190, 188, "the 100 in and write down the reading");
  return drawing.finished();
}

std::string draw_chain_length() {
  Drawing drawing("A chain's length from the pin at 12 o'clock to its end at the ring");
  constexpr double kX = 70.0, kY = 70.0, kRadius = 30.0;
  drawing.circle(kX, kY, kRadius, "fill=\"#e3e7ec\" stroke=\"#111\"");
  std::string teeth;
  for (int i = 0; i < 10; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 10.0 - 0.5 * std::numbers::pi;
    teeth += fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}",
                         kX + kRadius * std::cos(angle),
                         kY + kRadius * std::sin(angle),
                         kX + (kRadius + 6.0) * std::cos(angle),
                         kY + (kRadius + 6.0) * std::sin(angle));
  }
  drawing.path(teeth, "fill=\"none\" stroke=\"#111\" stroke-width=\"3\"");
  drawing.circle(kX, kY - kRadius - 4.0, 4.0, "fill=\"#111\"");
  // From 12 o'clock over the top, then straight to the ring.
  drawing.path("M70,36A34,34 0 0 1 97,49.5L290,130",
               fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"4\"", report::kAfterColor));
  drawing.circle(320, 142, 32, "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  drawing.circle(320, 142, 3, "fill=\"#111\"");
  drawing.path("M290,122V138", "fill=\"none\" stroke=\"#111\" stroke-width=\"2\"");
  drawing.text(70, 20, "pin at 12 o'clock");
  drawing.text(205, 80, "the chain's length", "start");
  drawing.text(282, 152, "its end at the ring", "end");
  drawing.text(320, 190, "sled");
  return drawing.finished();
}

}  // namespace chaintrue::cli
