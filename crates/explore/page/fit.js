// Data and fit: recordings and tables in, parameters with errors out.

import { ask, cancel, encoded, progress } from "./engine.js";
import { Chart, colour, html } from "./charts.js";
import { plain, quantity, split, titled, typed, withError } from "./numbers.js";

/** Largest file that the page takes, in bytes. */
const LARGEST = 64 * 1024 * 1024;

/** The pane with data, free numbers and results. */
export class Fit {
  constructor(place, page) {
    this.place = place;
    this.page = page;
    this.ticked = new Set();
    this.file = null;
    this.options = { rate: "", channel: "", speed: "" };
    this.build();
  }

  build() {
    const option = (key, label, hint) => {
      const id = `option-${key}`;
      const input = html("input", { type: "text", id, placeholder: hint, onchange: (event) => {
        this.options[key] = event.target.value;
        if (this.file) this.measure();
      } });
      return html("div", { class: "field" }, [html("label", { for: id }, label), input]);
    };
    this.about = html("div", { "aria-live": "polite" });
    this.list = html("div", { class: "checks", role: "group", "aria-label": "Free numbers" });
    this.state = html("div", { "aria-live": "polite" });
    this.result = html("div");
    this.start = html("button", { type: "button", class: "primary", onclick: () => this.run() }, "Fit");
    this.stop = html("button", { type: "button", hidden: true, onclick: () => this.cancel() }, "Cancel");
    this.remove = html("button", { type: "button", hidden: true, onclick: () => this.clear() }, "Remove the data");
    this.place.replaceChildren(
      html("h3", {}, "Data"),
      html("p", { class: "hint" }, "Drop a recording (CSV of an oscilloscope, HDF5, TDMS, NPY, WAV) or a table of times of flight on the page, or open one. Without data, take some from this row’s own curve."),
      html("div", { class: "row" }, [html("button", { type: "button", onclick: () => this.page.pickFile() }, "Open a file…"), html("button", { type: "button", onclick: () => this.synthetic() }, "Noisy data of this row"), this.remove]),
      html("details", {}, [html("summary", {}, "Rate, channels, speed of a recording"), option("rate", "Sampling rate", "500 kHz"), option("channel", "Channels, by name or number", "1, 2"), option("speed", "Speed of the shot", "0.5 m/s")]),
      this.about,
      html("h3", {}, "Free numbers"),
      html("p", { class: "hint" }, "What is ticked is fitted to the data; all else stays as the experiment has it."),
      this.list,
      html("div", { class: "row" }, [this.start, this.stop]),
      this.state,
      this.result,
    );
  }

  /** Lists what can be free in an experiment. */
  show(tree) {
    const found = tree ? candidates(tree) : [];
    this.candidates = found;
    for (const name of this.ticked) if (!found.some((one) => one.name === name)) this.ticked.delete(name);
    if (!this.ticked.size && found.length) {
      const usual = found.find((one) => /damping_cubic/.test(one.name)) ?? found.find((one) => /young/.test(one.name)) ?? found[0];
      this.ticked.add(usual.name);
    }
    this.list.replaceChildren(...found.map((one) => html("label", {}, [html("input", { type: "checkbox", checked: this.ticked.has(one.name), onchange: (event) => (event.target.checked ? this.ticked.add(one.name) : this.ticked.delete(one.name)) }), one.label, html("small", {}, one.value)])));
    this.start.disabled = !this.page.state.data?.points?.length || this.busy;
  }

  /** Noise of a part in a thousand on eight speeds of the present curve: something to fit. */
  async synthetic() {
    const { text, outline } = this.page.state;
    if (!outline?.speed_m_s) return this.say("This row has no striker, and so no curve.");
    try {
      const curve = await ask("synthetic", { verb: "batch", text, speeds: { from_m_s: 0.1, to_m_s: 1.2, count: 9 } });
      let seed = 7;
      const uniform = () => ((seed = (seed * 16807) % 2147483647) / 2147483647);
      const normal = () => Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
      const rows = curve.speed_m_s.map((speed, at) => [speed, 1e-4, curve.tof_incident_s[at], curve.tof_reflected_s[at]]).filter((row) => row[2] && row[3]).map(([speed, error, there, back]) => [speed, error, there * (1 + 5e-4 * normal()), 5e-4 * there, back * (1 + 5e-4 * normal()), 5e-4 * back, 0]);
      if (!rows.length) return this.say("This row has no times of flight: its chain has no wall.");
      const table = `speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,tof_reflected_s_error,tof_correlation\n${rows.map((row) => row.join(",")).join("\n")}\n`;
      await this.takeText("noisy data of this row.csv", table);
    } catch (error) {
      this.say(error.message);
    }
  }

