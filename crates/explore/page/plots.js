// The four figures: signals, times of flight against speed, space and time, energy.

import { Chart, colour, html, nearest } from "./charts.js";
import { plain, quantity, withError } from "./numbers.js";
import { ramp } from "./row.js";

const MICRO = 1e6;

/** Units of a row: numbers of a dimensionless one have none. */
export function units(state) {
  const bare = state.outline?.dimensionless;
  return {
    scale: bare ? 1 : MICRO,
    time: bare ? "time" : "time in µs",
    force: bare ? "force" : "force in N",
    t: (seconds, digits = 5) => (bare ? plain(seconds, digits) : `${plain(seconds * MICRO, digits)} µs`),
    q: (value, unit, digits) => (bare ? plain(value, digits) : quantity(value, unit, digits)),
  };
}

/** Samples of times in the figures' unit. */
function times(motion, scale) {
  const all = new Float64Array(motion.samples);
  for (let at = 0; at < all.length; at++) all[at] = at * motion.interval_s * scale;
  return all;
}

/** The end of what is of interest: a few widths after the reflected pulse. */
export function interesting(shot) {
  const last = shot.reflected ?? shot.wall ?? shot.incident;
  const end = shot.duration_s;
  if (!last) return end;
  return Math.min(end, last.time_s + Math.max(4 * (last.width_s ?? 0), 0.12 * last.time_s));
}

/** Figures of the page, each drawn from the page's state. */
export class Plots {
  constructor(choose, say) {
    const chart = (id, name) => new Chart(document.querySelector(`#${id} .plot`), name);
    this.signals = chart("signals", "Signals of the sensor bead and the wall");
    this.curve = chart("curve", "Time of flight against speed");
    this.spacetime = chart("spacetime", "Contact forces in space and time");
    this.energy = chart("energy", "Energy over time");
    this.map = html("canvas", { "aria-hidden": "true" });
    this.spacetime.place.prepend(this.map);
    this.map.style.cssText = "position:absolute";
    this.choose = choose;
    this.say = say;
  }

  note(id, ...children) {
    document.querySelector(`#${id} .note`).replaceChildren(...children);
  }

  /** Moves the cursor of all figures over time. */
  cursor(time, state) {
    const { scale } = units(state);
    for (const chart of [this.signals, this.spacetime, this.energy]) chart.cursor(time * scale);
  }

  drawSignals(state) {
    const { shot } = state;
    if (!shot?.motion) return;
    const of = units(state);
    const x = times(shot.motion, of.scale);
    const end = (state.whole ? shot.duration_s : interesting(shot)) * of.scale;
    const series = [{ name: "sensor bead", brief: "sensor", x, y: shot.motion.sensor, colour: colour("incident") }];
    if (shot.motion.wall.length) series.push({ name: "wall", x, y: shot.motion.wall, colour: colour("wall") });
    const overlay = aligned(state);
    for (const [at, one] of overlay.entries()) {
      const x = one.time.map((time) => time * of.scale);
      series.push({ name: one.name, brief: "recorded", y: one.y, quiet: at > 0, x, colour: colour("record"), width: 1.3 });
      series.push({ name: `residual of ${one.name}`, brief: "residual", y: one.residual, quiet: at > 0, x, colour: colour("soft"), width: 1, opacity: 0.8 });
    }
    const marks = [["incident", "incident"], ["wall", "wall"], ["reflected", "reflected"]].flatMap(([key, name]) =>
      shot[key] ? [{ x: shot[key].time_s * of.scale, y: shot[key].value_n, text: of.t(shot[key].time_s), colour: colour(name) }] : []);
    for (const { picks } of overlay) marks.push(...picks.map((one) => ({ x: one.time * of.scale, y: one.y, colour: colour("record") })));
    this.signals.draw({
      x: { label: of.time, from: 0, to: end },
      y: { label: of.force },
      series,
      marks,
      cursor: state.time * of.scale,
      choose: (value) => this.choose(value / of.scale),
      say: this.say,
      read: (value) => {
        const at = nearest(x, value);
        return {
          x: x[at],
          lines: [{ text: `t = ${of.t(x[at] / of.scale)}` }, ...series.map((one) => {
            const near = one.x === x ? at : nearest(one.x, value);
            return { text: `${one.name} ${of.q(one.y[near], "N", 4)}`, colour: one.colour };
          })],
        };
      },
    });
    const residual = overlay.filter((one) => one.rms !== undefined).map((one) => `${one.name}: residual ${plain(100 * one.rms, 3)} % of the peak (rms)`);
    this.note("signals", shot.missing ? `No time of flight: ${shot.missing}.` : residual.join("; ") || "Circles are picks: the largest maxima, located between the steps.");
  }

