// The page: its state, and what changes it.

import { PATIENCE, ask, cancel, decoded, newest, start } from "./engine.js";
import { formula, html } from "./charts.js";
import { copy, csv, figures, packed, pdf, picture, python, save, shell, slug, unpacked } from "./files.js";
import { Fit } from "./fit.js";
import { Form, sentence, source } from "./form.js";
import { plain, parts as quantityParts, quantity } from "./numbers.js";
import { Plots, interesting, units } from "./plots.js";
import { Motion, drawRow } from "./row.js";
import { SCENES } from "./scenes.js";
import { Story } from "./story.js";

const $ = (selector) => document.querySelector(selector);
const still = matchMedia("(prefers-reduced-motion: reduce)");

/** Samples of a shot while a slider moves, and once it stands. */
const SAMPLES = { draft: 500, full: 1800 };
/** Speeds of a curve, and where it runs for the paper's kind of row. */
const CURVE = { draft: 24, full: 60 };
const RANGE = [0.05, 2.5];
// For the browser's console: `hertzchain.curve.full = 200`.
hertzchain.curve = CURVE;

const state = {
  text: "", tree: null, outline: null, mistakes: [], shot: null, motion: null, curve: null, reference: null, data: null,
  presets: [], schema: null, laws: [], time: 0, whole: false, curveScale: "log", curveView: "tof", speeds: null, linked: null,
};

let plots;
let form;
let fit;
let story;
let playing = false;
let asked = 0;

// ---- The experiment: one text, from which all else follows.

/** Shows another experiment. */
async function load(text) {
  form.forget();
  story.end();
  fit.forget();
  state.fresh = true;
  await change([], { text });
}

/** Changes the experiment: a new text, or edits of the present one. A draft is not yet meant. */
async function change(edits, { text = null, draft = false } = {}) {
  if (text !== null) queued = { text, edits: [], draft };
  else if (queued) queued = { ...queued, edits: merged(queued.edits, edits), draft };
  else queued = { text: null, edits, draft };
  return check();
}

let queued = null;

/** Edits of which the last of each place counts. */
function merged(before, after) {
  const places = new Set(after.map((one) => JSON.stringify(one.path)));
  return [...before.filter((one) => !places.has(JSON.stringify(one.path))), ...after];
}

/** Longest time by which a slider's shot is ahead of its check, in ms. */
const HEAD_START = 60;

const check = newest(["check"], async () => {
  const work = queued;
  if (!work) return;
  queued = null;
  const began = ++asked;
  working(1);
  // What is computed of an older text may keep all engines busy.
  const late = setTimeout(() => ["shot", "curve", "reference"].forEach(cancel), PATIENCE);
  try {
    // A slider's shot comes before its check: the engine makes the same changes itself.
    if (work.draft) await Promise.race([shoot(true, { text: state.text, edits: work.edits }), new Promise((done) => setTimeout(done, HEAD_START))]);
    const reply = await ask("check", { verb: "check", text: work.text ?? state.text, edits: work.edits });
    Object.assign(state, { text: reply.text, tree: reply.tree ?? state.tree, mistakes: reply.mistakes });
    if (reply.outline) state.outline = reply.outline;
    showExperiment();
    if (!reply.outline || began !== asked) return;
    if (!work.draft) compute();
    // The curve takes all cores: first the shot is on the screen.
    else requestAnimationFrame(() => setTimeout(sweep, 0, true));
  } catch (error) {
    if (work.text !== null) state.text = work.text;
    if (!error.stopped) refuse(error);
  } finally {
    clearTimeout(late);
    working(-1);
  }
});

let works = 0;

/** Counts what is under way. */
function working(by) {
  works += by;
  document.body.classList.toggle("busy", works > 0);
}

