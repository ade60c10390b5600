// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Verbs and options of the command line. An option is a row: its names, the variable that it sets,
/// the help, and the inputs that it acts on. The variable's type says what the option takes. Cheap
/// handles; valid as long as the parser that made them. CLI11 is not in this header, since it costs
/// eight seconds of compiling for each file that includes it.
///
/// \code
///   auto [verb, c] = app.add_verb<ReportCommand>(
///       "report", "Write a map as a page", "Example:\n  chaintrue report map.json", run_report);
///   verb.has({{"file", required(reads(c.input)), "A chaintrue_map file"},
///             {"--certificate", c.certificate, "One page", facts::map, "to be left out: ..."},
///             {"--size-mm", {c.size_mm, {"mm", 1.0, 5000.0}}, "Length of a side"}});
/// \endcode
///
/// Names that CLI11 rejects throw its exception when the verb is added. Numbers follow the rules of
/// numbers in files (grid/files/number_text.hpp): the same ranges and messages, all problems at once,
/// exit code 3. NaN and infinity are rejected.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "grid/files/number_text.hpp"
#include "tools/cli/names.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace chaintrue::cli {

using files::Range;

/// The command's exit codes, on which scripts may rely.
enum ExitCode {
  kDone = 0,
  kCheckFailed = 1,
  kUsage = 2,
  kBadInput = 3,
  kNotSupportedOrOutside = 4,
  kInternal = 5,
};

// The kinds of input that an option applies to. An option without effect on its verb's input
// is refused before any work; tests/inputs tries each with every kind of input.

/// Facts about a verb's input on which options depend; several hold at once.
using Facts = std::uint32_t;

namespace facts {

enum : Facts {
  // Kinds of files, in the order of files::FileKind.
  machine = 1U << 0,
  grid = 1U << 1,
  holes = 1U << 2,
  belt_holes = 1U << 3,  ///< on four belts, alone or with their lengths
  belts = 1U << 4,
  map = 1U << 5,
  anchors = 1U << 6,
  diagnosis = 1U << 7,
  /// Instead of a map: a V-plotter with a measured drawing.
  plotter = 1U << 8,
  /// fit and diagnose: a V-plotter's test drawing, alone.
  drawing = 1U << 9,
  other = 1U << 10,
  chains = grid | holes,
  taped = holes | belt_holes,
  /// A single grid.
  one_grid = 1U << 11,
  /// fit: a smooth correction on the calibrated machine, or splines through the lengths.
  residual = 1U << 12,
  direct = 1U << 13,
  /// --outside fade.
  fade = 1U << 14,
  // plan and simulate: the kind of plan or data.
  lattice = 1U << 15,    ///< marks in columns and rows
  scattered = 1U << 16,  ///< marks anywhere
  marks = 1U << 17,      ///< marks of a list
  places = 1U << 18,     ///< true places of a list
  tape = 1U << 19,       ///< holes and a tape
  check = 1U << 20,      ///< points that check a map
  follow_up = 1U << 21,  ///< after a diagnosis
  /// A program is written (--gcode).
  program = 1U << 22,
  /// It drills, rather than stopping above the marks.
  drilled = 1U << 23,
  /// A program without --map.
  no_map = 1U << 24,
  /// fit: without --plain.
  causes = 1U << 25,
  /// A table (CSV) is among the files.
  table = 1U << 26,
  /// Every input of fit and diagnose except a test drawing.
  no_drawing = grid | holes | belts | belt_holes,
  /// plan: without --after; of those, at marks.
  planned = lattice | tape | check,
  planned_marks = lattice | check,
  /// simulate: marks that are visited; readings that are drawn.
  session = lattice | scattered | marks,
  drawn = session | tape | belts,
  /// What a program is compensated with.
  target = map | anchors | plotter,
  /// For an option that other verbs also have.
  nothing = 0,
  any = ~0U,
};

}  // namespace facts

/// The work of a verb; throws InputError for bad input.
using Run = std::function<int()>;

class Verb;

/// A variable that an option sets. A default is shown in the help, unless it is an empty text or a
/// number out of the option's range.
struct Value {
  using Take = std::function<void(double)>;

  /// \param one_of the words that are taken; none: any text
  Value(std::string& text, Words one_of = {});
  Value(Words& texts);
  Value(bool& flag);
  /// A double or a whole number, or optional of either.
  template <class Number>
  Value(Number& number, const Range& range)
      : Value(
            range, std::is_integral_v<Number>,
            [&number](double given) { number = static_cast<Number>(given); },
            static_cast<double>(number)) {}
  template <class Number>
  Value(std::optional<Number>& number, const Range& range)
      : Value(range, std::is_integral_v<Number>,
              [&number](double given) { number = static_cast<Number>(given); }) {}
  /// A word, of which `named` knows the meaning. \param usual the default's word
  /// \param expected what is said if `named` does not know it, with exit code 3
  template <class Meaning>
  Value(Meaning& meaning, std::optional<Meaning> (*named)(std::string_view word), std::string usual,
        std::string expected)
      : Value(std::move(usual), std::move(expected), [&meaning, named](const std::string& word) {
          const auto known = named(word);
          meaning = known.value_or(meaning);
          return known.has_value();
        }) {}
  /// \param count how many numbers are taken; 0: any
  Value(std::vector<double>& numbers, const Range& range, int count = 0);

