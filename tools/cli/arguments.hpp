// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Verbs and options of the command line, each option bound to a variable. Cheap handles; valid as
/// long as the parser that made them. CLI11 is not in this header, since it costs eight seconds of
/// compiling for each file that includes it.
///
/// \code
///   Verb verb = app.add_verb("square", "Predict a test square");
///   verb.add_option("--at", options->at, "X Y of the lower left corner, mm").takes(2);
///   verb.add_flag("--json", options->json, "JSON, all digits");
///   verb.footer("Example:\n  chaintrue square --map map.json");
///   verb.runs(options, run_square);
/// \endcode
///
/// Names that CLI11 rejects throw its exception when the verb is added.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace chaintrue::cli {

/// Words of a command line: all of them, or those given for one option.
using Words = std::vector<std::string>;

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
//
// \code
//   verb.add_flag("--below", ...).acts_on(facts::map | facts::machine, "to be left out: ...");
//   ...
//   verb.refuse_idle_options(facts::plotter);
// \endcode

/// Facts about a verb's input on which options depend; several hold at once.
using Facts = std::uint32_t;

namespace facts {
// Kinds of files.
inline constexpr Facts grid = 1U << 0;
inline constexpr Facts holes = 1U << 1;
inline constexpr Facts belts = 1U << 2;
inline constexpr Facts belt_holes = 1U << 3;  ///< on four belts, alone or with their lengths
inline constexpr Facts chains = grid | holes;
inline constexpr Facts taped = holes | belt_holes;
inline constexpr Facts map = 1U << 4;
inline constexpr Facts anchors = 1U << 5;
inline constexpr Facts diagnosis = 1U << 6;
inline constexpr Facts machine = 1U << 7;
/// A single grid.
inline constexpr Facts one_grid = 1U << 8;
/// fit: a smooth correction on the calibrated machine, or splines through the lengths.
inline constexpr Facts residual = 1U << 9;
inline constexpr Facts direct = 1U << 10;
/// --outside fade.
inline constexpr Facts fade = 1U << 11;
// plan and simulate: the kind of plan or data.
inline constexpr Facts lattice = 1U << 12;    ///< marks in columns and rows
inline constexpr Facts scattered = 1U << 13;  ///< marks anywhere
inline constexpr Facts marks = 1U << 14;      ///< marks of a list
inline constexpr Facts places = 1U << 15;     ///< true places of a list
inline constexpr Facts tape = 1U << 16;       ///< holes and a tape
inline constexpr Facts check = 1U << 17;      ///< points that check a map
inline constexpr Facts follow_up = 1U << 18;  ///< after a diagnosis
/// A program is written (--gcode).
inline constexpr Facts program = 1U << 21;
/// It drills, rather than stopping above the marks.
inline constexpr Facts drilled = 1U << 22;
/// A program without --map.
inline constexpr Facts no_map = 1U << 23;
/// fit: without --plain.
inline constexpr Facts causes = 1U << 24;
/// A table (CSV) is among the files.
inline constexpr Facts table = 1U << 28;
/// fit and diagnose: a V-plotter's test drawing, alone.
inline constexpr Facts drawing = 1U << 29;
/// Every input of fit and diagnose except a test drawing.
inline constexpr Facts no_drawing = grid | holes | belts | belt_holes;
/// Instead of a map: a V-plotter with a measured drawing.
inline constexpr Facts plotter = 1U << 30;
/// plan: without --after; of those, at marks.
inline constexpr Facts planned = lattice | tape | check;
inline constexpr Facts planned_marks = lattice | check;
/// simulate: marks that are visited; readings that are drawn.
inline constexpr Facts session = lattice | scattered | marks;
inline constexpr Facts drawn = session | tape | belts;
/// What a program is compensated with.
inline constexpr Facts target = map | anchors | plotter;
/// For an option that other verbs also have.
inline constexpr Facts nothing = 0;
inline constexpr Facts any = ~0U;

}  // namespace facts

/// The work of a verb; throws InputError for bad input.
using Run = std::function<int()>;