  drawCurve(state) {
    const { curve, reference } = state;
    const log = state.curveScale === "log";
    const ratio = state.curveView === "ratio";
    const of = units(state);
    if (!curve) {
      this.curve.draw({ x: { label: "speed", log }, y: { label: "", log }, series: [], empty: state.curveWhy ? "no curve" : "" });
      this.note("curve", state.curveWhy ?? "");
      return;
    }
    const [blue, green] = [colour("incident"), colour("reflected")];
    const kinds = [["incident", "tof_incident_s", blue], ["reflected", "tof_reflected_s", green]];
    const scaled = (values) => values.map((value) => (value === null ? null : value * of.scale));
    let series = [];
    if (ratio && reference?.curve) {
      for (const [name, key, tint] of kinds) {
        series.push({ name, key, x: curve.speed_m_s, y: curve[key].map((value, at) => over(value, at_speed(reference.curve, key, curve.speed_m_s[at]))), colour: tint });
      }
      series.push({ name: "1", quiet: true, x: [curve.speed_m_s[0], curve.speed_m_s[curve.speed_m_s.length - 1]], y: [1, 1], colour: colour("soft"), dash: "4 4", width: 1 });
    } else {
      for (const [name, key, tint] of kinds) {
        series.push({ name, key, x: curve.speed_m_s, y: scaled(curve[key]), colour: tint });
        if (reference?.curve) series.push({ name: `${name}, ${reference.name}`, brief: "ref.", quiet: name === "reflected", key, x: reference.curve.speed_m_s, y: scaled(reference.curve[key]), colour: tint, dash: "5 4", width: 1.4 });
      }
    }
    for (const [name, key, tint] of kinds) {
      const rows = (state.data?.points ?? []).filter((row) => row[key]);
      if (!rows.length) continue;
      const divisor = (row) => (ratio && reference?.curve ? at_speed(reference.curve, key, row.speed_m_s[0]) : 1 / of.scale);
      series.push({
        name: `measured ${name}`, brief: "data", quiet: name === "reflected", points: true, square: name === "reflected", colour: tint, hollow: true, measured: key,
        x: rows.map((row) => row.speed_m_s[0]), errorsX: rows.map((row) => row.speed_m_s[1]),
        y: rows.map((row) => over(row[key][0], divisor(row))), errors: rows.map((row) => over(row[key][1], divisor(row))),
      });
    }
    const marks = [];
    if (!ratio && state.shot?.speed_m_s) {
      for (const [, key, tint] of kinds) if (state.shot[key]) marks.push({ x: state.shot.speed_m_s, y: state.shot[key] * of.scale, colour: tint });
    }
    // Ratios of equal rows differ by the accuracy of times: no axis shows that large.
    const near = ratio && series.every((one) => one.y.every((value) => value === null || Math.abs(value - 1) < 1e-3));
    const label = of.scale === 1 ? "time of flight" : "time of flight in µs";
    this.curve.draw({
      x: { label: of.scale === 1 ? "speed of the striker" : "speed of the striker in m/s", log },
      y: { label: ratio ? `time of flight over ${reference?.name ?? "reference"}` : label, log: log && !ratio, ...(near ? { from: 0.998, to: 1.002 } : {}) },
      series,
      marks,
      say: this.say,
      choose: state.setSpeed && ((value) => state.setSpeed(value)),
      read: (value) => {
        const at = nearest(curve.speed_m_s, value);
        const lines = series.filter((one) => one.key).map((one) => {
          const near = one.x === curve.speed_m_s ? at : nearest(one.x, value);
          return { text: `${one.name} ${ratio ? plain(one.y[near], 6) : `${plain(one.y[near], 6)}${of.scale === 1 ? "" : " µs"}`}`, colour: one.colour };
        });
        return { x: curve.speed_m_s[at], lines: [{ text: `${plain(curve.speed_m_s[at], 4)}${of.scale === 1 ? "" : " m/s"}` }, ...lines] };
      },
    });
    this.note("curve", ...law(curve, of), ...(curve.failed.length ? [` ${curve.failed.length} speeds failed: ${curve.failed[0][1]}`] : []));
  }

