// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/whole_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <system_error>

#include "grid/files/input_error.hpp"
#include "grid/files/pending_file.hpp"
#include "grid/files/sha256.hpp"
#include "grid/files/sources.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Three times the largest supported file; G-code is read line by line.
constexpr std::size_t kMostBytes = std::size_t{16} << 20U;

std::string read_to_the_end(std::FILE* file, const fs::path& path) {
  const std::string name = name_in_messages(path);
  note_as_read(path == "-" ? "/dev/stdin" : path);
  std::string text;
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, file)) > 0) {
    if (text.size() + count > kMostBytes) {
      refuse(name, "a larger file",
             fmt::format("at most {} MB; no file of measurements or settings is larger",
                         kMostBytes >> 20U),
             ProblemKind::file_kind);
    }
    text.append(buffer, count);
  }
  if (std::ferror(file) != 0) {
    refuse(name, fmt::format("a read error ({})", system_words(errno)),
           "a file that can be read to its end", ProblemKind::unreadable_file);
  }
  note_source({name_without_folders(path), sha256(text)});
  return text;
}

/// Rejects files that look like text because a program shows them as a table.
void check_is_text(const std::string& text, const std::string& name) {
  struct Kind {
    std::string_view beginning;
    std::string_view found;
    std::string_view expected;
  };
  using namespace std::string_view_literals;
  constexpr Kind kKinds[] = {
      {"PK\x03\x04"sv, "a spreadsheet of Excel or LibreOffice (.xlsx, .ods), or a zip archive",
       "text: open it in the spreadsheet and save it as CSV"},
      {"\xD0\xCF\x11\xE0"sv, "an old Excel spreadsheet (.xls)",
       "text: open it in a spreadsheet and save it as CSV"},
      {"%PDF"sv, "a PDF",
       "text: the contents of a PDF must be typed, or saved as CSV in the program that made it"},
      {"\x89PNG"sv, "a picture", "text: the numbers must be typed"},
      {"\xFF\xD8\xFF"sv, "a picture", "text: the numbers must be typed"},
  };
  for (const Kind& kind : kKinds) {
    if (text.starts_with(kind.beginning))
      refuse(name, std::string(kind.found), std::string(kind.expected), ProblemKind::file_kind);
  }
}

/// What Excel saves as "Unicode text" begins with a byte order mark of UTF-16; other text is
/// unchanged.
std::string utf8_of(std::string text, const std::string& name) {
  const bool is_little = text.starts_with("\xFF\xFE");
  if (!is_little && !text.starts_with("\xFE\xFF")) return text;
  std::u16string units;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
    const auto first = static_cast<unsigned char>(text[i]);
    const auto second = static_cast<unsigned char>(text[i + 1]);
    units += static_cast<char16_t>(is_little ? first | second << 8 : first << 8 | second);
  }
  try {
    // A path has the only conversion of the standard library that is not deprecated.
    return fs::path(units).string();
  } catch (const fs::filesystem_error&) {
    refuse(name, "UTF-16 with half a character", "text in UTF-8", ProblemKind::unreadable_file);
  }
}

std::string read_text(std::FILE* file, const fs::path& path) {
  const std::string name = name_in_messages(path);
  std::string text = utf8_of(read_to_the_end(file, path), name);
  check_is_text(text, name);
  return text;
}

}  // namespace

std::string name_in_messages(const fs::path& path) {
  return path == "-" ? "standard input" : path.string();
}

std::string read_whole_file(const fs::path& path) {
  if (path == "-") return read_text(stdin, path);
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    refuse(path.string(), "a directory", "a file", ProblemKind::unreadable_file);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    const std::string name = path.string();
    const std::string sentence =
        errno == ENOENT
            ? fmt::format("There is no file {}{}.", name, path.has_parent_path() ? "" : " here")
            : fmt::format("{} cannot be read: {}.", name, system_words(errno));
    throw InputError({{"", "", name, "a file that can be opened for reading", sentence,
                       ProblemKind::unreadable_file}});
  }
  return read_text(file.get(), path);
}

void write_whole_file(const fs::path& path, std::string_view text) {
  PendingFile file(path);
  file.write(text);
  take_places({&file});
}

void write_whole_files(const std::vector<OutputFile>& outputs) {
  std::set<std::string> names;
  std::vector<std::unique_ptr<PendingFile>> pending;
  std::vector<PendingFile*> files;
  for (const OutputFile& output : outputs) {
    std::error_code error;
    const std::string place =
        output.path == "-" ? "-" : fs::weakly_canonical(output.path, error).string();
    const bool is_device = fs::is_character_file(output.path, error);
    if (!is_device && !names.insert(place).second)
      refuse(output.path.string(), "a name given twice", "a different file for each output",
             ProblemKind::output_repeated);
    files.push_back(pending.emplace_back(std::make_unique<PendingFile>(output.path)).get());
    files.back()->write(output.text);
  }
  take_places(files);
}

}  // namespace chaintrue::grid::files
