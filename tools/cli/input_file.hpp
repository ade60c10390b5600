// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The loader of the files that a verb works with: it looks once at what a file is, refuses a kind
/// that the verb does not take, and tells on standard error what was assumed.
///
/// \code
///   const InputFile file = open_input(command.map);
///   require_kind(file, {FileKind::map, FileKind::anchors});
///   if (file.kind == FileKind::anchors) return query_anchors(load_anchors(file), ...);
///   return query_map(load_map(file), ...);
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

namespace chaintrue::cli {

using grid::files::FileKind;

struct InputFile {
  std::string path;  ///< as it was given
  std::string name;  ///< what messages call it
  std::string text;
  FileKind kind = FileKind::other;
};

/// "-" is standard input. \throws files::InputError where it cannot be read, or is JSON that breaks
/// off before it says what it is.
[[nodiscard]] InputFile open_input(const std::string& path);

/// \param also where a kind that is refused is taken instead, a clause; or nothing
/// \throws files::InputError that says what was found and which kinds are taken.
void require_kind(const InputFile& file,
                  const std::vector<FileKind>& taken,
                  const std::string& also = "");

/// Each reads a file of its kind. \throws files::InputError with every problem.
[[nodiscard]] grid::files::FittedAnchors load_anchors(const InputFile& file);
[[nodiscard]] grid::diagnosis::Diagnosis load_diagnosis(const InputFile& file);
[[nodiscard]] model::Machine load_machine(const InputFile& file);
/// As read_belt_machine_input().
[[nodiscard]] model::BeltMachine load_belt_machine(const InputFile& file);
/// At most kMostBeltPoints places; `work` is what they are read for: "a fit".
[[nodiscard]] grid::files::ReadBelts load_belts(const InputFile& file, const std::string& work);
/// The same without points, counted from 1.
[[nodiscard]] grid::files::ReadBelts load_belts(const InputFile& file,
                                                const std::string& work,
                                                const std::vector<std::size_t>& without);

[[nodiscard]] grid::CompensationMap load_map(const InputFile& file);

/// "-" is standard input. A file that is read again says nothing new. \throws files::InputError.
[[nodiscard]] model::Machine read_machine_input(const std::string& path);

/// What the controller of four belts believes: of a chaintrue_belts file the anchors in force, of a
/// chaintrue_anchors file those that were fitted, as export maslow4 has them pasted. \throws
/// files::InputError.
[[nodiscard]] model::BeltMachine read_belt_machine_input(const std::string& path);

}  // namespace chaintrue::cli