function showExperiment() {
  const { text, tree, schema, laws, mistakes, outline } = state;
  form.show(tree, schema, laws, mistakes);
  fit.show(tree);
  const area = $("#text");
  if (document.activeElement !== area && area.value !== text) area.value = text;
  showLines();
  $("#text-errors").replaceChildren(...mistakes.map((one) => html("li", {}, `Line ${one.line}: ${sentence(one)}`)));
  if (mistakes.length) banner(mistakes.length === 1 ? `Line ${mistakes[0].line}: ${sentence(mistakes[0])}` : `${mistakes.length} mistakes; line ${mistakes[0].line}: ${sentence(mistakes[0])}`);
  else banner(outline?.warnings.length ? outline.warnings.map(sentence).join("\n") : "", true);
  $("#row-about").textContent = outline?.title ?? "";
  document.title = `${outline?.title ?? "Row"} – hertzchain explorer`;
  const preset = state.presets.find((one) => one.text === text);
  $("#preset").value = preset?.name ?? "";
}

function showLines() {
  const wrong = new Set(state.mistakes.map((one) => one.line));
  const count = $("#text").value.split("\n").length;
  const parts = [];
  for (let line = 1; line <= count; line++) parts.push(wrong.has(line) ? html("b", {}, `${line}`) : String(line), "\n");
  $("#lines").replaceChildren(...parts);
  $("#lines").scrollTop = $("#text").scrollTop;
}

function banner(text, warm = false) {
  const place = $("#banner");
  place.classList.toggle("warm", warm);
  if (place.textContent !== text) place.textContent = text;
  place.hidden = !text;
}

function refuse(error) {
  banner(error.message);
}

// ---- Results: a shot and a curve, asked for side by side; while a slider moves the shot comes first.

function compute() {
  shoot(false);
  sweep(false);
}

const shoot = newest(["shot"], async (draft, of = { text: state.text }) => {
  working(1);
  try {
    const shot = await ask("shot", { verb: "shot", ...of, samples: draft ? SAMPLES.draft : SAMPLES.full, draft });
    takeShot(shot, draft);
    if (!draft) announceShot();
  } catch (error) {
    if (error.mistakes?.length) form.mark(error.mistakes);
    if (!error.stopped) refuse(error);
  } finally {
    working(-1);
  }
});

function takeShot(shot, draft) {
  const { motion } = shot;
  if (motion) {
    motion.sensor = decoded(motion.sensor_n);
    motion.wall = decoded(motion.wall_n);
    motion.displacement = decoded(motion.displacement_m);
    motion.force = decoded(motion.force_n);
  }
  if (shot.energy) {
    shot.energy.time = decoded(shot.energy.time_s);
    shot.energy.parts = shot.energy.parts.map(([name, values]) => [name, decoded(values)]);
  }
  // Drafts have no energy: what was seen last stays until the slider stands.
  shot.energy ??= state.fresh ? null : state.shot?.energy ?? null;
  state.shot = shot;
  state.motion = motion ? new Motion(shot) : null;
  const bare = Boolean(state.outline?.dimensionless);
  if (bare !== state.bare || (bare && state.fresh)) {
    state.bare = bare;
    setPaces();
  }
  if (state.fresh) {
    state.fresh = false;
    // A first look: the pulse half-way to the wall.
    state.time = state.linked?.time ?? (shot.incident && shot.wall ? 0.5 * (shot.incident.time_s + shot.wall.time_s) : 0.6 * highest(motion));
    setMagnify(Number(state.linked?.magnify));
    state.linked = null;
  }
  state.time = Math.min(state.time, shot.duration_s);
  drawShot(draft);
}

/** When the sensor bead's signal is largest, in s. */
function highest(motion) {
  if (!motion) return 0;
  return motion.sensor.indexOf(Math.max(...motion.sensor)) * motion.interval_s;
}

let later = 0;

/** Draws numbers, row and signals; the rest once these are on the screen. */
function drawShot(draft) {
  // The row first, which asks for its size before anything else has changed.
  showTime();
  drawTiles();
  plots.drawSignals(state);
  cancelAnimationFrame(later);
  later = requestAnimationFrame(() => setTimeout(drawRest, 0, draft));
}

function drawRest(draft) {
  plots.drawSpacetime(state);
  if (!draft) {
    // A draft has no energy, and its curve follows.
    plots.drawEnergy(state);
    plots.drawCurve(state);
  }
  drawTables();
  story.tell();
}

