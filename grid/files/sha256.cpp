// SPDX-License-Identifier: GPL-3.0-or-later
// Names as in FIPS 180-4: section 4.1.2 the functions, 5.1.1 the padding, 6.2.2 a block.
#include "grid/files/sha256.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string_view>
#include <vector>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

/// First 32 bits of the fractional parts of the cube roots of the first 64 primes (4.2.2).
const std::vector<std::uint32_t>& round_constants() {
  static const auto constants = [] {
    Indices primes;
    for (std::size_t n = 2; primes.size() < 64; ++n) {
      if (none_of(primes, [n](std::size_t prime) { return n % prime == 0; })) primes.push_back(n);
    }
    return mapped(primes, [](std::size_t prime) {
      const double root = std::cbrt(as_double(prime));
      return static_cast<std::uint32_t>((root - std::floor(root)) * 0x1p32);
    });
  }();
  return constants;
}

std::uint32_t word_at(std::string_view bytes) {
  std::uint32_t word = 0;
  for (const char byte : bytes.substr(0, 4)) word = word << 8U | static_cast<unsigned char>(byte);
  return word;
}

/// By 1 to 31 bits. std::rotr has an int parameter in one standard library and an unsigned one in another.
std::uint32_t rotated(std::uint32_t x, unsigned bits) { return x >> bits | x << (32U - bits); }

std::uint32_t sum(std::uint32_t x, unsigned first, unsigned second, unsigned third) {
  return rotated(x, first) ^ rotated(x, second) ^ rotated(x, third);
}
std::uint32_t mix(std::uint32_t x, unsigned first, unsigned second, unsigned shift) {
  return rotated(x, first) ^ rotated(x, second) ^ (x >> shift);
}

using State = std::array<std::uint32_t, 8>;
constexpr std::size_t kBlockBytes = 64;

void take_block(std::string_view block, State& state) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t) w[t] = word_at(block.substr(4 * t));
  for (std::size_t t = 16; t < 64; ++t)
    w[t] = mix(w[t - 2], 17, 19, 10) + w[t - 7] + mix(w[t - 15], 7, 18, 3) + w[t - 16];
  const auto& constants = round_constants();
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t choice = (e & f) ^ (~e & g);
    const std::uint32_t majority = (a & b) ^ (a & c) ^ (b & c);
    const std::uint32_t t1 = h + sum(e, 6, 11, 25) + choice + constants[t] + w[t];
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
  const State found = {a, b, c, d, e, f, g, h};
  for (const auto i : each_index(found)) state[i] += found[i];
}

}  // namespace

std::string sha256(std::istream& in) {
  State state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::string block(kBlockBytes, '\0');
  std::uint64_t bytes = 0;
  for (; in.read(block.data(), kBlockBytes); bytes += kBlockBytes) take_block(block, state);
  block.resize(as_size(in.gcount()));
  const std::uint64_t bits = 8 * (bytes + block.size());
  block += '\x80';
  while (block.size() % kBlockBytes != kBlockBytes - sizeof bits) block += '\0';
  for (unsigned shift = 64; shift > 0; shift -= 8)
    block += static_cast<char>(bits >> (shift - 8) & 0xFFU);
  for (std::size_t at = 0; at < block.size(); at += kBlockBytes)
    take_block(std::string_view(block).substr(at), state);
  std::string text;
  for (const std::uint32_t word : state) text += fmt::format("{:08x}", word);
  return text;
}

std::string sha256(const std::string& bytes) {
  std::istringstream in(bytes);
  return sha256(in);
}

}  // namespace chaintrue::grid::files
