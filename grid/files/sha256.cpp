// SPDX-License-Identifier: GPL-3.0-or-later
// Names as in FIPS 180-4: section 4.1.2 the functions, 5.1.1 the padding, 6.2.2 a block.
#include "grid/files/sha256.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace chaintrue::grid::files {
namespace {

/// First 32 bits of the fractional parts of the cube roots of the first 64 primes (4.2.2).
constexpr std::array<std::uint32_t, 64> kRoundConstants = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t word_at(const unsigned char* bytes) {
  return std::uint32_t{bytes[0]} << 24U | std::uint32_t{bytes[1]} << 16U |
         std::uint32_t{bytes[2]} << 8U | std::uint32_t{bytes[3]};
}

/// By 1 to 31 bits. std::rotr has an int parameter in one standard library and an unsigned one in another.
std::uint32_t rotated(std::uint32_t x, unsigned bits) { return x >> bits | x << (32U - bits); }

std::uint32_t sum(std::uint32_t x, unsigned first, unsigned second, unsigned third) {
  return rotated(x, first) ^ rotated(x, second) ^ rotated(x, third);
}
std::uint32_t mix(std::uint32_t x, unsigned first, unsigned second, unsigned shift) {
  return rotated(x, first) ^ rotated(x, second) ^ (x >> shift);
}

}  // namespace

void Sha256::take_block(const unsigned char* block) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t) w[t] = word_at(block + 4 * t);
  for (std::size_t t = 16; t < 64; ++t)
    w[t] = mix(w[t - 2], 17, 19, 10) + w[t - 7] + mix(w[t - 15], 7, 18, 3) + w[t - 16];
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t choice = (e & f) ^ (~e & g);
    const std::uint32_t majority = (a & b) ^ (a & c) ^ (b & c);
    const std::uint32_t t1 = h + sum(e, 6, 11, 25) + choice + kRoundConstants[t] + w[t];
    const std::uint32_t t2 = sum(a, 2, 13, 22) + majority;
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<std::uint32_t, 8> found = {a, b, c, d, e, f, g, h};
  for (const auto i : each_index(found)) state_[i] += found[i];
}

Sha256& Sha256::add(std::string_view bytes) {
  bytes_ += bytes.size();
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), kBlockBytes - waiting_bytes_);
    std::copy_n(bytes.begin(), taken,
                waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_bytes_));
    waiting_bytes_ += taken;
    bytes.remove_prefix(taken);
    if (waiting_bytes_ < kBlockBytes) break;
    take_block(waiting_.data());
    waiting_bytes_ = 0;
  }
  return *this;
}

std::string Sha256::text() const {
  Sha256 ended = *this;
  constexpr std::size_t kLengthBytes = 8;
  const std::uint64_t bits = 8 * bytes_;
  ended.add("\x80");
  while (ended.waiting_bytes_ != kBlockBytes - kLengthBytes) ended.add(std::string_view("\0", 1));
  std::string length;
  for (const auto i : each_below(kLengthBytes))
    length += static_cast<char>(bits >> (8 * (kLengthBytes - 1 - i)) & 0xFFU);
  ended.add(length);
  std::string text;
  for (const std::uint32_t word : ended.state_) text += fmt::format("{:08x}", word);
  return text;
}

}  // namespace chaintrue::grid::files
