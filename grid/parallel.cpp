// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/parallel.hpp"

namespace chaintrue::grid {
namespace {

IndexLoop own_loop = nullptr;

}  // namespace

void set_index_loop(IndexLoop loop) { own_loop = loop; }

void for_each_index(std::size_t count, const IndexWork& work) {
  if (own_loop != nullptr && count > 1) return own_loop(count, work);
  for (std::size_t k = 0; k < count; ++k) work(k);
}

}  // namespace chaintrue::grid
