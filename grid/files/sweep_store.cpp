// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/sweep_store.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "grid/files/input_error.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using sweep::CellResult;
using sweep::CellStatus;

constexpr std::uint64_t kMagic = 0x31534c4c45435443U;  // "CTCELLS1"
constexpr std::size_t kWords = 8;
// cell, status, five values, checksum
using CellRecord = std::array<std::uint64_t, kWords>;
constexpr std::size_t kRecordBytes = sizeof(CellRecord);

/// "shard-3-of-16", with the process's number if there are several.
std::string part_name(const sweep::Share& share) {
  std::string name = fmt::format("shard-{}-of-{}", share.index + 1, share.count);
  if (share.ranks > 1) name += fmt::format("-rank-{}-of-{}", share.rank + 1, share.ranks);
  return name;
}

std::uint64_t checksum(const CellRecord& record) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t i = 0; i + 1 < kWords; ++i) {
    hash = (hash ^ record[i]) * 0x100000001b3U;
    hash ^= hash >> 29U;
  }
  return hash;
}

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof value);
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double double_of(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

CellRecord record_of(std::uint64_t cell, const CellResult& r) {
  CellRecord record{cell,
                    static_cast<std::uint64_t>(r.status),
                    bits_of(r.chain_rms_mm),
                    bits_of(r.chain_max_mm),
                    bits_of(r.tool_rms_mm),
                    bits_of(r.tool_max_mm),
                    bits_of(r.expected_tool_rms_mm),
                    0};
  record.back() = checksum(record);
  return record;
}

CellResult result_of(const CellRecord& record) {
  CellResult r;
  r.status = static_cast<CellStatus>(record[1]);
  r.chain_rms_mm = double_of(record[2]);
  r.chain_max_mm = double_of(record[3]);
  r.tool_rms_mm = double_of(record[4]);
  r.tool_max_mm = double_of(record[5]);
  r.expected_tool_rms_mm = double_of(record[6]);
  return r;
}

CellRecord header_of(std::uint64_t spec_hash) {
  CellRecord header{kMagic, spec_hash};
  header.back() = checksum(header);
  return header;
}

[[noreturn]] void refuse(const fs::path& path,
                         const std::string& value,
                         const std::string& expected) {
  throw InputError({{path.string(), "", value, expected}});
}

bool read_record(std::istream& in, CellRecord& record) {
  in.read(reinterpret_cast<char*>(record.data()), kRecordBytes);
  return in.gcount() == static_cast<std::streamsize>(kRecordBytes);
}

fs::path parts_of(const fs::path& directory) { return directory / "parts"; }

/// A file of this process only, removed however the process ends.
OpenPart unnamed_file_in(const fs::path& directory) {
  std::string name = (directory / "cells-XXXXXX").string();
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) refuse(directory, "", "a folder that can be written to");
  ::unlink(name.c_str());
  OpenPart file(::fdopen(descriptor, "w+b"));
  if (!file) {
    ::close(descriptor);
    refuse(directory, "", "a folder that can be written to");
  }
  return file;
}

}  // namespace

PartWriter::PartWriter(const fs::path& directory, const std::string& name, std::uint64_t spec_hash)
    : path_(parts_of(directory) / (name + ".cells")) {
  std::error_code error;
  fs::create_directories(parts_of(directory), error);
  const bool exists = fs::exists(path_, error);
  const std::uintmax_t size = exists ? fs::file_size(path_, error) : 0;
  if (exists && size % kRecordBytes != 0)
    fs::resize_file(path_, size / kRecordBytes * kRecordBytes, error);
  file_.reset(std::fopen(path_.c_str(), "ab"));
  if (!file_) refuse(path_, "", "a folder that can be written to");
  if (size < kRecordBytes) {
    const CellRecord header = header_of(spec_hash);
    if (std::fwrite(header.data(), kRecordBytes, 1, file_.get()) != 1 ||
        std::fflush(file_.get()) != 0) {
      refuse(path_, "", "room on the disk");
    }
  }
}

void PartWriter::append(std::uint64_t cell, const CellResult& result) {
  const CellRecord record = record_of(cell, result);
  if (std::fwrite(record.data(), kRecordBytes, 1, file_.get()) != 1 ||
      std::fflush(file_.get()) != 0) {
    refuse(path_, "", "room on the disk");
  }
}

ResultStore::ResultStore(fs::path directory, std::uint64_t spec_hash, std::uint64_t cells)
    : directory_(std::move(directory)),
      spec_hash_(spec_hash),
      done_(static_cast<std::size_t>(cells)) {
  read_parts([&](std::uint64_t cell, const CellResult&) {
    if (cell < done_.size() && !done_[static_cast<std::size_t>(cell)]) {
      done_[static_cast<std::size_t>(cell)] = true;
      ++finished_;
    }
  });
}

void ResultStore::read_parts(
    const std::function<void(std::uint64_t, const CellResult&)>& visit) const {
  std::vector<fs::path> parts;
  // No folder yet: no parts.
  std::error_code error;
  for (fs::directory_iterator entry(parts_of(directory_), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".cells") parts.push_back(entry->path());
  }
  std::sort(parts.begin(), parts.end());
  for (const fs::path& part : parts) {
    std::ifstream in(part, std::ios::binary);
    CellRecord record;
    if (!read_record(in, record)) continue;  // stopped before its first record
    if (record != header_of(spec_hash_)) {
      refuse(part,
             "cells of another sweep",
             "an empty folder, or one that holds parts of this very specification");
    }
    while (read_record(in, record)) {
      if (record.back() == checksum(record)) visit(record[0], result_of(record));
    }
  }
}

void ResultStore::for_each(
    const std::function<void(std::uint64_t, const CellResult&)>& visit) const {
  if (!complete()) {
    throw precondition("sweep: {} of {} cells are missing", cells() - finished_, cells());
  }
  // Sorted on disk: the record of a cell is at its number.
  const OpenPart sorted = unnamed_file_in(directory_);
  const auto must = [&](bool done) {
    if (!done) refuse(directory_, "", "room on the disk");
  };
  read_parts([&](std::uint64_t cell, const CellResult& result) {
    if (cell >= cells()) return;
    const CellRecord record = record_of(cell, result);
    must(::fseeko(sorted.get(), static_cast<off_t>(cell * kRecordBytes), SEEK_SET) == 0);
    must(std::fwrite(record.data(), kRecordBytes, 1, sorted.get()) == 1);
  });
  must(std::fflush(sorted.get()) == 0 && ::fseeko(sorted.get(), 0, SEEK_SET) == 0);
  CellRecord record;
  for (std::uint64_t cell = 0; cell < cells(); ++cell) {
    if (std::fread(record.data(), kRecordBytes, 1, sorted.get()) != 1 || record[0] != cell)
      throw std::logic_error("sweep: sorted cells are damaged");
    visit(cell, result_of(record));
  }
}

sweep::CellStore cells_kept_in(const fs::path& directory,
                               const sweep::SweepSpec& spec,
                               std::uint64_t spec_hash,
                               const sweep::Share& share) {
  const auto store = std::make_shared<const ResultStore>(directory, spec_hash, cells(spec));
  return {[store](std::uint64_t cell) { return store->has(cell); },
          [directory, spec_hash, share] {
            const auto part = std::make_shared<PartWriter>(directory, part_name(share), spec_hash);
            return [part](std::uint64_t cell, const CellResult& result) {
              part->append(cell, result);
            };
          }};
}

}  // namespace chaintrue::grid::files