  /** Takes a file that was opened or dropped. */
  async take(file) {
    if (file.size > LARGEST) return this.say(`${file.name} has ${plain(file.size / 1e6, 3)} MB: the page takes up to 64 MB; hertzchain measure takes any size.`);
    this.file = { name: file.name, bytes: encoded(await file.arrayBuffer()) };
    return this.measure();
  }

  /** Takes a table of times of flight as a text. */
  takeText(name, table) {
    return this.take(new File([table], name));
  }

  async measure() {
    const { outline } = this.page.state;
    const options = {};
    if (outline?.has_wall) Object.assign(options, { beads: outline.beads, sensor: outline.sensor_bead });
    if (this.options.rate.trim()) options.rate = typed(this.options.rate);
    if (this.options.channel.trim()) options.channel = this.options.channel.split(",").map((one) => one.trim()).filter(Boolean);
    this.say(`Reading ${this.file.name} …`);
    try {
      const found = await ask("measure", { verb: "measure", ...this.file, options });
      const data = { name: this.file.name, ...found };
      if (found.kind === "recording") this.recorded(data);
      this.page.setData(data);
      this.remove.hidden = false;
      this.tell(data);
    } catch (error) {
      if (!error.stopped) this.say(error.message);
    }
  }

  recorded(data) {
    const { shots } = data.measured;
    const seen = shots.find((shot) => shot.incident);
    if (seen) data.picks = { incident: seen.incident, wall: seen.wall, reflected: seen.reflected };
    const speed = split(typed(this.options.speed));
    if (seen && speed && !data.points?.length) {
      const value = speed.value * ({ "mm/s": 1e-3, "cm/s": 1e-2 }[speed.unit] ?? 1);
      const estimate = (of) => (of ? [of.value, of.sigma] : null);
      const row = { speed_m_s: [value, 0], tof_incident_s: estimate(seen.tof_incident_s), tof_reflected_s: estimate(seen.tof_reflected_s) };
      const cells = Object.entries(row).filter(([, cell]) => cell).flatMap(([key, [mean, sigma]]) => [[key, mean], [key === "speed_m_s" ? "speed_error_m_s" : `${key}_error`, sigma]]);
      data.points = [row];
      data.table = [0, 1].map((line) => `${cells.map((cell) => cell[line]).join(",")}\n`).join("");
    }
  }

  tell(data) {
    if (data.kind === "table") {
      this.about.replaceChildren(html("p", { class: "hint" }, `${data.name}: ${data.points.length} speeds.`));
      return;
    }
    const { measured } = data;
    const lines = measured.shots.slice(0, 12).map((shot, at) => html("tr", {}, [
      html("td", {}, `${shot.file} ${shot.shot ?? at + 1}`),
      html("td", {}, shot.missing ?? `${withError(shot.tof_incident_s.value, shot.tof_incident_s.sigma, "s")}`),
      html("td", {}, shot.tof_reflected_s ? withError(shot.tof_reflected_s.value, shot.tof_reflected_s.sigma, "s") : "–"),
    ]));
    const head = html("tr", {}, ["Shot", "Incident", "Reflected"].map((name) => html("th", { scope: "col" }, name)));
    const notes = [...measured.notes.map((note) => note.note), ...measured.refused, ...measured.shots.flatMap((shot) => [].concat(shot.flags ?? []))];
    this.about.replaceChildren(
      html("table", { class: "result" }, [html("thead", {}, head), html("tbody", {}, lines)]),
      ...[...new Set(notes)].filter(Boolean).slice(0, 6).map((note) => html("p", { class: "hint" }, String(note))),
      ...(measured.shots.length && !data.points?.length ? [html("p", { class: "hint" }, "A fit needs the speed of the shot: type it above under “Speed of the shot”, or open a table of times against speed.")] : []),
      ...(measured.shots.length ? [] : [html("p", { class: "error" }, "No shot was found in it.")]),
    );
  }

