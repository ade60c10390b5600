// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bounding boxes and counts.
#include "tools/gcode/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace chaintrue::gcode {
namespace {

/// Bulges of arcs are found to within radius (1 - cos(angle / 2)), 0.03 % of the radius at this
/// step.
constexpr double kLookRad = std::numbers::pi / 64.0;

class Surveyor final : public Sink {
 public:
  Surveyor(model::BedPoint home, const interp::Rectangle& sheet, Findings& findings)
      : home_(home), sheet_(sheet), findings_(findings) {}

  Result<void> move(const Move& move) override {
    count(move);
    if (!move.names_xy) {
      if (move.names_z) height(move.to.z_mm);
      return {};
    }
    const int looks =
        move.arc ? static_cast<int>(std::ceil(std::fabs(move.arc->sweep_rad) / kLookRad)) : 1;
    for (int i = move.kind == MoveKind::rapid ? looks : 0; i <= looks; ++i) {
      Point place = at(move, static_cast<double>(i) / looks);
      place.x_mm += home_.x_mm;
      place.y_mm += home_.y_mm;
      take(place, move.line);
    }
    return {};
  }
  void note(const Note& note) override { findings_.add(note); }

  Survey result;

 private:
  void count(const Move& move) {
    std::uint64_t* counters[] = {&result.rapids, &result.feeds, &result.arcs, &result.probes};
    ++*counters[static_cast<std::size_t>(move.kind)];
    const double length = length_mm(move);
    result.path_mm += length;
    if (move.kind == MoveKind::rapid) return;
    const double feed = feed_mm_per_min(move);
    result.slowest_mm_per_min = std::min(result.slowest_mm_per_min.value_or(feed), feed);
    result.fastest_mm_per_min = std::max(result.fastest_mm_per_min.value_or(feed), feed);
  }

  void height(double z_mm) {
    if (!result.box) return;
    result.box->least.z_mm = std::min(result.box->least.z_mm, z_mm);
    result.box->most.z_mm = std::max(result.box->most.z_mm, z_mm);
  }

  void take(Point place, std::size_t line) {
    if (!result.box) result.box = Box{place, place};
    Box& box = *result.box;
    box.least.x_mm = std::min(box.least.x_mm, place.x_mm);
    box.least.y_mm = std::min(box.least.y_mm, place.y_mm);
    box.most.x_mm = std::max(box.most.x_mm, place.x_mm);
    box.most.y_mm = std::max(box.most.y_mm, place.y_mm);
    height(place.z_mm);
    const double beyond = std::max({sheet_.x_min - place.x_mm,
                                    place.x_mm - sheet_.x_max,
                                    sheet_.y_min - place.y_mm,
                                    place.y_mm - sheet_.y_max});
    if (beyond <= 1e-9 || objected_line_ == line) return;
    objected_line_ = line;
    findings_.add(Problem{
        ProblemName::outside_sheet,
        {line, 0},
        fmt::format(
            "X{:.3f} Y{:.3f} lies {:.2f} mm outside the sheet", place.x_mm, place.y_mm, beyond)});
  }

  model::BedPoint home_;
  interp::Rectangle sheet_;
  Findings& findings_;
  std::size_t objected_line_ = 0;
};

}  // namespace

Result<Survey> survey(LineSource& source,
                      const Dialect& dialect,
                      model::BedPoint home,
                      const interp::Rectangle& sheet,
                      Findings& findings) {
  Surveyor surveyor(home, sheet, findings);
  const auto program = run_program(source, dialect, surveyor);
  if (!program) return tl::unexpected(program.error());
  surveyor.result.program = *program;
  return surveyor.result;
}

}  // namespace chaintrue::gcode
