// The page in a real browser: looks, keyboard, files, scenes, fit, link; no violation of axe-core.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, truncateSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { basename, extname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { deflateRawSync } from "node:zlib";
import { chromium } from "playwright-core";
import { KINDS, hosted, served } from "./hosts.mjs";
import { recorded, tdms } from "./recordings.mjs";

// What answers: `native`, the program; a folder, the static site in it; an HTML file, itself.
const [engine, program, browserPath, shots] = process.argv.slice(2);
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "explore-"));
if (shots) mkdirSync(shots, { recursive: true });

/** Longest time that anything may take, in ms: the machine may be doing other things. */
const PATIENCE = 240_000;
const isNative = engine === "native";
/** By how much times of flight of WebAssembly may differ, relatively. */
const EQUAL = isNative ? 0 : 1e-12;
/**
 * WebAssembly has no fused multiply-add, with which glibc's powers round differently in the last bit: that moves
 * step sizes, and times by up to 1.5e-12. So the program is held to the instructions that both have.
 */
const SAME_INSTRUCTIONS = isNative || process.arch !== "x64" ? {} : { GLIBC_TUNABLES: "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2", HERTZCHAIN_INSTRUCTION_SET: "sse2" };

const flags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

const onDisk = engine.endsWith(".html");
const { address, close } = isNative ? await served(program) : onDisk ? { address: pathToFileURL(resolve(engine)).href, close: () => {} } : await hosted(engine);
const browser = await chromium.launch({ executablePath: browserPath, args: flags, timeout: PATIENCE });
const faults = [];

async function opened({ width = 1280, height = 900, scheme = "light", url = address } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, reducedMotion: "reduce", acceptDownloads: true });
  context.setDefaultTimeout(PATIENCE);
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  // PAGE=FOLDER tries files of the page without building the program anew.
  if (process.env.PAGE) {
    await context.route(/\/(\?token.*)?$|\.(js|css|svg)$/, async (route) => {
      const name = new URL(route.request().url()).pathname.slice(1) || "index.html";
      await route.fulfill({ body: readFileSync(join(process.env.PAGE, name)), contentType: KINDS[extname(name)] });
    });
  }
  const page = await context.newPage();
  const own = onDisk ? address : new URL(address).origin;
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("request", (request) => request.url().startsWith(own) || /^(blob|data):/.test(request.url()) || faults.push(`elsewhere: ${request.url()}`));
  await page.goto(url, { timeout: PATIENCE });
  await ready(page);
  // Curves of few speeds: what they cost is measured by a test of its own.
  await page.evaluate(() => Object.assign(hertzchain.curve, { draft: 8, full: 12 }));
  return page;
}

/** Waits until shot and curve are drawn and nothing is under way. */
async function ready(page) {
  await page.waitForFunction(() => document.querySelector("#tiles dd") && !document.querySelector(".busy, .stale"));
}

/** Waits until an element's text has something in it. */
const has = (page, selector, text) => page.waitForFunction(([selector, text]) => document.querySelector(selector)?.textContent.includes(text), [selector, text]);

const tile = (page, at) => page.locator("#tiles dd").nth(at).innerText();
const microseconds = async (page, at = 0) => Number((await tile(page, at)).replace(/[^\d.]/g, ""));

/** What is asked of the engine by the page. */
const asked = (page, request) => page.evaluate((request) => hertzchain.ask("test", request), request);

/** What the program prints as JSON. */
const printed = (...words) => JSON.parse(execFileSync(program, [...words, "--json"], { encoding: "utf8", maxBuffer: 1 << 28, env: { ...process.env, ...SAME_INSTRUCTIONS } }));

async function violations(page, where) {
  // As a text: scripts of others are kept out by the page's policy, this is the browser's own call.
  await page.evaluate(axe);
  const found = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const words = found.violations.map((one) => `${where}: ${one.id}: ${one.nodes.slice(0, 3).map((node) => `${node.html.slice(0, 160)} – ${node.failureSummary}`).join("; ")}`);
  assert.deepEqual(words, []);
}

const look = (page, name, options = {}) => (shots ? page.screenshot({ path: join(shots, `${name}.png`), ...options }) : null);