  clear() {
    this.file = null;
    this.remove.hidden = true;
    this.about.replaceChildren();
    this.result.replaceChildren();
    this.page.setData(null);
  }

  /** Another row is shown: results were of the one before. */
  forget() {
    this.result.replaceChildren();
    this.state.replaceChildren();
  }

  say(text) {
    this.about.replaceChildren(html("p", { class: "error" }, text));
  }

  async run() {
    const { state } = this.page;
    if (!state.data?.points?.length || this.busy) return;
    const free = [...this.ticked];
    if (!free.length) return this.state.replaceChildren(html("p", { class: "error" }, "Tick at least one number."));
    this.working(true);
    const shown = html("progress", { "aria-label": "The fit is running" });
    const words = html("p", { class: "hint" }, "Fitting …");
    this.state.replaceChildren(shown, words);
    const watch = setInterval(async () => {
      const now = await progress("fit").catch(() => null);
      if (now) words.textContent = now.note || `Fitting … ${now.done} shots computed`;
    }, 400);
    try {
      const found = await ask("fit", { verb: "fit", text: state.text, table: state.data.table, options: { free } });
      this.state.replaceChildren();
      this.present(found);
    } catch (error) {
      this.state.replaceChildren(html("p", { class: error.stopped ? "hint" : "error" }, error.stopped ? "The fit was cancelled." : error.message));
    } finally {
      clearInterval(watch);
      this.working(false);
    }
  }

  working(busy) {
    this.busy = busy;
    this.start.disabled = busy || !this.page.state.data?.points?.length;
    this.stop.hidden = !busy;
    if (busy) this.stop.focus();
    else if (document.activeElement === document.body) this.start.focus();
  }

  cancel() {
    cancel("fit");
  }

  /** What a parameter is called where it is ticked; a prefactor or an exponent comes after it. */
  label(name) {
    const of = this.candidates.find((one) => name === one.name || name.startsWith(`${one.name}.`));
    return of ? `${of.label}${name.slice(of.name.length).replace(".", ", ")}` : name.replaceAll("_", " ");
  }

  present(found) {
    const { parameters, correlation, chi_square: chi } = found;
    const label = (at) => `${at + 1} ${this.label(parameters[at].name)}`;
    const rows = parameters.map((one, at) => html("tr", {}, [
      html("th", { scope: "row" }, label(at)),
      html("td", {}, one.determined ? withError(one.value, one.standard_error, one.unit === "1" ? "" : one.unit) : `${quantity(one.value, one.unit === "1" ? "" : one.unit)}, not determined`),
    ]));
    const head = (names) => html("thead", {}, html("tr", {}, names.map((name) => html("th", { scope: "col" }, name))));
    const parts = [html("h3", {}, "Result"), html("table", { class: "result" }, [head(["Number", "Value ± error"]), html("tbody", {}, rows)])];
    if (chi) parts.push(html("p", { class: "hint" }, `χ² = ${plain(chi.value, 4)} at ${chi.freedom} degrees of freedom, p = ${plain(chi.probability, 3)}: the model ${found.follows_data ? "follows" : "does not follow"} the data.`));
    for (const one of found.not_determined ?? []) parts.push(html("p", { class: "error" }, `Not determined: ${one.words}`));
    for (const words of found.would_separate ?? []) parts.push(html("p", { class: "hint" }, words));
    if (parameters.length > 1) {
      const body = correlation.map((row, at) => html("tr", {}, [html("th", { scope: "row" }, label(at)), ...row.map((value) => html("td", { class: "n" }, value === null ? "–" : plain(value, 3)))]));
      parts.push(html("h3", {}, "Correlation"), html("table", { class: "result" }, [head(["Number", ...parameters.map((_, at) => String(at + 1))]), html("tbody", {}, body)]));
    }
    const plot = html("div", { class: "plot" });
    parts.push(html("h3", {}, "Residuals"), plot, html("div", { class: "row" }, html("button", { type: "button", onclick: () => this.adopt(found) }, "Use these values in the experiment")));
    this.result.replaceChildren(...parts);
    this.residuals(plot, found.residuals);
    this.page.announce(`The fit has ended: ${parameters.map((one) => `${this.label(one.name)} ${withError(one.value, one.standard_error ?? 0, one.unit)}`).join(", ")}`);
  }

