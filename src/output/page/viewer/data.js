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

  static async read() {
    const run = new Run();
    run.scene = JSON.parse(document.getElementById("scene").textContent);
    run.elements = ["crowd", "forces"].map(name => [...document.getElementsByClassName(name)]);
    run.kept = new Map();
    run.times = [];
    run.starts = [];
    run.series = run.scene.series.map(() => []);
    run.events = [];
    for (const element of document.getElementsByClassName("series")) {
      let part;
      try {
        part = JSON.parse(new TextDecoder().decode(await inflated(element)));
      } catch {
        break; // the file was cut off here
      }
      run.starts.push(Math.max(run.times.length - 1, 0));
      run.times.push(...part.times);
      run.series.forEach((values, k) => values.push(...part.series[k]));
      run.events.push(...part.events);
    }
    return run;
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
    const element = this.elements[kind][part];
    if (!element) return null;
    const key = 2 * part + kind;
    const known = this.kept.get(key);
    this.kept.delete(key);
    this.kept.set(key, known ?? "reading");
    if (known === undefined) {
      const width = kind === 0 ? this.scene.columns.length : 2 * this.scene.terms.length;
      inflated(element).then(bytes => {
        this.kept.set(key, decoded(bytes, width));
        then();
      });
      while (this.kept.size > Run.MOST) this.kept.delete(this.kept.keys().next().value);
    }
    return known === "reading" ? null : known ?? null;
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
