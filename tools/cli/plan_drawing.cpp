// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {
namespace {

using model::BedPoint;
using model::MarkPoint;

// The picture, in its own units.
constexpr double kBedWide = 900.0, kLeft = 30.0, kTop = 80.0, kBelow = 90.0;
constexpr double kBarWide = 300.0, kBarHigh = 14.0;
constexpr int kBarSteps = 30;

/// Light to dark, from the least expected error to the largest: dark is bad in grey print as well.
std::string colour(double share) {
  constexpr std::array<int, 3> kLight = {255, 247, 236};
  constexpr std::array<int, 3> kDark = {179, 88, 6};
  std::array<long, 3> mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = std::lround(kLight[i] + share * (kDark[i] - kLight[i]));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

class Picture {
 public:
  explicit Picture(const model::Bed& bed) : bed_(bed), scale_(kBedWide / bed.width_mm) {}
  [[nodiscard]] double x(double x_mm) const {
    return kLeft + scale_ * (x_mm + 0.5 * bed_.width_mm);
  }
  [[nodiscard]] double y(double y_mm) const {
    return kTop + scale_ * (0.5 * bed_.height_mm - y_mm);
  }
  [[nodiscard]] double bed_high() const { return scale_ * bed_.height_mm; }
  [[nodiscard]] double wide() const { return kBedWide + 2.0 * kLeft; }
  [[nodiscard]] double high() const { return kTop + bed_high() + kBelow; }

 private:
  const model::Bed& bed_;
  double scale_;
};

std::string head(const Picture& picture, std::string_view title, std::string_view description) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222222\">\n"
      "<title>{2}</title>\n"
      "<desc>{3}</desc>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      picture.wide(),
      picture.high(),
      title,
      description);
}

void text(std::string& svg, double x, double y, std::string_view anchor, std::string_view words) {
  fmt::format_to(std::back_inserter(svg),
                 "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                 x,
                 y,
                 anchor,
                 words);
}

void rectangle(
    std::string& svg, const BedPoint& corner, double wide, double high, const std::string& fill) {
  fmt::format_to(std::back_inserter(svg),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                 "fill=\"{}\"/>\n",
                 corner.x_mm,
                 corner.y_mm,
                 wide,
                 high,
                 fill);
}

struct Shades {
  double least_mm = 0.0;
  double largest_mm = 0.0;
  [[nodiscard]] std::string of(double error_mm) const {
    const double range = largest_mm - least_mm;
    return colour(range > 0.0 ? (error_mm - least_mm) / range : 0.0);
  }
};

Shades shades_of(const ExpectedErrors& errors) {
  Shades shades{errors.largest_mm, errors.largest_mm};
  for (double error : errors.cells_mm) {
    if (error >= 0.0) shades.least_mm = std::min(shades.least_mm, error);
  }
  return shades;
}

void draw_errors(std::string& svg,
                 const Picture& picture,
                 const ExpectedErrors& errors,
                 const Shades& shades) {
  const double wide = kBedWide / errors.columns;
  const double high = picture.bed_high() / errors.rows;
  svg += "<g shape-rendering=\"crispEdges\">\n";
  for (int row = 0; row < errors.rows; ++row) {
    for (int column = 0; column < errors.columns; ++column) {
      const double error =
          errors.cells_mm[static_cast<std::size_t>(row) * static_cast<std::size_t>(errors.columns) +
                          static_cast<std::size_t>(column)];
      const BedPoint corner{kLeft + wide * column, kTop + high * (errors.rows - 1 - row)};
      rectangle(svg, corner, wide, high, error < 0.0 ? "#bbbbbb" : shades.of(error));
    }
  }
  svg += "</g>\n";
}

void draw_walk(std::string& svg, const Picture& picture, const std::vector<MarkPoint>& marks) {
  fmt::format_to(std::back_inserter(svg),
                 "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1\" "
                 "stroke-opacity=\"0.6\" points=\"",
                 report::kAfterColor);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    fmt::format_to(std::back_inserter(svg),
                   "{}{:.2f},{:.2f}",
                   i == 0 ? "" : " ",
                   picture.x(marks[i].x_mm),
                   picture.y(marks[i].y_mm));
  }
  svg += "\"/>\n";
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double x = picture.x(marks[i].x_mm);
    const double y = picture.y(marks[i].y_mm);
    fmt::format_to(std::back_inserter(svg),
                   "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4\" fill=\"{}\"/>\n",
                   x,
                   y,
                   report::kAfterColor);
    // Numbers stand towards the middle of the bed, so that none is cut off at its edge.
    const bool right_half = marks[i].x_mm > 0.0;
    const bool upper_half = marks[i].y_mm > 0.0;
    text(svg,
         x + (right_half ? -7.0 : 7.0),
         y + (upper_half ? 15.0 : -6.0),
         right_half ? "end" : "start",
         fmt::format("{}", i + 1));
  }
}

