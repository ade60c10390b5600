// SPDX-License-Identifier: GPL-3.0-or-later
// Screens against stored ones, in Chromium. A screen that differs is written to build/page/screens, whose path is said;
// CHAINTRUE_STORE_SCREENS=1 node --test tools/web/test/screens.test.mjs stores all of them anew: look at them first.
import assert from "node:assert/strict";
import {existsSync, mkdirSync, readdirSync, readFileSync, statSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {after, before, describe, test} from "node:test";
import {fileURLToPath} from "node:url";
import {built, fixture, Visit} from "./browser.mjs";

const STORED = join(dirname(fileURLToPath(import.meta.url)), "screens");
const FOUND = join(built, "screens");
const isStoring = process.env.CHAINTRUE_STORE_SCREENS === "1";

/** A version of a font or of Chromium draws the edges of letters otherwise: by a few of 255, or by a fraction of a pixel. */
const SAME_COLOUR = 48;
/** Letters cover a tenth of a screen and their edges a third of that: another edge everywhere is 3 %, a missing paragraph more. */
const MOST_DIFFERING = 0.03;
/** Stored pictures are part of the repository. */
const MOST_BYTES = 600_000;

/** Colours are stored in steps of this: pictures are half as large, and a step is less than what counts as another colour. */
const STEP = 16;

/** Runs in the page: a picture made smaller and in fewer colours, so that the stored ones are small and the edges of letters weigh less. */
async function scaled(data, scale, step) {
  const image = new Image();
  image.src = `data:image/png;base64,${data}`;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), {width: scale * image.width, height: scale * image.height});
  const context = canvas.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height);
  pixels.data.forEach((value, at) => {
    pixels.data[at] = step * Math.round(value / step);
  });
  context.putImageData(pixels, 0, 0);
  return canvas.toDataURL("image/png").split(",")[1];
}

/** Runs in the page: the share of pixels that differ, 1 for pictures of other sizes. */
async function differing(one, other, same) {
  const [first, second] = await Promise.all([one, other].map(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), {width: image.width, height: image.height});
    const context = canvas.getContext("2d", {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
  }));
  if (first.width !== second.width || first.height !== second.height) return 1;
  let count = 0;
  for (let at = 0; at < first.data.length; at += 4) {
    if ([0, 1, 2].some((colour) => Math.abs(first.data[at + colour] - second.data[at + colour]) > same)) ++count;
  }
  return count / (first.width * first.height);
}

const SCREENS = {
  begin: async () => {},
  measure: async (visit) => {
    await visit.openSettings(fixture("good/groundcontrol_ring.ini"));
    await visit.unfold("How to measure");
    await visit.page.waitForSelector(".how", {visible: true});
  },
  result: async (visit) => {
    await visit.click("Machine");
    await visit.click("A worn chain");
    await visit.text("#step-measure .said", "With this map it misses by");
    await visit.click("See the map and the causes");
    await visit.text("#step-result .headline", "With this map it misses by");
  },
  belts: async (visit) => {
    await visit.click("Machine");
    await visit.click("A Maslow 4");
    await visit.text("#step-result .causes", "belt stretch");
  },
};

for (const [width, height, dark, scale] of [[1200, 900, false, 0.5], [400, 800, true, 0.5], [1200, 900, true, 0.5]]) {
  describe(`at ${width} px, ${dark ? "dark" : "light"}`, () => {
    let visit = null;
    before(async () => {
      visit = await Visit.to("chrome", {width, height, dark});
    });
    after(() => visit.close());

    for (const [name, go] of Object.entries(SCREENS)) {
      test(name, async () => {
        await go(visit);
        await visit.page.waitForFunction(() => document.querySelector(".busy").hidden);
        await visit.page.evaluate(() => {
          document.activeElement.blur();
          scrollTo(0, 0);
        });
        const path = join(STORED, `${name}-${width}-${dark ? "dark" : "light"}.png`);
        const whole = await visit.page.screenshot({encoding: "base64", captureBeyondViewport: false});
        const screen = Buffer.from(await visit.page.evaluate(scaled, whole, scale, STEP), "base64");
        if (isStoring) {
          mkdirSync(STORED, {recursive: true});
          writeFileSync(path, screen);
          return;
        }
        assert.ok(existsSync(path), `there is no ${path}`);
        const share = await visit.page.evaluate(differing, readFileSync(path).toString("base64"), screen.toString("base64"), SAME_COLOUR);
        if (share <= MOST_DIFFERING) return;
        mkdirSync(FOUND, {recursive: true});
        const found = join(FOUND, `${name}-${width}-${dark ? "dark" : "light"}.png`);
        writeFileSync(found, screen);
        assert.fail(`${(100 * share).toFixed(1)} % of ${path} differ from ${found}`);
      });
    }
  });
}

test("a screen that differs is found, and the stored ones are small", async () => {
  const visit = await Visit.to("chrome", {width: 400, height: 800});
  try {
    const light = await visit.page.screenshot({encoding: "base64"});
    assert.equal(await visit.page.evaluate(differing, light, light, SAME_COLOUR), 0);
    await visit.page.$eval("#step-machine section", (section) => section.remove());
    const without = await visit.page.screenshot({encoding: "base64"});
    assert.ok(await visit.page.evaluate(differing, light, without, SAME_COLOUR) > MOST_DIFFERING);
  } finally {
    await visit.close();
  }
  const bytes = readdirSync(STORED).reduce((sum, name) => sum + statSync(join(STORED, name)).size, 0);
  assert.ok(bytes <= MOST_BYTES, `${bytes} bytes`);
});
