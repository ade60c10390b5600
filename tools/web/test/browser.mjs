// SPDX-License-Identifier: GPL-3.0-or-later
// The built page in a real browser, and the native command of the same source.
import {spawnSync} from "node:child_process";
import {existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {after} from "node:test";
import {fileURLToPath, pathToFileURL} from "node:url";
import puppeteer from "puppeteer-core";
import {folderOf} from "../page/zip.js";

export const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
export const built = join(root, "build/page");
export const native = join(root, "build/chaintrue");
export const fixture = (path) => join(root, "fixtures", path);

/** Generous for slow, busy machines; times are measured elsewhere. */
export const PATIENCE_MS = 120_000;

const EXECUTABLES = {chrome: ["/usr/bin/chromium"], firefox: ["/usr/bin/firefox-esr", "/usr/bin/firefox"]};
const executableOf = (browser) => EXECUTABLES[browser].find((path) => existsSync(path));

/** The browsers that are installed, or those of them that CHAINTRUE_BROWSERS lists. */
const wanted = process.env.CHAINTRUE_BROWSERS?.split(",") ?? Object.keys(EXECUTABLES);
export const browsers = wanted.filter(executableOf);

/** A browser that does not close is killed after this. */
const CLOSING_MS = 10_000;

const folders = [];
process.on("exit", () => folders.forEach((folder) => rmSync(folder, {recursive: true, force: true})));

/** Open browsers. One left over would keep node running. */
const open = new Set();
after(() => Promise.all([...open].map(closed)));

async function closed(browser) {
  open.delete(browser);
  let timer = null;
  const late = new Promise((resolve) => {
    timer = setTimeout(() => {
      browser.process()?.kill("SIGKILL");
      resolve();
    }, CLOSING_MS);
  });
  await Promise.race([browser.close().catch(() => browser.process()?.kill("SIGKILL")), late]);
  clearTimeout(timer);
}

/** A folder that is removed when the process ends. */
export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), "chaintrue-page-"));
  folders.push(folder);
  return folder;
}

/** Runs the native command, with the page's order of sums: {code, stdout, stderr}. */
export function runNative(words, folder) {
  const env = {...process.env, CHAINTRUE_BASELINE: "1"};
  const {status, stdout, stderr} = spawnSync(native, words, {cwd: folder, env, encoding: "utf8", maxBuffer: 1e9});
  return {code: status, stdout, stderr};
}

/** Poll by time: polling by animation frame never ends while the page paints nothing. */
const OFTEN = {polling: 100};

/** A visit to the page. Errors that the page logs or throws are collected in `problems`. */
export class Visit {
  problems = [];
  /** How often the page asked before it replaced something; the answer is yes. */
  questions = 0;

  static async to(browserName, {width = 1280, height = 900, dark = false, patience = PATIENCE_MS, prepare, url = pathToFileURL(join(built, "chaintrue.html")).href} = {}) {
    const visit = new Visit();
    visit.downloads = temporaryFolder();
    visit.browser = await puppeteer.launch({
      browser: browserName, executablePath: executableOf(browserName), headless: true, timeout: PATIENCE_MS,
      // The sandbox is not available to root in a container. Only this page is opened.
      args: browserName === "chrome" ? ["--no-sandbox"] : [],
      ...(browserName === "chrome" && {downloadBehavior: {policy: "allow", downloadPath: visit.downloads}}),
      extraPrefsFirefox: {
        "browser.download.folderList": 2, "browser.download.dir": visit.downloads, "browser.download.alwaysOpenPanel": false,
        "browser.helperApps.neverAsk.saveToDisk": "application/octet-stream", "browser.download.useDownloadDir": true,
        "ui.systemUsesDarkTheme": dark ? 1 : 0, "layout.css.prefers-color-scheme.content-override": dark ? 0 : 1,
      },
    });
    open.add(visit.browser);
    visit.page = await visit.browser.newPage();
    await visit.page.setViewport({width, height});
    if (browserName === "chrome") await visit.page.emulateMediaFeatures([{name: "prefers-color-scheme", value: dark ? "dark" : "light"}]);
    visit.page.setDefaultTimeout(patience);
    visit.page.on("pageerror", (error) => visit.problems.push(error.message));
    visit.page.on("console", (message) => {
      if (message.type() === "error") visit.problems.push(message.text());
    });
    visit.page.on("dialog", (dialog) => {
      ++visit.questions;
      return dialog.accept();
    });
    if (prepare) await prepare(visit.page);
    await visit.page.goto(url);
    await visit.ready();
    return visit;
  }

  ready() {
    return this.page.waitForSelector("body[data-ready]");
  }