  /// Declares an option that sets the variable.
  std::function<CLI::Option*(Verb verb, const std::string& names, const std::string& help)> declare;

  /// This variable, with more done to its option.
  using Change = std::function<void(Verb verb, const std::string& names, CLI::Option& option)>;
  [[nodiscard]] Value with(Change change) const;

 private:
  Value(const Range& range, bool is_whole, Take take, std::optional<double> usual = {});
  Value(std::string usual, std::string expected, std::function<bool(const std::string&)> take);
};
Value required(const Value& value);
/// Its default is not shown.
[[nodiscard]] Value without_default(const Value& value);

/// An option has an effect if one of the facts holds; `otherwise` states what is expected if none
/// does: "to be left out of holes: ...". If an option has several rules, the first that refuses it is
/// reported.
struct ActsOn {
  Facts facts = facts::nothing;
  std::string otherwise;
};

struct OptionRow {
  std::string names;  ///< "-o,--output"; without dashes: an argument
  Value value;
  std::string help;
  /// The option's first rule, if it has any, and its others.
  Facts facts = facts::any;
  std::string otherwise = {};
  std::vector<ActsOn> more = {};
  /// A value that states the default behaviour, which no rule refuses.
  std::string harmless = {};
};

/// A rule of an option, by names.
struct OptionRule {
  std::string verb;  ///< "fit", "gcode check"
  std::string option;
  Facts acts_on;
  std::string otherwise;
  std::string harmless;
};

/// An option of the command line, by its longest name, with the words given for it: none for a
/// flag.
struct GivenOption {
  std::string name;
  Words words;
};

class Verb {
 public:
  Verb() = default;
  explicit Verb(CLI::App& app) : app_(&app) {}

  /// \param footer the end of the help, with an example; empty: that of the verb above
  Verb add_verb(const std::string& name, const std::string& help,
                const std::string& footer = {}) const;
  /// Options of which exactly one is to be given.
  Verb add_choice(const std::string& name) const;
  /// One of the verbs below is required.
  void require_verb() const;
  void has(const std::vector<OptionRow>& rows) const;
  /// Further rules of an option.
  void acts_on(const std::string& option, const std::vector<ActsOn>& rules,
               const std::string& harmless = {}) const;
  /// Using these options without the other is an error; `excludes`: with it.
  void needs(const Words& options, const std::string& other) const;
  void excludes(const Words& options, const std::string& other) const;
  /// The work done if the verb is chosen: `act(verb, *command)` or `act(*command)`, whose answer is
  /// the exit code. `check(*command)` is asked first, for usage_error().
  template <class Command, class Act>
  void runs(const std::shared_ptr<Command>& command, Act act,
            std::function<void(const std::type_identity_t<Command>&)> check = {}) const {
    const auto first = [command, check] {
      if (check) check(*command);
    };
    if constexpr (std::is_invocable_v<Act, Verb, Command&>)
      when_chosen([command, act, verb = *this] { return act(verb, *command); }, first);
    else
      when_chosen([command, act] { return act(*command); }, first);
  }

  /// A verb below that works on a Command, which lives as long as the parser, as runs() does.
  template <class Command, class Act>
  std::pair<Verb, Command&> add_verb(const std::string& name, const std::string& help,
                                     const std::string& footer, Act act,
                                     std::function<void(const Command&)> check = {}) const {
    const auto command = std::make_shared<Command>();
    const Verb verb = add_verb(name, help, footer);
    verb.runs(command, act, std::move(check));
    return {verb, *command};
  }

  bool has_option(const std::string& name) const;
  bool is_given(const std::string& name) const;
  /// In the verb's order; without positional arguments.
  std::vector<GivenOption> given_options() const;
  /// \throws InputError with a sentence for each given option that would have no effect on this
  /// input.
  void refuse_idle_options(Facts facts) const;
  /// As it is typed: "gcode check".
  std::string path() const;
  /// On the command line that was parsed.
  bool is_chosen() const;
  /// The verb of a group of options; for a verb, itself.
  [[nodiscard]] Verb with_name() const;
  CLI::App& app() const { return *app_; }

 private:
  void when_chosen(Run run, std::function<void()> check) const;

  CLI::App* app_ = nullptr;
};

/// What a verb has, including what its groups of options have.
struct VerbParts {
  std::vector<CLI::Option*> options;  ///< and arguments
  std::vector<CLI::App*> verbs;
};
VerbParts parts_of(CLI::App& verb);
Words long_names(const std::vector<CLI::Option*>& options);
Words names_of(const std::vector<CLI::App*>& verbs);

/// The run of the verb that was chosen.
Run& chosen_run();

/// For the check of runs(): ends the command with a usage error, exit code 2.
[[noreturn]] void usage_error(const std::string& verb, const std::string& sentence);
[[noreturn]] void missing_option(const std::string& names);

}  // namespace chaintrue::cli
