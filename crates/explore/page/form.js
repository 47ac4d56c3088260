// Controls for everything that an experiment file knows, made from its JSON Schema.

import { formula, html } from "./charts.js";
import { brief, split, titled, typed } from "./numbers.js";

/** Tables in the order in which a row is thought of; what is not named here comes after. */
const ORDER = ["striker", "beads", "contacts", "materials", "near_end", "far_end", "gaps", "track", "suspension", "driven", "initial", "sensors", "reading", "solver", "tension", "liquid", "units", "title", "rig", "campaign"];

/** Tables whose numbers have sliders, and those that are open at first. */
const SLIDERS = new Set(["striker", "beads", "contacts", "materials", "near_end", "far_end", "gaps", "track", "suspension", "driven", "initial"]);
const OPEN = new Set(["striker", "beads", "contacts", "materials", "near_end", "gaps"]);

/** What a new value starts with, where the schema's example would be out of scale. */
const SUGGESTED = {
  gap: "10 um", incline: "0.5 deg", length: "150 mm", duration: "3 ms", displacement: "1 um", velocity: "0.1 m/s", amplitude: "1 um",
  frequency: "5 kHz", radius: "6.35 mm", mass: "8.54 g", density: "7960 kg/m^3", radius_ratio: 0.95, accuracy: "1e-8", step: "0.2 us", repeat: 10, from: 0,
};
const SUGGESTED_LAWS = {
  elastic_power: { stiffness: "2.5e12 N/m^2", exponent: 2 }, elastic_plastic_thornton: { yield_pressure: "1.6 GPa" },
  damping_cubic: { coefficient: "77 kg s/m^2" }, damping_cubic_ungated: { coefficient: "77 kg s/m^2" },
  damping_kuwabara_kono: { coefficient: "4000 N s/m^(3/2)" }, damping_tsuji: { damping_ratio: 0.02 }, damping_linear: { coefficient: "2 N s/m" },
  damping_power: { coefficient: "2 N s/m", overlap_exponent: 0, rate_exponent: 1 }, elastic_hertz: { stiffness: "8.8e9 N/m^(3/2)" },
  damping_viscoelastic: { relaxation_time: "0.34 us" }, damping_brilliantov_1996: { relaxation_time: "0.34 us" },
};

const keyOf = (path) => JSON.stringify(path);
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);

/** Keys that have no place beside another one. */
const WITHOUT = { cell: ["count", "mass", "material", "radius", "radius_ratio"], striker: ["driven"], driven: ["striker"] };

/** A mistake as one sentence. */
export const sentence = (mistake) => `${mistake.message}: ${mistake.expected}${mistake.help ? ` (${mistake.help})` : ""}`;

/** The kind of control that a place of the schema needs. */
function kind(schema, value) {
  if (schema.oneOf && schema.oneOf[0].properties) return "variant";
  if (schema.anyOf) return isObject(value) ? "power" : "number";
  if (schema.enum) return "choice";
  const types = [].concat(schema.type ?? []);
  if (types.includes("boolean")) return "flag";
  if (types.includes("array")) return schema.items?.type === "integer" || schema.items?.type === "number" ? "list" : "members";
  if (types.includes("object")) return "table";
  if (schema.pattern || types.includes("integer") || types.includes("number")) return "number";
  return "text";
}

/** The schema of a variant that a value has, by the one key whose value is fixed. */
function variant(schema, value) {
  const fixed = (one) => Object.entries(one.properties).find(([, of]) => of.const !== undefined);
  const [key] = fixed(schema.oneOf[0]) ?? ["kind"];
  const found = schema.oneOf.find((one) => fixed(one)?.[1].const === value?.[key]) ?? schema.oneOf[0];
  return { key, found, names: schema.oneOf.map((one) => fixed(one)?.[1].const) };
}

export class Form {
  /** `edit(path, value, draft)` changes the experiment; no value removes. */
  constructor(place, edit) {
    this.place = place;
    this.edit = edit;
    this.fields = new Map();
    this.bases = new Map();
    this.opened = new Map();
    this.count = 0;
    place.addEventListener("toggle", (event) => event.target.dataset.group && this.opened.set(event.target.dataset.group, event.target.open), true);
  }