  residuals(plot, residuals) {
    const chart = new Chart(plot, "Residuals of the fit in standard errors");
    const kinds = [["incident", "tof_incident_s", false], ["reflected", "tof_reflected_s", true]];
    const series = kinds.map(([name, key, square]) => {
      const rows = residuals.filter((row) => row[key]);
      return { name, points: true, square, colour: colour(name), x: rows.map((row) => row.speed_m_s), y: rows.map((row) => row[key][0] / row[key][1]), errors: rows.map(() => 1) };
    });
    const all = residuals.map((row) => row.speed_m_s);
    series.unshift({ name: "0", quiet: true, x: [Math.min(...all), Math.max(...all)], y: [0, 0], colour: colour("soft"), width: 1, dash: "4 4" });
    chart.draw({ x: { label: "speed in m/s", log: true }, y: { label: "residual in σ" }, series });
  }

  /** Puts the fitted values where the experiment has these numbers. */
  adopt(found) {
    const edits = [];
    for (const place of found.places) {
      const parameter = found.parameters.find((one) => one.name === place.name);
      const path = place.path && steps(place.path, this.page.state.tree);
      if (!parameter || !path) continue;
      const value = Number(parameter.value.toPrecision(7));
      edits.push({ path, value: parameter.unit && parameter.unit !== "1" ? `${value} ${parameter.unit}` : value });
    }
    if (edits.length) this.page.change(edits);
  }
}

/** Keys and indices of a path such as `contacts[1].laws.damping_cubic.coefficient`. */
export function steps(path, tree) {
  const words = path.split(".").flatMap((word) => {
    const found = /^(.*?)((?:\[\d+\])*)$/.exec(word);
    return [found[1], ...[...found[2].matchAll(/\[(\d+)\]/g)].map((one) => Number(one[1]))];
  });
  const all = [];
  let value = tree;
  for (const word of words) {
    let step = word;
    if (Array.isArray(value) && typeof word === "string") step = value.findIndex((one) => one === word || one?.law === word);
    if (step === -1) return null;
    if (typeof value === "string") return null;
    all.push(step);
    value = value?.[step];
  }
  return all;
}

/** Numbers of an experiment that a fit can free. */
function candidates(tree) {
  const found = [];
  const shown = (value) => (typeof value === "object" ? `${value.prefactor} · v^${value.exponent}` : String(value));
  for (const [material, of] of Object.entries(tree.materials ?? {})) {
    for (const key of ["young_modulus", "poisson_ratio", "shear_viscosity"]) {
      if (of[key] !== undefined) found.push({ name: `materials.${material}.${key}`, label: `${titled(key)} of ${material}`, value: shown(of[key]) });
    }
  }
  (tree.contacts ?? []).forEach((section, at) => {
    for (const law of section.laws ?? []) {
      if (typeof law !== "object") continue;
      for (const [key, value] of Object.entries(law)) {
        if (key === "law" || key === "contact" || !split(value)) continue;
        found.push({ name: `contacts[${at}].laws.${law.law}.${key}`, label: `${titled(key)} of ${law.law.replaceAll("_", " ")}${tree.contacts.length > 1 ? `, section ${at + 1}` : ""}`, value: shown(value) });
      }
    }
  });
  for (const [path, value] of [["track.incline", tree.track?.incline], ["near_end.force", tree.near_end?.force]]) {
    if (value !== undefined) found.push({ name: path, label: titled(path.replace(".", ": ")), value: String(value) });
  }
  return found;
}
