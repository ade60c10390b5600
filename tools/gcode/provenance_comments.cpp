// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/provenance_comments.hpp"

#include <fmt/format.h>

#include <string_view>

namespace chaintrue::gcode {
namespace {

/// Behind the ( or ; that opens it.
constexpr std::string_view kHashHead = "sha256 begins ";

bool is_harmless(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view(" ._,+=:-").find(c) != std::string_view::npos;
}

std::string comment(std::string text, std::size_t longest) {
  for (char& c : text) {
    if (!is_harmless(c)) c = '_';
  }
  return "(" + text.substr(0, longest - 2) + ")";
}

}  // namespace

std::vector<std::string> comments_of(const grid::Provenance& made_by, std::size_t longest) {
  std::vector<std::string> lines = {
      comment(fmt::format("chaintrue {}, {}", made_by.version, made_by.verb), longest)};
  for (const std::string& option : made_by.options)
    lines.push_back(comment("option " + option, longest));
  for (const grid::SourceFile& file : made_by.inputs) {
    lines.push_back(comment("from " + file.name, longest));
    lines.push_back("(" + std::string(kHashHead) + file.sha256.substr(0, kHashDigits) + ")");
  }
  return lines;
}

std::vector<std::string> hashes_in_head(LineSource program) {
  std::vector<std::string> hashes;
  SourceLine line;
  for (auto read = program.next(line); read && *read; read = program.next(line)) {
    std::string_view text = line.text;
    if (!text.starts_with('(') && !text.starts_with(';')) break;
    text.remove_prefix(1);
    if (text.starts_with(kHashHead))
      hashes.emplace_back(text.substr(kHashHead.size(), kHashDigits));
  }
  return hashes;
}

}  // namespace chaintrue::gcode
