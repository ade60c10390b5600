// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/pending_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <system_error>
#include <utility>

#include "grid/files/input_error.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// The name of a temporary file.
struct PendingName {
  std::atomic<bool> is_taken{false};
  std::atomic<bool> is_named{false};
  std::array<char, 4096> name{};
};

namespace {

namespace fs = std::filesystem;

/// At fixed addresses for the signal handler. A slot is claimed before its file is created, so that
/// every file has one.
std::array<PendingName, 16> slots;

extern "C" void remove_pending_and_end(int signal_number) {
  for (const PendingName& slot : slots) {
    if (slot.is_named.load()) ::unlink(slot.name.data());
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

/// Null if there is no room.
PendingName* claim_slot(const std::string& name) {
  for (PendingName& slot : slots) {
    if (name.size() >= slot.name.size() || slot.is_taken.exchange(true)) continue;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    slot.is_named.store(true);
    return &slot;
  }
  return nullptr;
}

void free_slot(PendingName*& slot) {
  if (slot == nullptr) return;
  slot->is_named.store(false);
  slot->is_taken.store(false);
  slot = nullptr;
}

/// The open descriptor that a path such as /dev/stdout or /proc/self/fd/3 names.
std::optional<int> descriptor_behind(const fs::path& path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  if (path.parent_path() != "/dev/fd" && path.parent_path() != "/proc/self/fd") return std::nullopt;
  return whole_number_of(path.filename().string(), 0, 1'000'000);
}

/// Where symbolic links lead, whether a file is there or not.
fs::path end_of_links(const fs::path& path) {
  constexpr int kMostLinks = 40;  // Linux's own limit
  std::error_code error;
  fs::path target = path;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    const fs::path next = fs::read_symlink(target, error);
    if (error || links == kMostLinks) {
      files::refuse(path.string(), system_words(error ? error.value() : ELOOP),
                    "a link that leads to a file", ProblemKind::output_place);
    }
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

/// The file that a path resolves to; empty if it is a device, a pipe or an open descriptor, which
/// are written to directly.
fs::path file_behind(const fs::path& path) {
  if (path.empty())
    files::refuse("output file", "an empty name", "the name of a file", ProblemKind::output_place);
  if (descriptor_behind(path)) return {};
  std::error_code error;
  if (fs::is_directory(path, error))
    files::refuse(path.string(), "a directory", "the name of a file", ProblemKind::output_place);
  const fs::path target = end_of_links(path);
  struct stat status = {};
  if (::stat(target.c_str(), &status) != 0) {
    // An invalid name would be detected only at the rename, after other files were renamed.
    if (errno != ENOENT)
      files::refuse(path.string(), system_words(errno), "the name of a file",
                    ProblemKind::output_place);
    return target;
  }
  if (!S_ISREG(status.st_mode)) return {};
  // An administrator may write to any file; files without any write permission are protected all
  // the same.
  constexpr mode_t kAnybodyWrites = S_IWUSR | S_IWGRP | S_IWOTH;
  const bool is_protected = (status.st_mode & kAnybodyWrites) == 0;
  if (is_protected || ::access(target.c_str(), W_OK) != 0) {
    files::refuse(path.string(), is_protected ? "a protected file" : system_words(errno),
                  "a file that may be overwritten", ProblemKind::output_place);
  }
  return target;
}

/// A new file gets the process's default permissions, an existing one keeps its own.
mode_t rights_for(const struct stat* old) {
  if (old != nullptr) return old->st_mode & 07777U;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666U & ~mask;
}

std::string unpredictable_name_next_to(const fs::path& target) {
  std::random_device bits;
  const std::uint64_t number = (static_cast<std::uint64_t>(bits()) << 32U) | bits();
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  // A name may have 255 bytes; it begins with the target's name to show where it belongs.
  return (folder / fmt::format(".{}.{:016x}", target.filename().string().substr(0, 200), number))
      .string();
}

/// False with errno set where not everything could be written.
bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ::ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

/// What an output replaces: under a second name until all outputs are in place.
class OldFile {
 public:
  explicit OldFile(const fs::path& target)
      : target_(target), name_(unpredictable_name_next_to(target)), slot_(claim_slot(name_)) {
    has_name_ = ::link(target_.c_str(), name_.c_str()) == 0;
    // Without hard links a replaced file cannot be restored.
    is_new_ = !has_name_ && errno == ENOENT;
  }
  ~OldFile() {
    if (has_name_) ::unlink(name_.c_str());
    free_slot(slot_);
  }
  OldFile(const OldFile&) = delete;
  OldFile& operator=(const OldFile&) = delete;

  void come_back() noexcept {
    if (is_new_) ::unlink(target_.c_str());
    if (has_name_ && std::rename(name_.c_str(), target_.c_str()) == 0) has_name_ = false;
  }

 private:
  fs::path target_;
  std::string name_;
  PendingName* slot_;
  bool has_name_ = false;
  bool is_new_ = false;
};

constexpr std::size_t kPiece = std::size_t{1} << 18U;

}  // namespace

PendingFile::PendingFile(fs::path path) : path_(std::move(path)), target_(file_behind(path_)) {
  if (target_.empty()) return;
  temporary_ = unpredictable_name_next_to(target_);
  slot_ = claim_slot(temporary_);
  descriptor_ =
      ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (descriptor_ >= 0) return;
  const int error_number = errno;
  temporary_.clear();
  free_slot(slot_);
  files::refuse(path_.string(), system_words(error_number),
                "a directory that exists and can be written to", ProblemKind::output_place);
}

PendingFile::~PendingFile() { discard(); }

void PendingFile::discard() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
  free_slot(slot_);
}

void PendingFile::refuse(int error_number) {
  discard();
  files::refuse(path_.string(), system_words(error_number),
                "free space and permission to write the file", ProblemKind::output_place);
}

void PendingFile::write(std::string_view bytes) {
  held_.append(bytes);
  if (target_.empty() || held_.size() < kPiece) return;
  if (error_number_ == 0 && !write_all(descriptor_, held_)) error_number_ = errno;
  held_.clear();
}

std::string PendingFile::flushed() {
  if (target_.empty()) return {};
  if (error_number_ == 0 && !write_all(descriptor_, held_)) error_number_ = errno;
  held_.clear();
  if (error_number_ != 0) refuse(error_number_);
  return temporary_;
}

void PendingFile::finish() {
  if (flushed().empty()) return;
  struct stat old = {};
  const bool replaces = ::stat(target_.c_str(), &old) == 0;
  // Only an administrator may change the owner; for other users it is their own already.
  if (replaces && ::fchown(descriptor_, old.st_uid, old.st_gid) != 0 && errno != EPERM)
    refuse(errno);
  if (::fchmod(descriptor_, rights_for(replaces ? &old : nullptr)) != 0 ||
      ::fsync(descriptor_) != 0 || ::close(std::exchange(descriptor_, -1)) != 0) {
    refuse(errno);
  }
}

void PendingFile::take_name() {
  if (target_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) refuse(errno);
  temporary_.clear();
  free_slot(slot_);
}

void PendingFile::put_out() const {
  if (!target_.empty()) return;
  const auto open_already = descriptor_behind(path_);
  // The standard streams keep the order of what is printed there.
  std::FILE* stream = open_already == STDOUT_FILENO   ? stdout
                      : open_already == STDERR_FILENO ? stderr
                                                      : nullptr;
  const int descriptor =
      open_already ? open_already.value() : ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  const bool is_written =
      stream != nullptr ? std::fwrite(held_.data(), 1, held_.size(), stream) == held_.size() &&
                              std::fflush(stream) == 0
                        : descriptor >= 0 && write_all(descriptor, held_);
  const int error_number = errno;
  if (!open_already && descriptor >= 0) ::close(descriptor);
  if (is_written) return;
  if (error_number == EPIPE) throw ReaderGone();
  files::refuse(path_ == "-" ? "standard output" : path_.string(), system_words(error_number),
                "something that can be written to", ProblemKind::output_place);
}

void take_places(const std::vector<PendingFile*>& files) {
  for (PendingFile* file : files) file->finish();
  std::vector<std::unique_ptr<OldFile>> replaced;
  try {
    for (PendingFile* file : files) {
      if (!file->target_.empty()) replaced.push_back(std::make_unique<OldFile>(file->target_));
      file->take_name();
    }
    for (const PendingFile* file : files) file->put_out();
  } catch (const ReaderGone&) {
    throw;
  } catch (...) {
    for (const auto& old : replaced) old->come_back();
    throw;
  }
}

void remove_pending_files_on_signals() {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction action = {};
    if (::sigaction(signal_number, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
    action = {};
    action.sa_handler = remove_pending_and_end;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal_number, &action, nullptr);
  }
}

}  // namespace chaintrue::grid::files
