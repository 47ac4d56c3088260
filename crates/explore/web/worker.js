// A worker that runs the engine, a program of WASI, anew for each request: standard input is the request,
// standard output the reply, standard error progress; files are in memory and end with the request.

"use strict";

const [BADF, EXIST, INVAL, ISDIR, NOENT, NOSYS, NOTDIR, NOTEMPTY] = [8, 20, 28, 31, 44, 52, 54, 55];
const [DEVICE, FOLDER, FILE] = [2, 3, 4];
/** The one folder that the engine is given: everything is in it. */
const ROOT = 3;
/** The program's environment: files in memory can't be locked, and need not be. */
const ENVIRONMENT = new TextEncoder().encode("HDF5_USE_FILE_LOCKING=FALSE\0");
/** Time between two reports of progress, in ms. */
const PACE = 100;

/** Bytes that grow as they are written. */
class Bytes {
  constructor(bytes = new Uint8Array(0)) {
    this.all = bytes;
    this.size = bytes.length;
  }

  get bytes() {
    return this.all.subarray(0, this.size);
  }

  resize(size) {
    if (size > this.all.length) {
      const grown = new Uint8Array(Math.max(size, 2 * this.all.length));
      grown.set(this.bytes);
      this.all = grown;
    } else if (size < this.size) {
      this.all.fill(0, size, this.size);
    }
    this.size = size;
  }

  write(at, bytes) {
    if (at + bytes.length > this.size) this.resize(at + bytes.length);
    this.all.set(bytes, at);
  }
}

/** Ends the program. */
class Exit {
  constructor(code) {
    this.code = code;
  }
}

/** What WASI's preview 1 gives a program: streams, files in memory, clocks, random numbers. */
class System {
  constructor(input, heard) {
    this.folders = new Set(["", "tmp"]);
    this.files = new Map();
    this.output = new Bytes();
    this.errors = "";
    this.heard = heard;
    this.open = new Map([
      [0, { kind: DEVICE, file: new Bytes(input), at: 0 }],
      [1, { kind: DEVICE, file: this.output, at: 0 }],
      [2, { kind: DEVICE, file: null, at: 0 }],
      [ROOT, { kind: FOLDER, path: "" }],
    ]);
    this.next = ROOT + 1;
  }

  get view() {
    return new DataView(this.memory.buffer);
  }

  memoryAt(at, length) {
    return new Uint8Array(this.memory.buffer, at, length);
  }

  /** A path relative to an open folder, without `.` and `..`. */
  path(folder, at, length) {
    const parts = [];
    const text = new TextDecoder().decode(this.memoryAt(at, length));
    for (const part of `${this.open.get(folder)?.path ?? ""}/${text}`.split("/")) {
      if (part === "..") parts.pop();
      else if (part && part !== ".") parts.push(part);
    }
    return parts.join("/");
  }

  inner(folder) {
    const prefix = folder ? `${folder}/` : "";
    const all = [...this.folders].map((path) => [path, FOLDER]).concat([...this.files.keys()].map((path) => [path, FILE]));
    return all.filter(([path]) => path && path.startsWith(prefix) && !path.slice(prefix.length).includes("/")).map(([path, kind]) => [path.slice(prefix.length), kind]);
  }

  vectors(at, count) {
    const { view } = this;
    return Array.from({ length: count }, (_, index) => this.memoryAt(view.getUint32(at + 8 * index, true), view.getUint32(at + 8 * index + 4, true)));
  }

  /** Reads into buffers from a place, and returns how many bytes. */
  read(opened, place, at, count) {
    let done = 0;
    for (const buffer of this.vectors(at, count)) {
      const part = opened.file.bytes.subarray(place + done, place + done + buffer.length);
      buffer.set(part);
      done += part.length;
      if (part.length < buffer.length) break;
    }
    return done;
  }

  write(opened, place, at, count) {
    let done = 0;
    for (const buffer of this.vectors(at, count)) {
      if (opened.file) opened.file.write(place + done, buffer);
      else this.hear(new TextDecoder().decode(buffer));
      done += buffer.length;
    }
    return done;
  }

