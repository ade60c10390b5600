// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/output_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "tests/gcode_witness/follower/strict_reader.hpp"
#include "tests/gcode_witness/support/compared.hpp"
#include "tests/gcode_witness/support/compensated.hpp"
#include "tests/gcode_witness/support/program_generator.hpp"
#include "tests/gcode_witness/support/random.hpp"

namespace chaintrue::witness {
namespace {

/// grbl keeps eight digits, as many as single precision has.
constexpr double kDigits = 1e-7;

/// A word that must be unchanged in the output: `M67 Q 0.5`.
struct Word {
  std::string code;
  char letter;
  double value;
};

bool equal(double a, double b) {
  return std::fabs(a - b) <= kDigits * std::max(std::fabs(a), std::fabs(b));
}

/// Small and large values, round and not.
std::string some_value(Random& random, double most) {
  switch (random.whole(0, 4)) {
    case 0:
      return fmt::format("{}", random.whole(0, static_cast<int>(most)));
    case 1:
      return fmt::format("{:.3f}", random.between(0.0, most));
    case 2:
      return fmt::format("{:.9f}", most * std::pow(10.0, random.between(-8.0, 0.0)));
    case 3:
      return fmt::format("0.0000{}", random.whole(1, 99));
    default:
      return fmt::format("{:.6f}", random.between(0.0, 1.0));
  }
}

class WordProgram {
 public:
  explicit WordProgram(std::uint64_t seed) : random_(seed) {
    text = "G21 G90 G94\nG0 X1 Y1 Z5\nF500\n";
    for (int i = random_.whole(4, 12); i > 0; --i) {
      word();
      if (random_.one_in(2)) move();
    }
    move();
  }
  std::string text;
  std::vector<Word> expected;

 private:
  void add(const std::string& code, const std::vector<std::pair<char, std::string>>& values) {
    std::string line = code.size() > 1 ? code : "";
    for (const auto& [letter, value] : values) {
      line += (line.empty() ? "" : " ") + std::string(1, letter) + value;
      expected.push_back({code, letter, std::stod(value)});
    }
    text += line + "\n";
  }

  void word() {
    const std::string whole = fmt::format("{}", random_.whole(0, 3));
    switch (random_.whole(0, 9)) {
      case 0:
        return add("S", {{'S', some_value(random_, 24000.0)}});
      case 1:
        return add("G4", {{'P', some_value(random_, 20.0)}});
      case 2:
        return add("G64", {{'P', some_value(random_, 5.0)}});
      case 3:
        return add("G64", {{'P', some_value(random_, 5.0)}, {'Q', some_value(random_, 1.0)}});
      case 4:
        return add(
            random_.any({"M67", "M68"}),
            {{'E', whole}, {'Q', (random_.one_in(3) ? "-" : "") + some_value(random_, 100.0)}});
      case 5:
        return add(random_.any({"M62", "M63", "M64", "M65"}), {{'P', whole}});
      case 6:
        return add("T", {{'T', fmt::format("{}", random_.whole(1, 99))}});
      case 7:
        return add("G43", {{'H', fmt::format("{}", random_.whole(1, 99))}});
      case 8:
        return add("M61", {{'Q', fmt::format("{}", random_.whole(0, 99))}});
      default:
        return add(random_.any({"M50", "M51", "M52", "M53"}), {{'P', random_.any({"0", "1"})}});
    }
  }

  void move() {
    const std::string feed = random_.one_in(2) ? "" : fmt::format(" F{}", some_feed());
    text += fmt::format("G1 X{:.3f} Y{:.3f}{}\n", random_.between(-300.0, 300.0),
                        random_.between(-200.0, 200.0), feed);
  }
  /// A valid feed: zero is not allowed.
  std::string some_feed() {
    return random_.one_in(3) ? fmt::format("{}", random_.whole(1, 9000))
                             : fmt::format("{:.6f}", std::pow(10.0, random_.between(-3.0, 4.0)));
  }
  Random random_;
};

/// Reads an output like a small controller, and compares its moves with ours.
class StrictRun {
 public:
  explicit StrictRun(const Answer& ours) {
    for (const Call& call : ours.calls) {
      if (call.kind == "RAPID" || call.kind == "FEED") moves_.push_back(call);
    }
  }