  async reload() {
    await this.page.reload();
    await this.ready();
  }

  /** Clicks the visible button of this text. */
  async click(text) {
    for (let trial = 1; ; ++trial) {
      const button = await this.page.waitForFunction((wanted) =>
        [...document.querySelectorAll("button")].find((one) => (one.getAttribute("aria-label") ?? one.textContent) === wanted && one.checkVisibility()), OFTEN, text);
      try {
        await button.asElement().click();
        return;
      } catch (error) {
        // A part that is drawn anew at that moment has its button elsewhere.
        if (trial === 5 || !/not clickable|detached/.test(error.message)) throw error;
        await new Promise((done) => setTimeout(done, 300));
      }
    }
  }

  /** Opens a settings file, and goes on from what was assumed to measuring. */
  async openSettings(path) {
    await this.upload("#settings", path);
    await this.click("On to measuring");
  }

  /** Opens the folded text of this summary. */
  async unfold(summary) {
    const found = await this.page.waitForFunction((wanted) =>
      [...document.querySelectorAll("summary")].find((one) => one.textContent === wanted && one.checkVisibility()), OFTEN, summary);
    if (!await found.evaluate((one) => one.parentElement.open)) await found.asElement().click();
  }

  /** Pastes a text into a box. */
  async paste(selector, text) {
    await this.page.waitForSelector(selector, {visible: true});
    await this.page.$eval(selector, (box, pasted) => {
      box.focus();
      const data = new DataTransfer();
      data.setData("text/plain", pasted);
      const isTaken = !box.dispatchEvent(new ClipboardEvent("paste", {clipboardData: data, bubbles: true, cancelable: true}));
      if (!isTaken) box.value = pasted;
    }, text);
  }

  /** Drops files {name: text} on the page. */
  drop(files) {
    return this.page.evaluate((dropped) => {
      const data = new DataTransfer();
      for (const [name, text] of Object.entries(dropped)) data.items.add(new File([text], name));
      document.querySelector("footer").dispatchEvent(new DragEvent("drop", {dataTransfer: data, bubbles: true, cancelable: true}));
    }, files);
  }

  /** The folder as Download gives it: {path: bytes}. */
  async folder() {
    await this.click("Download");
    return folderOf(await this.downloaded("my-machine.zip"));
  }

  async upload(selector, path) {
    const input = await this.page.waitForSelector(selector);
    await input.uploadFile(path);
  }

  /** Waits until the visible text of `selector` contains `wanted`; returns the text. */
  async text(selector, wanted = "") {
    await this.page.waitForFunction((where, what) => [...document.querySelectorAll(where)].some((one) =>
      one.checkVisibility() && one.textContent !== "" && one.textContent.includes(what)), OFTEN, selector, wanted);
    return this.page.$$eval(selector, (found) => found.filter((one) => one.checkVisibility()).map((one) => one.textContent).join("\n"));
  }

  /** The input of a column of a row, from 0. */
  cell(row, column) {
    return this.page.waitForSelector(`tr[data-row="${row}"] td:nth-last-child(${2 - column}) input`, {visible: true});
  }

  values() {
    return this.page.$$eval(".list input", (inputs) => inputs.map((input) => input.value));
  }

  /** Replaces the text of a cell by key presses. */
  async type(row, column, text) {
    await (await this.cell(row, column)).click({count: 3});
    await this.page.keyboard.press("Backspace");
    await this.page.keyboard.type(text);
  }

  /** The report in the frame of this title, once its charts are drawn. */
  async report(title) {
    const element = await this.page.waitForSelector(`iframe[title="${title}"]`);
    const frame = await element.contentFrame();
    await frame.waitForFunction(() => document.querySelectorAll("figure.chart").length > 0 &&
      [...document.querySelectorAll("figure.chart")].every((figure) => figure.querySelector("svg")));
    return frame;
  }

  /** The bytes of a downloaded file, once it is complete. */
  async downloaded(name) {
    const path = join(this.downloads, name);
    const until = Date.now() + PATIENCE_MS;
    for (;;) {
      const isPartial = readdirSync(this.downloads).some((one) => /\.(part|crdownload)$/.test(one));
      if (existsSync(path) && !isPartial && readFileSync(path).length > 0) break;
      if (Date.now() > until) throw new Error(`${name} was not downloaded; there are: ${readdirSync(this.downloads)}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    const bytes = readFileSync(path);
    rmSync(path);
    return bytes;
  }

  close() {
    return closed(this.browser);
  }
}

/** Writes files {path: bytes} into a folder. */
export function writeFolder(folder, files) {
  for (const [path, bytes] of Object.entries(files)) writeFileSync(join(folder, path), bytes);
}