  drawSpacetime(state) {
    const { shot, motion } = state;
    if (!motion || !shot?.motion || !motion.contacts) return;
    const of = units(state);
    const end = (state.whole ? motion.end : Math.min(motion.end, interesting(shot)));
    const first = shot.bodies[0].number;
    const top = first + motion.contacts - 1;
    this.spacetime.draw({
      x: { label: of.time, from: 0, to: end * of.scale },
      y: { label: "contact number", from: first - 0.5, to: top + 0.5 },
      series: [{ quiet: true, name: "", x: [0], y: [first], colour: "none" }],
      cursor: state.time * of.scale,
      say: this.say,
      choose: (value) => this.choose(value / of.scale),
      read: (value) => {
        const { forces, front } = motion.state(value / of.scale);
        const at = front >= 0 ? front : forces.indexOf(Math.max(...forces));
        return { x: value, lines: [{ text: `t = ${of.t(value / of.scale)}` }, { text: `largest force ${of.q(forces[at], "N", 3)} in contact ${first + at}` }] };
      },
    });
    const { inner, tall } = this.spacetime.size;
    paint(this.map, motion, end);
    Object.assign(this.map.style, { left: "54px", top: "24px", width: `${inner}px`, height: `${tall}px` });
    const scale = html("span", { class: "ramp", "aria-hidden": "true" });
    scale.style.background = `linear-gradient(90deg, ${[0, 0.25, 0.5, 0.75, 1].map((share) => `rgb(${ramp(share).map(Math.round).join(" ")})`).join(", ")})`;
    this.note("spacetime", "0 ", scale, ` ${of.q(motion.most, "N", 3)}. The slope of a ridge is the pulse’s speed.`);
  }

  drawEnergy(state) {
    const energy = state.shot?.energy;
    if (!energy) return;
    const of = units(state);
    const all = energy.time.map((time) => time * of.scale);
    const x = Array.from(all);
    const tints = ["#0b6fb8", "#e39b1d", "#c2410c", "#7a3e9d", "#00806b", "#8a6d3b", "#5b6775", "#b03a6b"];
    const share = (value) => (100 * value) / energy.input_j;
    const least = new Float64Array(x.length);
    const base = new Float64Array(x.length);
    const series = energy.parts.map(([name, values], index) => {
      const from = Array.from(base);
      for (let at = 0; at < x.length; at++) {
        base[at] += share(values[at]);
        least[at] = Math.min(least[at], base[at]);
      }
      return { name: name.replaceAll("_", " "), quiet: true, values, x, base: from, y: Array.from(base), colour: tints[index % tints.length], opacity: 0.82 };
    });
    const end = (state.whole ? state.shot.duration_s : interesting(state.shot)) * of.scale;
    const lowest = Math.min(0, ...least);
    this.energy.draw({
      x: { label: of.time, from: 0, to: end },
      y: { label: "share of the energy put in, %", from: lowest < -0.5 ? 1.05 * lowest : 0, to: 104 },
      series,
      cursor: state.time * of.scale,
      say: this.say,
      choose: (value) => this.choose(value / of.scale),
      read: (value) => {
        const at = nearest(x, value);
        return { x: x[at], lines: [{ text: `t = ${of.t(x[at] / of.scale)}` }, ...series.map((one) => ({ text: `${one.name} ${plain(share(one.values[at]), 3)} %`, colour: one.colour }))] };
      },
    });
    const legend = [...series].reverse().map((one) => {
      const dot = html("i");
      dot.style.background = one.colour;
      return html("span", { class: "key" }, [dot, one.name]);
    });
    this.note("energy", ...legend, `Put in: ${of.q(energy.input_j, "J", 4)}. The budget closes to ${plain(Math.abs(energy.relative_residual), 2)} of it.`);
  }
}

const over = (value, divisor) => (value === null || value === undefined || !divisor ? null : value / divisor);

/** A curve's time at a speed, between its points in the logarithms. */
function at_speed(curve, key, speed) {
  const x = curve.speed_m_s;
  if (speed < x[0] * 0.9999 || speed > x[x.length - 1] * 1.0001) return null;
  let low = 0;
  while (low < x.length - 2 && x[low + 1] < speed) low++;
  const [a, b] = [curve[key][low], curve[key][low + 1]];
  if (a === null || b === null) return null;
  const share = Math.log(speed / x[low]) / Math.log(x[low + 1] / x[low]);
  return Math.exp(Math.log(a) + share * Math.log(b / a));
}

