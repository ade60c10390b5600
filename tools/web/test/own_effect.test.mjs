// SPDX-License-Identifier: GPL-3.0-or-later
// A cause of the owner's own: drawn while it is typed, refused with a sentence, weighed with the others.
import assert from "node:assert/strict";
import {describe, test} from "node:test";
import {nextLawFile, OWN_EFFECT, ownEffects} from "../page/folder.js";
import {effectOf} from "../page/own_effect_file.js";
import {browsers, Visit} from "./browser.mjs";

test("a form becomes an effect file", () => {
  const form = {name: "Rubs on the Frame!", where: "x", formula: "size_mm * ramp(place_mm - L0) / turn", size: "0,3", place: "900"};
  const effect = effectOf(form);
  assert.equal(effect.id, "rubs_on_the_frame");
  assert.equal(effect.adds_mm, "side * cos(phi) * (size_mm * ramp(place_mm - L0) / turn)");
  assert.deepEqual(effect.sides, ["both"]);
  assert.deepEqual(effect.parameters.map(({name, nominal}) => [name, nominal]), [["size_mm", 0.3], ["place_mm", 900]]);
  assert.equal(effectOf({...form, where: "either", formula: "size_mm * x / turn"}).parameters.length, 1);
});

test("a law that is kept replaces neither a cause that was typed nor another law", () => {
  const folder = {[OWN_EFFECT]: new Uint8Array(1)};
  for (let k = 0; k < 3; k += 1) folder[nextLawFile(folder)] = new Uint8Array(1);
  assert.deepEqual(ownEffects(folder), ["law_effect.json", "law_effect_2.json", "law_effect_3.json", OWN_EFFECT]);
  assert.deepEqual(ownEffects({...folder, "law_effect.json": null, "grid.json": new Uint8Array(1)}), ["law_effect_2.json", "law_effect_3.json", OWN_EFFECT]);
});

for (const browser of browsers) {
  describe(`a cause of one's own in ${browser}`, () => {
    test("from a formula to an answer", async () => {
      const visit = await Visit.to(browser);
      const formula = async (text) => {
        const input = await visit.page.$("#own-formula");
        await input.evaluate((element) => element.select());
        await input.type(text);
      };
      try {
        await visit.click("A worn chain");
        await visit.text("#step-result .cause", "links");
        await visit.unfold("A cause of your own");
        const frame = await (await visit.page.waitForSelector('iframe[title="What it does to a square"]')).contentFrame();
        await frame.waitForSelector("svg");
        await formula("size_mm * sin(phy)");
        await visit.text("#step-result .problem", "phy");
        await formula("size_mm * sin(2 * pi * L0 / (111 * mm) + phase_rad)");
        await visit.page.waitForFunction(() => document.querySelectorAll("#step-result .own-picture iframe").length === 1 &&
          !document.querySelector("#step-result .problem"));
        await visit.click("Weigh it with the others");
        await visit.text("#step-result", "Weighed: a sprocket that is not round.");
        await visit.text("#step-result", "Your own cause");
        assert.match(await visit.text("#step-result .sentences", "A sprocket"), /(denied|left open)/i);
        await visit.click("Take it away");
        await visit.page.waitForFunction(() => ![...document.querySelectorAll("#step-result .hint")].some((hint) => !hint.hidden && /^Weighed/.test(hint.textContent)));
        assert.deepEqual(visit.problems, []);
      } finally {
        await visit.close();
      }
    });
  });
}
