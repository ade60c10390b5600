// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <system_error>

#include "grid/files/input_error.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void fail(std::string name, std::string found, std::string expected) {
  throw InputError({{std::move(name), "", std::move(found), std::move(expected)}});
}

/// The system's own words for an error number, in English whatever the locale.
std::string words_of(int error_number) {
  return std::error_code(error_number, std::generic_category()).message();
}

std::string read_to_the_end(std::FILE* file, const std::string& name) {
  std::string text;
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, file)) > 0) text.append(buffer, count);
  if (std::ferror(file) != 0) {
    fail(name,
         fmt::format("a read error ({})", words_of(errno)),
         "a file that can be read to its end");
  }
  return text;
}

/// False on a short write; errno says why.
bool write_to_the_end(std::FILE* file, std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

void write_directly(const fs::path& path, std::string_view text) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "wb"));
  if (!file || !write_to_the_end(file.get(), text)) {
    fail(path.string(), words_of(errno), "something that can be written to");
  }
}

/// A new file takes the rights that the process gives new files, an old one keeps its own.
mode_t rights_for(const fs::path& target) {
  struct stat status = {};
  if (::stat(target.c_str(), &status) == 0) return status.st_mode & 07777U;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666U & ~mask;
}

/// A text that lies beside its place under another name until it takes it; gone if it never does.
class StagedFile {
 public:
  StagedFile(fs::path target, std::string_view text) : target_(std::move(target)) {
    const fs::path directory = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    temporary_ = (directory / fmt::format(".{}.XXXXXX", target_.filename().string())).string();
    const int descriptor = ::mkstemp(temporary_.data());
    if (descriptor < 0) {
      fail(target_.string(), words_of(errno), "a directory that exists and can be written to");
    }
    std::unique_ptr<std::FILE, CloseFile> file(::fdopen(descriptor, "wb"));
    if (file && write_to_the_end(file.get(), text) &&
        ::fchmod(descriptor, rights_for(target_)) == 0 && ::fsync(descriptor) == 0) {
      return;
    }
    refuse(errno);
  }
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;
  ~StagedFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  void take_its_name() {
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) refuse(errno);
    temporary_.clear();
  }

 private:
  /// Called by the constructor as well, after which no destructor runs.
  [[noreturn]] void refuse(int error_number) {
    ::unlink(temporary_.c_str());
    temporary_.clear();
    fail(target_.string(), words_of(error_number), "room and the right to write the file");
  }

  fs::path target_;
  std::string temporary_;
};

/// The file that a path names in the end; empty where it is no file but a device or standard
/// output, which is written to directly.
fs::path file_behind(const fs::path& path) {
  if (path == "-") return {};
  std::error_code error;
  if (path.empty()) fail("output file", "an empty name", "the name of a file");
  if (fs::is_directory(path, error)) fail(path.string(), "a directory", "the name of a file");
  const fs::path resolved = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error) : path;
  const fs::path& target = error ? path : resolved;
  if (!fs::exists(target, error)) return target;
  if (!fs::is_regular_file(target, error)) return {};
  if (::access(target.c_str(), W_OK) != 0) {
    fail(path.string(), words_of(errno), "a file that may be written to");
  }
  return target;
}

void write_to_device(const fs::path& path, std::string_view text) {
  if (path != "-") return write_directly(path, text);
  if (!write_to_the_end(stdout, text)) fail("standard output", words_of(errno), "room to write");
}

}  // namespace

std::string name_in_messages(const fs::path& path) {
  return path == "-" ? "standard input" : path.string();
}

std::string read_whole_file(const fs::path& path) {
  if (path == "-") return read_to_the_end(stdin, name_in_messages(path));
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail(path.string(), "a directory", "a file");
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) fail(path.string(), words_of(errno), "a file that can be opened for reading");
  return read_to_the_end(file.get(), path.string());
}

void write_whole_file(const fs::path& path, std::string_view text) {
  const fs::path target = file_behind(path);
  if (target.empty()) return write_to_device(path, text);
  StagedFile(target, text).take_its_name();
}

void write_whole_files(const std::vector<OutputFile>& outputs) {
  std::set<std::string> names;
  std::vector<std::unique_ptr<StagedFile>> staged;
  for (const OutputFile& output : outputs) {
    const fs::path target = file_behind(output.path);
    if (target.empty()) continue;
    if (!names.insert(fs::absolute(target).lexically_normal().string()).second)
      fail(output.path.string(), "a name given twice", "a file of its own for each output");
    staged.push_back(std::make_unique<StagedFile>(target, output.text));
  }
  for (const auto& file : staged) file->take_its_name();
  for (const OutputFile& output : outputs) {
    if (file_behind(output.path).empty()) write_to_device(output.path, output.text);
  }
}

}  // namespace chaintrue::grid::files
