"use strict";
const data = "@DATA@";
const SECONDS_PER_RUN = 14;
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
const x0 = new Float32Array(bytes(data.x0));
const radius = new Float32Array(bytes(data.radius));
const u = new Uint16Array(bytes(data.u));
const f = new Uint16Array(bytes(data.f));
const colours = data.colours.match(/.{7}/g);
const element = (id) => document.getElementById(id);
const row = element("row"), map = element("map");

// Values between two frames are interpolated, so slow motion stays smooth.
function value(levels, range, index, frame) {
  const i = Math.min(Math.floor(frame), data.frames - 2), s = frame - i;
  const a = levels[index * data.frames + i], b = levels[index * data.frames + i + 1];
  return range[0] + (range[1] - range[0]) * (a + (b - a) * s) / 65535;
}
const moved = (bead, frame) => value(u, data.uRange, bead, frame);
const force = (contact, frame) => contact < data.contacts ? value(f, data.fRange, contact, frame) : 0;

const largest = Math.max(data.fRange[1], 1e-300);
function colour(strength) {
  const i = Math.round(255 * Math.sqrt(Math.min(Math.max(strength / largest, 0), 1)));
  return colours[i];
}

// Places on the page. Few beads do not fill it: balls larger than LARGEST_BALL
// would hide the names below them.
const LARGEST_BALL = 26;
const thickest = radius.reduce((most, r) => Math.max(most, r), 0);
const left = x0[0] - 3.5 * radius[0];
const right = x0[data.beads - 1] + 2.5 * radius[data.beads - 1];
let scale = 1, offset = 0;
const at = (x) => offset + (x - left) * scale;
const place = (bead, frame) => at(x0[bead] + data.factor * moved(bead, frame));
function rescale() {
  scale = Math.min(width / (right - left), LARGEST_BALL / thickest);
  offset = 0.5 * (width - scale * (right - left));
}

// Round numbers from 0 or above to the end of an axis, at most `most` of them.
function ticks(from, to, most) {
  const wanted = (to - from) / most, decade = 10 ** Math.floor(Math.log10(wanted));
  const pitch = [1, 2, 5, 10].map((n) => n * decade).find((n) => n >= wanted) || 1;
  const found = [];
  for (let n = Math.ceil(from / pitch - 1e-9); n * pitch <= to * (1 + 1e-9); n++) found.push(n * pitch);
  return found;
}
const text = (value) => Number(value.toPrecision(6)).toLocaleString("en", { maximumSignificantDigits: 6 }).replace("-", "\u2212");
const unit = (name) => name ? " (" + name + ")" : "";

function fit(canvas, height) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth;
  canvas.style.height = height + "px";
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [pen, width, height];
}

let pen, width, height, mapImage;
const curveTop = 26, curveBase = 170, middle = 214;

function drawRow(frame) {
  pen.clearRect(0, 0, width, height);
  drawGrid();
  drawWet(frame);
  for (let b = 0; b < data.beads; b++) drawBead(b, frame);
  drawWall();
  drawCurve(frame);
  drawMarks(frame);
}

function drawBead(b, frame) {
  const r = Math.max(0.6, radius[b] * scale);
  const squeezed = b > 0 ? 0.5 * (force(b - 1, frame) + force(b, frame)) : force(0, frame);
  pen.beginPath();
  pen.arc(place(b, frame), middle, r, 0, 2 * Math.PI);
  pen.fillStyle = colour(squeezed);
  pen.fill();
  if (r > 2) {
    pen.strokeStyle = "#444";
    pen.lineWidth = 0.8;
    pen.stroke();
  }
}

function drawWet(frame) {
  if (!data.wet) return;
  pen.fillStyle = "#e0a01e";
  for (let b = 0; b < data.beads; b++) {
    const contact = b * data.stride;
    if (contact < data.wet[0] || contact > data.wet[1]) continue;
    const r = radius[b] * scale, x = place(b, frame) + r;
    pen.fillRect(x - 0.28 * r, middle - 0.6 * r, 0.56 * r, 1.2 * r);
  }
}

