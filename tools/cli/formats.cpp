// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue formats: the reference page and the JSON Schema of each file format.
#include <fmt/format.h>

#include <memory>
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
  fmt::print("{}",
             command.schema ? files::write_format_schema(command.name)
                            : files::write_format_page(command.name));
  if (!command.schema) say_next({"formats", command.name, "--schema"});
  return kDone;
}

}  // namespace

void add_formats(Verb app) {
  auto command = std::make_shared<FormatsCommand>();
  Verb verb = app.add_verb(
      "formats",
      "Print every key of a file format with its unit, range and default, or its JSON Schema");
  verb.add_option("name", command->name, "The format; without it all formats are listed")
      .one_of(files::described_formats());
  verb.add_flag("--schema", command->schema, "Print the JSON Schema");
  add_output_folder(
      verb, "--all", command->all, "Write pages and schemas of all formats into this folder");
  verb.footer(
      "Example:\n"
      "  build/chaintrue formats machine\n"
      "  build/chaintrue formats grid --schema");
  verb.runs(command, run_formats);
}

}  // namespace chaintrue::cli
