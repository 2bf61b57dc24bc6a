// Runs the module of platform/baremetal/wasm under Node.js:
//
//     node host.mjs MODULE RUNS WORD...
//
// Runs the module with these words as its command line. Files, the console and the exit use Arm's semihosting, as on a
// board. Prints the output of the last run; then "ms_0" and the least milliseconds of all runs for stage 0, and so on.
import fs from "node:fs";

const OPEN = 0x01, CLOSE = 0x02, WRITE = 0x05, READ = 0x06, SEEK = 0x0a, LENGTH = 0x0c, COMMAND_LINE = 0x15, EXIT = 0x20;
const MODE_WRITE = 5;
const CONSOLE = 1; // handles above are files
const NO_STAGE = -1;

class Ended extends Error {
  constructor(status) {
    super();
    this.status = status;
  }
}

// The environment of one run.
class Host {
  constructor(words) {
    this.line = ["trim3r", ...words].join(" ");
    this.printed = [];
    this.files = new Map(); // handle: descriptor and position
    this.milliseconds = new Map(); // stage: time
    this.stage = NO_STAGE;
    this.since = performance.now();
  }

  bytes(at, count) {
    return new Uint8Array(this.memory.buffer, at, count);
  }

  text(at, count) {
    return Buffer.from(this.bytes(at, count)).toString();
  }

  open(path, mode) {
    if (path === ":tt") {
      return CONSOLE;
    }
    try {
      const handle = CONSOLE + 1 + this.files.size;
      this.files.set(handle, { descriptor: fs.openSync(path, mode === MODE_WRITE ? "w" : "r"), position: 0 });
      return handle;
    } catch {
      return -1;
    }
  }

  // Returns the number of bytes that were not written.
  write(handle, at, count) {
    if (handle === CONSOLE) {
      this.printed.push(this.text(at, count));
      return 0;
    }
    return count - fs.writeSync(this.files.get(handle).descriptor, this.bytes(at, count));
  }

  // Returns the number of bytes that were not read.
  read(handle, at, count) {
    const file = this.files.get(handle);
    const got = fs.readSync(file.descriptor, this.bytes(at, count), 0, count, file.position);
    file.position += got;
    return count - got;
  }

  close(handle) {
    if (handle !== CONSOLE) {
      fs.closeSync(this.files.get(handle).descriptor);
    }
    return 0;
  }

  commandLine(at, room) {
    const text = Buffer.from(`${this.line}\0`);
    if (text.length > room) {
      return -1;
    }
    this.bytes(at, room).set(text);
    return 0;
  }

  semihost(operation, block) {
    const [a, b, c] = new Uint32Array(this.memory.buffer, block, 3);
    switch (operation) {
      case OPEN:
        return this.open(this.text(a, c), b);
      case CLOSE:
        return this.close(a);
      case WRITE:
        return this.write(a, b, c);
      case READ:
        return this.read(a, b, c);
      case SEEK:
        this.files.get(a).position = b;
        return 0;
      case LENGTH:
        return fs.fstatSync(this.files.get(a).descriptor).size;
      case COMMAND_LINE:
        return this.commandLine(a, b);
      case EXIT:
        throw new Ended(b);
      default:
        return -1;
    }
  }

  mark(stage) {
    const now = performance.now();
    if (this.stage !== NO_STAGE) {
      this.milliseconds.set(this.stage, (this.milliseconds.get(this.stage) ?? 0) + now - this.since);
    }
    this.stage = stage;
    this.since = now;
  }

  // Returns the module's exit status.
  run(module) {
    const imports = {
      semihost: (operation, block) => this.semihost(operation, block),
      mark: (stage) => this.mark(stage),
    };
    const { exports } = new WebAssembly.Instance(module, { host: imports });
    this.memory = exports.memory;
    try {
      exports.run();
    } catch (ended) {
      if (ended instanceof Ended) {
        return ended.status;
      }
      throw ended;
    }
    return 2; // it returned without an exit call
  }
}

const [file, runs, ...words] = process.argv.slice(2);
const module = new WebAssembly.Module(fs.readFileSync(file));
const least = new Map();
for (let run = 1; run <= Number(runs); run++) {
  const host = new Host(words);
  const status = host.run(module);
  for (const [stage, time] of host.milliseconds) {
    least.set(stage, Math.min(time, least.get(stage) ?? Infinity));
  }
  if (run === Number(runs) || status !== 0) {
    process.stdout.write(host.printed.join(""));
    process.exitCode = status;
  }
  if (status !== 0) {
    break;
  }
}
for (const [stage, time] of least) {
  console.log(`ms_${stage} ${time.toFixed(3)}`);
}