function drawWall() {
  const r = radius[data.beads - 1] * scale, x = at(x0[data.beads - 1]) + r;
  if (data.contacts < data.beads) return;
  pen.fillStyle = "#9aa0a8";
  pen.fillRect(x + 1, middle - 1.6 * Math.max(r, 6), 8, 3.2 * Math.max(r, 6));
}

const lowest = Math.min(data.fRange[0], 0);
const up = (F) => curveBase - (curveBase - curveTop) * (F - lowest) / (largest - lowest);
function drawGrid() {
  pen.font = "12px sans-serif";
  pen.textAlign = "left";
  for (const F of ticks(lowest, largest, 5)) {
    pen.fillStyle = F === 0 ? "#999" : "#ddd";
    pen.fillRect(0, up(F) - 0.5, width, 1);
    pen.fillStyle = "#444";
    if (F !== 0) pen.fillText(text(F), 2, up(F) - 3);
  }
  pen.fillText("Contact force" + unit(data.forceUnit), 2, 13);
}

function drawCurve(frame) {
  pen.beginPath();
  for (let c = 0; c < data.contacts && c < data.beads; c++) {
    const x = place(c, frame) + radius[c] * scale;
    if (c === 0) pen.moveTo(x, up(force(c, frame))); else pen.lineTo(x, up(force(c, frame)));
  }
  pen.strokeStyle = "#ce5600";
  pen.lineWidth = 2;
  pen.lineJoin = "round";
  pen.stroke();
}

function drawMarks(frame) {
  const y = middle;
  pen.fillStyle = "#111";
  pen.font = "12px sans-serif";
  pen.textAlign = "center";
  for (const [bead, name] of data.marks) {
    const b = Math.round(bead / data.stride);
    if (b >= data.beads) continue;
    const r = Math.max(radius[b] * scale, 3), half = 0.5 * pen.measureText(name).width;
    const x = Math.min(Math.max(place(b, frame), half + 2), width - half - 2);
    pen.fillText(name, x, y + r + 18);
    pen.fillRect(place(b, frame) - 0.5, y + r + 2, 1, 5);
  }
}

// Force over time and contact, drawn once; the cursor moves over it.
function drawMap() {
  const picture = document.createElement("canvas");
  picture.width = data.frames;
  picture.height = Math.max(1, data.contacts);
  const brush = picture.getContext("2d");
  const image = brush.createImageData(picture.width, picture.height);
  const rgb = colours.map((c) => [1, 3, 5].map((i) => parseInt(c.slice(i, i + 2), 16)));
  for (let c = 0; c < data.contacts; c++) {
    for (let t = 0; t < data.frames; t++) {
      const F = data.fRange[0] + (data.fRange[1] - data.fRange[0]) * f[c * data.frames + t] / 65535;
      const level = Math.round(255 * Math.sqrt(Math.min(Math.max(F / largest, 0), 1)));
      const at = 4 * ((data.contacts - 1 - c) * data.frames + t);
      image.data.set([...rgb[level], 255], at);
    }
  }
  brush.putImageData(image, 0, 0);
  return picture;
}

let mapPen, mapWidth, mapHeight;
const gutter = { left: 56, right: 12, top: 10, bottom: 38 };
const mapSize = () => [mapWidth - gutter.left - gutter.right, mapHeight - gutter.top - gutter.bottom];
function drawCursor(frame) {
  const [across, down] = mapSize();
  mapPen.clearRect(0, 0, mapWidth, mapHeight);
  mapPen.imageSmoothingEnabled = false;
  mapPen.drawImage(mapImage, gutter.left, gutter.top, across, down);
  mapPen.strokeStyle = "#999";
  mapPen.strokeRect(gutter.left + 0.5, gutter.top + 0.5, across - 1, down - 1);
  drawMapAxes(across, down);
  const x = gutter.left + across * frame / (data.frames - 1);
  mapPen.fillStyle = "#0060a6";
  mapPen.fillRect(x - 1, gutter.top, 2, down);
}

