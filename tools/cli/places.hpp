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

#include <string>
#include <vector>

#include "grid/files/origin.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/names.hpp"
#include "tools/cli/option_checks.hpp"

namespace chaintrue::cli {

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
void take_place(files::PendingFile& pending, const std::string& path, const Outputs& others);

}  // namespace chaintrue::cli
