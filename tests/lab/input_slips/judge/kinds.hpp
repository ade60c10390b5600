// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The slips put into a file, one at a time, and the response to each.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "generator/hidden/random.hpp"
#include "input_slips/judge/session.hpp"

namespace chaintrue::slips {

/// Required parts of a message that reports it.
struct Expected {
  std::vector<std::string> words;  ///< any one of them will do
  std::string place;               ///< "/points/13"; empty for the file as a whole
  bool refused = false;            ///< no map may be made
};

struct Kind {
  std::string id;
  Way way;
  std::function<Expected(Session& session, generator::Dice& dice)> spoil;
};

/// Those of kinds.tsv.
const std::vector<Kind>& kinds();

struct Outcome {
  bool is_named = false;
  Expected expected;
  Reported reported;
};
[[nodiscard]] Outcome try_kind(const Kind& kind, std::uint64_t seed);

/// For a session without a slip: the false reports.
std::vector<std::string> false_alarms(Way way, std::uint64_t seed);

}  // namespace chaintrue::slips
