// Line charts as SVG: axes, series, error bars, marks, a cursor and a reading under the pointer.

import { logTicks, plain, ticks } from "./numbers.js";

const NAMESPACE = "http://www.w3.org/2000/svg";

/** An SVG element. */
export function svg(name, attributes = {}, children = []) {
  const element = document.createElementNS(NAMESPACE, name);
  for (const [key, value] of Object.entries(attributes)) if (value !== undefined && value !== null) element.setAttribute(key, value);
  for (const child of [].concat(children)) element.append(child);
  return element;
}

/** An HTML element; texts are set as texts, so that markup in them stays text. */
export function html(name, attributes = {}, children = []) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "value" || key === "checked" || key === "className") element[key] = value;
    else element.setAttribute(key, value === true ? "" : value);
  }
  for (const child of [].concat(children)) if (child !== null && child !== undefined) element.append(child);
  return element;
}

/** A formula's text with raised and lowered parts: `δ^{3/2}`, `v^n`, `F_y`. */
export function formula(text) {
  const parts = [];
  let from = 0;
  // A subscript follows a single letter: names such as `damping_cubic` have none.
  const marks = /(\^|(?<=(?<![\p{L}\d_])\p{L})_)(?:\{([^}]*)\}|([−-]?[\p{L}\d.]+|\*))/gu;
  for (const found of text.matchAll(marks)) {
    parts.push(text.slice(from, found.index), html(found[1] === "^" ? "sup" : "sub", {}, found[2] ?? found[3]));
    from = found.index + found[0].length;
  }
  return [...parts, text.slice(from)];
}

const colours = new Map();

