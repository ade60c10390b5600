// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A hash of a file's content: FNV-1a, 64 bits, as 16 hexadecimal digits. It distinguishes files;
/// it is no protection against forgery.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace chaintrue::gcode {

class FileHash {
 public:
  void add(std::string_view bytes);
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t state_ = 0xCBF29CE484222325ULL;
};

}  // namespace chaintrue::gcode
