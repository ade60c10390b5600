// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/file_type.hpp"
#include "grid/files/meanings.hpp"

namespace chaintrue::grid::files {
namespace {

/// The schema with null allowed as well: for a key that may be absent.
Json or_null(Json schema) {
  if (schema.contains("enum")) {
    schema["enum"].push_back(nullptr);
  } else if (schema.contains("type") && schema["type"].is_string()) {
    schema["type"] = {schema["type"], "null"};
  } else if (!schema.empty()) {
    schema = {{"anyOf", {schema, {{"type", "null"}}}}};
  }
  return schema;
}

}  // namespace

bool RecordTable::open(const Cursor& at, bool is_root) const {
  if (!at.json().is_object()) {
    at.expect(fmt::format("an object: {}", noun_));
    return false;
  }
  if (format_ == nullptr) return true;
  const Cursor type = at.child("file_type");
  if (!at.has("file_type")) {
    if (is_root) type.missing(fmt::format("\"{}\"", format_->file_type));
  } else if (type.json() != format_->file_type) {
    const std::string found = type.json().is_string() ? type.json().get<std::string>() : "";
    type.expect(fmt::format("\"{}\"{}", format_->file_type, what_takes(found)),
                ProblemKind::file_kind);
    return false;
  }
  const Cursor version = at.child("format_version");
  if (!at.has("format_version")) {
    if (is_root) version.missing(fmt::format("\"{}\"", format_->version));
  } else if (version.json() != format_->version) {
    version.expect(
        fmt::format("\"{}\", the version that this program reads: use the chaintrue that wrote the file",
                    format_->version),
        ProblemKind::format_version);
    return false;
  }
  return true;
}

void RecordTable::add_member(const std::string& key,
                             bool is_required,
                             Locate locate,
                             std::shared_ptr<const MemberValue> value) {
  Expected expected = value->expected();
  add({key,
       is_required,
       std::move(expected),
       [locate, value](const Cursor& at, void* object) { value->read(at, locate(object)); },
       [locate, value](const void* object) {
         // `locate` only finds the member; nothing is changed through it.
         return value->write(locate(const_cast<void*>(object)));
       }});
}

void RecordTable::add_defaulted(const std::string& key,
                                Locate locate,
                                std::shared_ptr<const MemberValue> value,
                                Make make) {
  add_member(key, false, locate, value);
  fields_.back().expected.schema = [locate, value, make] {
    const std::shared_ptr<void> object = make();
    return with_default(value->expected().schema(),
                        value->write(locate(object.get())).value_or(Json()));
  };
}

void RecordTable::add_constant(const std::string& key, const std::string& word) {
  const Value<std::string> value = one_of({word});
  add({key,
       true,
       value.expected,
       [read = value.read](const Cursor& at, void*) { (void)read(at); },
       [word](const void*) { return std::optional<Json>(word); }});
}

Expected RecordTable::expected() const {
  return {noun(), [this]() -> Json {
            if (format_ == nullptr) return schema();
            const std::string name = name_of(*format_);
            return {{"$ref", fmt::format("{0}.schema.json#/definitions/{0}", name)}};
          }};
}

Json RecordTable::schema() const {
  Json schema = schema_of_keys();
  for (const Json& rule : rules_) schema.update(rule);
  return schema;
}

Json RecordTable::schema_of_keys() const {
  Json properties = Json::object();
  Json required = Json::array();
  if (format_ != nullptr) {
    properties["file_type"] = {{"const", std::string(format_->file_type)}};
    properties["format_version"] = {{"const", std::string(format_->version)}};
  }
  properties["comment"] = {{"description", "Anything; not read."}};
  for (const Field& field : fields_) {
    Json schema = field.expected.schema();
    if (!field.is_required) schema = or_null(std::move(schema));
    if (const std::string meaning = meaning_of(noun_, field.key); !meaning.empty())
      schema["description"] = meaning;
    properties[field.key] = std::move(schema);
    if (field.is_required) required.push_back(field.key);
  }
  Json schema = {{"type", "object"}, {"title", noun_}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
  return schema;
}

std::vector<std::string> RecordTable::report_unknown_keys(const Cursor& at) const {
  std::vector<std::string> probably_meant;
  for (const auto& [key, value] : at.json().items()) {
    const bool head = format_ != nullptr && (key == "file_type" || key == "format_version");
    if (head || key == "comment" || has_key(key)) continue;
    std::vector<std::string> free;
    for (const Field& field : fields_) {
      if (!at.has(field.key)) free.push_back(field.key);
    }
    std::string expected = fmt::format("a key that {} has ({})", noun_, joined(keys()));
    if (const std::string meant = nearest(key, free); !meant.empty()) {
      probably_meant.push_back(meant);
      expected = fmt::format("\"{}\"? This key is unknown; {} has {}", meant, noun_, joined(keys()));
    }
    at.problems().add(at.pointer() + "/" + pointer_token(key),
                      compact_json(value),
                      expected,
                      ProblemKind::unknown_key);
  }
  return probably_meant;
}

bool RecordTable::has_key(const std::string& key) const {
  return std::any_of(
      fields_.begin(), fields_.end(), [&key](const Field& field) { return field.key == key; });
}

std::vector<std::string> RecordTable::keys() const {
  std::vector<std::string> keys;
  for (const Field& field : fields_) keys.push_back(field.key);
  return keys;
}

bool RecordTable::read_fields(const Cursor& at, void* object, bool is_root) const {
  if (!open(at, is_root)) return false;
  const std::vector<std::string> probably_meant = report_unknown_keys(at);
  for (const Field& field : fields_) {
    const Cursor child = at.child(field.key);
    if (!at.has(field.key) || (!field.is_required && child.json().is_null())) {
      const bool misspelt = std::find(probably_meant.begin(), probably_meant.end(), field.key) !=
                            probably_meant.end();
      if (field.is_required && !misspelt) child.missing(field.expected);
      continue;
    }
    field.read(child, object);
  }
  for (const Check& check : checks_) check(at, object);
  return true;
}

Json RecordTable::write_fields(const void* object) const {
  Json json = format_ != nullptr ? headed(*format_) : Json::object();
  for (const Field& field : fields_) {
    if (auto value = field.write(object)) json[field.key] = std::move(*value);
  }
  return json;
}

}  // namespace chaintrue::grid::files