  /** Sliders start anew: another row is shown. */
  forget() {
    this.bases.clear();
    this.signature = null;
  }

  /** Shows a tree; where its shape is as before, only values change and what is typed in stays. */
  show(tree, schema, laws, mistakes) {
    if (!tree) return;
    Object.assign(this, { tree, schema: tree.units === "dimensionless" ? schema.then ?? schema : schema.else ?? schema, laws });
    const signature = shape(tree);
    if (signature !== this.signature) {
      this.signature = signature;
      this.build();
    }
    for (const field of this.fields.values()) field.update();
    this.mark(mistakes);
  }

  build() {
    const active = this.place.contains(document.activeElement) ? document.activeElement : null;
    const { path: focused, stay } = active?.dataset ?? {};
    const within = active?.closest("[data-group]")?.dataset.group;
    const end = this.place.scrollTop;
    this.fields.clear();
    const keys = [...new Set([...ORDER, ...Object.keys(this.tree)])].filter((key) => this.tree[key] !== undefined && this.schema.properties[key]);
    const groups = keys.map((key) => this.group(key));
    this.place.replaceChildren(...groups, this.adder([], this.schema, this.tree, "Add to the experiment…"));
    this.place.scrollTop = end;
    if (!active) return;
    // What had the focus may be gone: its table's heading is near.
    const near = [focused && `[data-path="${CSS.escape(focused)}"]`, stay && `[data-stay="${CSS.escape(stay)}"]`, within && `[data-group="${within}"] > summary`, "summary"];
    near.filter(Boolean).map((one) => this.place.querySelector(one)).find(Boolean)?.focus({ preventScroll: true });
  }

  group(key) {
    const schema = this.schema.properties[key];
    const value = this.tree[key];
    const open = this.opened.get(key) ?? OPEN.has(key);
    const summary = html("summary", {}, [titled(key), html("small", { title: schema.description ?? "" }, schema.description ?? "")]);
    const whole = ["table", "members", "variant"].includes(kind(schema, value)) && !["beads", "contacts", "materials"].includes(key);
    const remove = whole ? html("button", { type: "button", class: "plain", onclick: () => this.edit([key], undefined) }, `Remove ${titled(key).toLowerCase()}`) : null;
    return html("details", { class: "group", "data-group": key, open, "aria-label": titled(key) }, [summary, ...this.controls([key], schema, value, SLIDERS.has(key)), remove].filter(Boolean));
  }

  /** Controls of a value, by the kind of its place. */
  controls(path, schema, value, sliders) {
    switch (kind(schema, value)) {
      case "table":
        return this.table(path, schema, value, sliders);
      case "members":
        return path[path.length - 1] === "laws" ? this.lawList(path, value) : this.members(path, schema, value, sliders);
      case "variant": {
        const { key, found, names } = variant(schema, value);
        const choose = (name) => {
          const next = schema.oneOf[names.indexOf(name)];
          const same = Object.fromEntries(Object.entries(value).filter(([of]) => next.properties[of] && of !== key));
          this.edit(path, { ...this.fresh(next), ...same, [key]: name });
        };
        return [this.choice([...path, key], names, () => this.at(path)?.[key], choose, titled(key)), ...this.table(path, found, value, sliders, key)];
      }
      default:
        return [this.field(path, schema, sliders)];
    }
  }

  table(path, schema, value, sliders, without) {
    const free = isObject(schema.additionalProperties) ? schema.additionalProperties : null;
    const known = Object.keys(value).filter((key) => key !== without && (schema.properties?.[key] || free));
    const parts = known.flatMap((key) => {
      const inner = [...path, key];
      const of = schema.properties?.[key] ?? free;
      if (["table", "members", "variant", "power"].includes(kind(of, value[key]))) return [this.member(inner, free ? key : titled(key), this.deep(inner, of, value[key], sliders), !(schema.required ?? []).includes(key))];
      return [this.field(inner, of, sliders, !(schema.required ?? []).includes(key))];
    });
    if (free) parts.push(this.namer(path, free));
    else if (schema.properties) parts.push(this.adder(path, schema, value, "Add…", without));
    return parts;
  }

