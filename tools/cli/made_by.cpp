// SPDX-License-Identifier: GPL-3.0-or-later

#include <string_view>

#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

/// These do not change the result, only what is printed or may be replaced.
constexpr std::string_view kWithoutTrace[] = {"--force",   "--json",    "--quiet",
                                              "--threads", "--verbose", "--wish-mm"};

/// \param is_file its words name files
std::string in_words(const GivenOption& option, bool is_file) {
  std::string text = option.name;
  for (const std::string& word : option.words)
    text += " " + (is_file ? name_without_folders(word) : word);
  return text;
}

}  // namespace

Provenance made_by(Verb verb) {
  Provenance made_by{std::string(files::version()), verb.path(), {}, files::sources_read()};
  for (const GivenOption& option : verb.given_options()) {
    const Place* place = place_of(option.name);
    const bool is_output = place != nullptr && !place->kinds.empty();
    if (is_output || contains(kWithoutTrace, option.name)) continue;
    made_by.options.push_back(in_words(option, place != nullptr));
  }
  return made_by;
}

void add_made_by(const std::optional<Provenance>& made_by, std::vector<Section>& sections) {
  if (!made_by) return;
  std::string command = "chaintrue " + made_by->verb;
  for (const std::string& option : made_by->options) command += " " + option;
  Table table{.columns = {{"file"}, {"SHA-256"}}};
  for (const SourceFile& file : made_by->inputs) table.add({file.name, file.sha256});
  Section section{"Where this comes from", {}, true, Detail::page};
  section.say("Made by version {} with \"{}\".", made_by->version, command);
  if (!table.rows.empty()) {
    table.caption = "sha256sum prints the same hash for an unchanged file.";
    section.blocks.push_back(std::move(table));
  }
  sections.push_back(std::move(section));
}

void report_difference(const InputFile& result) {
  const auto made_by = files::made_by_of(result.text, result.name);
  if (!made_by) return;
  for (const std::string& name : files::changed_since(*made_by, files::sources_read())) {
    end_progress();
    say("{} has changed since {} was made from it: make {} again if the measurements have "
        "changed.",
        name, result.name, result.name);
  }
}

}  // namespace chaintrue::cli
