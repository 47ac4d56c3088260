// What leaves the page: files, figures, command lines, links.

import { colour, measured, svg } from "./charts.js";

/** Saves a text or a blob under a name. */
export function save(name, content, kind) {
  const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type: kind }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** Columns of equal length as CSV. */
export function csv(columns) {
  const titles = Object.keys(columns);
  const rows = Array.from({ length: columns[titles[0]].length }, (_, at) => titles.map((title) => columns[title][at] ?? "").join(","));
  return `${titles.join(",")}\n${rows.join("\n")}\n`;
}

/** A name for files from an experiment's title. */
export const slug = (title) => title.normalize("NFKD").replace(/[^\w]+/g, "-").replace(/^-|-$/g, "").toLowerCase().slice(0, 60) || "row";

const PAINTED = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "opacity", "font-size", "font-family", "font-weight", "text-anchor", "paint-order", "stroke-linejoin", "visibility"];

/** A chart with its looks as attributes, as it stands alone in a file. */
function standalone(chart) {
  const copy = chart.root.cloneNode(true);
  const [of, to] = [chart.root.querySelectorAll("*"), copy.querySelectorAll("*")];
  of.forEach((element, at) => {
    if (["clipPath", "defs"].includes(element.tagName)) return;
    const style = getComputedStyle(element);
    for (const name of PAINTED) to[at].setAttribute(name, style.getPropertyValue(name));
    to[at].removeAttribute("class");
  });
  copy.querySelectorAll("[visibility=hidden]").forEach((element) => element.remove());
  return copy;
}

/** Names and colours of stacked parts, in a line that ends at a place. */
function keys(series, right, y) {
  const group = svg("g");
  let x = right;
  for (const one of series) {
    const width = measured(one.name, 10);
    group.append(svg("text", { x, y, "text-anchor": "end", "font-size": 10, "font-family": "system-ui, sans-serif", fill: colour("soft") }, one.name));
    group.append(svg("rect", { x: x - width - 13, y: y - 8, width: 8, height: 8, rx: 2, fill: one.colour }));
    x -= width + 25;
  }
  return group;
}

/** All figures of the page as one SVG; `row` draws the row on a canvas and returns its size. */
export function figures(state, plots, row) {
  const charts = [[plots.signals, "Signals"], [plots.curve, "Time of flight against speed"], [plots.spacetime, "Contact forces in space and time"], [plots.energy, "Where the energy is"]];
  const wide = Math.max(...charts.map(([chart]) => chart.size.width));
  const tall = Math.max(...charts.map(([chart]) => chart.size.height));
  const [pad, head] = [20, 24];
  const width = 2 * wide + 3 * pad;
  const canvas = document.createElement("canvas");
  const drawn = row(canvas);
  const rowTall = (drawn.height * (width - 2 * pad)) / drawn.width;
  const height = 50 + rowTall + 2 * (tall + head + pad) + pad;
  const text = (x, y, words, size, weight) => svg("text", { x, y, "font-size": size, "font-weight": weight, fill: colour("ink"), "font-family": "system-ui, sans-serif" }, words);
  const root = svg("svg", { xmlns: "http://www.w3.org/2000/svg", width, height, viewBox: `0 0 ${width} ${height}` });
  root.append(svg("rect", { width, height, fill: colour("card") }), text(pad, 32, state.outline?.title ?? "", 20, 600));
  root.append(svg("image", { x: pad, y: 44, width: width - 2 * pad, height: rowTall, href: canvas.toDataURL("image/png") }));
  charts.forEach(([chart, title], at) => {
    const x = pad + (at % 2) * (wide + pad);
    const y = 50 + rowTall + pad + Math.floor(at / 2) * (tall + head + pad);
    const copy = standalone(chart);
    for (const [key, value] of Object.entries({ x, y: y + 8, width: chart.size.width, height: chart.size.height })) copy.setAttribute(key, value);
    root.append(text(x, y, title, 14, 600));
    if (chart === plots.spacetime) {
      const { inner, tall: deep } = chart.size;
      root.append(svg("image", { x: x + 54, y: y + 32, width: inner, height: deep, preserveAspectRatio: "none", href: plots.map.toDataURL("image/png") }));
    }
    root.append(copy);
    if (chart === plots.energy) root.append(keys(chart.spec?.series ?? [], x + chart.size.width, y + chart.size.height + 20));
  });
  return new XMLSerializer().serializeToString(root);
}

/** The same on a canvas, so many times as fine. */
async function painted(text, times) {
  const url = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = times * image.naturalWidth;
  canvas.height = times * image.naturalHeight;
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(url);
  return canvas;
}

const blob = (canvas, kind, quality) => new Promise((done) => canvas.toBlob(done, kind, quality));

