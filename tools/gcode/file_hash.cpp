// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Fowler, Noll, Vo: http://www.isthe.com/chongo/tech/comp/fnv/
#include "tools/gcode/file_hash.hpp"

#include <fmt/format.h>

namespace chaintrue::gcode {

void FileHash::add(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;
  for (const char byte : bytes) state_ = (state_ ^ static_cast<unsigned char>(byte)) * kPrime;
}

std::string FileHash::text() const { return fmt::format("{:016x}", state_); }

}  // namespace chaintrue::gcode