const sweep = newest(["curve", "reference"], async (draft) => {
  const { outline, text } = state;
  if (!outline?.speed_m_s) {
    state.curve = null;
    state.speeds = null;
    state.curveWhy = "This row has no striker, and so no speed to vary.";
    plots.drawCurve(state);
    return;
  }
  const speed = outline.speed_m_s;
  const [from, to] = outline.dimensionless || speed < RANGE[0] || speed > RANGE[1] ? [speed / 5, speed * 5] : RANGE;
  const speeds = { from_m_s: from, to_m_s: to, count: draft ? CURVE.draft : CURVE.full };
  $("#curve").classList.toggle("stale", !draft);
  try {
    const curve = await ask("curve", { verb: "batch", text, speeds });
    Object.assign(state, { curve, speeds });
    if (state.reference) await drawReference(speeds);
    if (curve.tof_incident_s.every((time) => time === null)) {
      state.curve = null;
      state.curveWhy = curve.failed.length ? curve.failed[0][1] : "No times of flight: the chain has no wall at which a pulse could arrive.";
    }
  } catch (error) {
    if (error.stopped) return;
    state.curve = null;
    state.curveWhy = error.message;
  } finally {
    $("#curve").classList.remove("stale");
  }
  plots.drawCurve(state);
  drawTables();
  story.tell();
});

/** The reference's curve at the same speeds. */
async function drawReference(speeds) {
  const { reference } = state;
  const same = reference.curve && reference.from === speeds.from_m_s && reference.to === speeds.to_m_s;
  if (same) return;
  try {
    reference.curve = await ask("reference", { verb: "batch", text: reference.text, speeds: { ...speeds, count: CURVE.full } });
    Object.assign(reference, { from: speeds.from_m_s, to: speeds.to_m_s });
  } catch (error) {
    reference.curve = null;
    if (!error.stopped) toast(error.message);
  }
}

async function setReference(name) {
  if (name === "this row") {
    state.pinned = { name: "pinned", text: state.text };
    state.reference = state.pinned;
  } else {
    const preset = state.presets.find((one) => one.name === name);
    state.reference = name === "pinned" ? state.pinned : preset ? { name, text: preset.text } : null;
  }
  if (state.reference && state.speeds) await drawReference(state.speeds);
  if (!state.reference) setView("curveView", "tof");
  showReference();
  plots.drawCurve(state);
}

function showReference() {
  const options = [["", "no reference"], ["this row", "pin this row"], ...(state.pinned ? [["pinned", "pinned row"]] : []), ...state.presets.filter((one) => one.kind !== "campaign").map((one) => [one.name, one.name])];
  $("#reference").replaceChildren(...options.map(([value, text]) => html("option", { value }, text)));
  $("#reference").value = state.reference?.name ?? "";
}

function setView(key, value) {
  state[key] = value;
  const control = { curveScale: "#curve-scale", curveView: "#curve-view" }[key];
  if (control) $(control).value = value;
  if (key === "whole") $("#whole").checked = value;
}

// ---- Numbers as tiles and tables.

function drawTiles() {
  const { shot } = state;
  const of = units(state);
  const lost = shot.energy ? shot.energy.parts.filter(([name]) => !["kinetic", "elastic", "gravity", "preload", "stop"].includes(name)).reduce((sum, [, values]) => sum + values[values.length - 1], 0) / shot.energy.input_j : null;
  const pair = (value, unit, digits) => (of.scale === 1 ? [plain(value, digits), ""] : quantityParts(value, unit, digits));
  const tof = (value) => (value === null ? ["–", ""] : of.scale === 1 ? [plain(value, 6), ""] : [(value * 1e6).toFixed(2), "µs"]);
  const tiles = [
    ["Incident ToF", ...tof(shot.tof_incident_s), "incident"],
    ["Reflected ToF", ...tof(shot.tof_reflected_s), "reflected"],
    ["Wall force", ...pair(shot.wall?.value_n ?? null, "N", 4), "wall"],
    ["Pulse speed", ...(shot.pulse_speed_beads_s === null ? ["–", ""] : [plain(shot.pulse_speed_beads_s, 5), of.scale === 1 ? "" : "beads/s"])],
    ["Striker’s end speed", ...pair(shot.rebound_end_m_s ?? shot.rebound_first_m_s, "m/s", 3)],
    ["Energy lost", ...(lost === null ? ["–", ""] : [plain(Math.max(0, 100 * lost) < 1e-4 ? 0 : 100 * lost, 3), "%"])],
  ];
  $("#tiles").replaceChildren(...tiles.map(([name, value, unit, tint]) => {
    const dot = tint ? html("i", { "aria-hidden": "true" }) : null;
    if (dot) dot.style.background = `var(--${tint})`;
    return html("div", {}, [html("dt", {}, [dot, name]), html("dd", {}, [value, html("small", {}, unit)])]);
  }));
}

