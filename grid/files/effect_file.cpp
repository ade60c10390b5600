// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/effect_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using model::effects::Declaration;
using model::effects::DeclaredParameter;

/// The usual size is one sigma from null; a place may be anywhere, 0 if allowed.
double assumed_nominal(const DeclaredParameter& p) {
  if (p.role == ParameterRole::size) return std::min(p.null + p.prior_sigma, p.upper);
  const double middle = 0.5 * (p.lower + p.upper);
  const double place = p.lower <= 0.0 && p.upper >= 0.0 ? 0.0 : middle;
  return p.integer ? std::floor(place) : place;
}

void check_parameter(const Cursor& at, DeclaredParameter& p) {
  const bool place = p.role == ParameterRole::place;
  if (place && !at.is_null("null"))
    at.child("null").expect("to be left out for a place, which has no null");
  if (at.is_null("nominal")) p.nominal = assumed_nominal(p);
  if (place) p.null = p.nominal;
  if (p.symbol.empty()) p.symbol = p.name;
  if (p.meaning.empty()) p.meaning = place ? "where it sets in" : "how large it is";
}

RECORD_OF(DeclaredParameter, "a parameter of an effect")
REQUIRED(name,
         "Its name in the formula, which ends in its unit: mm, n, rad, visit, or one "
         "per another as in mm_per_rad; any other end is a plain number.")
SPARSE(symbol, "Its symbol in texts.")
SPARSE(meaning, "What it is.")
OPTIONAL(role, "size: how large the effect is. place: where or when it sets in.",
         in_order<ParameterRole>({"size", "place"}))
FIELD(computed, "null", "The size at which there is no effect; default 0. A place has none.", false,
      number(kAnyNumber), &DeclaredParameter::null, [](const DeclaredParameter& p) {
        return p.role == ParameterRole::place ? std::nullopt : std::optional(p.null);
      })
FIELD(computed, "nominal",
      "The usual value. Default for a size: one sigma from null; for a place: 0, or the "
      "middle of its bounds.",
      false, number(kAnyNumber), &DeclaredParameter::nominal, &DeclaredParameter::nominal)
REQUIRED(prior_sigma, "Prior sigma: for a size about null, for a place about nominal.")
REQUIRED(lower, "The smallest value.")
REQUIRED(upper, "The largest value.")
NAMED(optional, "whole", integer,
      "It takes whole numbers only; for effects on a reading or a visit.")
OPTIONAL(mirror_sign, "-1 if the mirrored machine has the negative value.", {"", -1.0, 1.0})
    .check(check_parameter) END_RECORD;

std::string words_of_sizes(const Declaration& own) {
  if (own.parameters.empty()) return {};
  return fmt::format("{} = {:g}", own.parameters.front().name, own.parameters.front().nominal);
}

void check_words(const Cursor&, Declaration& own) {
  if (own.signature.empty()) own.signature = "what its formula adds";
  if (own.typical.empty()) own.typical = words_of_sizes(own);
  if (own.source.empty()) own.source = "declared in a file";
}

/// The line and column of a byte of the text under this key, which escapes make longer in the file;
/// empty if the key is not written as it is.
std::string place_in_file(const std::string& json, const std::string& key, std::size_t offset) {
  std::size_t at = npos;
  do {
    at = json.rfind(key, at - 1);
    if (at == npos) return {};
  } while (json[json.find_first_not_of(" \t\r\n", at + key.size())] != ':');
  at = json.find('"', at + key.size()) + 1;
  for (; offset > 0; --offset) at += json[at] != '\\' ? 1 : json[at + 1] == 'u' ? 6 : 2;
  return line_and_column_of(json, at);
}

/// At this pointer; of a formula with the column in its text or, given the JSON of the declaration's own
/// file, with line and column of the file.
void add_problems(const std::string& pointer,
                  const std::vector<model::effects::DeclarationProblem>& found, Problems& problems,
                  const std::string& json = {}) {
  for (const auto& [own_place, value, expected, offset] : found) {
    std::string place;
    if (offset) place = place_in_file(json, fmt::format("\"{}\"", own_place.substr(1)), *offset);
    if (place.empty()) place = pointer + own_place;
    if (offset && json.empty()) place += fmt::format(", column {} of the formula", *offset + 1);
    problems.add(std::move(place), value, ProblemKind::bad_declaration, expected);
  }
}

}  // namespace

/// Without the checks of model::effects::problems_of.
FILE_RECORD(effect, Declaration, "a declared effect", kEffectFormat)
REQUIRED(id, "Its name: small letters, digits and _.")
SPARSE(instead_of, "The effect of the catalogue that it replaces; default: none, it is added.")
REQUIRED(acts_on,
         "paper: where marks are written. chain: the length that is paid out. reading: "
         "what is written down, by visits. visit: a single reading.",
         by_name_to(model::effects::ActsOn::visit))