class Option {
 public:
  Option() = default;
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required() const;
  Option one_of(const Words& words) const;
  /// Using this without `other` is an error; `excludes`: with it.
  Option needs(Option other) const;
  Option excludes(Option other) const;
  Option takes(int values) const;
  /// Shows the variable's current value, or `text`, in the help.
  Option shows_default() const;
  Option shows_default(const std::string& text) const;
  /// The word for a value in the help.
  Option value_word(const std::string& word) const;
  /// `fault` returns what is wrong with a value; empty if it is valid.
  Option refuses(std::function<std::string(const std::string&)> fault) const;
  /// The option has an effect if one of these holds; `otherwise` states what is expected if none
  /// does: "to be left out of holes: ...". A value that states the default behaviour is `harmless`
  /// and is not refused. If an option has several rules, the first that refuses it is reported.
  Option acts_on(Facts facts, std::string otherwise, std::string harmless = "") const;

 private:
  CLI::Option* option_ = nullptr;
};

/// A rule of Option::acts_on, by names.
struct OptionRule {
  std::string verb;  ///< "fit", "gcode check"
  std::string option;
  Facts acts_on;
  std::string otherwise;
  std::string harmless;
};
/// Of all verbs, in the order in which they were made.
[[nodiscard]] std::vector<OptionRule> option_rules();
/// Those of an earlier command line in this process.
void forget_option_rules();

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

  Verb add_verb(const std::string& name, const std::string& help) const;
  /// Options of which exactly one is to be given.
  Verb add_choice(const std::string& name) const;
  /// One of the verbs below is required.
  void require_verb() const;
  Option add_option(const std::string& names, std::string& value, const std::string& help) const;
  Option add_option(const std::string& names, Words& values, const std::string& help) const;
  /// `take` gets all texts that were given.
  Option add_option(const std::string& names,
                    std::function<void(const Words&)> take,
                    const std::string& help) const;
  /// `take` gets the text of each occurrence.
  Option add_option(const std::string& names,
                    std::function<void(const std::string&)> take,
                    const std::string& help) const;
  Option add_flag(const std::string& names, bool& value, const std::string& help) const;
  /// A flag, queried by is_given().
  void add_flag(const std::string& name, const std::string& help) const;
  void footer(const std::string& text) const;
  /// The work done if the verb is chosen: `act(verb, *command)` or `act(*command)`, whose answer is
  /// the exit code. `check(*command)` is asked first, for usage_error().
  template <class Command, class Act>
  void runs(const std::shared_ptr<Command>& command,
            Act act,
            std::function<void(const std::type_identity_t<Command>&)> check = {}) const {
    const auto first = [command, check] {
      if (check) check(*command);
    };
    if constexpr (std::is_invocable_v<Act, Verb, Command&>)
      when_chosen([command, act, verb = *this] { return act(verb, *command); }, first);
    else
      when_chosen([command, act] { return act(*command); }, first);
  }

  [[nodiscard]] Option option(const std::string& name) const;
  [[nodiscard]] bool has_option(const std::string& name) const;
  [[nodiscard]] bool is_given(const std::string& name) const;
  /// Its words, separated by blanks; for a flag "given".
  [[nodiscard]] std::string value_of(const std::string& name) const;
  /// In the verb's order; without positional arguments.
  [[nodiscard]] std::vector<GivenOption> given_options() const;
  /// \throws InputError with a sentence for each given option that would have no effect on this
  /// input.
  void refuse_idle_options(Facts facts) const;
  /// As it is typed: "gcode check".
  [[nodiscard]] std::string path() const;
  /// On the command line that was parsed.
  [[nodiscard]] bool is_chosen() const;
  /// The verb of a group of options; for a verb, itself.
  [[nodiscard]] Verb with_name() const;
  [[nodiscard]] CLI::App& app() const { return *app_; }

 private:
  void when_chosen(Run run, std::function<void()> check) const;

  CLI::App* app_ = nullptr;
};

/// What a verb has, including what its groups of options have.
struct VerbParts {
  std::vector<CLI::Option*> options;  ///< and arguments
  std::vector<CLI::App*> verbs;
};
[[nodiscard]] VerbParts parts_of(CLI::App& verb);
[[nodiscard]] std::vector<std::string> long_names(const std::vector<CLI::Option*>& options);
[[nodiscard]] std::vector<std::string> names_of(const std::vector<CLI::App*>& verbs);

/// Of the verb that was chosen.
[[nodiscard]] Run& chosen_run();

/// For the check of runs(): ends the command with a usage error, exit code 2.
[[noreturn]] void usage_error(const std::string& verb, const std::string& sentence);
[[noreturn]] void missing_option(const std::string& names);

}  // namespace chaintrue::cli
