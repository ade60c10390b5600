// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The inputs and outputs of a verb: declared with its options, and checked by one rule for all
/// verbs.
///
/// Before any work (check_places): an output is not one of the inputs, under any name; no two
/// outputs share a place; each is in an existing folder; and an existing file is replaced only if
/// this program made it and it is unchanged (grid/files/origin.hpp), or with --force. All of this
/// is checked again when the outputs are written, with machine files named by other files among the
/// inputs.
///
/// \code
///   verb.has({{"map", required(reads(c.map)), "A chaintrue_map file"},
///             {"-o,--output", writes(c.output, {Origin::table}), "- is standard output"}});
///   ...
///   write_output(command->output, text);
/// \endcode
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/origin.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/files/problems.hpp"
#include "grid/provenance.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

// What the verbs of a command line declared, and all its problems, reported at once and before any
// file is read: numbers out of range and unknown words, a verb's own checks, places of files (places.hpp). Checks that
// depend on a file's content are the verb's.
//
// \code
//   add_option_check(verb, c, check_words);  // void check_words(const Command&, OptionProblems&)
// \endcode
/// Collects all problems of a command's values and throws them together.
class OptionProblems {
 public:
  void add(std::string_view option, std::string value, std::string expected, ProblemKind kind);
  /// `value` is finite and within [least, most].
  void require(std::string_view option, double value, double least, double most);
  /// Adds the problems of an InputError thrown by `check`.
  void take_from(const std::function<void()>& check);
  void throw_if_any() const;

 private:
  std::vector<files::InputProblem> problems_;
};

struct DeclaredCheck {
  Verb verb;
  std::function<void(OptionProblems&)> check;
};

/// An option that names files; the names are known after parsing.
struct Place {
  Verb verb;
  std::string names;  ///< "-o,--output"
  std::function<Words()> paths;
  std::vector<files::Origin> kinds;  ///< of an output; none for an input
};

/// Those of all verbs of the current command line.
struct Declared {
  std::vector<OptionRule> rules;
  std::vector<DeclaredCheck> checks;
  std::vector<Place> places;
  files::Problems misread{"command line"};  ///< numbers and words that were given
};
Declared& declared();

/// `check` runs if the verb was chosen. Out-of-range numbers have their defaults then.
void add_option_check(Verb verb, std::function<void(OptionProblems&)> check);
template <class Command>
void add_option_check(Verb verb, const Command& command,
                      void (*check)(const Command&, OptionProblems&)) {
  add_option_check(verb, [&command, check](OptionProblems& problems) { check(command, problems); });
}

/// For the verb that was chosen, before its work. \throws InputError with all that is wrong.
void check_command_line();

using files::Origin;
/// Texts with their places; those with an empty path are not wanted.
using Outputs = std::vector<files::OutputFile>;

/// The variable of an option or argument that names a file to read.
Value reads(std::string& path);
Value reads(Words& paths);
/// The variable of an option that names a file to write; adds --force to the verb. \param kinds of content:
/// existing files of these kinds made by this program are replaced without --force
Value writes(std::string& path, std::vector<Origin> kinds);
/// The variable of an option that names a folder to write into, created if missing; adds --force to the verb.
Value writes_into(std::string& folder);

/// The files that an option of the chosen verb names; null if it names none.
const Place* place_of(const std::string& option);

/// A file of such a folder, and its kind.
struct FolderFile {
  std::string name;
  std::string text;
  Origin kind;
};
/// Checks, before any work, whether such files may be written there, by the rules of outputs. A
/// missing folder may be created. \throws InputError
void check_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents);
/// Writes all or none, by the rules of outputs. \throws InputError
void write_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents);

/// For the chosen verb, before its work. \throws InputError with all problems.
void check_places();

/// The command that writes the page next to a file: map.json, map.html.
Words report_words(const std::string& path);

/// One output, or several: all or none. \throws as files::write_whole_files.
void write_output(const std::string& path, const std::string& text);
void write_outputs(const Outputs& outputs);
/// For outputs that are written piece by piece, in addition to whole texts. Empty paths are
/// skipped.
void take_place(PendingFile& pending, const std::string& path, const Outputs& others);

// The provenance that a verb writes with its results, and its display in a report.
/// For the chosen verb: its options, except those that name outputs or only change printing, and
/// every file read so far.
Provenance made_by(Verb verb);

/// "Where this comes from", folded; nothing is added if it is unknown.
void add_made_by(const std::optional<Provenance>& made_by, std::vector<Section>& sections);

/// A note on standard error if an input has the same name as a source of this result but another
/// content.
void report_difference(const InputFile& result);

}  // namespace chaintrue::cli
