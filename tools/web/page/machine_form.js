// SPDX-License-Identifier: GPL-3.0-or-later
// The machine's numbers with a drawing that labels them. Ranges and messages are the command's.
import {h, svg} from "./dom.js";

const at = (machine, path) => path.reduce((value, key) => value?.[key], machine);

function put(machine, path, value) {
  const [key, ...rest] = path;
  return {...machine, [key]: rest.length === 0 ? value : put(machine?.[key] ?? {}, rest, value)};
}

/** A number as it is in the file. */
const plain = (id, label, ...path) => ({
  id, label, pointer: `/${path.join("/")}`, get: (machine) => at(machine, path), set: (machine, value) => put(machine, path, value),
});

/** Motors are given by their distance and height, as measured with a tape. */
const distance = {
  id: "distance", label: "Between the motors, mm", pointer: "/motors",
  get: ({motors}) => round(motors.right.x_mm - motors.left.x_mm),
  set: (machine, value) => {
    const middle = (machine.motors.right.x_mm + machine.motors.left.x_mm) / 2;
    const moved = put(machine, ["motors", "left", "x_mm"], round(middle - value / 2));
    return put(moved, ["motors", "right", "x_mm"], round(middle + value / 2));
  },
};
const rise = {
  id: "rise", label: "Motors above the sheet's upper edge, mm", pointer: "/motors",
  get: ({motors, bed}) => round((motors.left.y_mm + motors.right.y_mm) / 2 - bed.height_mm / 2),
  set: (machine, value) => {
    const by = value - rise.get(machine);
    const left = put(machine, ["motors", "left", "y_mm"], round(machine.motors.left.y_mm + by));
    return put(left, ["motors", "right", "y_mm"], round(machine.motors.right.y_mm + by));
  },
};

function round(value) {
  return Number(value.toFixed(4));
}

const BED = [plain("width", "Sheet, width, mm", "bed", "width_mm"), plain("height", "Sheet, height, mm", "bed", "height_mm")];
const RING = [plain("radius", "Ring: from the bit to a chain's end, mm", "attachment", "radius_mm")];
const BRACKETS = [
  plain("spacing", "Brackets: between the chains' ends, mm", "attachment", "spacing_mm"),
  plain("rise_of_ends", "Brackets: chains' ends above the bit, mm", "attachment", "height_mm"),
  plain("gravity", "Brackets: centre of gravity below the bit, mm", "attachment", "cg_below_bit_mm"),
];
const REST = [
  plain("sled", "Sled with its router, kg", "sled", "mass_kg"),
  plain("tilt", "Frame leans back, degrees", "frame", "tilt_from_vertical_deg"),
  plain("teeth", "Teeth of a sprocket", "sprocket", "teeth"),
  plain("pitch", "Pitch of the chain, mm", "sprocket", "pitch_mm"),
];

function fieldsOf(machine) {
  return [distance, rise, ...BED, ...(machine.attachment?.kind === "brackets" ? BRACKETS : RING), ...REST];
}

const withoutPlace = (sentence) => sentence.replace(/ \(\/[a-z_/]+\)$/, ".");
const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

export class MachineForm {
  element = h("form", {class: "machine-form", onsubmit: (event) => event.preventDefault()});
  #changed;
  #drawn = null;
  #fields = [];

  /** @param changed(machine, name, pointer) is called with the machine with a number replaced, and its place in the file */
  constructor(changed) {
    this.#changed = changed;
  }

