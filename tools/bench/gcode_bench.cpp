// SPDX-License-Identifier: GPL-3.0-or-later
// Compensating G-code as it comes from CAM programs: a relief of short straight cuts and a plate of
// arcs, on a map that was fitted to fixtures/grids/seven_by_four.json. items_per_second are input
// blocks. gcode/compensate_and_verify runs the output on the simulated controller and machine too,
// as the command does. gcode/compensate/200_mb streams a program of 200 MB that is generated while
// it is read; peak_rss_mb is the whole process's, map and benchmark included.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <istream>
#include <memory>
#include <streambuf>
#include <string>

#include "grid/files/grid_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/map_in_frame.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode {
namespace {

/// A map and the classic controller, fitted once.
struct Fitted {
  Fitted()
      : map(grid::fit(grid::files::read(grid::files::parse_grid,
                                        CHAINTRUE_FIXTURES "/grids/seven_by_four.json")
                          .grid)
                .value()),
        target(map),
        machine(with_classic_controller(*grid::stated_machine(map))),
        kinematics(model::make_controller_kinematics(machine)),
        corrector(target, *kinematics, firmware(machine.controller.kind)) {}

  static model::Machine with_classic_controller(model::Machine machine) {
    machine.controller.kind = model::ControllerKind::maslow_classic;
    return machine;
  }

  grid::CompensationMap map;
  grid::MapInFrame target;
  model::Machine machine;
  std::unique_ptr<const model::ControllerKinematics> kinematics;
  Corrector corrector;
};

const Fitted& fitted() {
  static const Fitted once;
  return once;
}

/// Rows of 0.8 mm cuts over a relief 1 m wide, from the middle of the bed outwards and back.
std::string relief_line(std::uint64_t number) {
  constexpr std::uint64_t kColumns = 1250;
  const std::uint64_t row = number / kColumns % 600;
  const std::uint64_t column = number % kColumns;
  const double x = -500.0 + 0.8 * static_cast<double>(row % 2 == 0 ? column : kColumns - column);
  const double y = -300.0 + static_cast<double>(row);
  return fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} F1500\n", x, y,
                     -3.0 + 2.0 * std::sin(0.03 * x) * std::cos(0.02 * y));
}

/// Makes its text as it is read; can only be rewound to the beginning.
class ReliefBuffer final : public std::streambuf {
 public:
  explicit ReliefBuffer(std::uint64_t bytes) : bytes_(bytes) {}

 protected:
  int_type underflow() override {
    if (made_ >= bytes_) return traits_type::eof();
    chunk_ = number_ == 0 ? "G21 G90\nG0 Z5\nG0 X-500 Y-300\n" : "";
    while (chunk_.size() < 65536) chunk_ += relief_line(number_++);
    made_ += chunk_.size();
    setg(chunk_.data(), chunk_.data(), chunk_.data() + chunk_.size());
    return traits_type::to_int_type(chunk_.front());
  }
  pos_type seekpos(pos_type, std::ios_base::openmode) override {
    number_ = made_ = 0;
    setg(nullptr, nullptr, nullptr);
    return 0;
  }

 private:
  std::uint64_t bytes_;
  std::uint64_t made_ = 0;
  std::uint64_t number_ = 0;
  std::string chunk_;
};

class ReliefStream final : public std::istream {
 public:
  explicit ReliefStream(std::uint64_t bytes) : std::istream(nullptr), buffer_(bytes) {
    rdbuf(&buffer_);
  }

 private:
  ReliefBuffer buffer_;
};

/// \param proves the output runs on the simulated machine, too
void compensate(benchmark::State& state, const std::function<LineSource()>& open,
                bool proves = false) {
  const Fitted& machine = fitted();
  std::uint64_t blocks = 0;
  std::uint64_t bytes_out = 0;
  for (auto _ : state) {
    std::string text;
    Compensator compensator(machine.corrector, {}, [&](std::string_view bytes) {
      bytes_out += bytes.size();
      if (proves) text += bytes;
    });
    LineSource source = open();
    const auto summary = compensator.run(source, {});
    if (!summary || compensator.findings().problem_count > 0) {
      state.SkipWithError(summary ? compensator.findings().problems.front().message().c_str()
                                  : summary.error().message().c_str());
      return;
    }
    blocks += summary->blocks;
    if (!proves) continue;
    LineSource original = open();
    LineSource written = LineSource::from_text(std::move(text));
    const auto proof = verify(original, written, machine.corrector, {}, {});
    if (!proof || !proof->holds()) {
      state.SkipWithError(proof ? proof->fault.c_str() : proof.error().problem.message().c_str());
      return;
    }
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.SetItemsProcessed(static_cast<std::int64_t>(blocks));
  state.counters["peak_rss_mb"] = static_cast<double>(usage.ru_maxrss) / 1024.0;
  state.counters["mb_out"] =
      static_cast<double>(bytes_out) / 1e6 / static_cast<double>(state.iterations());
}

/// A plate of 2000 arcs in rows of 39, with a straight line from row to row.
std::string arcs() {
  std::string text = "G21 G90 F1500\nG0 X-500 Y-300\n";
  for (int i = 0; i < 2000; ++i) {
    const bool arc = i % 40 != 0;
    text += fmt::format("G{} X{} Y{}", arc ? 2 + i % 2 : 1, -500 + i % 40 * 25, -300 + i / 40 * 12);
    text += arc ? fmt::format(" R{}\n", 20 + i % 30) : "\n";
  }
  return text;
}

void compensate_relief(benchmark::State& state, std::uint64_t bytes, bool proves) {
  compensate(
      state, [bytes] { return LineSource(std::make_unique<ReliefStream>(bytes)); }, proves);
}

void compensate_arcs(benchmark::State& state, bool proves) {
  const std::string text = arcs();
  compensate(
      state, [&text] { return LineSource::from_text(text); }, proves);
}

BENCHMARK_CAPTURE(compensate_relief, written, 2'000'000, false)
    ->Name("gcode/compensate")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compensate_arcs, written, false)
    ->Name("gcode/compensate/arcs")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compensate_relief, proved, 2'000'000, true)
    ->Name("gcode/compensate_and_verify")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compensate_arcs, proved, true)
    ->Name("gcode/compensate_and_verify/arcs")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(compensate_relief, large, 200'000'000, false)
    ->Name("gcode/compensate/200_mb")
    ->Unit(benchmark::kSecond)
    ->Iterations(1);

}  // namespace
}  // namespace chaintrue::gcode
