// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_reader.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/file_type.hpp"

namespace chaintrue::grid::files {
SharedCodec object_codec(const RecordTable& record, void (*reset)(void*)) {
  const auto table = std::make_shared<const RecordTable>(record);
  return shared_codec(
      {record.expected(),
       [=](const Cursor& at, void* object) { return table->read_fields(at, object, false, reset); },
       [=](const void* object) { return table->write_fields(object); }});
}

SharedCodec optional_codec(const SharedCodec& value, const OptionalAccess& access,
                           std::size_t offset) {
  const auto place = [=](const void* member) {
    return static_cast<const std::byte*>(access.value(member)) + offset;
  };
  return shared_codec(
      {value->expected,
       [=](const Cursor& at, void* member) {
         if (at.json().is_null()) return true;
         const bool was_empty = access.value(member) == nullptr;
         if (was_empty) access.emplace(member);
         const bool is_read = value->read(at, const_cast<std::byte*>(place(member)));
         if (was_empty && !is_read) access.reset(member);
         return is_read;
       },
       [=](const void* member) {
         return access.value(member) == nullptr ? kLeftOut : value->write(place(member));
       }});
}

bool RecordTable::open(const Cursor& at, bool is_root) const {
  if (!at.json().is_object()) {
    at.expect(fmt::format("an object: {}", noun_));
    return false;
  }
  if (format_ == nullptr) return true;
  const auto is_head = [&](const char* key, std::string_view value, std::string_view otherwise,
                           ProblemKind kind) {
    const Cursor own = at.child(key);
    if (own.json() == value) return true;
    const std::string expected = fmt::format("\"{}\"", value);
    if (!at.has(key) && is_root) own.missing(expected);
    if (at.has(key)) own.expect(fmt::format("{}{}", expected, otherwise), kind);
    return !at.has(key);
  };
  const Json& type = at.child("file_type").json();
  return is_head("file_type", format_->file_type,
                 what_takes(type.is_string() ? type.get<std::string>() : ""),
                 ProblemKind::file_kind) &&
         is_head("format_version", format_->version,
                 fmt::format(", the version that this program reads: {}", format_->anew),
                 ProblemKind::format_version);
}

RecordTable::Field& RecordTable::add(Field field, const SharedCodec& codec) {
  field.schema = codec->expected.schema;
  field.codec = codec;
  return fields_.emplace_back(std::move(field));
}

Json RecordTable::written_default(const Field& field) const {
  return field.codec->write(static_cast<const std::byte*>(blank_) + field.offset);
}

void RecordTable::state_default(Field& field) const {
  const Json value = written_default(field);
  const bool says_something = field.schema.contains("enum") || value.is_number() ||
                              value.is_boolean() || (value.is_array() && !value.empty());
  if (says_something) field.schema["default"] = value;
}

Expected RecordTable::expected() const {
  if (format_ == nullptr) return {noun_, schema()};
  return {noun_, {{"$ref", fmt::format("{0}.schema.json#/definitions/{0}", name_of(*format_))}}};
}

Json RecordTable::schema() const {
  Json properties = Json::object();
  Json required = Json::array();
  if (format_ != nullptr) {
    properties["file_type"] = {{"const", std::string(format_->file_type)}};
    properties["format_version"] = {{"const", std::string(format_->version)}};
  }
  properties["comment"] = {{"description", "Anything; not read."}};
  for (const Field& field : fields_) {
    Json schema = field.schema;
    if (!field.is_required || field.otherwise.is_null()) schema = schema_or_null(std::move(schema));
    schema["description"] = field.meaning;
    properties[field.key] = std::move(schema);
    if (field.is_required) required.push_back(field.key);
  }
  Json schema = {{"type", "object"}, {"title", noun_}, {"properties", std::move(properties)}};
  if (!required.empty()) schema["required"] = std::move(required);
  schema["additionalProperties"] = false;
  for (const Json& rule : rules_) schema.update(rule);
  return schema;
}

Words RecordTable::report_unknown_keys(const Cursor& at) const {
  Words probably_meant;
  const Words known = keys();
  for (const auto& [key, value] : at.json().items()) {
    const bool head = format_ != nullptr && (key == "file_type" || key == "format_version");
    if (head || key == "comment" || contains(known, key)) continue;
    Words free = known;
    std::erase_if(free, [&](const std::string& own) { return at.has(own); });
    std::string expected = fmt::format("a key of {} ({})", noun_, joined(known));
    if (const std::string meant = nearest(key, free); !meant.empty()) {
      probably_meant.push_back(meant);
      expected = fmt::format("\"{}\"? This key is unknown; {} has {}", meant, noun_, joined(known));
    }
    at.child(key).report(compact_json(value), ProblemKind::unknown_key, expected);
  }
  return probably_meant;
}

Words RecordTable::keys() const { return mapped(fields_, &Field::key); }

bool RecordTable::read_fields(const Cursor& at, void* object, bool is_root,
                              void (*reset)(void*)) const {
  if (!open(at, is_root)) return false;
  if (reset != nullptr) reset(object);
  const Words probably_meant = report_unknown_keys(at);
  for (const Field& field : fields_) {
    const Cursor child = at.child(field.key);
    if (!at.has(field.key) || (!field.is_required && child.json().is_null())) {
      const bool misspelt = contains(probably_meant, field.key);
      if (field.is_required && !misspelt) child.missing(field.codec->expected.words);
      continue;
    }
    field.codec->read(child, static_cast<std::byte*>(object) + field.offset);
  }
  for (const auto& check : checks_) check(at, object);
  return true;
}

Json RecordTable::write_fields(const void* object) const {
  Json json = format_ != nullptr ? headed(*format_) : Json::object();
  for (const Field& field : fields_) {
    Json value = field.codec->write(static_cast<const std::byte*>(object) + field.offset);
    if (value.is_discarded() || value == field.unless) value = field.otherwise;
    if (!value.is_discarded()) json[field.key] = std::move(value);
  }
  return json;
}

}  // namespace chaintrue::grid::files
