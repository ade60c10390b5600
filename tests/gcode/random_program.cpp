// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The generator and the law.
#include "tests/gcode/random_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode::testing_support {
namespace {

class Writer {
 public:
  explicit Writer(std::mt19937_64& random) : random_(random) {}

  std::string run() {
    text_ = "G21 G90 G17\n";
    if (below(4) == 0) text_ += "G0 Z5\n";
    if (below(3) == 0) text_ += "S12000 M3\n";
    rapid();
    feed_ = std::round(uniform(60.0, 2000.0));
    text_ += fmt::format("F{}\n", feed_);
    const int moves = 3 + static_cast<int>(below(28));
    for (int i = 0; i < moves; ++i) one();
    if (below(2) == 0) text_ += "M5\n";
    text_ += below(3) == 0 ? "" : below(2) == 0 ? "M2\n" : "M30\n";
    return text_;
  }

 private:
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  double uniform(double least, double most) {
    return least + (most - least) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  /// Log-uniform.
  double sized(double least, double most) {
    return std::exp(uniform(std::log(least), std::log(most)));
  }
  static double to_grid(double value, int decimals) {
    const double unit = std::pow(10.0, decimals);
    return std::round(value * unit) / unit;
  }

  void rapid() {
    x_ = to_grid(uniform(-900.0, 900.0), 3);
    y_ = to_grid(uniform(-450.0, 450.0), 3);
    text_ += fmt::format("G0 X{} Y{}\n", x_, y_);
  }

  void line() {
    const double length = sized(0.002, 600.0);
    const double angle = uniform(0.0, 2.0 * std::numbers::pi);
    x_ = to_grid(std::clamp(x_ + length * std::cos(angle), -950.0, 950.0), 4);
    y_ = to_grid(std::clamp(y_ + length * std::sin(angle), -470.0, 470.0), 4);
    text_ += fmt::format("G1 X{} Y{}", x_, y_);
    if (below(5) == 0) text_ += fmt::format(" Z{}", z_ = to_grid(uniform(-6.0, 1.0), 3));
    text_ += "\n";
  }

  /// About a centre towards the middle, so that the arc stays on the sheet.
  void arc() {
    const double radius = sized(0.01, 420.0);
    const double towards = std::atan2(-y_, -x_) + uniform(-0.4, 0.4);
    const double i = to_grid(radius * std::cos(towards), 5);
    const double j = to_grid(radius * std::sin(towards), 5);
    const bool clockwise = below(2) == 0;
    const bool full = below(4) == 0;
    const double sweep = full ? 2.0 * std::numbers::pi : uniform(0.05, 6.2);
    const double angle = std::atan2(-j, -i) + (clockwise ? -sweep : sweep);
    const double r = std::hypot(i, j);
    const double x = to_grid(x_ + i + r * std::cos(angle), 5);
    const double y = to_grid(y_ + j + r * std::sin(angle), 5);
    if (r < 0.009 || std::fabs(x_ + i) + r > 1000.0 || std::fabs(y_ + j) + r > 480.0) return line();
    text_ += fmt::format("G{}", clockwise ? 2 : 3);
    if (!full) {
      text_ += fmt::format(" X{:.5f} Y{:.5f}", x, y);
      x_ = x;
      y_ = y;
    }
    if (below(5) == 0) text_ += fmt::format(" Z{}", z_ = to_grid(z_ + uniform(-3.0, 3.0), 3));
    if (full && below(3) == 0) text_ += fmt::format(" P{}", 1 + below(4));
    text_ += fmt::format(" I{:.5f} J{:.5f}\n", i, j);
  }

  /// In the plane of X and Z, or Y and Z; back to its own height or beyond.
  void upright_arc() {
    const bool xz = below(2) == 0;
    double& along = xz ? x_ : y_;
    const double limit = xz ? 900.0 : 440.0;
    const double radius = to_grid(sized(0.05, 30.0), 3);
    const double side = along + 2.0 * radius > limit ? -1.0 : 1.0;
    text_ += xz ? "G18\n" : "G19\n";
    if (below(2) == 0) {
      text_ += fmt::format("G{} {}{:.3f} K0\n", 2 + below(2), xz ? "I" : "J", side * radius);
    } else {
      const double end = to_grid(along + side * 2.0 * radius, 3);
      text_ += fmt::format("G{} {}{:.3f} {}{:.3f} K0\n",
                           2 + below(2),
                           xz ? "X" : "Y",
                           end,
                           xz ? "I" : "J",
                           side * radius);
      along = end;
    }
    text_ += "G17\n";
  }

  /// Small steps on a curve, as CAM programs write reliefs and letters.
  void ripple() {
    const double step = sized(0.003, 2.0);
    const double angle = std::atan2(-y_, -x_) + uniform(-1.0, 1.0);
    const double bend = uniform(-0.3, 0.3);
    const int count = 5 + static_cast<int>(below(60));
    for (int i = 0; i < count; ++i) {
      x_ = to_grid(x_ + step * std::cos(angle + bend * i), 4);
      y_ = to_grid(y_ + step * std::sin(angle + bend * i), 4);
      text_ += fmt::format("G1 X{} Y{}\n", x_, y_);
    }
  }

  void word() {
    static constexpr const char* kWords[] = {"M8\n",
                                             "M9\n",
                                             "G4 P0.25\n",
                                             "S9000\n",
                                             "M0\n",
                                             "T3 M6\n",
                                             "G64 P0.05\n",
                                             "G61\n",
                                             "M62 P1\n"};
    text_ += kWords[below(std::size(kWords))];
  }

  void one() {
    switch (below(14)) {
      case 0:
        return rapid();
      case 1:
        text_ += fmt::format("G0 Z{}\n", z_ = to_grid(uniform(1.0, 6.0), 3));
        return;
      case 2:
        text_ += fmt::format("G1 Z{}\n", z_ = to_grid(uniform(-6.0, 0.0), 3));
        return;
      case 3:
        return word();
      case 4:
        feed_ = std::round(sized(5.0, 3000.0));
        text_ += fmt::format("F{}\n", feed_);
        return;
      case 5:
        return upright_arc();
      case 6:
        return ripple();
      case 7: {
        const double inch = to_grid(sized(0.0005, 4.0), 4) * (x_ > 0.0 ? -1.0 : 1.0);
        text_ += fmt::format("G20 G91 G1 X{}\nG21 G90\n", inch);
        x_ += 25.4 * inch;
        return;
      }
      case 8:
        text_ += fmt::format("G93\nG1 X{} Y{} F{}\nG94 F{}\n",
                             x_ = to_grid(uniform(-900.0, 900.0), 3),
                             y_,
                             to_grid(uniform(0.5, 20.0), 2),
                             feed_);
        return;
      case 9:
      case 10:
      case 11:
        return arc();
      default:
        return line();
    }
  }

  std::mt19937_64& random_;
  std::string text_;
  double x_ = 0.0;
  double y_ = 0.0;
  double z_ = 0.0;
  double feed_ = 0.0;
};

model::Machine true_machine(std::mt19937_64& random) {
  const auto off = [&random](double most) {
    return most * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  };
  model::Machine machine;
  machine.motors.left.x_mm += off(6.0);
  machine.motors.left.y_mm += off(6.0);
  machine.motors.right.x_mm += off(6.0);
  machine.motors.right.y_mm += off(6.0);
  machine.chain_zero = {off(3.0), off(3.0)};
  return machine;
}

Result<std::string> compensated(const LawCase& law, Findings& findings) {
  CompensateOptions options;
  options.tolerance_mm = law.tolerance_mm;
  options.largest_correction_mm = 100.0;
  std::string text;
  Compensator compensator(
      *law.corrector, options, [&text](std::string_view bytes) { text += bytes; });
  auto source = LineSource::from_text(law.program);
  const auto summary = compensator.run(source, {});
  findings = compensator.findings();
  if (!summary) return tl::unexpected(summary.error());
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = text.find('\n', from);
    lines.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return lines;
}

struct Command {
  std::size_t line = 0;
  double x = 0.0;
  double y = 0.0;
};

/// The commands in X and Y, as they are written.
std::vector<Command> commands_of(const std::vector<std::string>& lines) {
  std::vector<Command> commands;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!lines[i].starts_with("G0 X") && !lines[i].starts_with("G1 X")) continue;
    commands.push_back(
        {i, std::stod(lines[i].substr(4)), std::stod(lines[i].substr(lines[i].find('Y') + 1))});
  }
  return commands;
}

