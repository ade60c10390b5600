// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/assumed_order.hpp"

namespace chaintrue::cli {
namespace {

struct OrderWord {
  const char* word;
  grid::VisitingOrder order;
};
constexpr OrderWord kOrderWords[] = {{"rows", {.rows = true, .serpentine = false}},
                                     {"columns", {.rows = false, .serpentine = false}},
                                     {"serpentine_rows", {.rows = true, .serpentine = true}},
                                     {"serpentine_columns", {.rows = false, .serpentine = true}}};

}  // namespace

std::optional<grid::VisitingOrder> order_from_word(const std::string& word) {
  for (const OrderWord& known : kOrderWords) {
    if (known.word == word) return known.order;
  }
  return std::nullopt;
}

}  // namespace chaintrue::cli