function table(caption, titles, rows) {
  const head = html("tr", {}, titles.map((title, at) => html("th", { scope: "col", class: at ? "n" : null }, title)));
  const body = rows.map((row) => html("tr", {}, row.map((cell, at) => html("td", { class: at ? "n" : null }, cell))));
  return html("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption }, html("table", {}, [html("caption", {}, caption), html("thead", {}, head), html("tbody", {}, body)]));
}

function drawTables() {
  const place = $("#tables");
  if (!place.parentElement.open || !state.shot) return;
  const { shot, motion, curve } = state;
  const of = units(state);
  const peaks = [["incident, sensor bead", shot.incident], ["wall", shot.wall], ["reflected, sensor bead", shot.reflected]].filter(([, peak]) => peak);
  const all = [table("Pulses", ["pulse", "time", "height", "width at half height"], peaks.map(([name, peak]) => [name, of.t(peak.time_s, 7), of.q(peak.value_n, "N", 5), peak.width_s === null ? "–" : of.t(peak.width_s, 5)]))];
  if (curve) all.push(table("Times of flight", ["speed", "incident", "reflected"], curve.speed_m_s.map((speed, at) => [of.q(speed, "m/s", 4), of.t(curve.tof_incident_s[at] ?? NaN, 7), of.t(curve.tof_reflected_s[at] ?? NaN, 7)])));
  if (motion) {
    const { moved, forces } = motion.state(state.time);
    all.push(table(`Bodies at t = ${of.t(state.time)}`, ["body", "displacement", "force behind it", "velocity at the end"], shot.bodies.map((body, at) => [`${body.number} ${body.kind}`, of.q(moved[at], "m", 4), at < forces.length ? of.q(forces[at], "N", 4) : "–", of.q(shot.velocity_m_s[body.number] ?? 0, "m/s", 4)])));
  }
  const budget = shot.energy?.parts.map(([name, values]) => [name.replaceAll("_", " "), of.q(values[values.length - 1], "J", 4), `${plain((100 * values[values.length - 1]) / shot.energy.input_j, 4)} %`]);
  if (budget) all.push(table("Energy at the end", ["part", "energy", "share"], budget));
  all.push(html("p", { class: "hint" }, `${shot.solver}; ${shot.force_passes} force passes; relative accuracy of times ${plain(shot.accuracy_reached, 2)}. ${shot.notes.join(" ")}`));
  place.replaceChildren(...all);
}

// ---- Time.

function setMagnify(asked) {
  const usual = state.motion?.usual() ?? 1;
  const options = [...new Set([1, 10, 50, 100, 200, 500, 1000, 2000, usual])].sort((a, b) => a - b);
  const select = $("#magnify");
  select.replaceChildren(...options.map((value) => html("option", { value }, value === usual ? `${value} (auto)` : String(value))));
  select.value = options.includes(asked) ? asked : usual;
}

function setTime(time) {
  const end = state.shot?.duration_s ?? 0;
  state.time = Math.min(end, Math.max(0, time));
  showTime();
}

/** Draws the row at the present time. */
const show = (canvas, size) => drawRow(canvas, state.motion, state.time, Number($("#magnify").value) || 1, units(state).q(state.motion.most, "N", 3), size);

function showTime() {
  const { motion, shot } = state;
  if (!motion) return;
  const of = units(state);
  const end = shownEnd();
  const seen = show($("#row"));
  const open = seen.open.filter(Boolean).length;
  $("#clock").textContent = `t = ${of.scale === 1 ? plain(state.time, 4) : `${(state.time * 1e6).toFixed(1)} µs`}`;
  const slider = $("#time");
  slider.value = (1000 * state.time) / end;
  slider.setAttribute("aria-valuetext", `${of.t(state.time)}, ${seen.front >= 0 ? `largest force in contact ${shot.bodies[0].number + seen.front}` : "no pulse"}, ${open} contacts open`);
  $("#row").setAttribute("aria-label", `The row of ${state.outline?.beads} beads at ${of.t(state.time)}: ${seen.front >= 0 ? `the pulse is at contact ${shot.bodies[0].number + seen.front}` : "no pulse"}, ${open} contacts are open`);
  plots.cursor(state.time, state);
}

/** The end of what the time slider spans. */
const shownEnd = () => (state.whole || !state.shot ? state.shot?.duration_s ?? 1 : interesting(state.shot));

function pace() {
  return Number($("#pace").value);
}

function play(on) {
  playing = on;
  $("#play").classList.toggle("on", on);
  $("#play").setAttribute("aria-label", on ? "Pause" : "Play");
  if (!on) return;
  if (state.time >= shownEnd() * 0.999) setTime(0);
  let last = null;
  const frame = (now) => {
    if (!playing) return;
    // A frame is a sixtieth of a second, whatever the screen's rate is.
    if (last !== null) setTime(state.time + pace() * Math.min(3, (now - last) / (1000 / 60)));
    last = now;
    if (state.time >= shownEnd()) return play(false);
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}

function setPaces() {
  const duration = state.outline?.dimensionless ? shownEnd() : null;
  const all = duration ? [duration / 5000, duration / 1000, duration / 300] : [0.1e-6, 0.2e-6, 0.5e-6, 1e-6, 2e-6, 5e-6, 10e-6, 20e-6];
  $("#pace").replaceChildren(...all.map((value) => html("option", { value }, duration ? plain(value, 2) : quantity(value, "s", 2).replace(/\.0(?= )/, ""))));
  $("#pace").value = duration ? all[1] : 2e-6;
}

// ---- Words for those who listen.

let spoken = 0;
function announce(text) {
  clearTimeout(spoken);
  spoken = setTimeout(() => ($("#live").textContent = text), 250);
}

function announceShot() {
  const { shot } = state;
  const of = units(state);
  announce(shot.tof_incident_s === null ? `Computed. ${shot.missing ?? "No time of flight."}` : `Computed: incident ${of.t(shot.tof_incident_s)}, reflected ${shot.tof_reflected_s === null ? "not seen" : of.t(shot.tof_reflected_s)}.`);
}

function toast(text) {
  const place = $("#toast");
  place.textContent = text;
  place.classList.add("on");
  setTimeout(() => place.classList.remove("on"), 3500);
}

// ---- Guided scenes.

/** Shows a row after edits as a step of a scene looks at it. */
async function showStep(preset, edits, view) {
  for (const key of ["curveScale", "curveView", "whole"]) if (view[key] !== undefined) setView(key, view[key]);
  const reference = state.presets.find((one) => one.name === view.reference);
  state.reference = reference ? { name: reference.name, text: reference.text } : null;
  showReference();
  play(false);
  form.forget();
  state.fresh = true;
  queued = { text: state.presets.find((one) => one.name === preset).text, edits, draft: false };
  await check();
}

// ---- Files, links.

async function take(files) {
  for (const file of files) {
    if (/\.toml$/i.test(file.name)) {
      if (file.size > 256 * 1024) toast(`${file.name} is longer than an experiment can be`);
      else await load(await file.text());
    } else {
      tab("fit");
      await fit.take(file);
    }
  }
}

/** Draws the row as a file has it: sharp, whatever the screen. */
function row(canvas) {
  const size = { width: 900, height: 190, ratio: 3 };
  show(canvas, size);
  return size;
}

function saved(what) {
  const name = slug(state.outline?.title ?? "row");
  const { shot, curve } = state;
  const all = () => figures(state, plots, row);
  const done = {
    toml: () => save(`${name}.toml`, state.text, "application/toml"),
    signals: () => {
      const { motion } = shot;
      const time_s = Array.from({ length: motion.samples }, (_, at) => Number((at * motion.interval_s).toPrecision(9)));
      save(`${name}-signals.csv`, csv({ time_s, sensor_n: motion.sensor, ...(motion.wall.length ? { wall_n: motion.wall } : {}) }), "text/csv");
    },
    curve: () => curve && save(`${name}-tof.csv`, csv({ speed_m_s: curve.speed_m_s, tof_incident_s: curve.tof_incident_s, tof_reflected_s: curve.tof_reflected_s }), "text/csv"),
    print: () => print(),
    svg: () => save(`${name}.svg`, all(), "image/svg+xml"),
    png: async () => save(`${name}.png`, await picture(all())),
    pdf: async () => save(`${name}.pdf`, await pdf(all())),
  }[what];
  return done?.();
}

async function copied(what) {
  if (what === "shell" || what === "python") {
    await copy(what === "shell" ? shell(state) : python(state));
    return toast(what === "shell" ? "The command lines are on the clipboard" : "The Python lines are on the clipboard");
  }
  const { text, whole, curveScale, curveView, time, pinned, data } = state;
  const table = data?.points?.length ? { name: data.name, table: data.table } : undefined;
  const fragment = await packed({ text, whole, curveScale, curveView, time, magnify: $("#magnify").value, reference: state.reference?.name, pinned: pinned?.text, data: table });
  history.replaceState(null, "", fragment);
  await copy(location.href);
  return toast(`The link is on the clipboard; for another machine, put its part from # behind the address of the explorer there${data?.examples ? ". The recording itself is not in it" : ""}`);
}

// ---- Controls of the page.

function tab(name) {
  for (const one of document.querySelectorAll("[role=tab]")) {
    const on = one.id === `tab-${name}`;
    one.setAttribute("aria-selected", on);
    one.tabIndex = on ? 0 : -1;
    $(`#${one.getAttribute("aria-controls")}`).hidden = !on;
  }
  if (name === "theory") theory();
}

async function theory() {
  try {
    const groups = await ask("theory", { verb: "theory", text: state.text });
    const value = (row) => (Array.isArray(row.value) ? row.value.map((one) => (typeof one === "object" ? `${one.name} ${value(one)}` : quantity(one, row.unit))).join(", ") : typeof row.value === "number" ? quantity(row.value, row.unit, 5) : formula(String(row.value)));
    const shown = (all) => all.map((group) => html("section", { class: "groupcard" }, [html("h3", {}, group.title), html("dl", { class: "pairs" }, group.rows.flatMap((row) => [html("dt", {}, formula(row.name)), html("dd", {}, value(row))]))]));
    $("#pane-theory").replaceChildren(...(groups.length ? shown(groups) : [html("p", { class: "hint" }, "No closed theory fits this chain: no striker, no preload.")]), html("h3", {}, "As understood"), ...shown(state.outline?.groups ?? []));
  } catch (error) {
    $("#pane-theory").replaceChildren(html("p", { class: "error" }, error.message));
  }
}

function showLaws() {
  $("#pane-laws").replaceChildren(...state.laws.map((law) => html("section", { class: "lawcard" }, [
    html("h3", {}, [law.name.replaceAll("_", " "), html("span", { class: "tag" }, law.nature)]),
    html("p", { class: "equation" }, formula(law.equation)),
    ...law.parameters.map((one) => html("p", { class: "source" }, `${one.name}${one.unit === "1" ? "" : ` in ${one.unit}`}: ${one.meaning}`)),
    html("p", { class: "source" }, `Valid for ${law.validity}.`),
    html("p", { class: "source" }, source(law)),
  ])));
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  try {
    localStorage.setItem("theme", name);
  } catch {
    // Without storage the choice lasts as long as the page.
  }
  if (state.shot) drawShot();
}

function bind() {
  $("#preset").addEventListener("change", (event) => load(state.presets.find((one) => one.name === event.target.value).text));
  $("#scene").addEventListener("change", (event) => story.begin(event.target.value));
  $("#open").addEventListener("click", () => $("#file").click());
  $("#file").addEventListener("change", (event) => take([...event.target.files]).then(() => (event.target.value = "")));
  $("#jump").addEventListener("click", () => {
    $(".side").scrollIntoView({ behavior: still.matches ? "auto" : "smooth" });
    $("[role=tab][aria-selected=true]").focus({ preventScroll: true });
  });
  $("#theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  for (const button of document.querySelectorAll("[data-save]")) button.addEventListener("click", () => closeMenus() ?? saved(button.dataset.save));
  for (const button of document.querySelectorAll("[data-copy]")) button.addEventListener("click", () => closeMenus() ?? copied(button.dataset.copy));
  $("#play").addEventListener("click", () => play(!playing));
  $("#back").addEventListener("click", () => play(false) ?? setTime(state.time - pace()));
  $("#forth").addEventListener("click", () => play(false) ?? setTime(state.time + pace()));
  $("#time").addEventListener("input", (event) => play(false) ?? setTime((event.target.value / 1000) * shownEnd()));
  $("#magnify").addEventListener("change", showTime);
  $("#whole").addEventListener("change", (event) => {
    state.whole = event.target.checked;
    drawShot();
  });
  $("#curve-view").addEventListener("change", async (event) => {
    setView("curveView", event.target.value);
    if (state.curveView === "ratio" && !state.reference) await setReference("dry");
    plots.drawCurve(state);
  });
  $("#curve-scale").addEventListener("change", (event) => {
    setView("curveScale", event.target.value);
    plots.drawCurve(state);
  });
  $("#reference").addEventListener("change", (event) => setReference(event.target.value));
  $(".numbers").addEventListener("toggle", drawTables);
  bindRow();
  bindText();
  bindTabs();
  bindFiles();
  document.addEventListener("keydown", keys);
  // A link of another row in the same tab changes the fragment alone.
  addEventListener("hashchange", () => location.hash.startsWith("#s=") && location.reload());
  document.addEventListener("click", (event) => event.target.closest(".menu") || closeMenus());
  new ResizeObserver(() => state.motion && showTime()).observe($("#row"));
}

function closeMenus() {
  for (const menu of document.querySelectorAll(".menu[open]")) {
    if (menu.contains(document.activeElement)) menu.querySelector("summary").focus();
    menu.open = false;
  }
}

/** Dragging along the row scrubs. */
function bindRow() {
  const row = $("#row");
  let from = null;
  row.addEventListener("pointerdown", (event) => {
    play(false);
    from = { x: event.clientX, time: state.time };
    row.setPointerCapture(event.pointerId);
  });
  row.addEventListener("pointermove", (event) => from && setTime(from.time + ((event.clientX - from.x) / row.clientWidth) * shownEnd()));
  for (const end of ["pointerup", "pointercancel"]) row.addEventListener(end, () => (from = null));
  row.addEventListener("keydown", (event) => {
    const by = { ArrowLeft: -1, ArrowRight: 1, PageDown: -20, PageUp: 20 }[event.key];
    if (!by) return;
    event.preventDefault();
    play(false);
    setTime(state.time + by * pace());
  });
}

function bindText() {
  const area = $("#text");
  let wait = 0;
  area.addEventListener("input", () => {
    showLines();
    clearTimeout(wait);
    wait = setTimeout(() => change([], { text: area.value }), 250);
  });
  area.addEventListener("scroll", () => ($("#lines").scrollTop = area.scrollTop));
  area.addEventListener("blur", () => {
    // Not once more later: what a control changes meanwhile would be undone.
    clearTimeout(wait);
    if (area.value !== state.text) change([], { text: area.value });
  });
}

function bindTabs() {
  const all = [...document.querySelectorAll("[role=tab]")];
  all.forEach((one, at) => {
    one.addEventListener("click", () => tab(one.id.slice(4)));
    one.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: all.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      const next = all[(to + all.length) % all.length];
      tab(next.id.slice(4));
      next.focus();
    });
  });
}

function bindFiles() {
  let depth = 0;
  const over = (by) => {
    depth = Math.max(0, depth + by);
    $("#drop").hidden = depth === 0;
  };
  addEventListener("dragenter", (event) => event.preventDefault() ?? over(1));
  addEventListener("dragleave", () => over(-1));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    depth = 0;
    over(0);
    take([...event.dataTransfer.files]);
  });
}

