// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/content_hash.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/files/sha256.hpp"

namespace chaintrue::grid::files {
namespace {

/// A number's text depends on its value alone, however it was written.
std::string scalar_text(const Json& value) {
  return value.is_number() ? fmt::format("{}", value.get<double>() + 0.0) : compact_json(value);
}

void add(const Json& value, bool is_root, Sha256& hash) {
  if (!value.is_structured()) {
    hash.add(scalar_text(value));
    return;
  }
  hash.add(value.is_object() ? "{" : "[");
  for (const auto& [key, element] : value.items()) {
    if (value.is_object()) {
      if (key == "comment" || (is_root && key == "content_hash")) continue;
      hash.add(compact_json(key));
      hash.add(":");
    }
    add(element, false, hash);
    hash.add(",");
  }
  hash.add(value.is_object() ? "}" : "]");
}

}  // namespace

std::string content_hash(const Json& document) {
  Sha256 hash;
  add(document, true, hash);
  return hash.text();
}

std::string print_with_hash(Json document) {
  std::string hash = content_hash(document);
  document["content_hash"] = std::move(hash);
  return print_json(document);
}

void check_content(const Cursor& at) {
  const Cursor hash = at.child("content_hash");
  if (hash.json() != content_hash(at.json())) {
    hash.expect(
        "the hash of this file's content: the file was changed or damaged after it was written; "
        "fit the points again",
        ProblemKind::content_hash);
  }
}

}  // namespace chaintrue::grid::files
