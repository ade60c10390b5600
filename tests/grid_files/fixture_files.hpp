// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files of fixtures/good and fixtures/bad. A file's name begins with the kind of its reader
/// (grid_, machine_, ...), and it contains the expected messages: lines of "comment" in JSON,
/// comment lines elsewhere, and if neither is possible, a file of the same name plus .expect.
///   expect: part of the message of one problem; there are as many problems as such lines
///   warn:   part of one warning, likewise
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace chaintrue::grid::files {

struct FixtureFile {
  std::filesystem::path path;
  /// "grid", "machine", "points", "optical", "groundcontrol".
  std::string kind;
};

/// Readable in the names and messages of parameterised tests.
void PrintTo(const FixtureFile& fixture, std::ostream* out);
std::string test_name_of(const FixtureFile& fixture);

/// Sorted by name.
std::vector<FixtureFile> fixtures_in(const std::string& folder);
/// The texts after `mark` ("expect: ") in the file's comments.
std::vector<std::string> remarks_in(const FixtureFile& fixture, const std::string& mark);

/// The result of reading a file: the object written again, its warnings, or its problems.
struct Outcome {
  std::string written;
  std::vector<std::string> warnings;
  std::vector<std::string> problems;
};

/// Reads by the kind's reader. Throws std::out_of_range for a kind without a reader.
Outcome read_fixture(const FixtureFile& fixture);
/// The same for a text.
Outcome read_text(const std::string& kind, const std::string& text, const std::string& name);

}  // namespace chaintrue::grid::files
