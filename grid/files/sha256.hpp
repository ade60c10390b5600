// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// SHA-256 (NIST FIPS 180-4, 2015), for the files that a result was made from.
///
/// \code
///   Sha256().add("abc").text();  // "ba7816bf 8f01cfea ..." without blanks
/// \endcode
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace chaintrue::grid::files {

class Sha256 {
 public:
  Sha256& add(std::string_view bytes);
  /// 64 hexadecimal digits, of what was added so far.
  std::string text() const;

 private:
  static constexpr std::size_t kBlockBytes = 64;
  void take_block(const unsigned char* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, kBlockBytes> waiting_{};
  std::size_t waiting_bytes_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace chaintrue::grid::files
