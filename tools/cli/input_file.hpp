// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Loads the input files of a verb: detects their kind once, refuses kinds that the verb does not
/// read, and reports assumptions on standard error.
///
/// \code
///   const InputFile file = open_input(command.map);
///   require_kind(file, {FileKind::map, FileKind::anchors});
///   if (file.kind == FileKind::anchors) return check_anchors(load_anchors(file), ...);
///   return check_map(load_map(file), ...);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/file_type.hpp"
#include "grid/map/compensation_map.hpp"
#include "model/belts/belt_machine.hpp"
#include "model/machine.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

struct InputFile {
  std::string path;  ///< as given
  std::string name;  ///< its name in messages
  std::string text;
  FileKind kind = FileKind::other;

  /// For options that act on this kind only.
  Facts fact() const;
};

using InputFiles = std::vector<InputFile>;

/// "-" is standard input. \throws InputError if it cannot be read, or is JSON that ends
/// before its type.
InputFile open_input(const std::string& path);

/// \param also a clause on where a refused kind is accepted; empty: as usual for that kind
/// \throws InputError with the kind found and the kinds accepted.
void require_kind(const InputFile& file, const std::vector<FileKind>& taken,
                  const std::string& also = "");

/// Each reads a file of its kind. \throws InputError with every problem.
files::FittedAnchors load_anchors(const InputFile& file);
/// Null if there are none.
const grid::HolesWithBelts* holes_of(const files::FittedAnchors& found);
Diagnosis load_diagnosis(const InputFile& file);
Machine load_machine(const InputFile& file);
/// The belts of a chaintrue_belts file.
BeltMachine load_belt_machine(const InputFile& file);
/// At most kMostBeltPoints places; `work` is their purpose: "a fit". Leaves out the points
/// `without`, counted from 1.
files::ReadBelts load_belts(const InputFile& file, const std::string& work,
                            const std::vector<std::size_t>& without = {});

CompensationMap load_map(const InputFile& file);

/// "-" is standard input. A file that is read again gives no new warnings. \throws
/// InputError.
Machine read_machine_input(const std::string& path);

/// The machine of a four-belt controller: from a chaintrue_belts file with the anchors in force,
/// from a chaintrue_anchors file with the fitted ones, as pasted from export maslow4. \throws
/// InputError.
BeltMachine read_belt_machine_input(const std::string& path);

}  // namespace chaintrue::cli