function law(curve, of) {
  const one = (name, found) => {
    if (!found) return [];
    const exponent = found.exponent_error === null ? plain(found.exponent, 5) : withError(found.exponent, Math.max(found.exponent_error, 1e-7), "");
    const power = html("b", {}, ["v", html("sup", {}, exponent)]);
    return [html("span", { class: "law-note" }, [`${name} ≈ ${of.t(found.prefactor_s)} · `, power]), " "];
  };
  return [...one("incident", curve.power_law_incident), ...one("reflected", curve.power_law_reflected)];
}

/** A recording laid over the model: moved to its incident pick, scaled to its height. */
function aligned(state) {
  const { shot, data } = state;
  const example = data?.examples?.[0];
  const picks = example && data.picks;
  if (!picks || !shot?.incident) return [];
  const shift = shot.incident.time_s - picks.incident.time_s;
  return example.channels.map((volts, channel) => {
    const own = channel === 1 ? "wall" : "incident";
    const pick = channel === 1 ? picks.wall : picks.incident;
    const sign = volts[Math.min(volts.length - 1, Math.max(0, Math.round(pick.time_s / example.interval_s)))] < 0 ? -1 : 1;
    const scale = (sign * shot[own].value_n) / Math.abs(pick.height_v);
    const time = [];
    const y = [];
    for (let at = 0; at < volts.length; at++) {
      const when = at * example.interval_s + shift;
      if (when < 0 || when > shot.duration_s) continue;
      time.push(when);
      y.push(volts[at] * scale);
    }
    const model = modelled(shot.motion, channel, example.channels.length === 1);
    const residual = y.map((value, at) => value - model(time[at]));
    const seen = channel === 1 ? [picks.wall] : [picks.incident, ...(example.channels.length === 1 ? [picks.wall] : []), picks.reflected];
    const picked = seen.filter(Boolean).map((one) => ({ time: one.time_s + shift, y: Math.abs(scale * one.height_v) }));
    return { picks: picked, name: `recorded ${example.names[channel] ?? ""}`.trim(), time, y, residual, rms: size(shot, time, residual) };
  });
}

/** The model's signal in a channel of a recording, of which a single one has both sensors' sum. */
function modelled(motion, channel, single) {
  const own = channel === 1 ? motion.wall : motion.sensor;
  const other = single && motion.wall.length ? motion.wall : null;
  return (time) => {
    const place = Math.min(motion.samples - 1, time / motion.interval_s);
    const low = Math.max(0, Math.min(motion.samples - 2, Math.floor(place)));
    const between = (values) => values[low] + (values[low + 1] - values[low]) * (place - low);
    return between(own) + (other ? between(other) : 0);
  };
}

/** Root mean square of residuals until after the reflected pulse, over the peak. */
function size(shot, time, residual) {
  const end = interesting(shot);
  const seen = residual.filter((_, at) => time[at] <= end);
  const sum = seen.reduce((sum, one) => sum + one * one, 0);
  return seen.length ? Math.sqrt(sum / seen.length) / shot.incident.value_n : undefined;
}

/** Paints forces of all contacts until a time, a pixel a contact and sample. */
function paint(canvas, motion, end) {
  const samples = Math.max(2, Math.min(motion.samples, Math.round(end / motion.interval) + 1));
  const columns = Math.min(samples, 1200);
  canvas.width = columns;
  canvas.height = motion.contacts;
  const pen = canvas.getContext("2d");
  const image = pen.createImageData(columns, motion.contacts);
  const table = Array.from({ length: 256 }, (_, at) => ramp(at / 255));
  for (let contact = 0; contact < motion.contacts; contact++) {
    const line = (motion.contacts - 1 - contact) * columns * 4;
    for (let column = 0; column < columns; column++) {
      const sample = Math.round((column / (columns - 1)) * (samples - 1));
      const share = Math.max(0, motion.force[contact * motion.samples + sample]) / motion.most;
      // Weak forces stay visible: the root of the share.
      const tint = table[Math.round(255 * Math.sqrt(Math.min(1, share)))];
      image.data.set([tint[0], tint[1], tint[2], 255], line + 4 * column);
    }
  }
  pen.putImageData(image, 0, 0);
}
