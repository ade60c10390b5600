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
#include "grid/files/read_log.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string read_to_the_end(std::FILE* file, const std::string& name) {
  note_as_read(fileno(file));
  std::string text;
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, file)) > 0) text.append(buffer, count);
  if (std::ferror(file) != 0) {
    refuse_file(name,
                fmt::format("a read error ({})", system_words(errno)),
                "a file that can be read to its end");
  }
  return text;
}

/// Rejects files that look like text because a program shows them as a table.
void refuse_what_is_no_text(const std::string& text, const std::string& name) {
  struct Kind {
    std::string_view beginning;
    std::string_view found;
    std::string_view expected;
  };
  using namespace std::string_view_literals;
  constexpr Kind kKinds[] = {
      {"PK\x03\x04"sv,
       "a spreadsheet of Excel or LibreOffice (.xlsx, .ods), or a zip archive",
       "text: open it in the spreadsheet and save it as CSV"},
      {"\xD0\xCF\x11\xE0"sv,
       "a spreadsheet of an old Excel (.xls)",
       "text: open it in a spreadsheet and save it as CSV"},
      {"%PDF"sv,
       "a PDF",
       "text: what a PDF shows has to be typed, or saved as CSV where it was made"},
      {"\x89PNG"sv, "a picture", "text: the numbers have to be typed"},
      {"\xFF\xD8\xFF"sv, "a picture", "text: the numbers have to be typed"},
  };
  for (const Kind& kind : kKinds) {
    if (text.starts_with(kind.beginning))
      refuse_file(name, std::string(kind.found), std::string(kind.expected));
  }
}

std::string read_text(std::FILE* file, const std::string& name) {
  std::string text = read_to_the_end(file, name);
  refuse_what_is_no_text(text, name);
  return text;
}

}  // namespace

std::string name_in_messages(const fs::path& path) {
  return path == "-" ? "standard input" : path.string();
}

std::string read_whole_file(const fs::path& path) {
  if (path == "-") return read_text(stdin, name_in_messages(path));
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) refuse_file(path.string(), "a directory", "a file");
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file)
    refuse_file(path.string(), system_words(errno), "a file that can be opened for reading");
  return read_text(file.get(), path.string());
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
      refuse_file(output.path.string(), "a name given twice", "a file of its own for each output");
    files.push_back(pending.emplace_back(std::make_unique<PendingFile>(output.path)).get());
    files.back()->write(output.text);
  }
  take_places(files);
}

}  // namespace chaintrue::grid::files