std::string moved(std::vector<std::string> lines,
                  const std::vector<Command>& commands,
                  std::size_t first,
                  std::size_t last,
                  double dx,
                  double dy) {
  for (std::size_t i = first; i < last; ++i) {
    std::string& line = lines[commands[i].line];
    const std::size_t y = line.find('Y');
    const std::size_t rest = line.find_first_of(" ", y);
    line = fmt::format("{} X{:.6f} Y{:.6f}{}",
                       line.substr(0, 2),
                       commands[i].x + dx,
                       commands[i].y + dy,
                       rest == std::string::npos ? "" : line.substr(rest));
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

tl::expected<VerifySummary, VerifyProblem> verified(const LawCase& law, const std::string& run) {
  VerifyOptions options;
  options.tolerance_mm = law.tolerance_mm;
  auto a = LineSource::from_text(law.program);
  auto b = LineSource::from_text(run);
  return verify(a, b, *law.corrector, {}, options);
}

/// A corner, or a point on a long straight segment, and the direction away from the path.
struct Bump {
  std::size_t command = 0;
  double dx = 0.0;
  double dy = 0.0;
};
std::vector<Bump> bumps(const std::vector<Command>& commands, double tolerance_mm) {
  std::vector<Bump> found;
  for (std::size_t i = 1; i + 1 < commands.size(); ++i) {
    const double ax = commands[i].x - commands[i - 1].x, ay = commands[i].y - commands[i - 1].y;
    const double bx = commands[i + 1].x - commands[i].x, by = commands[i + 1].y - commands[i].y;
    const double a = std::hypot(ax, ay), b = std::hypot(bx, by);
    if (a < 20.0 * tolerance_mm || b < 20.0 * tolerance_mm) continue;
    double dx = ax / a - bx / b, dy = ay / a - by / b;
    const double size = std::hypot(dx, dy);
    if (size < 0.05) {
      found.push_back({i, -ay / a, ax / a});
    } else if (size > 0.5) {
      found.push_back({i, dx / size, dy / size});
    }
  }
  return found;
}

}  // namespace

std::string random_program(std::mt19937_64& random) { return Writer(random).run(); }

tl::expected<model::ChainLengths, grid::MapFailure> TrueMachine::lengths(
    model::BedPoint point) const {
  const auto found = kinematics_->lengths(point);
  if (!found) return tl::unexpected(grid::MapReason::unreachable);
  return *found;
}

tl::expected<grid::LengthsAnswer, grid::MapFailure> TrueMachine::query(
    model::BedPoint point) const {
  const auto found = lengths(point);
  if (!found) return tl::unexpected(found.error());
  return grid::LengthsAnswer{
      Eigen::Vector2d(found->left_mm, found->right_mm), {}, std::nullopt, grid::MapStatus::inside};
}

tl::expected<model::BedPoint, grid::MapFailure> TrueMachine::tool(
    model::ChainLengths lengths) const {
  const auto found = kinematics_->command(lengths);
  if (!found) return tl::unexpected(grid::MapReason::unreachable);
  return *found;
}

LawCase::LawCase(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  program = random_program(random);
  const auto share = static_cast<double>(random() >> 11) * 0x1p-53;
  tolerance_mm = 0.005 * std::pow(200.0, share);
  constexpr model::ControllerKind kKinds[] = {model::ControllerKind::ideal,
                                              model::ControllerKind::maslow_classic,
                                              model::ControllerKind::holey,
                                              model::ControllerKind::fluidnc_wallplotter};
  believed.controller.kind = kKinds[random() % std::size(kKinds)];
  map = std::make_unique<TrueMachine>(true_machine(random));
  kinematics = model::make_controller_kinematics(believed);
  corrector = std::make_unique<Corrector>(*map, *kinematics, firmware(believed.controller.kind));
}

std::string broken_law(std::uint64_t seed, int& accepted) {
  const LawCase law(seed);
  const auto story = [&](const std::string& what, const std::string& run) {
    return fmt::format("seed {}, {}, tolerance {} mm: {}\n--- program\n{}--- run\n{}",
                       seed,
                       law.corrector->firmware().name,
                       law.tolerance_mm,
                       what,
                       law.program,
                       run);
  };
  Findings findings;
  const auto run = compensated(law, findings);
  if (!run) return story("refused: " + run.error().message(), "");
  if (findings.problem_count > 0) return {};  // limits of map or correction, by line
  ++accepted;
  const auto held = verified(law, *run);
  if (!held) return story("verify has no answer: " + held.error().problem.message(), *run);
  if (!held->holds()) return story("does not hold: " + held->fault, *run);
  if (!(held->largest_mm() <= law.tolerance_mm)) return story("holds beyond the tolerance", *run);

  std::mt19937_64 random(seed + 1);
  const auto lines = lines_of(*run);
  const auto commands = commands_of(lines);
  if (commands.size() < 3) return {};
  const double size = 1.5 * law.tolerance_mm;
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(random() >> 11) * 0x1p-53;
  const double dx = size * std::cos(angle);
  const double dy = size * std::sin(angle);
  const auto must_fail = [&](const std::string& what, const std::string& tampered) -> std::string {
    const auto outcome = verified(law, tampered);
    if (!outcome || outcome->holds()) return story(what + " is not seen", tampered);
    if (outcome->strays && !(outcome->largest_mm() > law.tolerance_mm)) {
      return story(what + " is understated", tampered);
    }
    return {};
  };
  const std::string all =
      must_fail("the whole path, moved,", moved(lines, commands, 0, commands.size(), dx, dy));
  if (!all.empty()) return all;
  const std::size_t from = random() % (commands.size() - 1);
  const std::string tail =
      must_fail("its end, moved,", moved(lines, commands, from, commands.size(), dx, dy));
  if (!tail.empty()) return tail;
  const auto places = bumps(commands, law.tolerance_mm);
  if (places.empty()) return {};
  const Bump& bump = places[random() % places.size()];
  return must_fail(
      fmt::format("command {} alone, moved,", bump.command),
      moved(lines, commands, bump.command, bump.command + 1, size * bump.dx, size * bump.dy));
}

}  // namespace chaintrue::gcode::testing_support
