// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bounding boxes, counts, and sampling a path.
#include "tools/gcode/reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "grid/precondition.hpp"
#include "tools/gcode/corrector.hpp"
#include "tools/gcode/emitter.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

/// Samples per turn, so that a circle smaller than the step keeps its shape.
constexpr double kRowsPerTurn = 8.0;

class Sampler final : public Sink {
 public:
  Sampler(const grid::LengthMap& map, double every_mm,
          const std::function<void(const PathLengths&)>& write, Findings& findings)
      : map_(map), every_mm_(every_mm), write_(write), findings_(findings) {}

  void move(const Move& move) override {
    const double length = length_mm(move);
    const double turns = move.arc ? std::fabs(move.arc->sweep_rad) / (2.0 * std::numbers::pi) : 0.0;
    const double pieces =
        std::max({1.0, std::ceil(length / every_mm_), std::ceil(kRowsPerTurn * turns - 1e-9)});
    const double feed = move.kind == MoveKind::rapid ? 0.0 : feed_mm_per_min(move);
    for (double i = 1.0; i <= pieces; i += 1.0) {
      const Point place = at(move, i / pieces);
      const auto answer = map_.query(place);
      if (answer) {
        write_({move.line, move.kind, place, *answer, feed});
        continue;
      }
      findings_.add(Problem{
          outside_map,
          {move.line},
          fmt::format("{} {}", in_xy(place), correction_failure(answer.error()).sentence())});
      return;
    }
  }
  void comment(const Comment& comment) override { refuse_compensated(comment); }
  void note(const Note& note) override { findings_.add(note); }
  bool goes_on_after(const Problem& problem) override {
    findings_.add(problem);
    return true;
  }

 private:
  const grid::LengthMap& map_;
  double every_mm_;
  const std::function<void(const PathLengths&)>& write_;
  Findings& findings_;
};

class Surveyor final : public Sink {
 public:
  Surveyor(const Sheet& sheet, Findings& findings) : sheet_(sheet), findings_(findings) {}

  void move(const Move& move) override {
    count(move);
    if (!move.names_xy) {
      if (move.names_z && result.box)
        include({result.box->least.x_mm, result.box->least.y_mm, move.to.z_mm});
      return;
    }
    for (const double t : bounding_places(move)) {
      if (t == 0.0 && move.kind == MoveKind::rapid) continue;
      take(at(move, t), move.line);
    }
  }
  /// Home does not matter until it is used.
  void note(const Note& note) override {
    const bool only_home = note.problem == unknown_home;
    findings_.add(only_home ? Note{note.line, note.name, note.sentence} : note);
  }
  bool goes_on_after(const Problem& problem) override {
    findings_.add(problem);
    return true;
  }

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

  void include(Point place) {
    if (!result.box) result.box = Box{place, place};
    auto& [least, most] = *result.box;
    for (const auto axis : {&Point::x_mm, &Point::y_mm, &Point::z_mm}) {
      least.*axis = std::min(least.*axis, place.*axis);
      most.*axis = std::max(most.*axis, place.*axis);
    }
  }

  void take(Point place, std::size_t line) {
    include(place);
    const interp::Rectangle& area = sheet_.area;
    const double beyond = std::max({area.x_min - place.x_mm, place.x_mm - area.x_max,
                                    area.y_min - place.y_mm, place.y_mm - area.y_max});
    if (beyond <= 1e-9) return;
    std::string sentence = fmt::format("{} is {:.2f} mm outside the sheet", in_xy(place), beyond);
    if (sheet_.is_assumed) {
      sentence += fmt::format(
          ", assumed to be {:g} x {:g} mm with X0 Y0 in its middle; --machine sets another",
          area.x_max - area.x_min, area.y_max - area.y_min);
    }
    findings_.add(Problem{outside_sheet, {line}, std::move(sentence)});
  }

  Sheet sheet_;
  Findings& findings_;
};

}  // namespace

Result<ProgramSummary> path_lengths(LineSource& source, const Dialect& dialect,
                                    const grid::LengthMap& map, double every_mm,
                                    const std::function<void(const PathLengths&)>& write,
                                    Findings& findings) {
  if (!(every_mm > 0.0)) throw grid::precondition("places every {} mm make no path", every_mm);
  Sampler sampler(map, every_mm, write, findings);
  return run_program(source, dialect, sampler);
}

Result<Survey> survey(LineSource& source, const Dialect& dialect, const Sheet& sheet,
                      Findings& findings) {
  Surveyor surveyor(sheet, findings);
  return run_program(source, dialect, surveyor).map([&](const ProgramSummary& program) {
    surveyor.result.program = program;
    return surveyor.result;
  });
}

}  // namespace chaintrue::gcode
