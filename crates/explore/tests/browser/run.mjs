// The page in a real browser: looks, keyboard, files, scenes, fit, link; no violation of axe-core.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [program, browserPath, shots] = process.argv.slice(2);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "explore-"));
if (shots) mkdirSync(shots, { recursive: true });

/** Starts the program and returns its address. */
async function served() {
  const server = spawn(program, ["explore", "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
  const address = await new Promise((found, failed) => {
    let said = "";
    const hear = (text) => {
      said += text;
      const match = /http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]+/.exec(said);
      if (match) found(match[0]);
    };
    server.stdout.on("data", hear);
    server.stderr.on("data", hear);
    server.on("exit", () => failed(new Error(said)));
  });
  return { server, address };
}

const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

const { server, address } = await served();
const browser = await chromium.launch({ executablePath: browserPath, args: flags });
const faults = [];

async function opened({ width = 1280, height = 900, scheme = "light", url = address } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, reducedMotion: "reduce", acceptDownloads: true });
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  // PAGE=FOLDER tries files of the page without building the program anew.
  if (process.env.PAGE) {
    await context.route(/\/(\?token.*)?$|\.(js|css|svg)$/, async (route) => {
      const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
      const response = await route.fetch();
      await route.fulfill({ response, body: readFileSync(join(process.env.PAGE, name)) });
    });
  }
  const page = await context.newPage();
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("request", (request) => request.url().startsWith(new URL(address).origin) || /^(blob|data):/.test(request.url()) || faults.push(`elsewhere: ${request.url()}`));
  await page.goto(url);
  await ready(page);
  return page;
}

/** Waits until shot and curve are drawn and nothing is under way. */
async function ready(page) {
  await page.waitForFunction(() => document.querySelector("#tiles dd") && !document.querySelector(".busy, .stale"), null, { timeout: 240_000 });
  await page.waitForLoadState("networkidle");
  await page.waitForTimeout(150);
}

const tile = (page, at) => page.locator("#tiles dd").nth(at).innerText();
const microseconds = async (page, at = 0) => Number((await tile(page, at)).replace(/[^\d.]/g, ""));

async function violations(page, where) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const words = found.violations.map((one) => `${where}: ${one.id}: ${one.nodes.slice(0, 3).map((node) => `${node.html.slice(0, 160)} – ${node.failureSummary}`).join("; ")}`);
  assert.deepEqual(words, []);
}

const look = (page, name, options = {}) => (shots ? page.screenshot({ path: join(shots, `${name}.png`), ...options }) : null);