SPARSE(sides,
       "Where it may act, each side tested separately; both: one value for two. "
       "Default: on both equally.",
       list(by_name_to(EffectSide::y)))
REQUIRED(parameters, "Its size, followed by the place where it sets in, if it has one.")
SPARSE(adds_mm, "Formula for the amount added to a chain or a reading.")
SPARSE(adds_x_mm, "Formula for the shift of a mark in x.")
SPARSE(adds_y_mm, "Formula for the shift of a mark in y.")
SPARSE(elongation,
       "Replaces adds_mm: a counted length is the true one divided by 1 + this, after "
       "everything that is added.")
REQUIRED(cause, "The cause, as a diagnosis words it.")
SPARSE(signature, "How it shows on the bed.")
OPTIONAL(remedy_kind, "Where the remedy is applied.",
         by_name_to(model::effects::RemedyKind::compensate_on_its_own))
REQUIRED(remedy, "What to do about it.")
REQUIRED(not_modelled, "What the formula omits.")
SPARSE(typical, "Its usual size, in words.")
SPARSE(source, "Source of the formula.").check(check_words) END_FILE_RECORD;

Value<std::vector<const Effect*>> declared_value() {
  using All = std::vector<const Effect*>;
  return {[](const Cursor& at) -> std::optional<All> {
            if (!at.json().is_array()) return at.expect("a list of declared effects");
            All declared;
            for (const auto i : each_index(at.json())) {
              const Cursor own = at.element(i);
              const auto declaration = effect_record().read(own);
              if (!declaration || !own.clean()) continue;
              add_problems(own.pointer(), problems_of(*declaration), own.problems());
              if (!own.clean()) continue;
              const Effect* effect = &declared_effect(*declaration);
              const bool is_twice = any_of(declared, having(&Effect::id, effect->id));
              if (is_twice)
                own.child("id").expect("a name that no other effect of this machine has");
              if (!is_twice) declared.push_back(effect);
            }
            return declared;
          },
          [](const All& declared) {
            return json_list(declared, [](const Effect* effect) {
              return effect_record().write(*declaration_of(*effect));
            });
          },
          {"a list of declared effects", list_schema(effect_record().expected().schema, 0)}};
}

void check_declared_on_bed(const Cursor& at, const Machine& machine) {
  for (const auto i : each_index(machine.declared))
    add_problems(at.element(i).pointer(),
                 problems_on_bed(*declaration_of(*machine.declared[i]), machine), at.problems());
}

const Effect* declared_in_document(const Cursor& at, std::string_view id) {
  const Json& root = at.root();
  const auto machine = root.is_object() ? root.find("extended_machine") : root.end();
  if (machine == root.end() || !machine->is_object()) return nullptr;
  const auto all = machine->find("declared_effects");
  if (all == machine->end()) return nullptr;
  // The machine's record reports their problems.
  Problems unsaid(at.problems().file());
  const auto declared = declared_value().read(Cursor(*all, unsaid));
  if (!declared) return nullptr;
  const auto* found = find_where(*declared, having(&Effect::id, id));
  return found != nullptr ? *found : nullptr;
}

namespace {

/// Adds the declared effect of a file to the machine.
void declare(const Effect& effect, const std::string& json, Machine& machine, Problems& problems) {
  const auto* known = find_where(machine.declared, having(&Effect::id, effect.id));
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
  add_problems("", problems_on_bed(*declaration_of(effect), machine), problems, json);
  machine.declared.push_back(&effect);
}

}  // namespace

Declaration parse_effect(const std::string& text, const std::string& file) {
  Problems problems(file);
  Declaration declaration = read_document(effect_record(), text, problems);
  add_problems("", problems_of(declaration), problems, text);
  problems.throw_if_any();
  return declaration;
}

std::string write_effect(const Declaration& declaration) {
  return write_document(effect_record(), declaration);
}

void declare_effects(const Words& paths, Machine& machine) {
  std::vector<InputProblem> all;
  for (const std::string& path : paths) {
    try {
      Problems problems(name_in_messages(path));
      const std::string json = read_whole_file(path);
      declare(declared_effect(parse_effect(json, problems.file())), json, machine, problems);
      problems.throw_if_any();
    } catch (const InputError& error) {
      append_all(all, error.problems());
    }
  }
  if (!all.empty()) throw InputError(std::move(all));
}

}  // namespace chaintrue::grid::files