  deep(path, schema, value, sliders) {
    if (kind(schema, value) !== "power") return this.controls(path, schema, value, sliders);
    const power = schema.anyOf.find((one) => one.type === "object");
    const constant = html("button", { type: "button", onclick: () => this.edit(path, value.prefactor) }, "Make it constant");
    return [html("p", { class: "source" }, power.description), ...Object.keys(power.properties).map((key) => this.field([...path, key], power.properties[key], sliders)), constant];
  }

  member(path, title, children, removable = true) {
    const remove = removable && this.remover(path, title);
    return html("section", { class: "member", role: "group", "aria-label": title }, [html("header", {}, [html("span", {}, title), remove || null]), ...children]);
  }

  remover(path, title) {
    return html("button", { type: "button", class: "plain drop", title: `Remove ${title}`, "aria-label": `Remove ${title}`, onclick: () => this.edit(path, undefined) }, "×");
  }

  members(path, schema, value, sliders) {
    const name = { beads: "Group", contacts: "Section", gaps: "Gap", initial: "Bead", cell: "Bead of the cell", cases: "Case" }[path[path.length - 1]] ?? "Entry";
    const parts = value.map((one, at) => this.member([...path, at], `${name} ${at + 1}`, this.controls([...path, at], schema.items, one, sliders), value.length > 1 || path.length > 1 || path[0] === "gaps" || path[0] === "initial"));
    const copy = () => this.edit([...path, value.length], value.length ? { ...value[value.length - 1] } : this.fresh(schema.items));
    parts.push(html("div", { class: "add" }, html("button", { type: "button", onclick: copy }, `Add a ${name.toLowerCase()}`)));
    return parts;
  }

  /** Laws whose forces add, each with its equation and source. */
  lawList(path, value) {
    const names = this.laws.map((law) => law.name);
    const parts = value.map((entry, at) => {
      const name = typeof entry === "string" ? entry : entry.law;
      const law = this.laws.find((one) => one.name === name);
      const here = [...path, at];
      const choose = (other) => this.edit(here, this.law(other));
      const select = html("select", { "aria-label": `Law ${at + 1}`, "data-path": keyOf(here), onchange: (event) => choose(event.target.value) }, names.map((one) => html("option", { value: one, selected: one === name }, one.replaceAll("_", " "))));
      const header = html("header", {}, [select, this.remover(here, name)]);
      const given = typeof entry === "string" ? {} : entry;
      const fields = (law?.parameters ?? []).filter((one) => given[one.name] !== undefined).map((one) =>
        this.field([...here, one.name], { pattern: "1", type: one.unit === "1" ? ["string", "number"] : "string", description: one.meaning }, true, !one.required));
      const absent = (law?.parameters ?? []).filter((one) => given[one.name] === undefined);
      const add = absent.length ? this.select("Set…", absent.map((one) => [one.name, `${one.name.replaceAll("_", " ")}: ${one.meaning}`]), (key) => this.edit(here, { law: name, ...given, [key]: this.suggested(name, key) })) : null;
      return html("section", { class: "law", role: "group", "aria-label": name.replaceAll("_", " ") }, [header, html("p", { class: "equation" }, formula(law?.equation ?? "")), ...fields, add, html("p", { class: "source" }, source(law))]);
    });
    const present = new Set(value.map((entry) => entry.law ?? entry));
    parts.push(this.select("Add a law…", this.laws.filter((law) => !present.has(law.name)).map((law) => [law.name, `${law.name.replaceAll("_", " ")} (${law.nature})`]), (name) => this.edit([...path, value.length], this.law(name))));
    return parts;
  }

  law(name) {
    const law = this.laws.find((one) => one.name === name);
    const required = (law?.parameters ?? []).filter((one) => one.required);
    if (!required.length) return name;
    return { law: name, ...Object.fromEntries(required.map((one) => [one.name, this.suggested(name, one.name)])) };
  }

  /** A first value for a law's parameter. */
  suggested(name, parameter) {
    const { unit } = this.laws.find((law) => law.name === name).parameters.find((one) => one.name === parameter);
    return SUGGESTED_LAWS[name]?.[parameter] ?? (parameter === "stiffness" ? SUGGESTED_LAWS.elastic_hertz.stiffness : unit === "1" ? 1 : `1 ${unit}`);
  }

