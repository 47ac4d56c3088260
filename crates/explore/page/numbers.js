// Numbers as people read and type them.

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

const superscript = (text) => [...String(text)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"["0123456789".indexOf(c)] ?? (c === "-" ? "⁻" : c)).join("");

/** A plain number with so many digits; a minus sign that is one. */
export function plain(value, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  let text;
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    text = `${mantissa.replace(/\.?0+$/, "")} · 10${superscript(Number(exponent))}`;
  } else {
    const places = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    text = value.toFixed(Math.min(places, 12));
  }
  return text.replace("-", "−");
}

/** A quantity with the prefix that suits it: ["756.5", "µs"]. */
export function parts(value, unit, digits = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return ["–", ""];
  if (unit === "kg") return parts(value * 1000, "g", digits);
  if (!/^(s|m|N|J|Pa|Hz|V|g|m\/s|N\/m|Pa s)$/.test(unit) || value === 0) return [plain(value, digits), unit];
  const size = Math.abs(value);
  // Of slow things alone millimetres a second are read more easily.
  const scales = unit === "m/s" ? [size < 0.01 ? [1e-3, "m"] : [1, ""]] : PREFIXES;
  const [scale, prefix] = scales.find(([scale]) => size >= scale * 0.99995) ?? scales[scales.length - 1];
  return [plain(value / scale, digits), prefix + unit];
}

/** The same as one text. */
export const quantity = (value, unit, digits = 4) => parts(value, unit, digits).join(" ").trim();

/** A quantity with its standard error, both to the error's second digit. */
export function withError(value, error, unit) {
  if (!(error > 0)) return quantity(value, unit, 6);
  const size = Math.max(Math.abs(value), error);
  const scales = /^(s|m|N|Pa|Pa s)$/.test(unit) ? PREFIXES : [[1, ""]];
  const [scale, prefix] = scales.find(([scale]) => size >= scale) ?? [1, ""];
  const places = Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(error / scale))));
  return `${(value / scale).toFixed(places)} ± ${(error / scale).toFixed(places)} ${prefix}${unit}`.replace("-", "−").trim();
}

/** A key of the experiment file as a title. */
export const titled = (key) => key.replaceAll("_", " ").replace(/^./, (letter) => letter.toUpperCase());

/** A typed number or quantity: decimal comma and typographic minus become what the file has. */
export function typed(text) {
  return text.trim().replace(/[−–]/g, "-").replace(/^([-+]?\d*),(\d+)/, "$1.$2").replace(/(\*\s*10\^|·\s*10\^)/, "e");
}

/** The number and the rest of a quantity's text, or null. */
export function split(text) {
  const found = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*)$/.exec(String(text));
  return found && { value: Number(found[1]), unit: found[2].trim() };
}

/** A number for a file, with so many digits and no superfluous zeros. */
export const brief = (value, digits = 4) => String(Number(value.toPrecision(digits)));

/** Ticks of a linear axis. */
export function ticks(from, to, count) {
  const span = to - from;
  if (!(span > 0)) return [from];
  const raw = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((factor) => factor * power).find((step) => step >= raw * 0.999);
  const first = Math.ceil(from / step - 1e-9);
  const all = [];
  for (let at = first; at * step <= to + 1e-9 * span; at++) all.push(Number((at * step).toPrecision(12)));
  return all;
}

/** Ticks of a logarithmic axis: labelled ones, and all. */
export function logTicks(from, to) {
  const all = [];
  for (let power = Math.floor(Math.log10(from)); power <= Math.ceil(Math.log10(to)); power++) {
    for (let digit = 1; digit < 10; digit++) {
      const value = Number((digit * 10 ** power).toPrecision(12));
      if (value >= from * 0.9999 && value <= to * 1.0001) all.push({ value, digit });
    }
  }
  const decades = Math.log10(to / from);
  const shown = decades > 2.2 ? [1] : decades > 0.85 ? [1, 2, 5] : decades > 0.45 ? [1, 2, 3, 4, 5, 6, 8] : null;
  let labelled = all.filter(({ digit }) => !shown || shown.includes(digit)).map(({ value }) => value);
  if (labelled.length < 3) labelled = ticks(from, to, 5).filter((value) => value > 0);
  return { labelled, all: all.map(({ value }) => value) };
}
