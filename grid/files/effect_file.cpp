// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/effect_file.hpp"

#include <optional>

#include "grid/containers.hpp"
#include "grid/files/records.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using model::effects::Declaration;
using model::effects::DeclarationProblem;
using model::effects::Effect;

/// The end of the text in quotes that begins at `open`, behind its last quote.
std::size_t behind_text(const std::string& json, std::size_t open) {
  std::size_t at = open + 1;
  while (at < json.size() && json[at] != '"') at += json[at] == '\\' ? 2 : 1;
  return at + 1;
}

/// Start of the text of a key of the outermost object, after its quote. Precondition: JSON.
std::optional<std::size_t> text_of_key(const std::string& json, std::string_view key) {
  int depth = 0;
  for (std::size_t at = 0; at < json.size(); ++at) {
    const char c = json[at];
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    if (c != '"') continue;
    const std::size_t end = behind_text(json, at);
    const std::string_view found(json.data() + at + 1, end - at - 2);
    std::size_t next = json.find_first_not_of(" \t\r\n", end);
    if (depth == 1 && found == key && next != std::string::npos && json[next] == ':') {
      next = json.find_first_not_of(" \t\r\n", next + 1);
      if (next != std::string::npos && json[next] == '"') return next + 1;
    }
    at = end - 1;
  }
  return std::nullopt;
}

/// The place in the file of a byte of that text, which escapes make longer there.
std::size_t in_file(const std::string& json, std::size_t begin, std::size_t offset) {
  std::size_t at = begin;
  for (std::size_t k = 0; k < offset && at < json.size() && json[at] != '"'; ++k) {
    if (json[at] != '\\') {
      ++at;
    } else {
      at += at + 1 < json.size() && json[at + 1] == 'u' ? 6 : 2;
    }
  }
  return at;
}

/// With line and column where the problem is in a formula.
void add_problems(const std::string& text, const std::vector<DeclarationProblem>& found,
                  Problems& problems) {
  for (const DeclarationProblem& problem : found) {
    std::string place = problem.place;
    if (problem.offset) {
      if (const auto begin = text_of_key(text, problem.place.substr(1)))
        place = line_and_column_of(text, in_file(text, *begin, *problem.offset));
    }
    problems.add(std::move(place), problem.value, ProblemKind::bad_declaration, problem.expected);
  }
}

struct EffectText {
  std::string text;
  std::string file;
};

/// Adds the declared effects to the machine.
void declare(const EffectText& source, model::Machine& machine, Problems& problems) {
  const Effect& effect = declared_effect(parse_effect(source.text, source.file));
  const auto* known =
      find_where(machine.declared, [&](const Effect* other) { return other->id == effect.id; });
  // Declaring the same effect again has no effect.
  if (known != nullptr && *known == &effect) return;
  if (known != nullptr) {
    problems.add("/id", effect.id, ProblemKind::repeated_value,
                 "a name that no other effect has; two have this name");
    return;
  }
  const std::string& instead_of = declaration_of(effect)->instead_of;
  const bool taken = any_of(machine.declared, [&](const Effect* other) {
    return !instead_of.empty() && declaration_of(*other)->instead_of == instead_of;
  });
  if (taken) {
    problems.add("/instead_of", instead_of, ProblemKind::repeated_value,
                 "an effect of the catalogue that no other effect replaces");
    return;
  }
  add_problems(source.text, problems_on_bed(*declaration_of(effect), machine), problems);
  machine.declared.push_back(&effect);
}

}  // namespace

Declaration parse_effect(const std::string& text, const std::string& file) {
  Problems problems(file);
  Declaration declaration = read_document(declaration_record(), text, problems);
  add_problems(text, problems_of(declaration), problems);
  problems.throw_if_any();
  return declaration;
}

std::string write_effect(const Declaration& declaration) {
  return write_document(declaration_record(), declaration);
}

void declare_effects(const std::vector<std::string>& paths, model::Machine& machine) {
  std::vector<InputProblem> all;
  for (const std::string& path : paths) {
    try {
      const EffectText source{read_whole_file(path), name_in_messages(path)};
      Problems problems(source.file);
      declare(source, machine, problems);
      problems.throw_if_any();
    } catch (const InputError& error) {
      append_all(all, error.problems());
    }
  }
  if (!all.empty()) throw InputError(std::move(all));
}

}  // namespace chaintrue::grid::files
