// The row to scale: beads coloured by force, displacements magnified, contact forces as bars.

import { colour } from "./charts.js";

/** Colours of forces from none to the largest: lightness falls (light) or rises (dark) throughout. */
const RAMPS = {
  light: [[255, 255, 255], [253, 231, 178], [246, 184, 90], [226, 110, 38], [168, 47, 22], [92, 12, 20]],
  dark: [[21, 31, 41], [72, 40, 58], [150, 52, 52], [226, 104, 40], [250, 178, 74], [255, 244, 205]],
};

/** Whether the page is dark. */
export const isDark = () => document.documentElement.dataset.theme === "dark";

/** The colour of a share from 0 to 1 as [red, green, blue]. */
export function ramp(share) {
  const stops = RAMPS[isDark() ? "dark" : "light"];
  const place = Math.min(1, Math.max(0, share)) * (stops.length - 1);
  const low = Math.min(stops.length - 2, Math.floor(place));
  return stops[low].map((one, at) => one + (stops[low + 1][at] - one) * (place - low));
}

const mixed = (from, to, share) => from.map((one, at) => Math.round(one + (to[at] - one) * share));
const css = (rgb) => `rgb(${rgb.map(Math.round).join(" ")})`;

/** What a shot's motion gives at any time between samples. */
export class Motion {
  constructor(shot) {
    const { motion, bodies } = shot;
    this.bodies = bodies;
    this.samples = motion.samples;
    this.interval = motion.interval_s;
    this.end = (motion.samples - 1) * motion.interval_s;
    this.turns = shot.wall?.time_s ?? Infinity;
    this.displacement = motion.displacement;
    this.force = motion.force;
    this.contacts = Math.max(0, bodies.length - 1);
    this.most = motion.force.reduce((most, force) => Math.max(most, Math.abs(force)), 0) || 1;
    this.compression = this.deepest();
  }

  /** The largest approach of two neighbours in m. */
  deepest() {
    let most = 0;
    for (let body = 0; body < this.contacts; body++) {
      const [here, next] = [body * this.samples, (body + 1) * this.samples];
      for (let at = 0; at < this.samples; at++) most = Math.max(most, this.displacement[here + at] - this.displacement[next + at]);
    }
    return most || 1e-9;
  }

  at(array, index, time) {
    const place = Math.min(this.samples - 1, Math.max(0, time / this.interval));
    const low = Math.min(this.samples - 2, Math.floor(place));
    const start = index * this.samples + low;
    return low < 0 ? array[index * this.samples] : array[start] + (array[start + 1] - array[start]) * (place - low);
  }

  /** Displacements and forces at a time, the pulse's place, and which contacts are open. */
  state(time) {
    const moved = this.bodies.map((_, body) => this.at(this.displacement, body, time));
    const forces = Array.from({ length: this.contacts }, (_, contact) => this.at(this.force, contact, time));
    const open = forces.map((_, contact) => {
      const rest = this.bodies[contact + 1].rest_m - this.bodies[contact].rest_m;
      const touch = this.bodies[contact].radius_m + (this.bodies[contact + 1].kind === "plane" ? 0 : this.bodies[contact + 1].radius_m);
      return rest - touch + moved[contact + 1] - moved[contact] > 2e-3 * this.compression;
    });
    let front = -1;
    forces.forEach((force, contact) => {
      if (force > 0.15 * this.most && (front < 0 || force > forces[front])) front = contact;
    });
    return { moved, forces, open, front };
  }

  /** A magnification that shows compressions and keeps the row in sight. */
  usual() {
    const radius = Math.min(...this.bodies.map((body) => body.radius_m));
    let far = 0;
    for (const moved of this.displacement) far = Math.max(far, Math.abs(moved));
    const span = this.bodies[this.bodies.length - 1].rest_m;
    const wanted = Math.min((0.5 * radius) / this.compression, (0.16 * span) / (far || 1e-9));
    const power = 10 ** Math.floor(Math.log10(wanted));
    return Math.max(1, [5, 2, 1].map((digit) => digit * power).find((value) => value <= wanted) ?? power);
  }
}