/** The same as PNG, twice as fine. */
export const picture = async (text) => blob(await painted(text, 2), "image/png");

/** The same as PDF: one page, as wide as one of A4, with the figures as an image of some 300 dots an inch. */
export async function pdf(text) {
  const canvas = await painted(text, 3);
  const image = new Uint8Array(await (await blob(canvas, "image/jpeg", 0.92)).arrayBuffer());
  const [wide, tall] = [595, (595 * canvas.height) / canvas.width];
  const drawing = `q ${wide} 0 0 ${tall.toFixed(2)} 0 0 cm /Figures Do Q`;
  const about = `/Type /XObject /Subtype /Image /Width ${canvas.width} /Height ${canvas.height} /ColorSpace /DeviceRGB /BitsPerComponent 8 /Filter /DCTDecode`;
  const objects = [
    ["<< /Type /Catalog /Pages 2 0 R >>"],
    ["<< /Type /Pages /Kids [3 0 R] /Count 1 >>"],
    [`<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ${wide} ${tall.toFixed(2)}] /Resources << /XObject << /Figures 5 0 R >> >> /Contents 4 0 R >>`],
    [`<< /Length ${drawing.length} >>\nstream\n${drawing}\nendstream`],
    [`<< ${about} /Length ${image.length} >>\nstream\n`, image, "\nendstream"],
  ];
  const parts = ["%PDF-1.4\n"];
  const places = [];
  let at = parts[0].length;
  const put = (part) => {
    parts.push(part);
    at += part.length;
  };
  objects.forEach((object, index) => {
    places.push(at);
    [`${index + 1} 0 obj\n`, ...object, "\nendobj\n"].forEach(put);
  });
  const table = places.map((place) => `${String(place).padStart(10, "0")} 00000 n \n`).join("");
  const from = at;
  put(`xref\n0 ${places.length + 1}\n0000000000 65535 f \n${table}trailer\n<< /Size ${places.length + 1} /Root 1 0 R >>\nstartxref\n${from}\n%%EOF\n`);
  return new Blob(parts, { type: "application/pdf" });
}

const range = (speeds) => `log:${speeds.from_m_s}:${speeds.to_m_s}:${speeds.count}`;

/** Command lines that give the page's numbers. */
export function shell(state) {
  const preset = state.presets.find((one) => one.text === state.text);
  const of = preset ? `--preset ${preset.name}` : "row.toml";
  const lines = [];
  if (!preset) lines.push("cat > row.toml <<'EOF'", state.text.trimEnd(), "EOF");
  lines.push(`hertzchain shot ${of} --json`);
  if (state.speeds) lines.push(`hertzchain sweep ${of} --speeds ${range(state.speeds)} --json`);
  return `${lines.join("\n")}\n`;
}

/** Python lines that give the page's numbers. */
export function python(state) {
  const preset = state.presets.find((one) => one.text === state.text);
  const lines = ["import hertzchain as hc", "import numpy as np", ""];
  if (preset) lines.push(`row = hc.preset("${preset.name}")`);
  else lines.push("from pathlib import Path", "", `Path("row.toml").write_text('''${state.text.replaceAll("\\", "\\\\").replaceAll("'''", "\\'\\'\\'")}''', encoding="utf-8")`, 'row = hc.load("row.toml")');
  lines.push("print(hc.shot(row))");
  if (state.speeds) lines.push(`print(hc.sweep(row, np.geomspace(${state.speeds.from_m_s}, ${state.speeds.to_m_s}, ${state.speeds.count})))`);
  return `${lines.join("\n")}\n`;
}

async function through(bytes, stream) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/** A state as the fragment of an address. */
export async function packed(state) {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(state)), new CompressionStream("deflate-raw"));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return `#s=${btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/** Longest state that a link may unfold to, in characters. */
const LONGEST = 300_000;

/** The state of an address's fragment; null where it has none that can be read. */
export async function unpacked(fragment) {
  if (!fragment.startsWith("#s=")) return null;
  try {
    const text = atob(fragment.slice(3).replaceAll("-", "+").replaceAll("_", "/"));
    const reader = new Blob([Uint8Array.from(text, (c) => c.charCodeAt(0))]).stream().pipeThrough(new DecompressionStream("deflate-raw")).pipeThrough(new TextDecoderStream()).getReader();
    let all = "";
    for (;;) {
      const { done, value } = await reader.read();
      if (done) break;
      all += value;
      if (all.length > LONGEST) return null;
    }
    const state = JSON.parse(all);
    return typeof state.text === "string" ? state : null;
  } catch {
    return null;
  }
}

/** Puts a text on the clipboard. */
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = document.createElement("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
}