const clock = (time) => time * data.timeScale;
function drawMapAxes(across, down) {
  mapPen.fillStyle = "#444";
  mapPen.font = "12px sans-serif";
  mapPen.textAlign = "center";
  const [from, to] = [clock(data.from), clock(data.to)], bottom = gutter.top + down;
  for (const t of ticks(from, to, 8)) {
    const x = gutter.left + across * (t - from) / (to - from);
    mapPen.fillRect(x - 0.5, bottom, 1, 4);
    mapPen.fillText(text(t), x, bottom + 16);
  }
  mapPen.fillText("Time" + unit(data.timeUnit), gutter.left + 0.5 * across, bottom + 32);
  mapPen.textAlign = "right";
  const first = data.firstContact, last = first + (data.contacts - 1) * data.stride;
  for (const c of ticks(first, last, 5).filter(Number.isInteger)) {
    const y = bottom - down * ((c - first) / data.stride + 0.5) / data.contacts;
    mapPen.fillRect(gutter.left - 4, y - 0.5, 4, 1);
    mapPen.fillText(text(c), gutter.left - 7, y + 4);
  }
  mapPen.save();
  mapPen.translate(12, gutter.top + 0.5 * down);
  mapPen.rotate(-0.5 * Math.PI);
  mapPen.textAlign = "center";
  mapPen.fillText("Contact", 0, 0);
  mapPen.restore();
}

// Who asked their system for less motion starts it by hand.
const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
let share = 0, playing = !still, before = null;
function draw() {
  const frame = share * (data.frames - 1);
  drawRow(frame);
  drawCursor(frame);
  element("time").value = share;
  const time = clock(data.from + share * (data.to - data.from));
  const digits = Math.max(0, 3 - Math.floor(Math.log10(Math.max(clock(data.to), 1e-300))));
  element("clock").textContent = ("t = " + time.toFixed(Math.min(digits, 20)) + " " + data.timeUnit).trim();
}

function step(now) {
  if (playing && before !== null) {
    const passed = (now - before) / 1000 / SECONDS_PER_RUN * Number(element("speed").value);
    share = (share + passed) % 1;
    draw();
  }
  before = now;
  requestAnimationFrame(step);
}

function setPlaying(on) {
  playing = on;
  element("play").textContent = on ? "Pause" : "Play";
}
setPlaying(playing);
function seek(to) {
  share = Math.min(Math.max(to, 0), 1);
  draw();
}
function layout() {
  [pen, width, height] = fit(row, 266);
  [mapPen, mapWidth, mapHeight] = fit(map, 206);
  rescale();
  draw();
}

element("play").addEventListener("click", () => setPlaying(!playing));
element("time").addEventListener("input", (e) => { setPlaying(false); seek(Number(e.target.value)); });
map.addEventListener("click", (e) => seek((e.offsetX - gutter.left) / mapSize()[0]));
document.addEventListener("keydown", (e) => {
  const on = e.target.tagName;
  if (on === "SELECT" || e.ctrlKey || e.altKey || e.metaKey) return;
  const steps = { ArrowRight: 0.005, ArrowLeft: -0.005, Home: -1, End: 1 };
  if (e.key === " " && on !== "BUTTON") setPlaying(!playing);
  else if (e.key in steps) { setPlaying(false); seek(share + steps[e.key]); }
  else return;
  e.preventDefault();
});
window.addEventListener("resize", layout);

const pace = SECONDS_PER_RUN / Math.max(data.to - data.from, 1e-300);
const round = (value) => Number(value.toPrecision(2)).toLocaleString("en", { maximumSignificantDigits: 2 });
element("note").textContent =
  (data.factor === 1 ? "Displacements are drawn as large as they are" : "Displacements are drawn " + data.factor.toLocaleString("en") + " times as large as they are")
  + (data.timeUnit ? "; at speed 1, time runs " + round(pace) + " times slower than in the shot. " : "; at speed 1, one unit of time takes " + round(pace) + " s. ")
  + "Colours of beads and map show the contact force on a square-root scale. Space pauses, the arrow keys step, a click on the map goes to that time."
  + (data.stride > 1 ? " One bead in " + data.stride + " is drawn." : "");
mapImage = drawMap();
layout();
requestAnimationFrame(step);