function keys(event) {
  if (event.key === "Escape") closeMenus();
  const typing = event.target.closest("input, select, textarea, button, summary, [role=tab]");
  if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.key === " ") {
    event.preventDefault();
    play(!playing);
  }
  if (event.key === "," || event.key === ".") {
    play(false);
    setTime(state.time + (event.key === "." ? 1 : -1) * pace());
  }
}

async function main() {
  let chosen = null;
  try {
    chosen = localStorage.getItem("theme");
  } catch {
    // As above.
  }
  document.documentElement.dataset.theme = chosen ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  plots = new Plots((time) => play(false) ?? setTime(time), announce);
  form = new Form($("#pane-controls"), (path, value, draft) => change([{ path, value: value === undefined ? null : value }], { draft }));
  fit = new Fit($("#pane-fit"), {
    state,
    announce,
    pickFile: () => $("#file").click(),
    change: (edits) => change(edits),
    setData: (data) => {
      if (data?.examples) for (const example of data.examples) example.channels = example.volts.map(decoded);
      // A table keeps the recording that lies over the signals, and a recording without speeds the table.
      const { examples, picks, points, table } = state.data ?? {};
      if (data?.kind === "table") data = { ...data, examples, picks };
      else if (data && !data.points?.length && points) data = { ...data, points, table };
      state.data = data;
      fit.show(state.tree);
      if (state.shot) plots.drawSignals(state);
      plots.drawCurve(state);
    },
  });
  story = new Story($("#story"), {
    state,
    show: showStep,
    ended: () => ($("#scene").value = ""),
    playFromStart: () => {
      if (still.matches) return;
      setTime(0);
      play(true);
    },
  });
  state.setSpeed = (speed) => change([{ path: ["striker", "speed"], value: state.outline?.dimensionless ? Number(speed.toPrecision(3)) : `${Number(speed.toPrecision(3))} m/s` }]);
  bind();
  setPaces();
  try {
    const [began, presets, schema, laws, link] = await Promise.all([start(), ask("presets", { verb: "presets" }), ask("schema", { verb: "schema" }), ask("laws", { verb: "laws" }), unpacked(location.hash)]);
    Object.assign(state, { presets, schema, laws });
    const groups = [["paper", "The paper’s rows"], ["example", "Other rows"], ["campaign", "Campaigns"]];
    $("#preset").append(html("option", { value: "" }, "a row of your own"), ...groups.map(([kind, label]) => html("optgroup", { label }, presets.filter((one) => one.kind === kind).map((one) => html("option", { value: one.name }, one.title)))));
    $("#scene").append(html("option", { value: "" }, "none"), ...SCENES.map((one) => html("option", { value: one.id }, one.title)));
    showLaws();
    showReference();
    if (link) {
      for (const key of ["whole", "curveScale", "curveView"]) if (link[key] !== undefined) setView(key, link[key]);
      if (typeof link.pinned === "string") state.pinned = { name: "pinned", text: link.pinned };
      await setReference(link.reference ?? "");
    }
    if (link) state.linked = { time: Number.isFinite(link.time) ? link.time : null, magnify: link.magnify };
    await load(link?.text ?? began.experiment ?? presets[0].text);
    if (typeof link?.data?.table === "string") await fit.takeText(String(link.data.name), link.data.table);
  } catch (error) {
    refuse(error);
  }
}

main();
