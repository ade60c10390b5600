// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/program_generator.hpp"

#include <array>

#include "tests/gcode_witness/support/program_writer.hpp"

namespace chaintrue::witness {
namespace {

using Statement = void (ProgramWriter::*)();

struct Weighted {
  int weight;
  bool in_path;  ///< within Scope::path
  Statement write;
};

constexpr std::array kStatements = {
    Weighted{30, true, &ProgramWriter::straight},
    Weighted{18, true, &ProgramWriter::arc_by_centre},
    Weighted{8, true, &ProgramWriter::arc_by_radius},
    Weighted{4, true, &ProgramWriter::whole_circle},
    Weighted{6, true, &ProgramWriter::cycle},
    Weighted{4, true, &ProgramWriter::plane},
    Weighted{3, true, &ProgramWriter::units},
    Weighted{4, true, &ProgramWriter::distance_mode},
    Weighted{2, true, &ProgramWriter::centre_mode},
    Weighted{3, true, &ProgramWriter::inverse_time},
    Weighted{3, true, &ProgramWriter::feed},
    Weighted{4, true, &ProgramWriter::spindle},
    Weighted{2, true, &ProgramWriter::coolant},
    Weighted{2, true, &ProgramWriter::tool},
    Weighted{2, true, &ProgramWriter::dwell},
    Weighted{2, true, &ProgramWriter::remark},
    Weighted{2, true, &ProgramWriter::path_control},
    Weighted{4, true, &ProgramWriter::work_offset},
    Weighted{3, true, &ProgramWriter::axis_offset},
    Weighted{2, true, &ProgramWriter::machine_move},
    Weighted{3, true, &ProgramWriter::assignment},
    Weighted{2, false, &ProgramWriter::home},
    Weighted{2, false, &ProgramWriter::polar},
    Weighted{1, false, &ProgramWriter::override_or_output},
    Weighted{2, false, &ProgramWriter::condition},
    Weighted{3, false, &ProgramWriter::loop},
    Weighted{2, false, &ProgramWriter::subroutine},
    Weighted{1, false, &ProgramWriter::probe},
};

void write_statement(ProgramWriter& writer, Random& random, Scope scope) {
  int total = 0;
  for (const Weighted& choice : kStatements) {
    if (choice.in_path || scope == Scope::language) total += choice.weight;
  }
  int left = random.whole(0, total - 1);
  for (const Weighted& choice : kStatements) {
    if (!choice.in_path && scope != Scope::language) continue;
    left -= choice.weight;
    if (left >= 0) continue;
    (writer.*choice.write)();
    return;
  }
}

/// One typing error: a character lost, a word twice, an unused word, a line lost.
std::string damaged(const std::string& program, Random& random) {
  std::string text = program;
  const auto at = static_cast<std::size_t>(random.whole(0, static_cast<int>(text.size()) - 1));
  switch (random.whole(0, 3)) {
    case 0:
      text.erase(at, 1);
      break;
    case 1: {
      const std::size_t line = text.rfind('\n', at) == std::string::npos ? 0 : text.rfind('\n', at);
      text.erase(line, text.find('\n', line + 1) - line);
      break;
    }
    case 2:
      text.insert(text.find('\n', at), random.any({" X1", " Y2", " Z3", " F50", " G1", " S3"}));
      break;
    default:
      text.insert(text.find('\n', at),
                  random.any({" I1", " J1", " K1", " R2", " P1", " Q1", " L2", " H1", " D1"}));
  }
  return text;
}

}  // namespace

std::string random_program(std::uint64_t seed, const GeneratorOptions& options) {
  Random random(seed);
  ProgramWriter writer(random, options);
  writer.beginning();
  const int count = random.whole(options.statements / 2, options.statements * 3 / 2);
  for (int i = 0; i < count; ++i) write_statement(writer, random, options.scope);
  const std::string text = writer.finish();
  return options.scope == Scope::language && random.one_in(8) ? damaged(text, random) : text;
}

}  // namespace chaintrue::witness