void draw_bar(std::string& svg, const Picture& picture, const Shades& shades) {
  const double top = picture.high() - 55.0;
  for (int step = 0; step < kBarSteps; ++step) {
    const double share = (step + 0.5) / kBarSteps;
    rectangle(svg,
              {kLeft + kBarWide * step / kBarSteps, top},
              kBarWide / kBarSteps + 0.5,
              kBarHigh,
              colour(share));
  }
  text(svg, kLeft, top + 32.0, "start", fmt::format("{:.2f} mm", shades.least_mm));
  text(svg, kLeft + kBarWide, top + 32.0, "end", fmt::format("{:.2f} mm", shades.largest_mm));
  text(svg,
       kLeft + kBarWide + 20.0,
       top + 12.0,
       "start",
       "expected error of the tool, one sigma; grey: the chains cannot hold the sled");
}

}  // namespace

ExpectedErrors expected_errors(const grid::CompensationMap& map, const model::Bed& bed) {
  ExpectedErrors errors;
  errors.columns = 60;
  errors.rows = 30;
  errors.cells_mm = grid::expected_error_mm(map, bed, errors.columns, errors.rows);
  double squares = 0.0;
  for (std::size_t i = 0; i < errors.cells_mm.size(); ++i) {
    const double error = errors.cells_mm[i];
    if (error < 0.0) {
      ++errors.unanswered;
      continue;
    }
    squares += error * error;
    if (error > errors.largest_mm) {
      errors.largest_mm = error;
      const auto columns = static_cast<std::size_t>(errors.columns);
      errors.worst_at = {
          bed.width_mm * ((static_cast<double>(i % columns) + 0.5) / errors.columns - 0.5),
          bed.height_mm * ((static_cast<double>(i / columns) + 0.5) / errors.rows - 0.5)};
    }
  }
  const std::size_t answered = errors.cells_mm.size() - errors.unanswered;
  if (answered > 0) errors.rms_mm = std::sqrt(squares / static_cast<double>(answered));
  return errors;
}

std::string draw_follow_up(const FollowUpDrawing& drawing, const model::Bed& bed) {
  const Picture picture(bed);
  const std::string words = fmt::format(
      "{} places to measure next, among {} measured", drawing.next.size(), drawing.measured.size());
  std::string svg = head(picture, words, "The numbers are those of the list.");
  text(svg, kLeft, 32.0, "start", words);
  fmt::format_to(std::back_inserter(svg),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                 "fill=\"#faf6ee\" stroke=\"#222222\"/>\n",
                 kLeft,
                 kTop,
                 kBedWide,
                 picture.bed_high());
  for (const MarkPoint& mark : drawing.measured) {
    fmt::format_to(std::back_inserter(svg),
                   "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3\" fill=\"{}\"/>\n",
                   picture.x(mark.x_mm),
                   picture.y(mark.y_mm),
                   report::kNeutralColor);
  }
  for (const auto& [numbers, mark] : drawing.next) {
    const double x = picture.x(mark.x_mm);
    const double y = picture.y(mark.y_mm);
    constexpr double kArm = 7.0;
    fmt::format_to(std::back_inserter(svg),
                   "<path d=\"M{:.2f},{:.2f}L{:.2f},{:.2f}M{:.2f},{:.2f}L{:.2f},{:.2f}\" "
                   "stroke=\"{}\" stroke-width=\"2.5\"/>\n",
                   x - kArm,
                   y - kArm,
                   x + kArm,
                   y + kArm,
                   x - kArm,
                   y + kArm,
                   x + kArm,
                   y - kArm,
                   report::kAfterColor);
    const bool right_half = mark.x_mm > 0.0;
    text(svg,
         x + (right_half ? -10.0 : 10.0),
         y + (mark.y_mm > 0.0 ? 18.0 : -9.0),
         right_half ? "end" : "start",
         numbers);
  }
  return svg + "</svg>\n";
}

std::string draw_plan(const grid::MeasurementPlan& plan,
                      const model::Bed& bed,
                      const ExpectedErrors& errors) {
  const Picture picture(bed);
  const Shades shades = shades_of(errors);
  std::string svg = head(picture,
                         fmt::format("{} points to measure", plan.marks.size()),
                         "The bed coloured by the expected error of a map from these points; the "
                         "marks are numbered in the order of the walk.");
  text(svg,
       kLeft,
       32.0,
       "start",
       fmt::format("{} points to measure: {} columns x {} rows{}",
                   plan.marks.size(),
                   plan.columns,
                   plan.rows,
                   plan.extra > 0 ? fmt::format(" and {} more", plan.extra) : ""));
  text(svg,
       kLeft,
       56.0,
       "start",
       fmt::format("bed {:g} x {:g} mm, expected error {:.2f} mm rms, {:.2f} mm at most",
                   bed.width_mm,
                   bed.height_mm,
                   errors.rms_mm,
                   errors.largest_mm));
  draw_errors(svg, picture, errors, shades);
  fmt::format_to(std::back_inserter(svg),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                 "fill=\"none\" stroke=\"#222222\"/>\n",
                 kLeft,
                 kTop,
                 kBedWide,
                 picture.bed_high());
  draw_walk(svg, picture, plan.marks);
  draw_bar(svg, picture, shades);
  return svg + "</svg>\n";
}

}  // namespace chaintrue::cli