  select(title, options, choose, name = title) {
    const list = html("select", { "aria-label": name, "data-stay": name, title: "Arrow keys choose, Enter adds" }, [html("option", { value: "" }, title), ...options.map(([value, text]) => html("option", { value }, text))]);
    // Arrow keys change a closed list step by step: what they pass is not meant.
    let keyed = false;
    const add = () => list.value && choose(list.value);
    list.addEventListener("pointerdown", () => (keyed = false));
    list.addEventListener("change", () => keyed || add());
    list.addEventListener("keydown", (event) => {
      keyed = event.key !== "Enter";
      if (keyed || !list.value) return;
      event.preventDefault();
      add();
    });
    return html("div", { class: "add" }, list);
  }

  adder(path, schema, value, title, without) {
    const barred = new Set([without, ...Object.keys(value).flatMap((key) => WITHOUT[key] ?? []), ...(value.cell ? [] : ["repeat"])]);
    const absent = Object.entries(schema.properties).filter(([key, of]) => value[key] === undefined && !barred.has(key) && of.const === undefined);
    if (!absent.length) return null;
    const add = (key) => (key === "cell" ? this.edit(path, dimer(value)) : this.edit([...path, key], this.fresh(schema.properties[key], key)));
    const where = path.map((step) => (Number.isInteger(step) ? step + 1 : titled(step))).join(" ");
    return this.select(title, absent.map(([key, of]) => [key, `${key.replaceAll("_", " ")}: ${(of.description ?? "").split(/; default|, in |, from /)[0]}`.slice(0, 90)]), add, where ? `Add to ${where}` : title);
  }

  /** Adds an entry with a name of the user's choice: a material. */
  namer(path, schema) {
    const name = html("input", { type: "text", "aria-label": "Name of a new material", placeholder: "name" });
    const add = () => name.value.trim() && this.edit([...path, name.value.trim()], this.fresh(schema));
    return html("div", { class: "add" }, [name, html("button", { type: "button", onclick: add }, "Add")]);
  }

  /** A first value for a place of the schema. */
  fresh(schema, key) {
    if (key && SUGGESTED[key] !== undefined && !schema.oneOf && schema.type !== "object") return SUGGESTED[key];
    if (schema.anyOf) return this.fresh(schema.anyOf[0], key);
    if (schema.oneOf?.[0].properties) return this.fresh(schema.oneOf[0]);
    if (schema.const !== undefined) return schema.const;
    if (schema.enum) return schema.enum[0];
    const types = [].concat(schema.type ?? []);
    if (types.includes("object")) {
      const required = schema.required ?? [];
      return Object.fromEntries(required.map((of) => [of, this.fresh(schema.properties[of], of)]));
    }
    if (types.includes("array")) {
      if (key === "laws") return ["elastic_hertz"];
      return schema.items?.type === "integer" ? [Math.max(1, schema.items.minimum ?? 1)] : [{ ...this.fresh(schema.items), ...(key === "gaps" ? { contact: this.within(10), gap: SUGGESTED.gap } : {}), ...(key === "initial" ? { bead: 1, velocity: SUGGESTED.velocity } : {}) }];
    }
    if (types.includes("boolean")) return true;
    if (types.includes("integer")) return Math.max(1, schema.minimum ?? 1);
    if (key === "material") return Object.keys(this.tree.materials ?? { steel: 0 })[0];
    if (schema.examples) return schema.examples[0];
    if (/poisson/i.test(`${key}${schema.description}`)) return 0.3;
    return types.includes("number") ? 1 : "name";
  }

  /** A contact's number that the row has. */
  within(contact) {
    const beads = (this.tree.beads ?? []).map((one) => one.count ?? (one.cell?.length ?? 1) * (one.repeat ?? 1));
    return Math.max(1, Math.min(contact, beads.reduce((all, one) => all + one, 0) - 1));
  }

  at(path) {
    return path.reduce((value, step) => (typeof value === "string" ? undefined : value?.[step]), this.tree);
  }

