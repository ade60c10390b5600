// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/format_pages.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <set>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/files/blanks.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/pattern.hpp"
#include "grid/files/records.hpp"
#include "model/machine_ranges.hpp"

namespace chaintrue::grid::files {
namespace {

struct Described {
  const Format* format;
  Json (*schema)();
  std::string_view title;
  std::string_view about;  ///< Markdown
};

constexpr std::array kDescribed = {
    Described{
        &kMachineFormat, machine_schema, "A machine",
        "A machine. `chaintrue start` and `chaintrue import` write one from the controller's "
        "settings; `chaintrue start` without a file writes one to fill in. Ranges include every "
        "real hanging router. The motors must hang above the bed, the left one on the left."},
    Described{
        &kGridFormat, grid_schema, "A grid of measured points",
        "Readings at marks: chain lengths, or positions of a commanded tool. `chaintrue plan` "
        "writes one to fill in, `simulate` and `import optical` write complete ones; `fit`, "
        "`diagnose` and `check` read them.\n\nAs CSV the first line names the columns, in any "
        "order: `x_mm`, `y_mm`, and `left_mm`, `right_mm` or `commanded_x_mm`, `commanded_y_mm`, "
        "and optionally `order`; the rest comes from options. Cells are separated by commas, "
        "semicolons or tabs; with semicolons numbers may have decimal commas. A cell may carry its "
        "unit (`12.5 cm`, `43 13/16 in`; a fraction is of an inch), a column may be in inches "
        "(`x_in`), and unknown columns, notes below the last row and lines that begin with # are "
        "ignored. A row without readings counts as not measured."},
    Described{&kHolesFormat, holes_schema, "Holes and distances",
              "Holes that the machine drilled, and taped distances between them. `chaintrue plan "
              "--holes` writes one to fill in; `fit`, `diagnose` and `check` read them.\n\nAs CSV "
              "it is two tables, one below the other: `hole`, `x_mm`, `y_mm`, and `from`, `to`, "
              "`distance_mm`, and optionally `sigma_mm`; the rest comes from options."},
    Described{&kMapFormat, map_schema, "A compensation map",
              "The chain lengths for every place of the bed, with the map's error. `chaintrue "
              "fit` writes it; `query`, `gcode`, `report`, `check`, `export` and `square` read "
              "it. Do not edit it: a hash detects changes."},
    Described{&kDiagnosisFormat, diagnosis_schema, "A diagnosis",
              "The causes of a machine's error, and their probabilities. `chaintrue diagnose` "
              "writes it; `report`, `export` and `plan --after` read it. "
              "[diagnosis](../diagnosis.md) explains it."},
    Described{&kSweepFormat, sweep_schema, "A sweep",
              "What `chaintrue sweep` simulates: all combinations of the lists' entries. See "
              "[sweeps](../sweeps.md)."},
    Described{&kBeltsFormat, belts_schema, "Belt lengths of a router on four belts",
              "The four belt lengths at places whose positions are unknown. `chaintrue import "
              "maslow4` writes one from the machine's log; `fit` estimates the anchors from it."},
    Described{&kAnchorsFormat, anchors_schema, "Anchors of a router on four belts",
              "The points where the belts leave the frame, their uncertainty and the readings "
              "behind them. `chaintrue fit` writes one from belt lengths; `export maslow4` prints "
              "the lines to paste. Do not edit it: a hash detects changes."},
    Described{&kEffectFormat, effect_schema, "A declared effect",
              "A cause of error that is not in the catalogue: what it acts on, its size, its "
              "place, and a formula. `--effects` gives it to `diagnose`, `fit`, `simulate` and "
              "`effects`; [effects](../effects.md) explains formulas and has three examples."},
    Described{&kPlotterFormat, plotter_schema, "A V-plotter",
              "A plotter whose pen hangs on two cords, with the controller's settings and the "
              "results of a test drawing. `chaintrue import plotter` writes one from the "
              "controller's settings, `fit` adds the results; `start` and `export plotter` read "
              "it. See [plotters](../plotters.md). Places are measured from the middle between the "
              "two pins, x to the right, y up."},
    Described{&kDrawingFormat, drawing_schema, "A test drawing",
              "A page drawn by a V-plotter, and its measures. `chaintrue start` writes one to "
              "fill in; `fit` reads it."},
};

const Described& described(std::string_view name) {
  const auto* found =
      find_where(kDescribed, [&](const Described& d) { return name_of(*d.format) == name; });
  if (found == nullptr)
    throw std::invalid_argument(fmt::format("no file format is described as \"{}\"", name));
  return *found;
}

/// The object that has the first key of `place` ("/bed/width_mm"), in this schema or in an
/// alternative.
Json* property_at(Json& schema, std::string_view place) {
  const std::string_view rest = place.substr(1);
  const std::size_t slash = rest.find('/');
  const std::string key(rest.substr(0, slash));
  if (schema.contains("oneOf")) {
    for (Json& alternative : schema["oneOf"]) {
      if (Json* found = property_at(alternative, place)) return found;
    }
  }
  if (!schema.contains("properties") || !schema["properties"].contains(key)) return nullptr;
  Json& property = schema["properties"][key];
  return slash == npos ? &property : property_at(property, rest.substr(slash));
}

/// Adds the model's ranges; the reader's own ranges only exclude meaningless numbers.
void put_machine_ranges(Json& schema) {
  for (const model::MachineRange& range : model::machine_ranges()) {
    Json* property = property_at(schema, range.place);
    if (property == nullptr)
      throw std::logic_error(fmt::format("a machine file has no key {}", range.place));
    (*property)["minimum"] = range.least;
    (*property)["maximum"] = range.most;
  }
}

Json schema_with_units(const Described& d) {
  Json schema = d.schema();
  if (d.format == &kMachineFormat) put_machine_ranges(schema);
  return schema;
}

/// Appends units to descriptions: editors show descriptions but have no field for units.
void tell_units(Json& schema) {
  if (schema.is_array()) {
    for (Json& element : schema) tell_units(element);
  } else if (schema.is_object()) {
    if (schema.contains("unit") && schema["unit"].is_string()) {
      const std::string description = fmt::format("In {}.", schema["unit"].get<std::string>());
      schema["description"] =
          schema.contains("description")
              ? fmt::format("{} {}", schema["description"].get<std::string>(), description)
              : description;
      schema.erase("unit");
    }
    for (auto& [key, value] : schema.items()) tell_units(value);
  }
}

std::string number_text(const Json& number) { return fmt::format("{}", number.get<double>()); }

/// The name of an object in the page, from its noun in messages.
std::string noun_of(const Json& schema) {
  auto noun = schema["title"].get<std::string>();
  if (noun.ends_with(',')) noun.pop_back();
  return noun;
}

/// The link to an object's own table of keys, derived from its noun.
std::string anchor_of(const std::string& noun) {
  return replaced(replaced(in_small_letters(noun), " ", "-"), "[^-a-z0-9]", "");
}

bool allows_null(const Json& schema) {
  const auto holds = [&](const char* key, const Json& one) {
    return contains(schema.value(key, Json::array()), one);
  };
  return holds("type", nullptr) || holds("enum", nullptr) || holds("anyOf", {{"type", "null"}});
}

std::string type_of(const Json& schema) {
  const Json type = schema.value("type", Json(""));
  return (type.is_array() ? type.front() : type).get<std::string>();
}

std::string range_words(const Json& schema) {
  std::string words;
  if (schema.contains("minimum") && schema.contains("maximum")) {
    words =
        fmt::format(", {} to {}", number_text(schema["minimum"]), number_text(schema["maximum"]));
  } else if (schema.contains("minimum")) {
    words = fmt::format(", at least {}", number_text(schema["minimum"]));
  }
  if (schema.contains("unit")) words += " " + schema["unit"].get<std::string>();
  return words;
}

std::string one_of_words(const Json& names) {
  Words words;
  for (const Json& name : names) {
    if (!name.is_null())
      words.push_back(
          fmt::format("`{}`", name.is_string() ? name.get<std::string>() : compact_json(name)));
  }
  return joined(words);
}

/// The allowed values, with a link to the table of their own keys.
std::string values_of(const Json& schema) {
  if (schema.contains("$ref")) {
    const auto reference = schema["$ref"].get<std::string>();
    const std::string name = reference.substr(0, reference.find('.'));
    return fmt::format("[{0}]({0}.md)", name);
  }
  if (schema.contains("enum")) return one_of_words(schema["enum"]);
  if (schema.contains("const")) return one_of_words(Json::array({schema["const"]}));
  if (schema.contains("oneOf") && !schema.contains("properties"))
    return fmt::format("{}", fmt::join(mapped(schema["oneOf"], values_of), " or "));
  if (schema.contains("anyOf") && !schema.contains("properties"))
    return values_of(schema["anyOf"][0]);
  const std::string type = type_of(schema);
  if (type == "array") {
    std::string words = "list: " + values_of(schema["items"]);
    if (schema.contains("maxItems") && schema["minItems"] == schema["maxItems"])
      return fmt::format("{} of: {}", schema["minItems"].get<int>(), values_of(schema["items"]));
    if (schema.contains("minItems"))
      words += fmt::format("; {} at least", schema["minItems"].get<int>());
    return words;
  }
  if (schema.contains("title")) {
    const std::string noun = noun_of(schema);
    return fmt::format("[{}](#{})", noun, anchor_of(noun));
  }
  if (type == "object") return "object: " + values_of(schema["additionalProperties"]);
  if (type == "integer") return "whole number" + range_words(schema);
  if (type == "string") return schema.contains("minimum") ? "text or number" : "text";
  if (type == "boolean") return "`true` or `false`";
  return type + range_words(schema);
}

std::string absent_words(const Json& object, const std::string& key, const Json& schema) {
  if (key == "file_type" || key == "format_version") return "required at the start of a file";
  const Json names = object.value("required", Json::array());
  if (contains(names, Json(key))) return allows_null(schema) ? "required; may be null" : "required";
  if (schema.contains("default")) return fmt::format("`{}`", compact_json(schema["default"]));
  return "optional";
}

/// Tables of an object and of the objects in it, each noun once.
struct Tables {
  std::string& text;
  std::set<std::string> described = {};

