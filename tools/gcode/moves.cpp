// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Collecting moves.
#include "tools/gcode/moves.hpp"

#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {
namespace {

class Collector final : public Sink {
 public:
  Result<void> move(const Move& move) override {
    moves.push_back(move);
    return {};
  }
  std::vector<Move> moves;
};

}  // namespace

Result<std::vector<Move>> read_moves(LineSource& source, const Dialect& dialect) {
  Collector collector;
  const auto summary = run_program(source, dialect, collector);
  if (!summary) return tl::unexpected(summary.error());
  return std::move(collector.moves);
}

Result<std::vector<Move>> read_moves(const std::string& path, const Dialect& dialect) {
  auto source = LineSource::from_file(path);
  if (!source) return tl::unexpected(source.error());
  return read_moves(*source, dialect);
}

}  // namespace chaintrue::gcode