/** Draws a motion's row at a time on a canvas, as the page shows it or at another size; returns the row's state. */
export function drawRow(canvas, motion, time, magnify, most, size = {}) {
  const { width, height, ratio } = { width: canvas.clientWidth, height: canvas.clientHeight, ratio: window.devicePixelRatio || 1, ...size };
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  const state = motion.state(time);
  const { bodies } = motion;
  const first = bodies[0];
  const last = bodies[bodies.length - 1];
  const largest = Math.max(...bodies.map((body) => body.radius_m));
  const walled = last.kind === "plane" || last.kind === "half-bead";
  const [from, to] = [first.rest_m - first.radius_m, last.rest_m + (walled ? 0 : last.radius_m)];
  // Room for the struck row to move to the right, and for the striker to come back.
  const room = 26;
  // Where the row is low, bars keep 30 px.
  const tall = Math.max(8, Math.min(0.17 * height, (height - 112) / 2));
  const scale = Math.min((width - 2 * room) / (to - from), tall / largest);
  const left = (width - (to - from) * scale) / 2;
  const middle = largest * scale + 34;
  const place = bodies.map((body, at) => left + (body.rest_m - from + state.moved[at] * magnify) * scale);
  const theme = {
    steel: isDark() ? [104, 120, 134] : [182, 194, 205],
    light: isDark() ? [196, 208, 219] : [246, 249, 251],
    edge: colour("steel-3"), ink: colour("ink"), soft: colour("soft"), ground: colour("ground"), accent: colour("accent"), incident: colour("incident"), wall: colour("wall"),
  };
  const below = middle + largest * scale + 30;
  const bars = { top: below + 6, bottom: height - 12 };
  drawGround(pen, theme, { left, right: left + (to - from) * scale, y: middle + largest * scale + 3, walled, width });
  if (walled) drawWall(pen, theme, { x: place[bodies.length - 1], middle, tall: largest * scale + 10, width });
  bodies.forEach((body, at) => {
    if (body.kind === "plane") return;
    const around = [state.forces[at - 1] ?? 0, state.forces[at] ?? 0];
    const share = Math.max(0, (around[0] + around[1]) / 2 / motion.most);
    drawBead(pen, theme, { body, x: place[at], y: middle, r: body.radius_m * scale, share });
  });
  drawBars(pen, theme, motion, state, place, bars);
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "left";
  pen.fillStyle = theme.soft;
  const words = [`contact forces, up to ${most}`, ...(state.open.some(Boolean) ? ["boxes: open contacts"] : []), ...(bodies.some((body) => body.wet) ? ["dots below: wet"] : [])];
  const wide = (text) => pen.measureText(text).width;
  while (words.length > 1 && wide(words.join("; ")) > width - 12) words.pop();
  pen.fillText(words.join("; "), Math.max(6, Math.min(left, width - 6 - wide(words.join("; ")))), below);
  drawLabels(pen, theme, { bodies, place, middle, scale, state, largest, width, pulse: time > motion.turns ? "▼ reflection" : "▼ pulse" });
  return state;
}

function drawGround(pen, theme, { left, right, y, walled, width }) {
  pen.strokeStyle = theme.ground;
  pen.lineWidth = 2;
  pen.beginPath();
  pen.moveTo(Math.max(4, left - 20), y);
  pen.lineTo(walled ? right : Math.min(width - 4, right + 20), y);
  pen.stroke();
}

function drawWall(pen, theme, { x, middle, tall, width }) {
  const deep = Math.min(16, width - x - 2);
  pen.fillStyle = theme.ground;
  pen.fillRect(x, middle - tall, deep, 2 * tall);
  pen.strokeStyle = theme.soft;
  pen.lineWidth = 1;
  pen.save();
  pen.beginPath();
  pen.rect(x, middle - tall, deep, 2 * tall);
  pen.clip();
  pen.beginPath();
  for (let y = -tall - deep; y < tall; y += 7) {
    pen.moveTo(x, middle + y + deep);
    pen.lineTo(x + deep, middle + y);
  }
  pen.stroke();
  pen.restore();
}

