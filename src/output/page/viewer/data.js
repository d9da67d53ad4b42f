"use strict";
/* The data of the page: docs/reference/page-format.md of the sandbox has their format. */

/** The bytes of a text in base64. */
function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < bytes.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/** The bytes that an element of the page holds, decompressed. */
async function inflated(element) {
  const stream = new Blob([bytesOf(element.textContent)]).stream();
  const plain = stream.pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(plain).arrayBuffer());
}

/**
 * The frames of a block. Track `k` is a person `ids[k]` in `counts[k]` frames from `firsts[k]` on; its value of a
 * column in a frame is `columns[column][starts[k] + frame - firsts[k]]`.
 */
function decoded(bytes, width) {
  let at = 0;
  const number = () => {
    let value = 0, factor = 1, byte;
    do {
      byte = bytes[at++];
      value += (byte & 127) * factor;
      factor *= 128;
    } while (byte > 127);
    return value;
  };
  const frames = number(), count = number();
  const block = {
    frames,
    ids: new Float64Array(count),
    firsts: new Int32Array(count),
    counts: new Int32Array(count),
    starts: new Int32Array(count),
    radii: new Int32Array(count),
    groups: new Int32Array(count),
    columns: [],
  };
  let id = 0, rows = 0;
  for (let k = 0; k < count; k++) {
    const step = number();
    id += step % 2 ? -(step + 1) / 2 : step / 2;
    block.ids[k] = id;
    block.firsts[k] = number();
    block.counts[k] = number();
    block.radii[k] = number();
    block.groups[k] = number();
    block.starts[k] = rows;
    rows += block.counts[k];
  }
  for (let column = 0; column < width; column++) {
    const values = new Int32Array(rows);
    const isSecond = bytes[at++] === 2;
    let start = 0, row = 0;
    for (let k = 0; k < count; k++) {
      let value = start, slope = 0;
      for (let left = block.counts[k]; left > 0; left--, row++) {
        let byte = bytes[at++], rest = byte & 127, shift = 7;
        while (byte > 127) {
          byte = bytes[at++];
          rest |= (byte & 127) << shift;
          shift += 7;
        }
        const step = (rest >>> 1 ^ -(rest & 1)) + slope | 0;
        value = value + step | 0;
        values[row] = value;
        if (left === block.counts[k]) start = value;
        else if (isSecond) slope = step;
      }
    }
    block.columns.push(values);
  }
  return block;
}

/** A run: its scene, its times and time series, and its blocks, which are decoded when they are needed. */
class Run {
  /** The most blocks that are kept decoded. */
  static MOST = 6;

  constructor(scene) {
    this.scene = scene;
    /** What holds the blocks of people and of forces, part by part: elements of the page, or bytes. */
    this.sources = [[], []];
    this.kept = new Map();
    this.times = [];
    this.starts = [];
    this.series = scene.series.map(() => []);
    this.events = [];
  }

  /** The run that the page holds. */
  static async read() {
    const run = new Run(JSON.parse(document.getElementById("scene").textContent));
    run.sources = ["crowd", "forces"].map(name => [...document.getElementsByClassName(name)]);
    for (const element of document.getElementsByClassName("series")) {
      let part;
      try {
        part = JSON.parse(new TextDecoder().decode(await inflated(element)));
      } catch {
        break; // the file was cut off here
      }
      run.add(part);
    }
    return run;
  }

  /** Adds a part, which begins with the last frame of the part before unless there is a gap between them. */
  add(part, joins = true) {
    this.starts.push(joins ? Math.max(this.times.length - 1, 0) : this.times.length);
    this.times.push(...part.times);
    this.series.forEach((values, k) => values.push(...part.series[k]));
    this.events.push(...part.events);
  }

  get last() {
    return this.times.length - 1;
  }

  /** The last frame at or before a time, or the first frame. */
  frameAt(time) {
    let low = 0, high = this.last;
    while (low < high) {
      const middle = low + high + 1 >> 1;
      if (this.times[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** The number of the block with a frame and the one after it. */
  partOf(frame) {
    let k = this.starts.length - 1;
    while (k > 0 && this.starts[k] > frame) k--;
    return k;
  }

  /** A block that is decoded, or nothing; decoding then begins, and `then` is called after it. */
  block(kind, part, then = () => {}) {
    const source = this.sources[kind][part];
    if (!source) return null;
    const known = this.kept.get(source);
    this.keep(source, known ?? "reading");
    if (known === undefined) this.decode(source, kind).then(then);
    return known === "reading" ? null : known ?? null;
  }

  async decode(source, kind) {
    this.keep(source, decoded(await inflated(source), this.width(kind)));
  }

  /** Keeps a block as the last that was needed, and forgets those that were not needed for the longest time. */
  keep(source, block) {
    this.kept.delete(source);
    this.kept.set(source, block);
    while (this.kept.size > this.constructor.MOST) this.kept.delete(this.kept.keys().next().value);
  }

  /** The number of columns of people or of forces. */
  width(kind) {
    return kind === 0 ? this.scene.columns.length : 2 * this.scene.terms.length;
  }

  /** The person with an id in a frame of a block: the number of its track, or −1. */
  static find(block, id, frame) {
    let low = 0, high = block.ids.length;
    while (low < high) {
      const middle = low + high >> 1;
      if (block.ids[middle] < id) low = middle + 1;
      else high = middle;
    }
    for (; block.ids[low] === id; low++) {
      const after = frame - block.firsts[low];
      if (after >= 0 && after < block.counts[low]) return low;
    }
    return -1;
  }
}
