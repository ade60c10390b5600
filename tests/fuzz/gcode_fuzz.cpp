// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The mutations and the checks.
#include "tests/fuzz/gcode_fuzz.hpp"

#include <array>

#include "tests/gcode/formula_target.hpp"
#include "tests/gcode/program_events.hpp"
#include "tools/gcode/compensator.hpp"
#include "tools/gcode/verifier.hpp"

namespace chaintrue::gcode::fuzz {
namespace {

constexpr std::array kTokens = {"G0",
                                "G1",
                                "G2",
                                "G3",
                                "G17",
                                "G18",
                                "G19",
                                "G20",
                                "G21",
                                "G28",
                                "G30",
                                "G28.1",
                                "G38.2",
                                "G40",
                                "G43.1",
                                "G52",
                                "G53",
                                "G54",
                                "G59.3",
                                "G61",
                                "G64",
                                "G73",
                                "G80",
                                "G81",
                                "G83",
                                "G84",
                                "G87",
                                "G88",
                                "G90",
                                "G91",
                                "G90.1",
                                "G91.1",
                                "G92",
                                "G92.1",
                                "G92.3",
                                "G93",
                                "G94",
                                "G98",
                                "G99",
                                "G10 L2",
                                "G10 L20",
                                "M3",
                                "M98",
                                "M99",
                                "M2",
                                "P1",
                                "P2",
                                "R5",
                                "R-5",
                                "I5",
                                "J-3",
                                "K1",
                                "L3",
                                "Q1",
                                "X",
                                "Y",
                                "Z",
                                "F",
                                "F0",
                                "-",
                                "[",
                                "]",
                                "#1",
                                "#1=",
                                "#<a>",
                                "#<_x>",
                                "1e9",
                                "999999999",
                                "0.00000001",
                                "**",
                                "mod",
                                "sin[",
                                "o1 if",
                                "o1 while [1]",
                                "o1 endwhile",
                                "o1 sub",
                                "o1 endsub",
                                "o1 call",
                                "o1 repeat [3]",
                                "o1 endrepeat",
                                "(",
                                ")",
                                ";",
                                "%",
                                "*71",
                                "/",
                                "N1",
                                "@3",
                                "^45",
                                "\r",
                                "\n",
                                "\t"};

}  // namespace

std::vector<std::string> seeds() {
  return {
      "G21 G90 G17\nG0 Z5\nG0 X10 Y-20\nG1 Z-2 F300\nG2 X30 Y-20 I10 J0\nG3 X10 Y-20 R10\nG1 "
      "X0\nM5\nM2\n",
      "%\nN10 G20 G91\nN20 G1 X.5 Y.25 F10\nN30 G18 G2 X1 Z0 I.5\nG19 G3 Y1 Z0 R1\n%\n",
      "#1=5\n#<a>=[#1*2+sin[30]]\no1 repeat [#1]\nG91 G0 X#<a>\no1 endrepeat\no2 if [#1 gt 3]\nG90 "
      "G0 X0\no2 else\nG0 Y1\no2 endif\n",
      "o100 sub\nG0 X#1 Y#2\no100 endsub\no100 call [1] [2]\nM98 P200 L2\nM2\nO200\nG0 X1\nM99\n",
      "F100\nM3 S1000\nG98 G81 X1 Y1 Z-3 R1\nX2\nG99 G83 X3 Z-5 R2 Q1\nG73 X4 Q.5\nG82 X5 P.1\nG85 "
      "X6\nG86 X7 P1\nG89 X8 P1\nG80\n",
      "G10 L2 P2 X5 Y5 R30\nG55\nG0 X1 Y1\nG92 X0 Y0\nG1 X10 F50\nG52 X3\nG92.1\nG53 G0 X0 Y0\nG10 "
      "L20 P1 X3\nG28.1\nG28 X1\n",
      "G93 G1 X10 F2\nG94 F100\nG90.1 G2 X20 Y0 I15 J0 P3 Z-4\nG91.1 G3 I5 "
      "Z1\n(msg,hi)(debug,#1)\nT1 M6\nM62 P1\nG4 P.5\nG64 P.1\n",
  };
}

std::string run(const std::string& program) {
  static const FormulaMap map(random_smooth_displacement(7));
  static const PlainKinematics kinematics;
  static const Corrector corrector(map, kinematics,
                                   firmware(model::ControllerKind::maslow_classic));
  Dialect dialect;
  dialect.step_budget = 2000;
  std::string output;
  CompensateOptions options;
  options.largest_correction_mm = 1e3;
  Compensator compensator(corrector, options, [&](std::string_view bytes) { output += bytes; });
  auto source = LineSource::from_text(program);
  const auto outcome = compensator.run(source, dialect);
  if (!outcome && outcome.error().sentence.empty()) return "a refusal without a reason";
  if (!outcome || compensator.findings().problem_count > 0) return {};
  for (const char* word : {"nan", "inf", "e+", "e-", "-0 "}) {
    // Comments may contain anything.
    for (std::size_t at = output.find(word); at != std::string::npos;
         at = output.find(word, at + 1)) {
      const std::size_t line = output.rfind('\n', at) + 1;
      if (output[line] != '(') return "the output holds " + std::string(word);
    }
  }
  auto again = LineSource::from_text(output);
  const auto moves = read_moves(again);
  if (!moves) return "the output is refused: " + moves.error().message();
  if (moves->size() != outcome->commands)
    return "the output does not hold the commands that were counted";
  for (const Move& move : *moves) {
    for (const double value : {move.to.x_mm, move.to.y_mm, move.to.z_mm}) {
      if (!(std::fabs(value) < 1e9)) return "the output goes to no sensible place";
    }
  }
  // Accepted programs are cut as intended.
  auto original = LineSource::from_text(program);
  auto written = LineSource::from_text(output);
  const auto proof = verify(original, written, corrector, dialect, {});
  if (!proof) return "verify has no answer: " + proof.error().problem.message();
  if (!proof->holds()) return "the output does not hold: " + proof->fault;
  return {};
}

Mutator::Mutator(std::vector<std::string> corpus, std::uint64_t seed)
    : corpus_(std::move(corpus)), random_(seed) {}

void Mutator::mutate_bytes(std::string& text) {
  if (text.empty()) return;
  const std::size_t at = below(text.size());
  switch (below(4)) {
    case 0:
      text[at] = static_cast<char>(below(256));
      break;
    case 1:
      text.erase(at, 1 + below(8));
      break;
    case 2:
      text.insert(at, 1, static_cast<char>(below(128)));
      break;
    default:
      text[at] = static_cast<char>(text[at] ^ static_cast<char>(1U << below(8)));
  }
}

void Mutator::mutate_tokens(std::string& text) {
  const std::size_t at = below(text.size() + 1);
  text.insert(at, std::string(" ") + kTokens[below(kTokens.size())]);
  if (below(3) == 0 && at < text.size()) {
    // Digits change their size.
    const std::size_t digit = text.find_first_of("0123456789", at);
    if (digit != std::string::npos) text.insert(digit, below(2) == 0 ? "00000" : "73.");
  }
}

void Mutator::mutate_lines(std::string& text) {
  const std::size_t at = text.find('\n', below(text.size() + 1));
  if (at == std::string::npos) return;
  const std::string& other = corpus_[below(corpus_.size())];
  const std::size_t from = below(other.size() + 1);
  text.insert(at + 1, other.substr(from, below(120)));
}

std::string Mutator::next() {
  std::string text = corpus_[below(corpus_.size())];
  // Long programs are cut to a window, so that a second holds many runs.
  constexpr std::size_t kWindow = 1500;
  if (text.size() > kWindow) text = text.substr(below(text.size() - kWindow), kWindow);
  const std::size_t changes = 1 + below(8);
  for (std::size_t i = 0; i < changes; ++i) {
    switch (below(3)) {
      case 0:
        mutate_bytes(text);
        break;
      case 1:
        mutate_tokens(text);
        break;
      default:
        mutate_lines(text);
    }
  }
  return text;
}

}  // namespace chaintrue::gcode::fuzz