/** A page of another origin, which knows the token, gets no answer and can't frame the page. */
async function stranger() {
  writeFileSync(join(folder, "index.html"), "<!doctype html><title>another page</title>");
  const other = await hosted(folder);
  const page = await browser.newPage();
  await page.goto(other.address);
  const got = await page.evaluate(async (address) => {
    const { origin, searchParams } = new URL(address);
    const headers = { "Content-Type": "application/json", "X-Hertzchain-Token": searchParams.get("token") };
    const reach = (more) => fetch(`${origin}/answer`, { method: "POST", body: '{"verb":"presets"}', ...more }).then((reply) => reply.text(), () => "");
    const frame = document.createElement("iframe");
    frame.src = address;
    const loaded = new Promise((done) => frame.addEventListener("load", done));
    document.body.append(frame);
    await loaded;
    return [await reach({ headers }), await reach({ mode: "no-cors" })];
  }, address);
  assert.deepEqual(got, ["", ""]);
  assert.equal(await page.frames()[1].locator("#row").count(), 0, "the page is in a frame of another origin");
  await page.close();
  other.close();
}

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

  async "times of flight are the program's for every preset"() {
    const page = await opened();
    for (const { name, text } of await asked(page, { verb: "presets" })) {
      const shot = await asked(page, { verb: "shot", text });
      const own = printed("shot", "--preset", name);
      for (const key of ["tof_incident_s", "tof_reflected_s"]) {
        const [here, there] = [shot[key], own[key] ?? null];
        assert.ok(here === there || Math.abs(here / there - 1) <= EQUAL, `${name}: ${key} ${here} ${there}`);
      }
    }
    const [{ text }] = await asked(page, { verb: "presets" });
    const curve = await asked(page, { verb: "batch", text, speeds: { from_m_s: 0.05, to_m_s: 2.5, count: 24 } });
    const own = printed("sweep", "--preset", "dry", "--speeds", "log:0.05:2.5:24").points;
    curve.tof_incident_s.forEach((here, at) => assert.ok(Math.abs(here / own[at].tof_incident_s - 1) <= EQUAL, `curve: ${here} ${own[at].tof_incident_s}`));
    await page.context().close();
  },

  async "every control can be reached by keyboard"() {
    const page = await opened();
    const all = await page.evaluate(() => {
      const shown = (one) => one.checkVisibility() && !one.disabled && one.tabIndex >= 0;
      const controls = [...document.querySelectorAll("button, input, select, textarea, summary, [tabindex]")].filter(shown);
      controls.forEach((one, at) => (one.dataset.control = at));
      return controls.length;
    });
    const seen = new Set();
    await page.evaluate(() => document.activeElement?.blur());
    for (let key = 0; key < all + 20; key++) {
      await page.keyboard.press("Tab");
      seen.add(await page.evaluate(() => document.activeElement?.dataset.control));
    }
    const missed = await page.evaluate((seen) => [...document.querySelectorAll("[data-control]")].filter((one) => !seen.includes(one.dataset.control)).map((one) => one.outerHTML.slice(0, 160)), [...seen]);
    assert.deepEqual(missed, []);
    await page.context().close();
  },

  async "a screen reader gets names, values, tables and announcements"() {
    const page = await opened();
    const client = await page.context().newCDPSession(page);
    const read = async () => (await client.send("Accessibility.getFullAXTree")).nodes.filter((node) => !node.ignored);
    const property = (node, name) => node.properties?.find((one) => one.name === name)?.value.value;
    await page.click(".numbers summary");
    for (const name of ["text", "fit", "laws", "theory", "controls"]) {
      await page.click(`#tab-${name}`);
      await page.evaluate(() => document.querySelectorAll("#pane-controls details").forEach((one) => (one.open = true)));
      const reached = (await read()).filter((node) => property(node, "focusable") && node.role.value !== "RootWebArea");
      const nameless = reached.filter((node) => !node.name?.value.trim() || ["generic", "none"].includes(node.role.value));
      assert.deepEqual(nameless.map((node) => `${node.role.value} ${node.nodeId}`), [], name);
      assert.ok(reached.length > 30, `${name}: ${reached.length}`);
    }
    const nodes = await read();
    const named = (role) => nodes.filter((node) => node.role.value === role).map((node) => node.name.value);
    for (const title of ["Pulses", "Times of flight", "Energy at the end"]) assert.ok(named("table").includes(title), `${title}: ${named("table")}`);
    assert.ok(named("columnheader").length > 10 && named("image").some((name) => /the pulse is at contact/.test(name)), String(named("image")));
    const sliders = nodes.filter((node) => node.role.value === "slider").map((node) => property(node, "valuetext"));
    assert.ok(sliders.length > 5 && sliders.every(Boolean), String(sliders));
    await page.locator("[data-group=striker] input[type=range]").focus();
    await page.keyboard.press("PageUp");
    await has(page, "#live", "Computed: incident");
    await page.waitForFunction(() => !document.querySelector("#live").textContent.includes("761.90"));
    await ready(page);
    await page.focus("#signals svg");
    await page.keyboard.press("ArrowRight");
    await has(page, "#live", "sensor bead");
    await page.context().close();
  },

  async "every control of the experiment changes it by keyboard"() {
    const page = await opened();
    await page.selectOption("#preset", "gear");
    await ready(page);
    const paths = await page.locator("#pane-controls [data-path]").evaluateAll((all) => [...new Set(all.filter((one) => one.checkVisibility()).map((one) => one.dataset.path))]);
    assert.ok(paths.length > 10, String(paths));
    const text = () => page.inputValue("#text");
    for (const path of paths) {
      const before = await text();
      const field = page.locator(`#pane-controls [data-path='${path}']`).first();
      await field.focus();
      const [kind, value] = await field.evaluate((one) => [one.type, one.value]);
      const chosen = kind === "select-one";
      if (chosen && (await field.locator("option").count()) < 2) continue;
      if (!chosen && kind !== "checkbox" && !/^[-+]?[\d.]/.test(value)) continue;
      await page.keyboard.press(chosen ? "ArrowDown" : kind === "checkbox" ? "Space" : "ArrowUp");
      if (chosen && (await field.inputValue()) === value) await page.keyboard.press("ArrowUp");
      await page.waitForFunction((before) => document.querySelector("#text").value !== before, before);
      if (!chosen && kind !== "checkbox") continue;
      // Another choice has other controls.
      await page.focus("#tab-text");
      await page.keyboard.press("Enter");
      await page.fill("#text", before);
      await page.focus("#tab-controls");
      await page.keyboard.press("Enter");
      await page.waitForFunction((before) => document.querySelector("#text").value === before && !document.querySelector(".busy, .stale"), before);
    }
    await page.context().close();
  },

  async "a list that adds waits for Enter, and the focus stays in the form"() {
    const page = await opened();
    const before = await page.inputValue("#text");
    const list = page.locator("[data-group=striker] [data-stay]").first();
    await list.focus();
    const options = await list.locator("option").evaluateAll((all) => all.map((one) => one.value));
    for (const key of ["ArrowDown", "ArrowDown"]) await page.keyboard.press(key);
    assert.equal(await list.inputValue(), options[2]);
    assert.equal(await page.inputValue("#text"), before);
    await page.keyboard.press("Enter");
    await page.waitForFunction((before) => document.querySelector("#text").value !== before, before);
    assert.match(await page.inputValue("#text"), new RegExp(`\\[striker\\][^\\[]*${options[2]} =`));
    await page.waitForFunction(() => document.querySelector("#pane-controls").contains(document.activeElement));
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
    const { interval_s, channels } = await recorded(page);
    const lines = ["time_s,sensor_V,wall_V"];
    channels[0].forEach((volts, sample) => lines.push(`${(sample * interval_s).toFixed(7)},${volts.toFixed(5)},${channels[1][sample].toFixed(5)}`));
    const file = join(folder, "scope.csv");
    writeFileSync(file, `${lines.join("\n")}\n`);
    await page.setInputFiles("#file", file);
    await page.waitForSelector("#pane-fit table.result");
    const shown = await page.innerText("#pane-fit table.result");
    assert.match(shown, /scope\.csv/);
    assert.ok(!shown.includes("/tmp"), shown);
    assert.match(await page.innerText("#signals .note"), /residual 0\.\d+ %/);
    assert.match(await page.textContent("#signals svg"), /residual/);
    await look(page, "recording");
    // Headings that name no times, as other makers write them; decimal commas.
    const german = lines.slice(1).map((line) => line.replaceAll(",", ";").replaceAll(".", ","));
    for (const [name, text] of [
      ["keysight.csv", ["x-axis,1,2", "second,Volt,Volt", ...lines.slice(1)]],
      ["deutsch.csv", ["Zeit in s;Sensor in V;Wand in V", ...german]],
    ]) {
      writeFileSync(join(folder, name), `${text.join("\n")}\n`);
      await page.setInputFiles("#file", join(folder, name));
      await has(page, "#pane-fit table.result", name);
      assert.match(await page.innerText("#pane-fit table.result"), /µs/, name);
    }
    const marked = join(folder, "<img src=x onerror=document.title='executed'>.csv");
    writeFileSync(marked, `# <script>document.title='executed'</script>\n${lines.join("\n")}\n`);
    await page.setInputFiles("#file", marked);
    await has(page, "#pane-fit table.result", "onerror");
    assert.doesNotMatch(await page.title(), /executed/);
    await page.context().close();
  },

  async "recordings of other formats are dropped and picked"() {
    const page = await opened();
    const series = join(folder, "campaign");
    const campaign = new URL("../../../sim/tests/small.toml", import.meta.url);
    execFileSync(program, ["campaign", fileURLToPath(campaign), "--out", series], { stdio: "pipe" });
    const { interval_s, channels } = await recorded(page);
    writeFileSync(join(folder, "card.tdms"), tdms(interval_s, channels));
    for (const file of [join(folder, "card.tdms"), fileURLToPath(campaign), join(series, "dry-03-0.9000.h5")]) {
      const name = basename(file);
      const bytes = readFileSync(file).toString("base64");
      await page.evaluate(([name, bytes]) => {
        const held = new DataTransfer();
        held.items.add(new File([Uint8Array.from(atob(bytes), (one) => one.charCodeAt(0))], name));
        for (const kind of ["dragenter", "drop"]) document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: held, bubbles: true, cancelable: true }));
      }, [name, bytes]);
      if (name.endsWith(".toml")) {
        // The campaign's own row, which says where its sensor is.
        await has(page, "#row-about", "A small campaign");
        await ready(page);
        continue;
      }
      await has(page, "#pane-fit table.result", name);
      assert.match(await page.innerText("#pane-fit table.result"), /µs/);
    }
    await page.context().close();
  },

  async "hostile experiments and links run nothing and hang nothing"() {
    const page = await opened();
    await page.click("#tab-text");
    const text = await page.inputValue("#text");
    const markup = "<img src=x onerror=globalThis.executed=1><script>globalThis.executed=1</script>";
    await page.fill("#text", text.replace(/title = ".*"/, `title = "${markup}"`));
    await has(page, "#row-about", "onerror");
    await page.fill("#text", text.replace("count = 40", "count = 2000000"));
    await has(page, "#banner", "takes at most");
    const slow = (step) => page.fill("#text", `${text}\n[solver]\nmethod = "rk4"\nstep = "${step}"\nduration = "10 ms"\n`);
    await slow("0.1 ns");
    await has(page, "#banner", "expected at least");
    // Many seconds of work, which the next text ends.
    await slow("3 ns");
    await page.waitForSelector("body.busy");
    await page.fill("#text", text);
    await page.waitForSelector("#banner", { state: "hidden" });
    await ready(page);
    assert.match(await tile(page, 0), /761\.9/);
    assert.equal(await page.evaluate(() => globalThis.executed), undefined);
    await page.context().close();
    const large = join(folder, "large.csv");
    writeFileSync(large, "");
    truncateSync(large, 1 << 30);
    const stuffed = await opened();
    await stuffed.setInputFiles("#file", large);
    await has(stuffed, "#pane-fit", "the page takes up to 64 MB");
    await stuffed.context().close();
    if (isNative) await stranger();
    for (const fragment of ["#s=%00", "#s=AAAA", `#s=${deflateRawSync(Buffer.alloc(1 << 24, "[")).toString("base64url")}`]) {
      const other = await opened({ url: address + fragment });
      assert.match(await tile(other, 0), /761\.9/);
      await other.context().close();
    }
  },

  async "a fit is cancelled"() {
    const page = await opened();
    await page.click("#tab-fit");
    await page.getByRole("button", { name: "Noisy data of this row" }).click();
    await page.waitForSelector("#pane-fit button.primary:not(:disabled)");
    // A longer row to a higher accuracy: minutes of work.
    await page.click("#tab-text");
    const text = await page.inputValue("#text");
    await page.fill("#text", text.replace("count = 40", "count = 400"));
    await page.waitForFunction(() => document.querySelector("#row").getAttribute("aria-label").includes("400 beads"));
    await page.click("#tab-fit");
    await page.getByRole("checkbox", { name: /Young modulus/ }).check();
    await page.getByRole("button", { name: "Fit", exact: true }).click();
    await page.getByRole("button", { name: "Cancel" }).click();
    await has(page, "#pane-fit", "The fit was cancelled.");
    await page.waitForSelector("#pane-fit button.primary:not(:disabled)");
    await page.context().close();
  },

  async "a fit ends with values and errors, or says what is not determined"() {
    const page = await opened();
    await page.click("#tab-fit");
    await page.getByRole("button", { name: "Noisy data of this row" }).click();
    await page.waitForFunction(() => document.querySelector("#pane-fit button.primary:not(:disabled)"));
    await page.getByRole("checkbox", { name: /Young modulus/ }).check();
    await page.getByRole("button", { name: "Fit", exact: true }).click();
    await page.waitForSelector("#pane-fit h3:has-text('Result')");
    await violations(page, "a fit");
    await look(page, "fit");
    const found = await page.innerText("#pane-fit table.result >> nth=0");
    assert.match(found, /±/);
    for (const name of [/Poisson ratio/, /Shear viscosity/]) await page.getByRole("checkbox", { name }).check();
    await page.getByRole("button", { name: "Fit", exact: true }).click();
    await has(page, "#pane-fit", "Not determined:");
    await page.context().close();
  },

  async "a link and a reload bring the whole state back"() {
    const page = await opened();
    await page.selectOption("#preset", "gear");
    await ready(page);
    await page.click("#tab-fit");
    await page.getByRole("button", { name: "Noisy data of this row" }).click();
    await has(page, "#pane-fit", "9 speeds");
    await page.selectOption("#reference", "this row");
    await page.click("#tab-controls");
    await page.locator("[data-group=striker] input[type=text]").fill("0,7 m/s");
    await page.keyboard.press("Tab");
    await page.waitForFunction(() => document.querySelector("#preset").value === "");
    await ready(page);
    await page.selectOption("#magnify", "50");
    await page.selectOption("#curve-scale", "linear");
    const state = (page) => page.evaluate(() => [...["#magnify", "#curve-scale", "#reference"].map((one) => document.querySelector(one).value), document.querySelector("#clock").textContent, document.querySelector("#tiles dd").textContent, document.querySelector("#text").value]);
    const before = await state(page);
    assert.deepEqual(before.slice(0, 3), ["50", "linear", "pinned"]);
    await page.click("summary:has-text('Share')");
    await page.click("[data-copy=link]");
    await has(page, "#toast", "The link is on the clipboard");
    assert.match(page.url(), /#s=/);
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const again = await opened({ url: link });
    await page.reload();
    for (const one of [again, page]) {
      await ready(one);
      await has(one, "#pane-fit", "9 speeds");
      assert.deepEqual(await state(one), before);
    }
    await page.context().close();
    await again.context().close();
  },

  async "copied command lines give the page's numbers"() {
    const page = await opened();
    const lines = async (what) => {
      await page.click("summary:has-text('Share')");
      await page.click(`[data-copy=${what}]`);
      await has(page, "#toast", what === "shell" ? "command lines" : "Python lines");
      return page.evaluate(() => navigator.clipboard.readText());
    };
    await page.selectOption("#preset", "gear");
    await ready(page);
    assert.match(await lines("shell"), /hertzchain shot --preset gear --json/);
    assert.match(await lines("python"), /row = hc\.preset\("gear"\)/);
    await page.locator("[data-group=striker] input[type=text]").fill("0,7 m/s");
    await page.keyboard.press("Tab");
    await page.waitForFunction(() => document.querySelector("#preset").value === "");
    await ready(page);
    const copied = (await lines("shell")).replaceAll(/^hertzchain/gm, resolve(program));
    const shot = copied.split("\n").filter((line) => !/ sweep /.test(line)).join("\n");
    const there = JSON.parse(execFileSync("bash", ["-c", shot], { cwd: folder, encoding: "utf8", env: { ...process.env, ...SAME_INSTRUCTIONS } }));
    const here = await asked(page, { verb: "shot", text: await page.inputValue("#text") });
    assert.ok(Math.abs(here.tof_incident_s / there.tof_incident_s - 1) <= EQUAL && there.speed_m_s === 0.7, `${here.tof_incident_s} ${there.tof_incident_s}`);
    await page.context().close();
  },

  async "files are saved"() {
    const page = await opened();
    for (const [what, kind] of [["toml", /\.toml$/], ["signals", /\.csv$/], ["curve", /\.csv$/], ["svg", /\.svg$/], ["png", /\.png$/], ["pdf", /\.pdf$/]]) {
      await page.click("summary:has-text('Save')");
      const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-save=${what}]`)]);
      assert.match(download.suggestedFilename(), kind);
      const path = join(folder, download.suggestedFilename());
      await download.saveAs(path);
      const content = readFileSync(path);
      assert.ok(content.length > 200);
      if (what === "pdf") assert.equal(content.indexOf("xref"), Number(/startxref\n(\d+)/.exec(content.toString("latin1"))[1]));
      if (shots && ["png", "pdf"].includes(what)) writeFileSync(join(shots, `saved-figures.${what}`), content);
    }
    await page.context().close();
  },

  async "how long a slider's move takes"() {
    const page = await opened();
    const times = await page.evaluate(async () => {
      Object.assign(hertzchain.curve, { draft: 60, full: 60 });
      const slider = document.querySelector("[data-group=striker] input[type=range]");
      const [tiles, curve] = ["#tiles", "#curve svg"].map((one) => document.querySelector(one));
      const changed = (place) => new Promise((done) => {
        const seen = new MutationObserver(() => (seen.disconnect(), requestAnimationFrame(() => setTimeout(done))));
        seen.observe(place, { childList: true });
      });
      const moves = { row: [], curve: [] };
      for (let move = 0; move < 11; move++) {
        const began = performance.now();
        const took = (name) => () => moves[name].push(performance.now() - began);
        // The page redraws row and signals in one go with the numbers.
        const drawn = [changed(tiles).then(took("row")), changed(curve).then(took("curve"))];
        slider.value = 400 + 20 * move;
        slider.dispatchEvent(new Event("input"));
        await Promise.all(drawn);
      }
      return moves;
    });
    const words = Object.entries(times).map(([name, all]) => `${name} ${Math.min(...all).toFixed(0)} to ${Math.max(...all).toFixed(0)}, median ${all.sort((a, b) => a - b)[5].toFixed(0)} ms`);
    console.log(`  ${words.join("; ")}`);
    await page.context().close();
  },
};

let failed = 0;
let passed = 0;
const wanted = process.env.ONLY;
// From disk only what depends on where the page comes from.
const FROM_DISK = /first look|wrong unit|oscilloscope|link|fit/;
for (const [name, test] of Object.entries(tests)) {
  if ((wanted && !name.includes(wanted)) || (onDisk && !FROM_DISK.test(name))) continue;
  const began = Date.now();
  try {
    await test();
    passed += 1;
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
await close();
rmSync(folder, { recursive: true, force: true });
if (faults.length) console.log(`faults of the page:\n${[...new Set(faults)].join("\n")}`);
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed || faults.length ? 1 : 0);