  /** Standard error: progress, a line of JSON each, or last words. */
  hear(text) {
    this.errors = (this.errors + text).slice(-4000);
    const lines = this.errors.split("\n");
    const progress = lines.findLast((line) => line.startsWith("{") && line.endsWith("}"));
    if (!progress || lines.at(-1)) return;
    this.errors = lines.filter((line) => !line.startsWith("{")).join("\n");
    const now = performance.now();
    if (now - (this.told ?? -Infinity) < PACE) return;
    this.told = now;
    this.heard(JSON.parse(progress));
  }

  about(out, kind, size) {
    this.memoryAt(out, 64).fill(0);
    this.view.setUint8(out + 16, kind);
    this.view.setBigUint64(out + 24, 1n, true);
    this.view.setBigUint64(out + 32, BigInt(size), true);
    return 0;
  }

  /** Puts a number of 32 bits where the program asked for it. */
  give(out, value) {
    this.view.setUint32(out, value, true);
    return 0;
  }

  give64(out, value) {
    this.view.setBigUint64(out, value, true);
    return 0;
  }

  /** The functions by their names in WASI. */
  functions() {
    const held = (fd, act) => (this.open.has(fd) ? act(this.open.get(fd)) : BADF);
    const file = (fd, act) => held(fd, (opened) => (opened.kind === FOLDER ? ISDIR : act(opened)));
    const none = (counted, sized) => this.give(counted, 0) || this.give(sized, 0);
    return {
      args_sizes_get: none,
      args_get: () => 0,
      environ_sizes_get: (counted, sized) => this.give(counted, 1) || this.give(sized, ENVIRONMENT.length),
      environ_get: (list, at) => this.memoryAt(at, ENVIRONMENT.length).set(ENVIRONMENT) ?? this.give(list, at),
      proc_exit: (code) => {
        throw new Exit(code);
      },
      sched_yield: () => 0,
      clock_res_get: (_clock, out) => this.give64(out, 1000n),
      clock_time_get: (clock, _precision, out) => this.give64(out, BigInt(Math.round((clock === 0 ? Date.now() : performance.now()) * 1e6))),
      random_get: (at, length) => {
        for (let done = 0; done < length; done += 65536) crypto.getRandomValues(this.memoryAt(at + done, Math.min(65536, length - done)));
        return 0;
      },
      fd_read: (fd, at, count, out) => file(fd, (opened) => {
        const done = this.read(opened, opened.at, at, count);
        opened.at += done;
        return this.give(out, done);
      }),
      fd_pread: (fd, at, count, place, out) => file(fd, (opened) => this.give(out, this.read(opened, Number(place), at, count))),
      fd_write: (fd, at, count, out) => file(fd, (opened) => {
        const done = this.write(opened, opened.at, at, count);
        opened.at += done;
        return this.give(out, done);
      }),
      fd_pwrite: (fd, at, count, place, out) => file(fd, (opened) => this.give(out, this.write(opened, Number(place), at, count))),
      fd_seek: (fd, by, whence, out) => file(fd, (opened) => {
        const to = Number(by) + [0, opened.at, opened.file.size][whence];
        if (to < 0) return INVAL;
        opened.at = to;
        return this.give64(out, BigInt(to));
      }),
      fd_tell: (fd, out) => file(fd, (opened) => this.give64(out, BigInt(opened.at))),
      fd_close: (fd) => held(fd, () => (this.open.delete(fd) ? 0 : BADF)),
      fd_sync: () => 0,
      fd_datasync: () => 0,
      fd_advise: () => 0,
      fd_fdstat_set_flags: () => 0,
      fd_fdstat_get: (fd, out) => held(fd, ({ kind }) => {
        this.memoryAt(out, 24).fill(0);
        this.view.setUint8(out, kind);
        this.memoryAt(out + 8, 16).fill(255);
        return 0;
      }),
      fd_filestat_get: (fd, out) => held(fd, (opened) => this.about(out, opened.kind, opened.file?.size ?? 0)),
      fd_filestat_set_size: (fd, size) => file(fd, (opened) => opened.file.resize(Number(size)) ?? 0),
      fd_prestat_get: (fd, out) => (fd === ROOT ? this.give(out, 0) || this.give(out + 4, 1) : BADF),
      fd_prestat_dir_name: (_fd, at) => this.memoryAt(at, 1).fill(47) && 0,
      fd_readdir: (fd, at, length, from, out) => held(fd, ({ kind, path }) => (kind === FOLDER ? this.list(path, at, length, Number(from), out) : NOTDIR)),
      path_open: (folder, _follow, at, length, how, _rights, _inherited, _flags, out) => this.opened(this.path(folder, at, length), how, out),
      path_filestat_get: (folder, _follow, at, length, out) => {
        const path = this.path(folder, at, length);
        if (this.folders.has(path)) return this.about(out, FOLDER, 0);
        return this.files.has(path) ? this.about(out, FILE, this.files.get(path).size) : NOENT;
      },
      path_create_directory: (folder, at, length) => {
        const path = this.path(folder, at, length);
        if (this.folders.has(path) || this.files.has(path)) return EXIST;
        return this.folders.add(path) && 0;
      },
      path_remove_directory: (folder, at, length) => {
        const path = this.path(folder, at, length);
        if (this.inner(path).length) return NOTEMPTY;
        return this.folders.delete(path) ? 0 : NOENT;
      },
      path_unlink_file: (folder, at, length) => (this.files.delete(this.path(folder, at, length)) ? 0 : NOENT),
      path_rename: (folder, at, length, other, to, long) => {
        const path = this.path(folder, at, length);
        if (!this.files.has(path)) return NOENT;
        this.files.set(this.path(other, to, long), this.files.get(path));
        return this.files.delete(path) ? 0 : NOENT;
      },
      path_readlink: () => INVAL,
    };
  }

