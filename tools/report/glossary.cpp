// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/report/glossary.hpp"

#include <utility>

namespace chaintrue::report {

Section glossary() {
  Table table{.columns = {{"Word"}, {"What it means here"}}};
  for (const Term& term : kTerms) table.add({term.word, term.meaning});
  return {.title = "Words", .blocks = {std::move(table)}, .is_folded = true};
}

}  // namespace chaintrue::report