/** A colour of the page's theme; asked for once, as each asking has the browser settle all styles. */
export function colour(name) {
  const key = `${name} ${document.documentElement.dataset.theme}`;
  if (!colours.has(key)) colours.set(key, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return colours.get(key);
}

const ruler = document.createElement("canvas").getContext("2d");
let family = null;

/** The width of a text in the page's font, in pixels. */
export function measured(text, size = 12) {
  family ??= getComputedStyle(document.body).fontFamily;
  ruler.font = `${size}px ${family}`;
  return ruler.measureText(text).width;
}

function axis(from, to, log) {
  if (log) {
    const [a, b] = [Math.log(from), Math.log(to)];
    return { from, to, log, at: (value) => (Math.log(value) - a) / (b - a), back: (share) => Math.exp(a + share * (b - a)) };
  }
  return { from, to, log, at: (value) => (value - from) / (to - from), back: (share) => from + share * (to - from) };
}

function extent(series, key, log) {
  let least = Infinity;
  let most = -Infinity;
  for (const one of series) {
    if (one.outside) continue;
    const values = one[key];
    for (let at = 0; at < values.length; at++) {
      const value = values[at];
      if (value === null || !Number.isFinite(value) || (log && value <= 0)) continue;
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  return least <= most ? [least, most] : [log ? 0.1 : 0, 1];
}

function padded([least, most], log, share, zero) {
  if (log) {
    const factor = (most / least) ** share || 1.05;
    return most / least > 1 + 1e-9 ? [least / factor, most * factor] : [least / 1.1, most * 1.1];
  }
  if (zero && least >= 0) least = 0;
  const room = (most - least || Math.abs(most) || 1) * share;
  return [zero && least === 0 ? 0 : least - room, most + room];
}

const LEFT = 54;
const RIGHT = 12;
const TOP = 24;
const BOTTOM = 36;

/**
 * A chart in an element of its own size. `draw` shows what it is given:
 * {x: {label, from, to, log}, y: {label, from, to, log, zero}, series: [{name, x, y, colour, dash, width,
 * points, errors, errorsX, fill, base, quiet}], marks: [{x, y, text, colour}], cursor, read, choose}.
 */
export class Chart {
  constructor(place, name) {
    this.place = place;
    this.root = svg("svg", { role: "img", tabindex: "0", "aria-label": `${name}; arrow keys read its values` });
    this.tip = html("div", { class: "tip", hidden: true });
    place.replaceChildren(this.root, this.tip);
    this.name = name;
    this.spec = null;
    this.root.addEventListener("pointermove", (event) => this.point(event));
    this.root.addEventListener("pointerleave", () => this.leave());
    this.root.addEventListener("pointerdown", (event) => this.choose(event));
    this.root.addEventListener("keydown", (event) => this.key(event));
    this.root.addEventListener("blur", () => this.leave());
    new ResizeObserver(() => {
      this.size = null;
      if (this.spec) this.draw(this.spec);
    }).observe(place);
  }

  draw(spec) {
    this.spec = spec;
    this.size ??= this.measure();
    const { width, height } = this.size;
    const drawn = spec.series.filter((one) => one.x.length);
    if (!drawn.length) return this.empty();
    const range = (of, key, share) => {
      const found = padded(extent(drawn, key, of.log), of.log, share, of.zero);
      return axis(of.from ?? found[0], of.to ?? found[1], of.log);
    };
    this.x = range(spec.x, "x", spec.x.log ? 0.02 : 0);
    this.y = range(spec.y, "y", 0.06);
    this.root.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const clip = `clip-${this.name.replace(/\W/g, "")}`;
    const bounds = svg("clipPath", { id: clip }, svg("rect", { x: LEFT, y: TOP - 8, width: this.size.inner, height: this.size.tall + 9 }));
    const inside = svg("g", { "clip-path": `url(#${clip})` });
    for (const one of drawn) inside.append(...this.series(one));
    this.marks = svg("g", { class: "mark" });
    this.cursorLine = svg("line", { class: "cursor", y1: TOP, y2: TOP + this.size.tall, visibility: "hidden" });
    this.hoverLine = svg("line", { class: "hover", y1: TOP, y2: TOP + this.size.tall, visibility: "hidden" });
    this.root.replaceChildren(svg("defs", {}, bounds), this.axes(spec), inside, this.cursorLine, this.hoverLine, this.marks, this.legend(drawn));
    for (const mark of spec.marks ?? []) this.mark(mark);
    this.cursor(spec.cursor);
  }

  /** The place's size, which is read only when it has changed: reading it has the browser lay out the page. */
  measure() {
    const width = Math.max(180, this.place.clientWidth);
    const height = Math.max(120, this.place.clientHeight);
    return { width, height, inner: width - LEFT - RIGHT, tall: height - TOP - BOTTOM };
  }

  /** Nothing to draw: no axes either, which would promise something. */
  empty() {
    this.root.setAttribute("viewBox", `0 0 ${this.size.width} ${this.size.height}`);
    this.root.replaceChildren(svg("text", { x: this.size.width / 2, y: this.size.height / 2, "text-anchor": "middle" }, this.spec.empty ?? "nothing to draw"));
    this.cursorLine = null;
    this.hoverLine = null;
    this.leave();
  }

  px(value) {
    return LEFT + this.x.at(value) * this.size.inner;
  }

  py(value) {
    return TOP + (1 - this.y.at(value)) * this.size.tall;
  }

  axes(spec) {
    const group = svg("g");
    const { inner, tall, height } = this.size;
    const of = (axis, count) => (axis.log ? logTicks(axis.from, axis.to) : { labelled: ticks(axis.from, axis.to, count), all: [] });
    const across = of(this.x, inner / 62);
    const up = of(this.y, tall / 42);
    const inRange = (axis, value) => axis.at(value) > -1e-6 && axis.at(value) < 1 + 1e-6;
    for (const value of new Set([...up.all, ...up.labelled])) {
      if (inRange(this.y, value)) group.append(svg("line", { class: "gridline", x1: LEFT, x2: LEFT + inner, y1: this.py(value), y2: this.py(value) }));
    }
    for (const value of new Set([...across.all, ...across.labelled])) {
      if (inRange(this.x, value)) group.append(svg("line", { class: "gridline", x1: this.px(value), x2: this.px(value), y1: TOP, y2: TOP + tall }));
    }
    const label = (value) => plain(value, 6).replace(/(\.\d*?)0+(?= |$)/, "$1").replace(/\.(?= |$)/, "");
    for (const value of up.labelled) {
      if (inRange(this.y, value)) group.append(svg("text", { x: LEFT - 7, y: this.py(value) + 4, "text-anchor": "end" }, label(value)));
    }
    for (const value of across.labelled) {
      if (inRange(this.x, value)) group.append(svg("text", { x: this.px(value), y: TOP + tall + 16, "text-anchor": "middle" }, label(value)));
    }
    group.append(svg("line", { class: "axis", x1: LEFT, x2: LEFT + inner, y1: TOP + tall, y2: TOP + tall }));
    group.append(svg("line", { class: "axis", x1: LEFT, x2: LEFT, y1: TOP, y2: TOP + tall }));
    group.append(svg("text", { x: LEFT + inner, y: height - 4, "text-anchor": "end" }, spec.x.label));
    group.append(svg("text", { x: 2, y: 12 }, spec.y.label));
    return group;
  }

  path(one) {
    let text = "";
    let pen = false;
    for (let at = 0; at < one.x.length; at++) {
      const [x, y] = [this.px(one.x[at]), this.py(one.y[at])];
      if (one.y[at] === null || !Number.isFinite(x) || !Number.isFinite(y)) {
        pen = false;
        continue;
      }
      text += `${pen ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`;
      pen = true;
    }
    return text;
  }

  series(one) {
    const parts = [];
    if (one.base) {
      let text = this.path(one);
      for (let at = one.x.length - 1; at >= 0; at--) text += `L${this.px(one.x[at]).toFixed(1)} ${this.py(one.base[at]).toFixed(1)}`;
      return [svg("path", { d: `${text}Z`, fill: one.colour, "fill-opacity": one.opacity ?? 0.85, stroke: "none" })];
    }
    if (!one.points) {
      return [svg("path", { class: "series", d: this.path(one), stroke: one.colour, fill: "none", "stroke-width": one.width ?? 2, "stroke-dasharray": one.dash, opacity: one.opacity })];
    }
    for (let at = 0; at < one.x.length; at++) {
      if (one.y[at] === null) continue;
      const [x, y] = [this.px(one.x[at]), this.py(one.y[at])];
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      const bar = (x1, x2, y1, y2) => parts.push(svg("line", { x1, x2, y1, y2, stroke: one.colour, "stroke-width": 1.3 }));
      const up = one.errors?.[at];
      const wide = one.errorsX?.[at];
      if (up > 0) bar(x, x, this.py(one.y[at] - up), this.py(one.y[at] + up));
      if (wide > 0) bar(this.px(Math.max(one.x[at] - wide, this.x.from)), this.px(one.x[at] + wide), y, y);
      const shape = { fill: one.hollow ? "var(--card)" : one.colour, stroke: one.colour, "stroke-width": 1.5 };
      parts.push(one.square ? svg("rect", { x: x - 3.4, y: y - 3.4, width: 6.8, height: 6.8, ...shape }) : svg("circle", { cx: x, cy: y, r: 3.6, ...shape }));
    }
    return parts;
  }

  legend(drawn) {
    const group = svg("g");
    let x = this.size.width - RIGHT;
    const shown = drawn.filter((one) => !one.quiet);
    const narrow = this.size.width < 430;
    for (const one of shown.reverse()) {
      const name = narrow ? one.brief ?? one.name : one.name;
      group.append(svg("text", { y: 12, "text-anchor": "end", x }, name));
      const start = x - measured(name) - 21;
      if (one.points) group.append(one.square ? svg("rect", { x: start + 4, y: 4.5, width: 7, height: 7, fill: one.hollow ? "none" : one.colour, stroke: one.colour }) : svg("circle", { cx: start + 8, cy: 8, r: 3.5, fill: one.hollow ? "none" : one.colour, stroke: one.colour }));
      else if (one.base) group.append(svg("rect", { x: start + 3, y: 3, width: 11, height: 10, rx: 2, fill: one.colour, "fill-opacity": one.opacity ?? 0.85 }));
      else group.append(svg("line", { x1: start, x2: start + 15, y1: 8, y2: 8, stroke: one.colour, "stroke-width": 2.5, "stroke-dasharray": one.dash }));
      x = start - 12;
    }
    return group;
  }

  mark({ x, y, text, colour, below }) {
    const [px, py] = [this.px(x), this.py(y)];
    if (!Number.isFinite(px) || !Number.isFinite(py) || px < LEFT - 1 || px > LEFT + this.size.inner + 1) return;
    this.marks.append(svg("circle", { cx: px, cy: py, r: 4.2, fill: "var(--card)", stroke: colour, "stroke-width": 2.2 }));
    if (!text) return;
    const right = px > LEFT + this.size.inner - 86;
    this.marks.append(svg("text", { class: "halo", x: px + (right ? -8 : 8), y: py + (below ? 16 : -5), "text-anchor": right ? "end" : "start" }, text));
  }

  cursor(value) {
    if (!this.cursorLine) return;
    const x = value === undefined || value === null ? NaN : this.px(value);
    const seen = x >= LEFT - 0.5 && x <= LEFT + this.size.inner + 0.5;
    this.cursorLine.setAttribute("visibility", seen ? "visible" : "hidden");
    if (seen) {
      this.cursorLine.setAttribute("x1", x);
      this.cursorLine.setAttribute("x2", x);
    }
  }

  under(event) {
    const box = this.root.getBoundingClientRect();
    const share = ((event.clientX - box.left) * (this.size.width / box.width) - LEFT) / this.size.inner;
    return this.x.back(Math.min(1, Math.max(0, share)));
  }

  point(event) {
    if (!this.spec?.read) return;
    this.show(this.under(event));
    if (event.buttons & 1) this.choose(event);
  }

  show(value) {
    this.at = value;
    const reading = this.spec.read(value);
    if (!reading) return this.leave();
    const x = this.px(reading.x ?? value);
    this.hoverLine.setAttribute("visibility", "visible");
    this.hoverLine.setAttribute("x1", x);
    this.hoverLine.setAttribute("x2", x);
    this.tip.replaceChildren(...reading.lines.map(({ text, colour }) => {
      const line = html("div");
      if (colour) {
        const dot = html("i");
        dot.style.background = colour;
        line.append(dot);
      }
      line.append(text);
      return line;
    }));
    this.tip.hidden = false;
    const share = this.place.clientWidth / this.size.width;
    const left = x * share + 12;
    const over = left + this.tip.offsetWidth > this.place.clientWidth;
    this.tip.style.left = `${over ? Math.max(0, x * share - 12 - this.tip.offsetWidth) : left}px`;
    this.tip.style.top = "28px";
    return reading;
  }

  leave() {
    this.tip.hidden = true;
    this.hoverLine?.setAttribute("visibility", "hidden");
  }

  choose(event) {
    if (this.spec?.choose && event.button <= 0) this.spec.choose(this.under(event));
  }

  key(event) {
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[event.key];
    if (!step || !this.spec?.read) return;
    event.preventDefault();
    const share = this.at === undefined ? 0.5 : this.x.at(this.at);
    const reading = this.show(this.x.back(Math.min(1, Math.max(0, share + step / 150))));
    if (reading) this.spec.say?.(reading.lines.map(({ text }) => text).join(", "));
  }
}

/** The index of the value nearest to one, in increasing values. */
export function nearest(values, value) {
  let [low, high] = [0, values.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] < value) low = middle;
    else high = middle;
  }
  return Math.abs(values[low] - value) <= Math.abs(values[high] - value) ? low : high;
}
