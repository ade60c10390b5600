// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue formats: the reference page and the JSON Schema of each file format.
#include <fmt/format.h>

#include <string>

#include "grid/files/format_pages.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct FormatsCommand {
  std::string name;
  bool schema = false;
  std::string all;
};

int write_all(Verb verb, const std::string& folder) {
  std::vector<FolderFile> contents;
  for (const std::string& name : files::described_formats()) {
    contents.push_back({name + ".md", files::write_format_page(name), Origin::description});
    contents.push_back(
        {name + ".schema.json", files::write_format_schema(name), Origin::description});
  }
  write_folder(verb, folder, contents);
  return kDone;
}

int run_formats(Verb verb, const FormatsCommand& command) {
  if (verb.is_given("--all")) return write_all(verb, command.all);
  if (command.name.empty()) {
    for (const std::string& name : files::described_formats()) fmt::print("{}\n", name);
    say_next({"formats", files::described_formats().front()});
    return kDone;
  }
  fmt::print("{}", command.schema ? files::write_format_schema(command.name)
                                  : files::write_format_page(command.name));
  if (!command.schema) say_next({"formats", command.name, "--schema"});
  return kDone;
}

}  // namespace

void add_formats(Verb app) {
  auto [verb, c] = app.add_verb<FormatsCommand>(
      "formats",
      "Print every key of a file format with its unit, range and default, or its JSON Schema",
      R"(Example:
  build/chaintrue formats machine
  build/chaintrue formats grid --schema)",
      run_formats);
  verb.has(
      {{"name",
        {c.name, files::described_formats()},
        "The format; without it all formats are listed"},
       {"--schema", c.schema, "Print the JSON Schema"},
       {"--all", writes_into(c.all), "Write pages and schemas of all formats into this folder"}});
}

}  // namespace chaintrue::cli
