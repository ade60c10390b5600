// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sources of a map, a diagnosis or a compensated program. Dates and folders are left out, so
/// the same input produces the same bytes on any machine.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::grid {

/// A file that was read.
struct SourceFile {
  std::string name;    ///< without folders
  std::string sha256;  ///< of its bytes, 64 hexadecimal digits, as sha256sum prints it
  friend bool operator==(const SourceFile&, const SourceFile&) = default;
};

struct Provenance {
  std::string version;               ///< of chaintrue: "0.1.0"
  std::string verb;                  ///< of the command, or the function: "fit"
  std::vector<std::string> options;  ///< as given, files without folders: "--surface direct"
  std::vector<SourceFile> inputs;    ///< in the order in which they were read
  friend bool operator==(const Provenance&, const Provenance&) = default;
};

}  // namespace chaintrue::grid