  draw(machine) {
    const key = JSON.stringify(machine);
    if (key === this.#drawn) return;
    this.#drawn = key;
    const active = document.activeElement?.id;
    const picture = drawing();
    this.#fields = fieldsOf(machine).map((field) => this.#field(field, machine, picture));
    this.element.replaceChildren(h("div", {class: "fields"}, this.#fields.map(({row}) => row)), picture);
    if (active?.startsWith("machine-")) document.getElementById(active)?.focus();
  }

  /** Shows each problem {pointer, text} at its field; returns those without a field. */
  mark(problems) {
    const left = [...problems];
    for (const {field, input, note} of this.#fields) {
      const index = left.findIndex(({pointer}) => pointer?.startsWith(field.pointer));
      const problem = index < 0 ? null : left.splice(index, 1)[0];
      note.textContent = problem?.text ?? "";
      if (problem) input.setAttribute("aria-invalid", "true");
      else input.removeAttribute("aria-invalid");
    }
    return left;
  }

  /** Shows each assumption, a sentence that ends with its place in the file, at its field; returns those without a field. */
  assume(sentences) {
    const left = [...sentences];
    for (const {field, assumed} of this.#fields) {
      const index = left.findIndex((sentence) => sentence.includes(`(${field.pointer})`));
      const sentence = index < 0 ? "" : left.splice(index, 1)[0];
      assumed.textContent = capital(withoutPlace(sentence));
    }
    return left.map((sentence) => capital(withoutPlace(sentence)));
  }

  #field(field, machine, picture) {
    const id = `machine-${field.id}`;
    const note = h("span", {class: "note", id: `${id}-note`});
    const assumed = h("span", {class: "assumed", id: `${id}-assumed`});
    const light = (on) => picture.querySelector(`.of-${field.id}`)?.classList.toggle("lit", on);
    const input = h("input", {
      id, type: "text", inputmode: "text", autocomplete: "off", "aria-describedby": `${note.id} ${assumed.id}`,
      onfocus: () => light(true), onblur: () => light(false),
      onchange: () => this.#take(field, machine, input.value),
    });
    input.value = field.get(machine) ?? "";
    return {field, input, note, assumed, row: h("p", {}, h("label", {for: id}, field.label), input, note, assumed)};
  }

  #take(field, machine, typed) {
    const text = typed.trim().replace(/^([-+]?\d*),(\d+)$/, "$1.$2");
    const value = Number(text);
    // A text is written to the file unchanged, so that the command reports what it expected.
    const isNumber = text !== "" && Number.isFinite(value);
    const changed = isNumber || field.pointer !== "/motors" ? field.set(machine, isNumber ? value : text)
      : put(machine, ["motors", "left", "x_mm"], text);
    this.#changed(changed, `machine ${field.id}`, field.pointer);
  }
}

function dimension(id, x1, y1, x2, y2, x, y, text) {
  return svg("g", {class: `dimension of-${id}`}, svg("line", {x1, y1, x2, y2}), svg("text", {x, y}, text));
}

/** A sketch, not to scale, that labels the numbers. */
function drawing() {
  return svg("svg", {class: "machine-drawing", viewBox: "0 0 420 300", role: "img",
    "aria-label": "The machine: a sheet, above it two motors, from each a chain to the sled. The number being typed is lit."},
  svg("rect", {class: "board", x: 70, y: 110, width: 280, height: 140}),
  svg("path", {class: "chain", d: "M 40 50 L 196 172 M 380 50 L 224 172"}),
  svg("circle", {class: "motor", cx: 40, cy: 50, r: 11}), svg("circle", {class: "motor", cx: 380, cy: 50, r: 11}),
  svg("circle", {class: "sled", cx: 210, cy: 183, r: 32}), svg("circle", {class: "bit", cx: 210, cy: 183, r: 3}),
  dimension("distance", 40, 22, 380, 22, 210, 16, "between the motors"),
  dimension("rise", 400, 64, 400, 110, 376, 92, "above"),
  dimension("width", 70, 272, 350, 272, 210, 290, "width"),
  dimension("height", 58, 110, 58, 250, 32, 184, "height"),
  dimension("radius", 210, 183, 233, 160, 262, 156, "ring"),
  dimension("spacing", 184, 160, 236, 160, 210, 148, "spacing"),
  dimension("rise_of_ends", 246, 160, 246, 183, 266, 176, "up"),
  dimension("gravity", 210, 183, 210, 206, 226, 214, "down"),
  dimension("sled", 210, 215, 210, 240, 232, 236, "kg"),
  dimension("tilt", 330, 60, 352, 108, 322, 90, "lean"),
  dimension("teeth", 29, 50, 51, 50, 40, 82, "teeth"),
  dimension("pitch", 78, 80, 92, 91, 112, 80, "pitch"));
}
