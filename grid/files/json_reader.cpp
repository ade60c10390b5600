// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/json_reader.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/file_type.hpp"

namespace chaintrue::grid::files {
namespace {

class OptionalCodec : public Codec {
 public:
  OptionalCodec(std::shared_ptr<const Codec> value, const OptionalAccess& access,
                std::size_t offset)
      : Codec(value->expected()), value_(std::move(value)), access_(access), offset_(offset) {}
  bool read(const Cursor& at, void* member) const override {
    if (at.json().is_null()) return true;
    const bool was_empty = access_.value(member) == nullptr;
    if (was_empty) access_.emplace(member);
    const bool is_read = value_->read(at, const_cast<std::byte*>(place(member)));
    if (was_empty && !is_read) access_.reset(member);
    return is_read;
  }
  Json write(const void* member) const override {
    return access_.value(member) == nullptr ? kLeftOut : value_->write(place(member));
  }

 private:
  const std::byte* place(const void* member) const {
    return static_cast<const std::byte*>(access_.value(member)) + offset_;
  }

  std::shared_ptr<const Codec> value_;
  OptionalAccess access_;
  std::size_t offset_;
};

}  // namespace

class ObjectCodec : public Codec {
 public:
  ObjectCodec(const RecordTable& record, void (*reset)(void*))
      : Codec(record.expected()), record_(record), reset_(reset) {}
  bool read(const Cursor& at, void* value) const override {
    return record_.read_fields(at, value, false, reset_);
  }
  Json write(const void* value) const override { return record_.write_fields(value); }

 private:
  RecordTable record_;
  void (*reset_)(void*);
};

std::shared_ptr<const Codec> object_codec(const RecordTable& record, void (*reset)(void*)) {
  return std::make_shared<ObjectCodec>(record, reset);
}

std::shared_ptr<const Codec> optional_codec(std::shared_ptr<const Codec> value,
                                            const OptionalAccess& access, std::size_t offset) {
  return std::make_shared<OptionalCodec>(std::move(value), access, offset);
}

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
    version.expect(fmt::format("\"{}\", the version that this program reads: {}", format_->version,
                               format_->anew),
                   ProblemKind::format_version);
    return false;
  }
  return true;
}

RecordTable::Field& RecordTable::add(Field field, std::shared_ptr<const Codec> codec) {
  field.expected = codec->expected();
  field.codec = std::move(codec);
  return fields_.emplace_back(std::move(field));
}

namespace {

Json written_default(const Codec& codec, std::size_t offset, const std::shared_ptr<void>& object) {
  return codec.write(static_cast<const std::byte*>(object.get()) + offset);
}

}  // namespace

void RecordTable::state_default(Field& field, Make make) {
  field.expected.schema = [offset = field.offset, codec = field.codec, make] {
    return with_default(codec->expected().schema(), written_default(*codec, offset, make()));
  };
}

void RecordTable::leave_out_default(Field& field, Make make) {
  field.unless = written_default(*field.codec, field.offset, make());
}

Expected RecordTable::expected() const {
  if (format_ == nullptr) {
    return {noun(),
            [table = std::make_shared<const RecordTable>(*this)] { return table->schema(); }};
  }
  return {noun(), [name = name_of(*format_)]() -> Json {
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
    if (!field.is_required || field.otherwise.is_null()) schema = schema_or_null(std::move(schema));
    schema["description"] = field.meaning;
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
    std::string expected = fmt::format("a key of {} ({})", noun_, joined(keys()));
    if (const std::string meant = nearest(key, free); !meant.empty()) {
      probably_meant.push_back(meant);
      expected =
          fmt::format("\"{}\"? This key is unknown; {} has {}", meant, noun_, joined(keys()));
    }
    at.child(key).report(compact_json(value), ProblemKind::unknown_key, expected);
  }
  return probably_meant;
}

bool RecordTable::has_key(const std::string& key) const {
  return any_of(fields_, [&key](const Field& field) { return field.key == key; });
}

std::vector<std::string> RecordTable::keys() const {
  std::vector<std::string> keys;
  for (const Field& field : fields_) keys.push_back(field.key);
  return keys;
}

bool RecordTable::read_fields(const Cursor& at, void* object, bool is_root,
                              void (*reset)(void*)) const {
  if (!open(at, is_root)) return false;
  if (reset != nullptr) reset(object);
  const std::vector<std::string> probably_meant = report_unknown_keys(at);
  for (const Field& field : fields_) {
    const Cursor child = at.child(field.key);
    if (!at.has(field.key) || (!field.is_required && child.json().is_null())) {
      const bool misspelt = contains(probably_meant, field.key);
      if (field.is_required && !misspelt) child.missing(field.expected);
      continue;
    }
    field.codec->read(child, static_cast<std::byte*>(object) + field.offset);
  }
  for (const Check& check : checks_) check(at, object);
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
