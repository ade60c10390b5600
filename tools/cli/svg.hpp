// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Pictures made without Vega: an SVG builder, and the placement of the bed in it.
///
/// \code
///   const BedView view{grid::area_of(machine.bed), {30, 80}, 900};
///   Svg svg(960, view.high() + 170, "font-size=\"13\"", "28 points to measure");
///   svg.circle(view.x(100), view.y(200), 4, "fill=\"#000\"");
///   write_file("plan.svg", svg.finished());
/// \endcode
#pragma once

#include <fmt/format.h>
#include <string>
#include <string_view>
#include <utility>

#include "grid/raster.hpp"
#include "grid/synthetic/effect_picture.hpp"
#include "model/machine.hpp"
#include "model/square.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/bed_chart.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {

using model::CutSquare;

/// From millimetres of a rectangle, y up, to a picture's units.
struct BedView {
  Rectangle area;
  report::ToolVector corner;  ///< the upper left one in the picture
  double wide;

  double scale() const { return wide / area.width(); }
  double x(double x_mm) const { return corner.x_mm + scale() * (x_mm - area.x_min); }
  double y(double y_mm) const { return corner.y_mm + scale() * (area.y_max - y_mm); }
  double high() const { return scale() * area.height(); }
};

/// Texts are escaped; a `look` is a list of attributes as written in an element.
class Svg {
 public:
  /// \param look of the whole: its font and other attributes that all elements share
  Svg(double wide, double high, std::string_view look, std::string_view title) {
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\" "
        "{2}>\n<title>{3}</title>\n",
        wide, high, look, report::escaped(title));
  }
  template <class... Arguments>
  void add(::fmt::format_string<Arguments...> element, Arguments&&... arguments) {
    text_ += fmt::format(element, std::forward<Arguments>(arguments)...);
  }
  /// White behind all that follows.
  void fill() { text_ += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"; }
  void rectangle(double x, double y, double wide, double high, std::string_view look) {
    add("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", x, y, wide,
        high, look);
  }
  void circle(double x, double y, double radius, std::string_view look) {
    add("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.1f}\" {}/>\n", x, y, radius, look);
  }
  void path(std::string_view d, std::string_view look) { add("<path d=\"{}\" {}/>\n", d, look); }
  /// \param anchor start, middle or end
  /// \param look empty, or with a blank in front
  void text(double x, double y, std::string_view words, std::string_view anchor = "start",
            std::string_view look = "") {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, look,
        report::escaped(words));
  }
  std::string finished() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

// Drawings (SVG) of what a machine does with its errors: what an effect moves, every cause on one
// page, and a square as cut. Same picture, same bytes.
/// Arrows over the bed before and after calibration, and the two squares as cut, both with their
/// scale printed.
std::string draw_effect(const Machine& machine, const synthetic::EffectPicture& picture);

/// `3`, `0.17`, `6e-06`: three digits, without trailing zeros.
std::string short_number(double value);

/// chaintrue square: the commanded outline, the cut one with its errors magnified, and the numbers
/// that a ruler would show.
std::string draw_square(const CutSquare& square, const SquareTask& task);

/// chaintrue effects --atlas: writes a page with the drawings of each cause, for two chains, four
/// belts or a V-plotter; only for one cause if `cause` is not empty. `declared` are files of the
/// owner's effects, for two chains only. \throws InputError with every problem.
int write_atlas(const std::string& machine, const std::string& cause, const Words& declared,
                const std::string& output);

}  // namespace chaintrue::cli