  opened(path, how, out) {
    const [create, folder, exclusive, truncate] = [1, 2, 4, 8].map((flag) => how & flag);
    const opened = (entry) => {
      this.open.set(this.next, entry);
      return this.give(out, this.next++);
    };
    if (this.folders.has(path)) return create ? ISDIR : opened({ kind: FOLDER, path });
    if (folder) return this.files.has(path) ? NOTDIR : NOENT;
    if (this.files.has(path) && exclusive) return EXIST;
    if (!this.files.has(path)) {
      if (!create || !this.folders.has(path.split("/").slice(0, -1).join("/"))) return NOENT;
      this.files.set(path, new Bytes());
    }
    const file = this.files.get(path);
    if (truncate) file.resize(0);
    return opened({ kind: FILE, file, at: 0 });
  }

  list(path, at, length, from, out) {
    const buffer = this.memoryAt(at, length);
    let used = 0;
    for (const [index, [name, kind]] of this.inner(path).entries()) {
      if (index < from || used >= length) continue;
      const bytes = new TextEncoder().encode(name);
      const entry = new Uint8Array(24 + bytes.length);
      const view = new DataView(entry.buffer);
      view.setBigUint64(0, BigInt(index + 1), true);
      view.setUint32(16, bytes.length, true);
      view.setUint8(20, kind);
      entry.set(bytes, 24);
      const part = entry.subarray(0, length - used);
      buffer.set(part, used);
      used += part.length;
    }
    return this.give(out, used);
  }
}

/** Runs the engine on a request's text and returns its reply's. */
function run(module, text, heard) {
  const system = new System(new TextEncoder().encode(text), heard);
  const functions = system.functions();
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = functions[name] ?? (() => NOSYS);
  const instance = new WebAssembly.Instance(module, imports);
  system.memory = instance.exports.memory;
  try {
    instance.exports._start();
  } catch (error) {
    if (!(error instanceof Exit)) throw new Error(`${error.message}. ${system.errors.trim()}`.trim());
  }
  return new TextDecoder().decode(system.output.bytes);
}

let engine = null;

onmessage = ({ data }) => {
  if (data.module) {
    engine = data.module;
    return;
  }
  try {
    postMessage({ reply: JSON.parse(run(engine, data.text, (progress) => postMessage({ progress }))) });
  } catch (error) {
    postMessage({ reply: { refused: { error: `The engine failed, which is a bug: ${error.message}` } } });
  }
};
