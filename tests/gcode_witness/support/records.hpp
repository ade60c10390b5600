// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bundles of programs and answers: `=== NAME BYTES`, a line feed, that many bytes, a line feed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::witness {

struct Record {
  std::string name;
  std::string text;
};

std::string write_records(const std::vector<Record>& records);
/// \throws std::runtime_error if the text is not a bundle.
std::vector<Record> read_records(std::string_view text);

}  // namespace chaintrue::witness
