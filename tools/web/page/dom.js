// SPDX-License-Identifier: GPL-3.0-or-later
// Elements in one expression.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, properties, children) {
  for (const [name, value] of Object.entries(properties ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else element.setAttribute(name, value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

export const h = (tag, properties, ...children) => fill(document.createElement(tag), properties, children);
export const svg = (tag, properties, ...children) => fill(document.createElementNS(SVG, tag), properties, children);

export const textOf = (bytes) => new TextDecoder().decode(bytes);
export const bytesOf = (text) => new TextEncoder().encode(text);

/** The bytes of a chosen or dropped file; null if it cannot be read, such as a folder. */
export async function contentOf(file) {
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch {
    return null;
  }
}

export const unreadable = (file) => `${file.name} cannot be read. Open a file, not a folder, that is still there.`;

/** Offers a file as a download. */
export function download(name, bytes) {
  const url = URL.createObjectURL(new Blob([bytes], {type: "application/octet-stream"}));
  const link = h("a", {href: url, download: name});
  document.body.append(link);
  link.click();
  link.remove();
  // The browser reads the bytes after the click has returned.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** A button that opens the browser's file dialog. `id` is that of the input. */
export function fileButton(id, label, accept, take) {
  const input = h("input", {type: "file", id, accept, multiple: true, class: "unseen", onchange: async () => {
    const files = [...input.files];
    input.value = "";
    if (files.length > 0) await take(files);
  }});
  return h("span", {class: "file"}, input, h("label", {for: id}, label));
}

/** Text that `draw` fills when it is first opened. `forget` empties it, and fills it anew if it is open. */
export function folded(summary, draw) {
  const box = h("div");
  let isDrawn = false;
  function fill() {
    if (!element.open || isDrawn) return;
    isDrawn = true;
    draw(box);
  }
  const element = h("details", {class: "folded", ontoggle: fill}, h("summary", {}, summary), box);
  return {
    element,
    forget() {
      isDrawn = false;
      box.replaceChildren();
      fill();
    },
  };
}
