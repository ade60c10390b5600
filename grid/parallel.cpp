// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/parallel.hpp"

#include "grid/containers.hpp"

namespace chaintrue::grid {
namespace {

IndexLoop own_loop = nullptr;

}  // namespace

void set_index_loop(IndexLoop loop) { own_loop = loop; }

void for_each_index(std::size_t count, const IndexWork& work) {
  if (own_loop != nullptr && count > 1) return own_loop(count, work);
  for (const std::size_t k : each_below(count)) work(k);
}

}  // namespace chaintrue::grid
