// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/whole_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <system_error>

#include "grid/files/file_identity.hpp"
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
  note_as_read(fileno(file));
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
  Sha256 hash;
  hash.add(text);
  note_source({name_without_folders(path), hash.text()});
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

void put_utf8(std::uint32_t code, std::string& text) {
  const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xC0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
  }
  put(0x80 | (code & 0x3F));
}

/// What Excel saves as "Unicode text" begins with a byte order mark of UTF-16; other text is
/// unchanged.
std::string utf8_of(std::string text) {
  const bool is_little = text.starts_with("\xFF\xFE");
  if (!is_little && !text.starts_with("\xFE\xFF")) return text;
  std::string result;
  std::uint32_t high = 0;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2) {
    const auto byte = [&](std::size_t k) {
      return std::uint32_t{static_cast<unsigned char>(text[k])};
    };
    const std::uint32_t unit = is_little ? byte(i) | byte(i + 1) << 8 : byte(i) << 8 | byte(i + 1);
    const bool is_low = unit >= 0xDC00 && unit < 0xE000;
    if (unit >= 0xD800 && unit < 0xDC00) {
      high = unit;
    } else {
      // Half of a surrogate pair becomes the replacement character.
      put_utf8(!is_low     ? unit
               : high != 0 ? 0x10000 + ((high - 0xD800) << 10) + (unit - 0xDC00)
                           : 0xFFFD,
               result);
      high = 0;
    }
  }
  return result;
}

std::string read_text(std::FILE* file, const fs::path& path) {
  std::string text = utf8_of(read_to_the_end(file, path));
  check_is_text(text, name_in_messages(path));
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