function drawBead(pen, theme, { body, x, y, r, share }) {
  const hot = ramp((isDark() ? 0.5 : 0.2) + (isDark() ? 0.4 : 0.6) * share);
  const lit = Math.min(1, 2.2 * share);
  const base = mixed(theme.steel, hot, lit);
  const shine = mixed(theme.light, mixed(hot, [255, 255, 255], 0.45), lit);
  pen.beginPath();
  if (body.kind === "half-bead") pen.arc(x, y, r, Math.PI / 2, -Math.PI / 2);
  else pen.arc(x, y, r, 0, 2 * Math.PI);
  pen.closePath();
  if (r > 2.5) {
    const gradient = pen.createRadialGradient(x - 0.35 * r, y - 0.4 * r, 0.1 * r, x, y, r);
    gradient.addColorStop(0, css(shine));
    gradient.addColorStop(0.75, css(base));
    gradient.addColorStop(1, css(mixed(base, [0, 0, 0], 0.22)));
    pen.fillStyle = gradient;
  } else pen.fillStyle = css(base);
  pen.fill();
  if (r > 2.5) {
    pen.lineWidth = body.sensor ? 2.2 : 0.8;
    pen.strokeStyle = body.sensor ? theme.incident : theme.edge;
    pen.stroke();
  }
  if (body.sensor && r > 4) {
    // A split bead: its disc is in the mid-plane.
    pen.beginPath();
    pen.moveTo(x, y - 0.9 * r);
    pen.lineTo(x, y + 0.9 * r);
    pen.stroke();
  }
  if (body.kind === "striker" && r > 5) {
    pen.fillStyle = theme.ink;
    pen.font = `${Math.min(13, r)}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.fillText("▸", x + 0.05 * r, y + 0.5);
    pen.textBaseline = "alphabetic";
  }
}

function drawBars(pen, theme, motion, state, place, { top, bottom }) {
  const tall = bottom - top;
  pen.strokeStyle = theme.ground;
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(place[0], bottom + 0.5);
  pen.lineTo(place[place.length - 1], bottom + 0.5);
  pen.stroke();
  state.forces.forEach((force, contact) => {
    const x = (place[contact] + place[contact + 1]) / 2;
    const gap = Math.abs(place[contact + 1] - place[contact]);
    const wide = Math.max(1, Math.min(12, 0.55 * gap));
    const share = Math.max(0, force) / motion.most;
    if (motion.bodies[contact].wet) {
      pen.fillStyle = theme.accent;
      pen.fillRect(x - Math.max(1, wide / 4), bottom + 3, Math.max(2, wide / 2), 3);
    }
    if (share > 0.002) {
      pen.fillStyle = css(ramp(0.3 + 0.55 * share));
      pen.fillRect(x - wide / 2, bottom - share * tall, wide, share * tall);
    } else if (state.open[contact]) {
      pen.strokeStyle = theme.soft;
      pen.strokeRect(x - Math.min(2.5, wide / 2), bottom - 8, Math.min(5, wide), 7);
    }
  });
}

function drawLabels(pen, theme, { bodies, place, middle, scale, state, largest, width, pulse }) {
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = "center";
  const above = middle - largest * scale - 14;
  const taken = [];
  const label = (text, x, ink, strong) => {
    const half = pen.measureText(text).width / 2 + 6;
    x = Math.max(half, Math.min(width - half, x));
    if (taken.some(([a, b]) => x + half > a && x - half < b)) return;
    taken.push([x - half, x + half]);
    pen.fillStyle = ink;
    pen.font = `${strong ? 600 : 400} 12px system-ui, sans-serif`;
    pen.fillText(text, x, above);
  };
  const sensor = bodies.findIndex((body) => body.sensor);
  if (state.front >= 0) label(pulse, (place[state.front] + place[state.front + 1]) / 2, theme.ink, true);
  if (sensor >= 0) label(`sensor ${bodies[sensor].number}`, place[sensor], theme.incident, true);
  if (bodies[0].kind === "striker") label("striker", place[0], theme.soft);
  const last = bodies[bodies.length - 1];
  if (last.kind === "half-bead" || last.kind === "plane") label("wall", width, theme.wall, true);
}
