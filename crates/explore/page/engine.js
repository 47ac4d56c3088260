// The engine behind the page: one request a lane, arrays decoded.

import * as transport from "./transport.js";

/** Why the engine gave no answer: `mistakes` of the experiment, or `message`. */
export class Refused extends Error {
  constructor(refusal) {
    const mistakes = refusal?.mistakes ?? [];
    super(refusal?.error ?? mistakes.map((one) => one.message).join("; ") ?? "stopped");
    this.mistakes = mistakes;
    this.stopped = refusal === "stopped";
  }
}

function granted(json) {
  if (json && json.refused !== undefined) throw new Refused(json.refused);
  return json;
}

/** What the page starts with. */
export const start = async () => granted(await transport.start());

/** The answer to a request; a newer one in the same lane ends it. */
export const ask = async (lane, request, signal) => granted(await transport.answer(lane, request, signal)).reply;

/** How far the work of a lane is. */
export const progress = async (lane) => granted(await transport.progress(lane));

/** Ends the work of a lane. */
export const cancel = async (lane) => granted(await transport.cancel(lane));

/** Numbers of an array in a reply. */
export function decoded(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let at = 0; at < text.length; at++) bytes[at] = text.charCodeAt(at);
  return new Float32Array(bytes.buffer);
}

/** Base64 of a file's bytes. */
export function encoded(buffer) {
  const bytes = new Uint8Array(buffer);
  let text = "";
  for (let at = 0; at < bytes.length; at += 0x8000) {
    text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  }
  return btoa(text);
}

/** Longest time that a newer call waits for the one under way, in ms. */
export const PATIENCE = 3000;

/**
 * Runs the newest of many calls: while one is under way only the last that came waits, so that
 * a slider shows intermediate results; what takes too long is ended by its lanes.
 */
export function newest(lanes, run) {
  let busy = false;
  let waiting = null;
  let began = 0;
  let late = 0;
  return async function call(...given) {
    if (busy) {
      waiting = given;
      clearTimeout(late);
      late = setTimeout(() => lanes.forEach(cancel), began + PATIENCE - performance.now());
      return;
    }
    busy = true;
    began = performance.now();
    try {
      await run(...given);
    } finally {
      busy = false;
      clearTimeout(late);
      const next = waiting;
      waiting = null;
      if (next) call(...next);
    }
  };
}

// For the browser's console: `await hertzchain.ask("console", { verb: "presets" })`.
globalThis.hertzchain = { ask, decoded };