const tests = {
  async "the first look has the paper's times of flight"() {
    const page = await opened();
    assert.ok(Math.abs((await microseconds(page)) - 761.9) < 0.2, await tile(page, 0));
    await violations(page, "first look");
    await look(page, "laptop");
    for (const name of ["text", "fit", "laws", "theory"]) {
      await page.click(`#tab-${name}`);
      await page.waitForTimeout(300);
      await violations(page, name);
      await look(page, `laptop-${name}`);
    }
    await page.click(".numbers summary");
    await violations(page, "tables");
    await page.context().close();
  },

  async "phone, projector and dark"() {
    for (const [name, width, height, scheme] of [["phone", 360, 780, "light"], ["projector", 1920, 1080, "light"], ["dark", 1280, 900, "dark"], ["phone-dark", 360, 780, "dark"]]) {
      const page = await opened({ width, height, scheme });
      assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `${name} is wider than its screen`);
      await violations(page, name);
      await look(page, name, { fullPage: name.startsWith("phone") });
      await page.context().close();
    }
  },

  async "a slider moves times and text"() {
    const page = await opened();
    const before = await microseconds(page);
    await page.locator("[data-group=striker] input[type=range]").focus();
    for (let key = 0; key < 40; key++) await page.keyboard.press("ArrowRight");
    await ready(page);
    assert.ok((await microseconds(page)) < before);
    await page.click("#tab-text");
    assert.match(await page.inputValue("#text"), /speed = "0\.5[67]\d* m\/s"/);
    await page.context().close();
  },

  async "a wrong unit is refused in place in the program's words"() {
    const page = await opened();
    const field = page.getByLabel("Young modulus", { exact: true });
    await field.fill("213 mm");
    await field.press("Tab");
    await page.waitForSelector(".field.wrong .error");
    assert.match(await page.innerText(".field.wrong .error"), /is a length: expected a pressure/);
    await violations(page, "a mistake");
    await look(page, "mistake");
    await field.fill("210,5 GPa");
    await field.press("Tab");
    await ready(page);
    await page.waitForSelector(".field.wrong", { state: "detached" });
    await page.click("#tab-text");
    assert.match(await page.inputValue("#text"), /young_modulus = "210\.5 GPa"/);
    await page.context().close();
  },

  async "the text changes the controls"() {
    const page = await opened();
    await page.click("#tab-text");
    const text = await page.inputValue("#text");
    await page.fill("#text", text.replace("count = 40", "count = 30"));
    await page.waitForFunction(() => document.querySelector("#row").getAttribute("aria-label").includes("30 beads"));
    await ready(page);
    await page.click("#tab-controls");
    assert.equal(await page.getByRole("textbox", { name: /^Count/ }).inputValue(), "30");
    await page.fill("#text", "beads = [").catch(() => {});
    await page.click("#tab-text");
    await page.fill("#text", "beads = [");
    await page.waitForSelector("#text-errors li");
    await page.context().close();
  },

  async "every preset is shown without a refusal"() {
    const page = await opened();
    const names = await page.locator("#preset option").evaluateAll((all) => all.map((one) => one.value).filter(Boolean));
    for (const name of names) {
      await page.selectOption("#preset", name);
      await ready(page);
      assert.equal(await page.locator("#banner:not(.warm)").isVisible(), false, `${name}: ${await page.locator("#banner").innerText()}`);
    }
    await page.context().close();
  },

  async "every scene can be gone through by keyboard"() {
    const page = await opened();
    const ids = await page.locator("#scene option").evaluateAll((all) => all.map((one) => one.value).filter(Boolean));
    for (const id of ids) {
      await page.selectOption("#scene", id);
      await ready(page);
      await page.waitForSelector("#story:not([hidden])");
      for (;;) {
        await ready(page);
        await look(page, `scene-${id}-${await page.locator("#story .steps span").innerText()}`.replaceAll(" ", "-"));
        const next = page.locator("#story [data-go=next]");
        const last = (await next.innerText()) === "Show an answer";
        await next.focus();
        await page.keyboard.press("Enter");
        if (last) break;
      }
      assert.ok(await page.locator("#story .answer").isVisible());
      assert.equal(await page.locator("#banner:not(.warm)").isVisible(), false, `${id}: ${await page.locator("#banner").innerText()}`);
      if (id === "wave") assert.match(await page.locator("#curve .note").innerText(), /v−0\.2000000/);
      if (id === ids[0]) await violations(page, `scene ${id}`);
    }
    await page.context().close();
  },

  async "the animation is worked by keyboard"() {
    const page = await opened();
    const clock = () => page.innerText("#clock");
    const before = await clock();
    await page.focus("#row");
    await page.keyboard.press("ArrowRight");
    assert.notEqual(await clock(), before);
    await page.focus("#play");
    await page.keyboard.press("Enter");
    assert.equal(await page.getAttribute("#play", "aria-label"), "Pause");
    await page.waitForTimeout(300);
    await page.keyboard.press("Enter");
    assert.equal(await page.getAttribute("#play", "aria-label"), "Play");
    await page.focus("#signals svg");
    await page.keyboard.press("ArrowRight");
    assert.ok(await page.locator("#signals .tip").isVisible());
    await page.context().close();
  },

  async "an oscilloscope's CSV is picked and laid over the model"() {
    const page = await opened();
    const trace = await page.evaluate(async () => {
      const { ask, decoded } = await import("./engine.js");
      const presets = await ask("test", { verb: "presets" });
      const { motion } = await ask("test", { verb: "shot", text: presets[0].text, samples: 3000 });
      return { interval: motion.interval_s, sensor: [...decoded(motion.sensor_n)], wall: [...decoded(motion.wall_n)] };
    });
    const rate = 1e6;
    const at = (values, time) => values[Math.min(values.length - 1, Math.round(time / trace.interval))];
    const lines = ["time_s,sensor_V,wall_V"];
    for (let sample = 0; sample < 3000; sample++) {
      const time = sample / rate - 400e-6;
      const noise = 0.002 * Math.sin(37.7 * sample) * Math.cos(11.3 * sample);
      lines.push(`${(sample / rate).toFixed(7)},${(time < 0 ? noise : 0.01 * at(trace.sensor, time) + noise).toFixed(5)},${(time < 0 ? noise : 0.01 * at(trace.wall, time) + noise).toFixed(5)}`);
    }
    const file = join(folder, "scope.csv");
    writeFileSync(file, `${lines.join("\n")}\n`);
    await page.setInputFiles("#file", file);
    await page.waitForSelector("#pane-fit table.result", { timeout: 30_000 });
    const shown = await page.innerText("#pane-fit table.result");
    assert.match(shown, /scope\.csv/);
    assert.ok(!shown.includes("/tmp"), shown);
    assert.match(await page.innerText("#signals .note"), /residual/);
    await look(page, "recording");
    const marked = join(folder, "<img src=x onerror=document.title='executed'>.csv");
    writeFileSync(marked, `# <script>document.title='executed'</script>\n${lines.join("\n")}\n`);
    await page.setInputFiles("#file", marked);
    await page.waitForTimeout(1500);
    assert.doesNotMatch(await page.title(), /executed/);
    await page.context().close();
  },

  async "a fit ends with values and errors"() {
    const page = await opened();
    await page.click("#tab-fit");
    await page.getByRole("button", { name: "Noisy data of this row" }).click();
    await page.waitForFunction(() => document.querySelector("#pane-fit button.primary:not(:disabled)"), null, { timeout: 30_000 });
    await page.getByRole("checkbox", { name: /young modulus/ }).check();
    await page.getByRole("button", { name: "Fit", exact: true }).click();
    await page.waitForSelector("#pane-fit h3:has-text('Result')", { timeout: 120_000 });
    await violations(page, "a fit");
    await look(page, "fit");
    const found = await page.innerText("#pane-fit table.result >> nth=0");
    assert.match(found, /±/);
    await page.context().close();
  },

  async "a link and a reload bring the state back"() {
    const page = await opened();
    await page.selectOption("#preset", "gear");
    await ready(page);
    const before = await tile(page, 0);
    await page.click("summary:has-text('Share')");
    await page.click("[data-copy=link]");
    await page.waitForFunction(() => location.hash.startsWith("#s="));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const again = await opened({ url: link });
    assert.equal(await tile(again, 0), before);
    await page.reload();
    await ready(page);
    assert.equal(await tile(page, 0), before);
    await page.click("summary:has-text('Share')");
    await page.click("[data-copy=shell]");
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /hertzchain shot --preset gear/);
    await page.context().close();
    await again.context().close();
  },

  async "files are saved"() {
    const page = await opened();
    for (const [what, kind] of [["toml", /\.toml$/], ["signals", /\.csv$/], ["curve", /\.csv$/], ["svg", /\.svg$/], ["png", /\.png$/]]) {
      await page.click("summary:has-text('Save')");
      const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-save=${what}]`)]);
      assert.match(download.suggestedFilename(), kind);
      const path = join(folder, download.suggestedFilename());
      await download.saveAs(path);
      assert.ok(readFileSync(path).length > 200);
      if (shots && what === "png") writeFileSync(join(shots, "saved-figures.png"), readFileSync(path));
    }
    await page.context().close();
  },

  async "how long the answers to a slider's move take"() {
    const page = await opened();
    const times = await page.evaluate(async () => {
      const { ask } = await import("./engine.js");
      const presets = await ask("test", { verb: "presets" });
      const { text } = presets[0];
      const took = async (request) => {
        const all = [];
        for (let at = 0; at < 7; at++) {
          const began = performance.now();
          await ask("test", request);
          all.push(performance.now() - began);
        }
        return all.sort((a, b) => a - b)[3];
      };
      return { shot: await took({ verb: "shot", text, samples: 500, draft: true }), curve: await took({ verb: "batch", text, speeds: { from_m_s: 0.05, to_m_s: 2.5, count: 60 } }) };
    });
    console.log(`  shot ${times.shot.toFixed(0)} ms, curve of 60 speeds ${times.curve.toFixed(0)} ms`);
    await page.context().close();
  },
};

let failed = 0;
const wanted = process.env.ONLY;
for (const [name, test] of Object.entries(tests)) {
  if (wanted && !name.includes(wanted)) continue;
  const began = Date.now();
  try {
    await test();
    console.log(`ok   ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed += 1;
    console.log(`FAIL ${name}\n${error.stack}`);
    for (const context of browser.contexts()) {
      if (shots) for (const page of context.pages()) await page.screenshot({ path: join(shots, `failed-${failed}.png`) }).catch(() => {});
      await context.close();
    }
  }
}
await browser.close();
server.kill();
if (faults.length) console.log(`faults of the page:\n${[...new Set(faults)].join("\n")}`);
process.exit(failed || faults.length ? 1 : 0);
