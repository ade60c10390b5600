// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a verb reads and where it writes: said once, when its options are made, and held to by one
/// rule for all verbs.
///
/// Before any work (check_places): an output is none of the inputs, whatever it is called; no two
/// outputs share a place; each lies in a folder that exists; and a file that stands there already
/// is replaced only where this program made it and nobody has changed it since
/// (grid/files/origin.hpp), or with --force. When the outputs are written all of it is looked at
/// again, with what other files named as their machine among the inputs.
///
/// \code
///   add_input(verb, "map", command->map, "A chaintrue_map file").required();
///   add_output(verb, "-o,--output", command->output, {Origin::table}, "- is standard output");
///   ...
///   write_output(command->output, text);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/origin.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

using grid::files::Origin;

/// An option or argument that names a file to read.
Option add_input(Verb verb, const std::string& names, std::string& path, const std::string& help);
Option add_input(Verb verb,
                 const std::string& names,
                 std::vector<std::string>& paths,
                 const std::string& help);
/// An option that names a file to write; adds --force to the verb. \param kinds what is written
/// there: a file of these kinds that this program made is replaced without being asked
Option add_output(Verb verb,
                  const std::string& names,
                  std::string& path,
                  std::vector<Origin> kinds,
                  const std::string& help);

/// What an option of the verb names.
enum class PlaceUse { nothing, input, output };
[[nodiscard]] PlaceUse use_of(Verb verb, const std::string& option);

/// A folder that is made where it is not there yet; adds --force to the verb.
Option add_output_folder(Verb verb,
                         const std::string& names,
                         std::string& path,
                         const std::string& help);

/// A file of such a folder, and what it is.
struct FolderFile {
  std::string name;
  std::string text;
  Origin kind;
};
/// Whether such files may be written there, before any work: the rules of outputs. A folder that is
/// not there yet may be made. \throws files::InputError
void check_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents);
/// All or none, held to the rules of outputs. \throws files::InputError
void write_folder(Verb verb, const std::string& folder, const std::vector<FolderFile>& contents);

/// For the verb that was chosen, before its work. \throws files::InputError with all that is wrong.
void check_places();
/// Before another command line in this process.
void forget_places();

/// One output, or several: all or none. \throws as files::write_whole_files.
void write_output(const std::string& path, const std::string& text);
void write_outputs(const std::vector<grid::files::OutputFile>& outputs);
/// For outputs that are written piece by piece, in addition to whole texts. A path that is empty is left
/// out.
void take_place(grid::files::PendingFile& pending,
                const std::string& path,
                const std::vector<grid::files::OutputFile>& others);

}  // namespace chaintrue::cli
