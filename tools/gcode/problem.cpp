// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of problems.
#include "tools/gcode/problem.hpp"

#include <fmt/format.h>

namespace chaintrue::gcode {
namespace {

struct Row {
  std::string_view name;
  ProblemKind kind;
};

constexpr Row kRows[] = {
#define CHAINTRUE_GCODE_PROBLEM(name, kind) {#name, ProblemKind::kind},
#include "tools/gcode/problems.def"
#undef CHAINTRUE_GCODE_PROBLEM
};

const Row& row(ProblemName problem) { return kRows[static_cast<std::size_t>(problem)]; }

}  // namespace

std::string_view name(ProblemName problem) { return row(problem).name; }

ProblemKind kind(ProblemName problem) { return row(problem).kind; }

std::string Problem::message() const {
  const std::string column = place.column != 0 ? fmt::format(", column {}", place.column) : "";
  const std::string where = place.line != 0 ? fmt::format("line {}{}: ", place.line, column) : "";
  return fmt::format("{}{} ({})", where, sentence, gcode::name(name));
}

void refuse(ProblemName problem, Place place, std::string sentence) {
  throw Refusal({problem, place, std::move(sentence)});
}

}  // namespace chaintrue::gcode
