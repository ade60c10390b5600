// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/findings.hpp"
namespace chaintrue::grid::diagnosis {
void put_into_words(const Session&, const Analysis&, Diagnosis& d) { d.sentence = name(d.verdict); }
}  // namespace chaintrue::grid::diagnosis
