// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Look-up in the tables of codes.
#include "tools/gcode/codes.hpp"

#include <fmt/format.h>

#include <array>

namespace chaintrue::gcode {
namespace {

constexpr GCode kGCodes[] = {
#define CHAINTRUE_GCODE_G(tenths, group, axes, refusal) {tenths, GGroup::group, axes, refusal},
#include "tools/gcode/g_codes.def"
#undef CHAINTRUE_GCODE_G
};

constexpr MCode kMCodes[] = {
#define CHAINTRUE_GCODE_M(number, group, refusal) {number, MGroup::group, refusal},
#include "tools/gcode/m_codes.def"
#undef CHAINTRUE_GCODE_M
};

template <class Code, std::size_t size, std::size_t rows>
constexpr std::array<std::int16_t, size> index_of(const Code (&codes)[rows], int Code::*number) {
  std::array<std::int16_t, size> index{};
  for (auto& entry : index) entry = -1;
  for (std::size_t i = 0; i < rows; ++i) {
    index[static_cast<std::size_t>(codes[i].*number)] = static_cast<std::int16_t>(i);
  }
  return index;
}

constexpr auto kGIndex = index_of<GCode, 1000>(kGCodes, &GCode::tenths);
constexpr auto kMIndex = index_of<MCode, 200>(kMCodes, &MCode::number);

}  // namespace

const GCode* find_g(int tenths) {
  if (tenths < 0 || tenths >= static_cast<int>(kGIndex.size())) return nullptr;
  const auto row = kGIndex[static_cast<std::size_t>(tenths)];
  return row < 0 ? nullptr : &kGCodes[row];
}

const MCode* find_m(int number) {
  if (number < 0 || number >= static_cast<int>(kMIndex.size())) return nullptr;
  const auto row = kMIndex[static_cast<std::size_t>(number)];
  return row < 0 ? nullptr : &kMCodes[row];
}

std::string g_name(int tenths) {
  return tenths % 10 == 0 ? fmt::format("G{}", tenths / 10)
                          : fmt::format("G{}.{}", tenths / 10, tenths % 10);
}

}  // namespace chaintrue::gcode
