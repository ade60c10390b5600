// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/effect_file.hpp"

#include <optional>

#include "grid/containers.hpp"
#include "grid/files/records.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using model::effects::Declaration;
using model::effects::Effect;

/// Adds the declared effect to the machine.
void declare(const Effect& effect, model::Machine& machine, Problems& problems) {
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
  add_problems("", problems_on_bed(*declaration_of(effect), machine), problems);
  machine.declared.push_back(&effect);
}

}  // namespace

Declaration parse_effect(const std::string& text, const std::string& file) {
  Problems problems(file);
  Declaration declaration = read_document(declaration_record(), text, problems);
  add_problems("", problems_of(declaration), problems);
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
      Problems problems(name_in_messages(path));
      declare(declared_effect(read(parse_effect, path)), machine, problems);
      problems.throw_if_any();
    } catch (const InputError& error) {
      append_all(all, error.problems());
    }
  }
  if (!all.empty()) throw InputError(std::move(all));
}

}  // namespace chaintrue::grid::files