  /** One value: label, input, slider, and the program's words where it refuses it. */
  field(path, schema, sliders, removable = true) {
    const what = kind(schema, this.at(path));
    const key = String(path[path.length - 1]);
    if (what === "choice") return this.choice(path, schema.enum, () => this.at(path), (value) => this.edit(path, value), titled(key), removable, schema);
    if (what === "flag") return this.flag(path, titled(key), removable, schema);
    if (what === "text" && /name of a material/.test(schema.description ?? "")) {
      return this.choice(path, Object.keys(this.tree.materials ?? {}), () => this.at(path), (value) => this.edit(path, value), titled(key), removable);
    }
    const text = () => {
      const value = this.at(path);
      return Array.isArray(value) ? value.join(", ") : isObject(value) || value === undefined ? "" : String(value);
    };
    const id = `field-${++this.count}`;
    const input = html("input", { type: "text", id, "data-path": keyOf(path), value: text(), autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-error`, inputmode: what === "text" ? undefined : "text" });
    input.addEventListener("change", () => this.edit(path, parsed(input.value, what, schema)));
    input.addEventListener("keydown", (event) => what === "number" && this.nudge(event, path, input, schema));
    const range = sliders && what === "number" ? this.range(path, schema, titled(key)) : null;
    const update = () => {
      if (document.activeElement !== input) input.value = text();
      range?.update();
    };
    return this.frame(path, { id, label: titled(key), schema, control: input, range: range?.element, removable, update });
  }

  frame(path, { id, label, schema, control, range, removable, update }) {
    const description = (schema?.description ?? "").split(/; default|, in |, from |, between /)[0];
    const small = description && !description.toLowerCase().startsWith(label.toLowerCase()) ? html("small", {}, description) : null;
    const error = html("div", { class: "error", id: `${id}-error`, hidden: true });
    const remove = removable ? this.remover(path, label) : html("span");
    const frame = html("div", { class: "field" }, [html("label", { for: id, title: schema?.description ?? "" }, [label, small]), control, remove, range ?? null, error]);
    this.fields.set(keyOf(path), { update, frame, control, error });
    return frame;
  }

  choice(path, options, get, choose, label, removable = false, schema = null) {
    const id = `field-${++this.count}`;
    const select = html("select", { id, "data-path": keyOf(path), "aria-describedby": `${id}-error`, onchange: (event) => choose(event.target.value) }, options.map((one) => html("option", { value: one }, one)));
    const update = () => {
      if (!options.includes(get()) && get() !== undefined && ![...select.options].some((one) => one.value === get())) select.append(html("option", { value: get() }, String(get())));
      select.value = get();
    };
    return this.frame(path, { id, label, schema, control: select, removable, update });
  }

  flag(path, label, removable, schema) {
    const id = `field-${++this.count}`;
    const box = html("input", { type: "checkbox", id, "data-path": keyOf(path), "aria-describedby": `${id}-error`, onchange: (event) => this.edit(path, event.target.checked) });
    return this.frame(path, { id, label, schema, control: box, removable, update: () => (box.checked = this.at(path) === true) });
  }

  /** Arrow keys in a number's input change it by a hundredth, whole numbers by one. */
  nudge(event, path, input, schema) {
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    const found = direction && split(typed(input.value));
    if (!found) return;
    event.preventDefault();
    const whole = [].concat(schema.type).includes("integer");
    const step = whole ? 1 : (event.shiftKey ? 0.1 : 0.01) * (Math.abs(found.value) || 1);
    const next = whole ? found.value + direction : brief(found.value + direction * step);
    input.value = found.unit ? `${next} ${found.unit}` : String(next);
    this.edit(path, parsed(input.value, "number", schema));
  }

  /** A slider about the value that the row came with: factors, whole numbers, or shares. */
  range(path, schema, label) {
    const found = () => split(this.at(path) ?? "");
    const start = found();
    if (!start) return null;
    const key = keyOf(path);
    if (!this.bases.has(key)) this.bases.set(key, start.value);
    const base = this.bases.get(key);
    const whole = [].concat(schema.type).includes("integer");
    const name = String(path[path.length - 1]);
    const linear = whole || base <= 0 || /ratio|exponent/.test(name);
    let [from, to] = whole ? [schema.minimum ?? 1, Math.max(60, 3 * base)] : linear ? [0, base > 0 ? Math.max(1.5 * base, name === "poisson_ratio" ? 0.49 : 0) : 1] : [base / 5, base * 5];
    if (name === "contact" || name === "bead" || name === "from" || name === "to") to = Math.max(40, 2 * base);
    if (name === "poisson_ratio" && base <= 0.49) to = 0.49;
    if (linear && base < 0) [from, to] = [2 * base, -2 * base];
    const slider = html("input", { type: "range", class: "range", min: 0, max: 1000, step: whole ? 1000 / Math.max(1, to - from) : 1, "aria-label": `${label}, slider` });
    const value = () => {
      const share = slider.value / 1000;
      const next = linear ? from + share * (to - from) : from * (to / from) ** share;
      return whole ? Math.round(next) : Number(brief(next, 3));
    };
    const send = (draft) => {
      const unit = found()?.unit ?? start.unit;
      const next = value();
      slider.setAttribute("aria-valuetext", unit ? `${next} ${unit}` : String(next));
      this.edit(path, unit ? `${next} ${unit}` : next, draft);
    };
    slider.addEventListener("input", () => send(true));
    slider.addEventListener("change", () => send(false));
    const update = () => {
      const now = found();
      if (!now || document.activeElement === slider) return;
      const share = linear ? (now.value - from) / (to - from) : Math.log(now.value / from) / Math.log(to / from);
      slider.value = 1000 * share;
      slider.setAttribute("aria-valuetext", String(this.at(path)));
    };
    return { element: slider, update };
  }

  /** Puts each mistake at its field; returns those that have none. */
  mark(mistakes) {
    for (const { frame, error, control } of this.fields.values()) {
      frame.classList.remove("wrong");
      control.removeAttribute("aria-invalid");
      error.hidden = true;
    }
    for (const mistake of mistakes) {
      const found = [...mistake.path.keys()].map((at) => this.fields.get(keyOf(mistake.path.slice(0, mistake.path.length - at)))).find(Boolean);
      if (!found) continue;
      found.frame.classList.add("wrong");
      found.control.setAttribute("aria-invalid", "true");
      found.error.textContent = sentence(mistake);
      found.error.hidden = false;
      for (let parent = found.frame.closest("details"); parent; parent = parent.parentElement.closest("details")) parent.open = true;
    }
  }
}

/** A group of equal beads as one whose beads alternate, at first alike. */
function dimer({ count, radius, mass, material }) {
  const bead = { radius: radius ?? SUGGESTED.radius, ...(mass && { mass }), ...(material && { material }) };
  return { cell: [bead, bead], repeat: Math.max(1, Math.round((count ?? 2) / 2)) };
}

/** What is typed as the file has it: numbers as numbers where the schema takes them. */
function parsed(text, what, schema) {
  const clean = what === "number" ? typed(text) : text.trim();
  const types = [].concat(schema.type ?? schema.anyOf?.[0].type ?? []);
  if (what === "list") return clean.split(/[\s,;]+/).filter(Boolean).map((one) => (Number.isFinite(Number(one)) ? Number(one) : one));
  const bare = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(clean);
  return what === "number" && bare && (types.includes("number") || types.includes("integer")) ? Number(clean) : clean;
}

/** The shape of a tree: all but the values of its numbers and texts. */
function shape(value) {
  if (Array.isArray(value)) return value.every((one) => !isObject(one)) && typeof value[0] !== "string" ? "[]" : `[${value.map((one) => (typeof one === "string" ? one : shape(one))).join()}]`;
  if (!isObject(value)) return typeof value === "boolean" ? "?" : "·";
  return `{${Object.entries(value).map(([key, one]) => `${key}:${["kind", "push", "motion", "law", "units"].includes(key) ? one : shape(one)}`).join()}}`;
}

/** Where a law comes from. */
export function source(law) {
  const work = law?.source;
  if (!work) return law?.reference ?? "";
  return `${work.authors.join("; ")}: ${work.title}. ${[work.journal, work.volume, work.pages].filter(Boolean).join(" ")}${work.year ? ` (${work.year})` : ""}`;
}
