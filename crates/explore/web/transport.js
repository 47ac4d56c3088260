// The engine as WebAssembly in workers: one request a worker at a time; to cancel one is to end its worker.

/** What the one-file page holds in itself; null on a host, where it is a file. */
const embedded = (id) => document.getElementById(id)?.textContent ?? null;

const MOST_WORKERS = Math.max(2, Math.min(8, navigator.hardwareConcurrency ?? 2));
/** Fewest speeds that a worker is started for. */
const FEWEST_SPEEDS = 8;

/** Where the engine lies on a host. */
const ENGINE = "engine.wasm.gz";

async function loaded() {
  const text = embedded("engine");
  if (text !== null) return Uint8Array.from(atob(text.trim()), (character) => character.charCodeAt(0));
  const response = await fetch(ENGINE);
  if (!response.ok) throw new Error(`${ENGINE}: ${response.status} ${response.statusText}`);
  return new Uint8Array(await response.arrayBuffer());
}

async function bytes() {
  const packed = await loaded();
  // Some hosts declare the compression, and the browser has undone it.
  const isPacked = packed[0] === 0x1f && packed[1] === 0x8b;
  return isPacked ? new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer() : packed;
}

let loading = null;
const module = () => (loading ??= bytes().then((all) => WebAssembly.compile(all)));

let address = null;
function source() {
  const text = embedded("worker");
  if (text === null) return "worker.js";
  return (address ??= URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
}

const idle = [];
const waiting = [];
let workers = 0;

/** One request on its way: to a worker as soon as one is free. */
class Job {
  constructor(request) {
    this.text = JSON.stringify(request);
    this.progress = null;
    this.done = new Promise((resolve) => (this.resolve = resolve));
    waiting.push(this);
    serve();
  }

  begin(worker) {
    this.worker = worker;
    worker.onmessage = ({ data }) => {
      if (data.progress) this.progress = data.progress;
      else this.end(data.reply);
    };
    worker.onerror = (event) => this.end({ refused: { error: `The engine failed: ${event.message ?? "its worker ended"}` } });
    worker.postMessage({ text: this.text });
  }

  end(reply) {
    idle.push(this.worker);
    this.worker = null;
    this.resolve(reply);
    serve();
  }

  stop() {
    const place = waiting.indexOf(this);
    if (place >= 0) waiting.splice(place, 1);
    if (this.worker) {
      this.worker.onmessage = null;
      this.worker.terminate();
      this.worker = null;
      workers -= 1;
    }
    this.resolve({ refused: "stopped" });
    serve();
  }
}

async function serve() {
  if (!waiting.length) return;
  if (!idle.length && workers < MOST_WORKERS) {
    workers += 1;
    try {
      const compiled = await module();
      const worker = new Worker(source());
      worker.postMessage({ module: compiled });
      idle.push(worker);
    } catch (error) {
      workers -= 1;
      loading = null;
      while (waiting.length) waiting.shift().resolve({ refused: { error: `The engine can't be loaded: ${error.message}` } });
      return;
    }
  }
  while (idle.length && waiting.length) waiting.shift().begin(idle.pop());
}

/** Jobs of each lane. */
const lanes = new Map();

/** A batch as several shards. */
function shards(request) {
  if (request.verb !== "batch") return [request];
  const count = Math.max(1, Math.min(MOST_WORKERS, Math.floor(request.speeds.count / FEWEST_SPEEDS)));
  return Array.from({ length: count }, (_, at) => ({ ...request, shard: [at + 1, count] }));
}

/** The reply of a request's shards. */
async function joined(replies) {
  const failed = replies.find((one) => one.refused !== undefined);
  if (failed || replies.length === 1) return failed ?? replies[0];
  return new Job({ verb: "join", shards: replies.map((one) => one.reply) }).done;
}

/** What the page starts with. */
export const start = async () => ({ experiment: null });

/** The answer to a request; a newer one in the same lane ends it. */
export async function answer(lane, request) {
  cancel(lane);
  const jobs = shards(request).map((shard) => new Job(shard));
  lanes.set(lane, jobs);
  const reply = await joined(await Promise.all(jobs.map((job) => job.done)));
  if (lanes.get(lane) === jobs) lanes.delete(lane);
  return reply;
}

/** How far the work of a lane is. */
export const progress = async (lane) => lanes.get(lane)?.[0].progress ?? null;

/** Ends the work of a lane. */
export async function cancel(lane) {
  for (const job of lanes.get(lane) ?? []) job.stop();
}