  void add(const Json& schema) {
    if (schema.is_array()) {
      for (const Json& element : schema) add(element);
      return;
    }
    if (!schema.is_object()) return;
    for (const char* key : {"oneOf", "anyOf", "items", "additionalProperties"}) {
      if (schema.contains(key) && !schema.contains("properties")) add(schema[key]);
    }
    if (!schema.contains("properties")) return;
    if (!schema.contains("title")) return add(schema["additionalProperties"]);
    const std::string noun = noun_of(schema);
    if (!described.insert(noun).second) return;
    table(noun, schema);
    for (const auto& [key, property] : schema["properties"].items()) add(property);
  }

  void table(const std::string& noun, const Json& schema) {
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "\n## {}\n\n| key | what it is | values | if absent |\n|---|---|---|---|\n",
                   noun);
    for (const auto& [key, property] : schema["properties"].items()) {
      if (key == "comment") continue;
      fmt::format_to(out, "| `{}` | {} | {} | {} |\n", key,
                     property.value("description", std::string("Optional inside another file.")),
                     values_of(property), absent_words(schema, key, property));
    }
  }
};

}  // namespace

Words described_formats() {
  return mapped(kDescribed, [](const Described& d) { return name_of(*d.format); });
}

std::string write_format_schema(std::string_view name) {
  const Described& d = described(name);
  Json part = schema_with_units(d);
  tell_units(part);
  Json schema;
  schema["$schema"] = "http://json-schema.org/draft-07/schema#";
  schema["title"] = fmt::format("{} {}", d.format->file_type, d.format->version);
  schema["description"] = std::string(d.title) + ", as chaintrue reads it.";
  schema["definitions"][std::string(name)] = std::move(part);
  schema["allOf"] = {{{"$ref", fmt::format("#/definitions/{}", name)}},
                     {{"required", {"file_type", "format_version"}}}};
  return print_json(schema);
}

std::string write_format_page(std::string_view name) {
  const Described& d = described(name);
  std::string text = fmt::format(
      "# {0}\n\n{1}\n\nA JSON file of type `{2}`, version {3}. Unknown keys are errors, except "
      "`comment`, which may contain anything; an optional key may also be null. `chaintrue formats "
      "{4} --schema` prints the JSON Schema, with which editors complete and check such files. "
      "`chaintrue formats {4}` writes this page from the reader's tables.\n",
      d.title, d.about, d.format->file_type, d.format->version, name);
  Tables{text}.add(schema_with_units(d));
  return text;
}

}  // namespace chaintrue::grid::files