  /// Empty if there is no difference.
  std::string run(const std::string& output) {
    std::istringstream lines(output);
    for (std::string text; std::getline(lines, text);) {
      std::string objection;
      const auto line = follower::read_strictly(text, objection);
      if (!line) return fmt::format("'{}': {}", text, objection);
      if (std::string fault = take(*line); !fault.empty())
        return fmt::format("'{}': {}", text, fault);
    }
    return moves_.size() == at_ ? "" : "our interpreter finds more moves than the strict reader";
  }
  std::vector<Word> words;

 private:
  std::string take(const follower::StrictLine& line) {
    std::string code;
    for (const auto& [letter, value] : line.words) {
      if (letter == 'G' || letter == 'M') code = fmt::format("{}{}", letter, value);
      if (letter == 'S' || letter == 'T') words.push_back({std::string(1, letter), letter, value});
      if (std::string("PQEHDLR").find(letter) != std::string::npos)
        words.push_back({code, letter, value});
      if (letter == 'F') state_['F'] = value;
    }
    if (code != "G0" && code != "G1") return {};
    for (const auto& [letter, value] : line.words) {
      if (letter == 'X' || letter == 'Y' || letter == 'Z') state_[letter] = value;
    }
    if (at_ == moves_.size()) return "a move that our interpreter does not find";
    const Call& move = moves_[at_++];
    // Positions have three decimals.
    const double off =
        std::hypot(move.to[0] - state_['X'], move.to[1] - state_['Y'], move.to[2] - state_['Z']);
    const bool feed = code == "G0" || equal(move.feed_mm_per_min, state_['F']);
    const bool kind = move.kind == (code == "G0" ? "RAPID" : "FEED");
    return off <= 1e-6 && feed && kind
               ? ""
               : "our interpreter finds another place, feed or kind of move";
  }

  std::vector<Call> moves_;
  std::size_t at_ = 0;
  std::map<char, double> state_;
};

std::string words_differ(const std::vector<Word>& expected, const std::vector<Word>& found) {
  const auto shown = [](const Word& word) {
    return fmt::format("{} {}{}", word.code, word.letter, word.value);
  };
  for (std::size_t i = 0; i < std::max(expected.size(), found.size()); ++i) {
    if (i >= found.size()) return shown(expected[i]) + " is missing";
    if (i >= expected.size()) return shown(found[i]) + " is too much";
    const Word& a = expected[i];
    const Word& b = found[i];
    if (a.code != b.code || a.letter != b.letter || !equal(a.value, b.value))
      return fmt::format("{} has become {}", shown(a), shown(b));
  }
  return {};
}

}  // namespace

OutputRun compare_output(const std::string& fixtures, std::uint64_t first_seed, std::uint64_t count,
                         bool ask, std::size_t most_reported) {
  const auto shop = measured_shop(fixtures, model::ControllerKind::ideal);
  GeneratorOptions options;
  options.scope = Scope::path;
  OutputRun run;
  const auto fail = [&](std::uint64_t seed, const std::string& what, const std::string& program) {
    ++run.different;
    if (run.failures.size() < most_reported)
      run.failures.push_back(fmt::format("seed {}: {}\n{}", seed, what, program));
  };
  std::vector<Record> outputs;
  std::vector<Answer> answers;
  std::vector<std::string> programs;
  for (std::uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
    const bool of_words = seed % 2 == 0;
    const WordProgram words(seed);
    const std::string program = of_words ? words.text : random_program(seed, options);
    std::string why;
    Random random(seed);
    const auto output = shop->compensate(program, 0.005 * std::pow(200.0, random.unit()), why);
    if (!output) {
      if (of_words) fail(seed, why, program);  // such programs stay on the bed
      continue;
    }
    ++run.outputs;
    const Answer answer = ours(*output);
    if (!answer.accepted) {
      fail(seed, "our reader refuses the output: " + answer.refusal, program);
      continue;
    }
    StrictRun strict(answer);
    if (const std::string fault = strict.run(*output); !fault.empty()) fail(seed, fault, program);
    if (of_words) {
      if (const std::string fault = words_differ(words.expected, strict.words); !fault.empty())
        fail(seed, fault, program);
    }
    outputs.push_back({fmt::format("seed_{}", seed), *output});
    answers.push_back(answer);
    programs.push_back(program);
  }
  if (!ask) return run;
  const auto truths = ask_linuxcnc(outputs);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    if (const auto found = difference(read_truth(truths[i].text), answers[i]))
      fail(first_seed, outputs[i].name + ": " + *found, programs[i]);
  }
  return run;
}

}  // namespace chaintrue::witness
