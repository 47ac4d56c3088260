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

// Lengths on the page, in metres of the row.
const left = x0[0] - 3.5 * radius[0];
const right = x0[data.beads - 1] + 2.5 * radius[data.beads - 1];

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
const curveTop = 26, curveBase = 170;

function drawRow(frame) {
  pen.clearRect(0, 0, width, height);
  const scale = width / (right - left);
  const at = (x) => (x - left) * scale;
  const place = (bead) => at(x0[bead] + data.factor * moved(bead, frame));
  const middle = 214;
  drawWet(middle, place, scale);
  for (let b = 0; b < data.beads; b++) drawBead(b, place(b), middle, scale, frame);
  drawWall(at, middle, scale);
  drawCurve(place, frame);
  drawMarks(place, middle, scale);
}

function drawBead(b, x, y, scale, frame) {
  const r = Math.max(0.6, radius[b] * scale);
  const squeezed = b > 0 ? 0.5 * (force(b - 1, frame) + force(b, frame)) : force(0, frame);
  pen.beginPath();
  pen.arc(x, y, r, 0, 2 * Math.PI);
  pen.fillStyle = colour(squeezed);
  pen.fill();
  if (r > 2) {
    pen.strokeStyle = "#444";
    pen.lineWidth = 0.8;
    pen.stroke();
  }
}

function drawWet(y, place, scale) {
  if (!data.wet) return;
  pen.fillStyle = "#e0a01e";
  for (let b = 0; b < data.beads; b++) {
    const contact = b * data.stride;
    if (contact < data.wet[0] || contact > data.wet[1]) continue;
    const r = radius[b] * scale, x = place(b) + r;
    pen.fillRect(x - 0.28 * r, y - 0.6 * r, 0.56 * r, 1.2 * r);
  }
}

function drawWall(at, y, scale) {
  const r = radius[data.beads - 1] * scale, x = at(x0[data.beads - 1]) + r;
  if (data.contacts < data.beads) return;
  pen.fillStyle = "#9aa0a8";
  pen.fillRect(x + 1, y - 1.6 * Math.max(r, 6), 8, 3.2 * Math.max(r, 6));
}

function drawCurve(place, frame) {
  const up = (F) => curveBase - (curveBase - curveTop) * F / largest;
  pen.strokeStyle = "#bbb";
  pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(0, curveBase);
  pen.lineTo(width, curveBase);
  pen.stroke();
  pen.beginPath();
  const scale = width / (right - left);
  for (let c = 0; c < data.contacts && c < data.beads; c++) {
    const x = place(c) + radius[c] * scale;
    if (c === 0) pen.moveTo(x, up(force(c, frame))); else pen.lineTo(x, up(force(c, frame)));
  }
  pen.strokeStyle = "#ce5600";
  pen.lineWidth = 2;
  pen.lineJoin = "round";
  pen.stroke();
  pen.fillStyle = "#555";
  pen.font = "12px sans-serif";
  pen.textAlign = "left";
  pen.fillText("contact force; top of the curve's range: " + largest.toPrecision(3) + " N", 2, 13);
}

function drawMarks(place, y, scale) {
  pen.fillStyle = "#111";
  pen.font = "12px sans-serif";
  pen.textAlign = "center";
  for (const [bead, name] of data.marks) {
    const b = Math.round(bead / data.stride);
    if (b >= data.beads) continue;
    const r = Math.max(radius[b] * scale, 3), half = 0.5 * pen.measureText(name).width;
    const x = Math.min(Math.max(place(b), half + 2), width - half - 2);
    pen.fillText(name, x, y + r + 18);
    pen.fillRect(place(b) - 0.5, y + r + 2, 1, 5);
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
function drawCursor(frame) {
  mapPen.imageSmoothingEnabled = false;
  mapPen.drawImage(mapImage, 0, 0, mapWidth, mapHeight);
  mapPen.strokeStyle = "#999";
  mapPen.strokeRect(0.5, 0.5, mapWidth - 1, mapHeight - 1);
  const x = mapWidth * frame / (data.frames - 1);
  mapPen.fillStyle = "#0060a6";
  mapPen.fillRect(x - 1, 0, 2, mapHeight);
}

let share = 0, playing = true, before = null;
function draw() {
  const frame = share * (data.frames - 1);
  drawRow(frame);
  drawCursor(frame);
  element("time").value = share;
  const microseconds = 1e6 * (data.from + share * (data.to - data.from));
  element("clock").textContent = "t = " + microseconds.toFixed(1) + " µs";
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
function seek(to) {
  share = Math.min(Math.max(to, 0), 1);
  draw();
}
function layout() {
  [pen, width, height] = fit(row, 262);
  [mapPen, mapWidth, mapHeight] = fit(map, 150);
  draw();
}

element("play").addEventListener("click", () => setPlaying(!playing));
element("time").addEventListener("input", (e) => { setPlaying(false); seek(Number(e.target.value)); });
map.addEventListener("click", (e) => seek(e.offsetX / map.clientWidth));
document.addEventListener("keydown", (e) => {
  if (e.target.tagName === "BUTTON" || e.target.tagName === "SELECT") return;
  if (e.key === " ") { e.preventDefault(); setPlaying(!playing); }
  if (e.key === "ArrowRight") seek(share + 0.005);
  if (e.key === "ArrowLeft") seek(share - 0.005);
});
window.addEventListener("resize", layout);

const slower = SECONDS_PER_RUN / Math.max(data.to - data.from, 1e-300);
element("note").textContent =
  "Displacements are drawn " + data.factor.toLocaleString("en") + " times as large as they are; at speed 1, time runs "
  + Number(slower.toPrecision(2)).toLocaleString("en") + " times slower than in the shot. Colour and map show the contact force "
  + "on a square-root scale; the map has time across and contacts upward."
  + (data.stride > 1 ? " One bead in " + data.stride + " is drawn." : "");
mapImage = drawMap();
layout();
requestAnimationFrame(step);
