// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/follow_run.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "tests/gcode_witness/support/compensated.hpp"
#include "tests/gcode_witness/support/program_generator.hpp"
#include "tests/gcode_witness/support/random.hpp"

namespace chaintrue::witness {
namespace {

using model::ControllerKind;

constexpr std::array kKinds = {ControllerKind::ideal, ControllerKind::maslow_classic,
                               ControllerKind::holey, ControllerKind::fluidnc_wallplotter};

/// The follower's own errors: its chords, its samples, and single precision's 6e-5 mm.
constexpr double kOwnMm = follower::kChordMm + 1e-4;
/// The two checks sample and match differently: they may disagree near the tolerance.
constexpr double kBand = 0.1;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

struct Command {
  std::size_t line;
  double x;
  double y;
};

/// The lines of the output that move in X or Y.
std::vector<Command> commands(const std::vector<std::string>& lines) {
  std::vector<Command> result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t x = lines[i].find(" X");
    const std::size_t y = lines[i].find(" Y");
    if (lines[i].front() != 'G' || x == std::string::npos || y == std::string::npos) continue;
    result.push_back({i, std::stod(lines[i].substr(x + 2)), std::stod(lines[i].substr(y + 2))});
  }
  return result;
}

/// The output with one command moved perpendicular to its path by this distance.
std::optional<std::string> moved(const std::string& output, Random& random, double by_mm) {
  auto lines = lines_of(output);
  const auto all = commands(lines);
  if (all.size() < 3) return std::nullopt;
  const auto at = static_cast<std::size_t>(random.whole(1, static_cast<int>(all.size()) - 1));
  const double dx = all[at].x - all[at - 1].x;
  const double dy = all[at].y - all[at - 1].y;
  const double way = std::hypot(dx, dy);
  if (way == 0.0) return std::nullopt;
  const double side = random.one_in(2) ? by_mm : -by_mm;
  std::string& line = lines[all[at].line];
  const std::size_t x = line.find(" X");
  const std::size_t y = line.find(" Y");
  const std::size_t end = line.find(' ', y + 1);
  line = line.substr(0, x) +
         fmt::format(" X{:.4f} Y{:.4f}", all[at].x - side * dy / way, all[at].y + side * dx / way) +
         (end == std::string::npos ? "" : line.substr(end));
  return joined_lines(lines);
}

/// The output without one of its commands.
std::optional<std::string> shortened(const std::string& output, Random& random) {
  auto lines = lines_of(output);
  const auto all = commands(lines);
  if (all.size() < 3) return std::nullopt;
  const auto at = static_cast<std::size_t>(random.whole(1, static_cast<int>(all.size()) - 1));
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(all[at].line));
  return joined_lines(lines);
}

/// What is wrong with one program, or nothing.
class Trial {
 public:
  Trial(const Shop& shop, const std::string& program, double tolerance_mm, Random& random)
      : shop_(shop), program_(program), tolerance_mm_(tolerance_mm), random_(random) {}

  /// Empty if it is right.
  std::string run(FollowRun& run) {
    std::string why;
    const auto output = shop_.compensate(program_, tolerance_mm_, why);
    if (!output) return {};
    ++run.compensated;
    if (!shop_.follows(program_, *output, tolerance_mm_ + kOwnMm)) {
      return fmt::format("the tool is {:.4f} mm off the path",
                         shop_.distance_mm(program_, *output, 100.0));
    }
    if (const std::string fault = shop_.verify(program_, *output, tolerance_mm_); !fault.empty())
      return "verify: " + fault;
    if (const auto wrong = moved(*output, random_, 1.5 * tolerance_mm_)) {
      ++run.judged_moved;
      if (std::string fault = same_verdicts(*wrong, "moved by 1.5 tolerances"); !fault.empty())
        return fault;
    }
    if (const auto wrong = shortened(*output, random_)) {
      ++run.judged_moved;
      return same_verdicts(*wrong, "without one command");
    }
    return {};
  }

 private:
  /// Verify's verdict on a changed output must equal the follower's. Verify checks more than the
  /// path, so that it may fail where the path alone passes.
  std::string same_verdicts(const std::string& output, const char* what) const {
    if (shop_.follows(program_, output, (1.0 + kBand) * tolerance_mm_ + kOwnMm)) return {};
    if (!shop_.verify(program_, output, tolerance_mm_).empty()) return {};
    return fmt::format("verify holds the output {}, but the tool is {:.4f} mm off the path", what,
                       shop_.distance_mm(program_, output, 100.0));
  }

  const Shop& shop_;
  const std::string& program_;
  double tolerance_mm_;
  Random& random_;
};

/// Empty if the program is compensated and judged correctly, or rejected.
std::string judged(const Shop& shop, const std::string& program, double tolerance_mm,
                   std::uint64_t seed, FollowRun& run) {
  Random random(seed);
  try {
    return Trial(shop, program, tolerance_mm, random).run(run);
  } catch (const std::runtime_error& error) {
    return std::string("the follower: ") + error.what();
  }
}

}  // namespace

FollowRun follow(const std::string& fixtures, const FollowOptions& options) {
  GeneratorOptions generator;
  generator.scope = Scope::path;
  FollowRun run;
  for (std::uint64_t i = options.share; i < options.count; i += options.shares) {
    const std::uint64_t seed = options.first_seed + i;
    const std::string program = random_program(seed, generator);
    // Log-uniform from 0.005 to 1 mm.
    const double tolerance_mm = 0.005 * std::pow(200.0, Random(~seed).unit());
    // Each controller in turn, with the measured machine and then with a random one.
    const ControllerKind kind = kKinds[seed % kKinds.size()];
    const bool measured = seed / kKinds.size() % 2 == 0;
    const auto shop = measured ? measured_shop(fixtures, kind) : random_shop(seed, kind);
    ++run.programs;
    const std::string fault = judged(*shop, program, tolerance_mm, seed, run);
    if (fault.empty()) continue;
    ++run.failed;
    if (run.failures.size() >= options.most_reported) continue;
    run.failures.push_back(fmt::format("seed {}, {}, tolerance {:.5f} mm: {}\n{}", seed,
                                       shop->name(), tolerance_mm, fault, program));
  }
  return run;
}

}  // namespace chaintrue::witness
